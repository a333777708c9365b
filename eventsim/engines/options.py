"""What an engine can be told, as a frozen dataclass: Python callers and the command line read the same one."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from numbers import Integral, Real
from typing import Any, Literal, get_args, get_origin, get_type_hints


@dataclass(frozen=True, slots=True)
class Options:
    """The options of an engine that has none; an engine that has some adds a dataclass of its own."""


def option(default: Any, words: str) -> Any:
    """An option that the command line knows too; words: what its value is."""
    return field(default=default, metadata={"words": words})


def words_of(kind: type[Options]) -> dict[str, str]:
    """name -> what its value is, of the options that the command line knows."""
    return {item.name: item.metadata["words"] for item in fields(kind) if "words" in item.metadata}


def names_of(kind: type[Options]) -> list[str]:
    """The names of all options, also of those that only Python callers have."""
    return [item.name for item in fields(kind)]


def wrong_value(kind: type[Options], name: str, value: Any) -> str | None:
    """What the value of an option must be, where it is of another type; None where it may be."""
    words = words_of(kind).get(name)
    return None if words is None or any(_fits(value, one) for one in _types(kind, name)) else words


def read_option(kind: type[Options], name: str, text: str) -> Any:
    """The value of an option from text; ValueError for what it cannot be."""
    for one in _types(kind, name):
        if one is bool and text.lower() in ("true", "false"):
            return text.lower() == "true"
        if one in (int, float):
            return one(text)
        if text == one:
            return text
    raise ValueError(text)


def _types(kind: type[Options], name: str) -> tuple[Any, ...]:
    """What an option may be: types, or the texts of a Literal."""
    hint = get_type_hints(kind)[name]
    return get_args(hint) if get_origin(hint) is Literal or get_args(hint) else (hint,)


def _fits(value: Any, one: Any) -> bool:
    if one in (int, float):
        return isinstance(value, Integral if one is int else Real) and not isinstance(value, bool)
    return isinstance(value, one) if isinstance(one, type) else bool(value == one)
