"""How walls treat what meets them: what a wall, or a side of the domain, has of its own."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields
from typing import Any

from eventsim.scene.numbers import FASTEST, LONGEST, SHORTEST, SLOWEST, SPEED, number
from eventsim.scene.restitution import line


@dataclass(frozen=True, slots=True, kw_only=True)
class Manner:
    """What becomes of the velocity of a disk at a wall; None: as the scene says.

    restitution: the share (0 to 1) of the normal approach velocity that comes back.  shaking: a saw-tooth of vanishing amplitude
    with this speed, length / time.  temperature: kT, mass length^2 / time^2, of a Maxwell flux that replaces the velocity.
    velocity: of the wall along itself, from start to end, along +x or +y, around a circle or ellipse counter-clockwise; its ends
    and vertices are at rest.
    """

    restitution: float | None = field(default=None, metadata=line("0.5"))
    shaking: float | None = field(default=None, metadata=line("0.3"))
    temperature: float | None = field(default=None, metadata=line("2.0"))
    velocity: float | None = field(default=None, metadata=line("1.0"))

    def __post_init__(self) -> None:
        """Store numbers as floats.

        Raises:
            SceneError: for what is no number.
        """
        for key in KEYS:
            value = getattr(self, key)
            object.__setattr__(self, key, None if value is None else number(value, f"wall.{key}"))

    @property
    def manner(self) -> dict[str, float]:
        """What the wall has of its own, by key."""
        return {key: value for key in KEYS if (value := getattr(self, key)) is not None}


class Side(Manner):
    """A side of the domain."""

    __slots__ = ()


KEYS = tuple(item.name for item in fields(Manner))
"""The keys that a [[wall]] table and a side of the domain have in common."""

EXAMPLES = {item.name: f"{item.name} = {item.metadata['line']}" for item in fields(Manner)}
"""A line for each of them."""


def manner_problems(values: Mapping[str, Any]) -> Iterator[str]:
    """Rules of what walls have of their own, of which some may be missing; each problem begins with the key that breaks it."""
    share = values.get("restitution")
    if share is not None and not 0.0 <= share <= 1.0:
        yield f".restitution = {share}: must be from 0 to 1"
    shaking, warm, along = (values.get(key) for key in ("shaking", "temperature", "velocity"))
    if shaking is not None and shaking != 0.0 and not SLOWEST <= shaking <= FASTEST:
        yield f".shaking = {shaking}: {SPEED}"
    if warm is not None and not SHORTEST <= warm <= LONGEST:
        yield f".temperature = {warm}: must be from {SHORTEST} to {LONGEST}"
    if along is not None and along != 0.0 and not SLOWEST <= abs(along) <= FASTEST:
        yield f".velocity = {along}: {SPEED}, along the wall or, with a minus, against it"
    for key in ("restitution", "shaking"):
        if warm is not None and values.get(key) is not None:
            yield f".{key} stands beside temperature: a wall that heats takes no account of how a disk came"
