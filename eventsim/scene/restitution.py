"""How much of the approach velocity comes back at a contact."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields
from typing import Any, TypeAlias

from eventsim.errors import SceneError
from eventsim.scene.numbers import number


def line(example: str) -> dict[str, str]:
    """What messages show of a key."""
    return {"line": example}


def of_law(example: str) -> dict[str, str]:
    """The same of a key that asks for a law of its own, one that looks at the speed of approach."""
    return line(example) | {"law": "by speed"}


Pairs: TypeAlias = tuple[tuple[str, str, float], ...]
"""Shares between species: (name, name, share), the smaller name first."""


@dataclass(frozen=True, slots=True)
class Restitution:
    """The share (0 to 1) of the normal approach velocity that comes back: between disks, and at walls.

    yield_speed: length / time; above it less comes back, as the inverse fourth root of the approach.  None: not so.
    pairs: shares between disks of two species, as in {"a-b": 0.8}; they beat `pair`.  Kept as (name, name, share), sorted.
    """

    pair: float = field(default=1.0, metadata=line("0.9"))
    wall: float = field(default=1.0, metadata=line("1.0"))
    yield_speed: float | None = field(default=None, metadata=of_law("0.5"))
    pairs: Pairs = field(default=(), metadata=line('{"a-b" = 0.8}'))

    def __post_init__(self) -> None:
        object.__setattr__(self, PAIRS, _pairs(self.pairs))
        for key in KEYS:
            value = getattr(self, key)
            if key == PAIRS:
                continue
            object.__setattr__(self, key, None if value is None else number(value, f"restitution.{key}"))

    def table(self) -> dict[str, Any]:
        """What a scene file writes of it."""
        found = {key: getattr(self, key) for key in KEYS if key != PAIRS and getattr(self, key) is not None}
        return found | ({PAIRS: {f"{a}-{b}": share for a, b, share in self.pairs}} if self.pairs else {})

    @property
    def laws(self) -> tuple[str, ...]:
        """The keys that ask for a law by speed: of a sound scene at most one."""
        return tuple(key for key in OF_LAWS if getattr(self, key) is not None)

    def problems(self) -> Iterator[str]:
        """Rules that its numbers break, one sentence each."""
        for other in self.laws[1:]:
            yield f"restitution.{other}: has a restitution.{self.laws[0]} beside it: one law says what comes back"
        for a, b, share in self.pairs:
            if not 0.0 <= share <= 1.0:
                yield f"restitution.pairs.{a}-{b} = {share}: must be from 0 to 1"
        pair, wall = self.pair, self.wall
        both = {"restitution": pair} if pair == wall else {"restitution.pair": pair, "restitution.wall": wall}
        for key, value in both.items():
            if not 0.0 <= value <= 1.0:
                yield f"{key} = {value}: must be from 0 to 1"
        if self.yield_speed is not None and not 0.0 < self.yield_speed < math.inf:
            yield f"restitution.yield_speed = {self.yield_speed}: must be a finite speed above 0"


PAIRS = "pairs"
KEYS = tuple(item.name for item in fields(Restitution))
"""The keys of a `restitution = {...}` table."""

OF_LAWS = tuple(item.name for item in fields(Restitution) if "law" in item.metadata)
"""Those that ask for a law by speed."""

EXAMPLES = {item.name: f"{item.name} = {item.metadata['line']}" for item in fields(Restitution)}
"""A line for each of them."""


def _pairs(given: Any) -> Pairs:
    """Shares of pairs of species in one form.

    Raises:
        SceneError: for what are not two names with a hyphen between.
    """
    if not isinstance(given, Mapping):
        triples = isinstance(given, tuple | list) and all(isinstance(one, tuple | list) and len(one) == 3 for one in given)
        if not triples:
            raise SceneError(f'restitution.pairs = {given!r}: must be a table of pairs of species, as {{"a-b" = 0.5}}')
        return tuple((a, b, share) for a, b, share in given)
    found: dict[tuple[str, str], float] = {}
    problems: list[str] = []
    for key, share in given.items():
        names = tuple(sorted(str(key).split("-")))
        if len(names) != 2 or not all(names):
            problems.append(f'restitution.pairs.{key}: must be two species with a hyphen between, as in "a-b"')
        elif names in found:
            problems.append(f"restitution.pairs.{key}: these two species have a share already")
        else:
            found[names[0], names[1]] = number(share, f"restitution.pairs.{key}")
    if problems:
        raise SceneError(problems)
    return tuple((a, b, share) for (a, b), share in sorted(found.items()))


def as_restitution(value: Restitution | Mapping[str, Any] | float | None) -> Restitution | None:
    """The restitution meant by a number (both alike), a mapping with its keys, or None; None if elastic.

    Raises:
        SceneError: if the value is none of these.
    """
    if value is None:
        return None
    if isinstance(value, Mapping):
        unknown = [key for key in value if key not in KEYS]
        if unknown:
            raise SceneError([f"restitution.{key}: unknown key (known: {', '.join(KEYS)})" for key in unknown])
        value = Restitution(**value)
    elif not isinstance(value, Restitution):
        value = Restitution(number(value, "restitution"), number(value, "restitution"))
    return None if value == Restitution() else value
