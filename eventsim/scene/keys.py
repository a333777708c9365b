"""Keys of a table: which there may be, which there must be, and what reads the value of each."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeAlias

Reader: TypeAlias = Callable[[object], Any]
"""Gives a value in its type, or raises Invalid."""


class Invalid(ValueError):  # noqa: N818  (a verdict on a value, which becomes one sentence among others)
    """What a value must be, and is not."""


class Optional(str):
    """A key that may be there."""

    __slots__ = ()


class Required(str):
    """A key that must be there."""

    __slots__ = ()


class Schema:
    """The keys of a kind of table, each with what reads its value."""

    def __init__(self, schema: Mapping[Any, Reader]) -> None:
        """schema: by Optional or Required keys."""
        self.schema = dict(schema)
