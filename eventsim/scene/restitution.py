"""How much of the approach velocity comes back at a contact."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields

from eventsim.errors import SceneError
from eventsim.scene.numbers import number


def line(example: str) -> dict[str, str]:
    """What messages show of a key."""
    return {"line": example}


@dataclass(frozen=True, slots=True)
class Restitution:
    """The share (0 to 1) of the normal approach velocity that comes back: between disks, and at walls.

    yield_speed: length / time; above it less comes back, as the inverse fourth root of the approach.  None: not so.
    """

    pair: float = field(default=1.0, metadata=line("0.9"))
    wall: float = field(default=1.0, metadata=line("1.0"))

    yield_speed: float | None = field(default=None, metadata=line("0.5"))

    def __post_init__(self) -> None:
        for key in KEYS:
            value = getattr(self, key)
            object.__setattr__(self, key, None if value is None else number(value, f"restitution.{key}"))

    def problems(self) -> Iterator[str]:
        """Rules that its numbers break, one sentence each."""
        pair, wall = self.pair, self.wall
        both = {"restitution": pair} if pair == wall else {"restitution.pair": pair, "restitution.wall": wall}
        for key, value in both.items():
            if not 0.0 <= value <= 1.0:
                yield f"{key} = {value}: must be from 0 to 1"
        if self.yield_speed is not None and not 0.0 < self.yield_speed < math.inf:
            yield f"restitution.yield_speed = {self.yield_speed}: must be a finite speed above 0"


KEYS = tuple(item.name for item in fields(Restitution))
"""The keys of a `restitution = {...}` table."""

EXAMPLES = {item.name: f"{item.name} = {item.metadata['line']}" for item in fields(Restitution)}
"""A line for each of them."""


def as_restitution(value: Restitution | Mapping[str, float] | float | None) -> Restitution | None:
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
