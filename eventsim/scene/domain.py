"""The region in which the disks live, and what happens at its boundary."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, TypeAlias

from eventsim.scene.numbers import Point, point


@dataclass(frozen=True, slots=True)
class _Rectangle:
    """A rectangle of `size` (width, height), length, with its lower-left corner at `origin`."""

    size: Point
    origin: Point = (0.0, 0.0)
    periodic: ClassVar[tuple[bool, bool]]

    def __post_init__(self) -> None:
        object.__setattr__(self, "size", point(self.size, "domain.size"))
        object.__setattr__(self, "origin", point(self.origin, "domain.origin"))

    @property
    def period(self) -> tuple[float | None, float | None]:
        """The period along x and y; None along an axis without one."""
        (width, height), (along_x, along_y) = self.size, self.periodic
        return (width if along_x else None), (height if along_y else None)


@dataclass(frozen=True, slots=True)
class Box(_Rectangle):
    """Four hard walls, named left, right, bottom and top."""

    kind: ClassVar[str] = "box"
    periodic: ClassVar[tuple[bool, bool]] = (False, False)


@dataclass(frozen=True, slots=True)
class Periodic(_Rectangle):
    """A torus: what leaves on one side comes in on the other."""

    kind: ClassVar[str] = "periodic"
    periodic: ClassVar[tuple[bool, bool]] = (True, True)


@dataclass(frozen=True, slots=True)
class Channel(_Rectangle):
    """Periodic in x; hard walls named bottom and top."""

    kind: ClassVar[str] = "channel"
    periodic: ClassVar[tuple[bool, bool]] = (True, False)


@dataclass(frozen=True, slots=True)
class Open:
    """The whole plane: no boundary, no size."""

    kind: ClassVar[str] = "open"
    periodic: ClassVar[tuple[bool, bool]] = (False, False)
    period: ClassVar[tuple[None, None]] = (None, None)
    size: ClassVar[None] = None
    origin: ClassVar[Point] = (0.0, 0.0)


Domain: TypeAlias = Box | Periodic | Channel | Open
DOMAINS: dict[str, type[Domain]] = {kind.kind: kind for kind in (Box, Periodic, Channel, Open)}
BOUNDARY_NAMES = ("left", "right", "bottom", "top")


def hard_sides(domain: Domain) -> tuple[str, ...]:
    """The names of the sides that are walls: four of a box, two of a channel, else none."""
    if isinstance(domain, Open):
        return ()
    along_x, along_y = domain.periodic
    return (() if along_x else BOUNDARY_NAMES[:2]) + (() if along_y else BOUNDARY_NAMES[2:])
