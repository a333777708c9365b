"""How much of the approach velocity comes back at a contact."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from eventsim.errors import SceneError
from eventsim.scene.numbers import number


@dataclass(frozen=True, slots=True)
class Restitution:
    """The share (0 to 1) of the normal approach velocity that comes back: between disks, and at walls."""

    pair: float = 1.0
    wall: float = 1.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "pair", number(self.pair, "restitution.pair"))
        object.__setattr__(self, "wall", number(self.wall, "restitution.wall"))


def as_restitution(value: Restitution | Mapping[str, float] | float | None) -> Restitution | None:
    """The restitution meant by a number (both alike), a mapping with pair and wall, or None; None if elastic.

    Raises:
        SceneError: if the value is none of these.
    """
    if value is None:
        return None
    if isinstance(value, Mapping):
        unknown = [key for key in value if key not in ("pair", "wall")]
        if unknown:
            raise SceneError([f"restitution.{key}: unknown key (known: pair, wall)" for key in unknown])
        value = Restitution(**value)
    elif not isinstance(value, Restitution):
        value = Restitution(number(value, "restitution"), number(value, "restitution"))
    return None if value == Restitution() else value
