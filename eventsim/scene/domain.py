"""The region in which the disks live, and what happens at its boundary."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, TypeAlias

from numpy.typing import NDArray

from eventsim.errors import SceneError
from eventsim.scene.manner import KEYS, Side
from eventsim.scene.numbers import Point, point

Sides: TypeAlias = tuple[tuple[str, Side], ...]
"""What sides of a domain have of their own, by name."""


@dataclass(frozen=True, slots=True)
class _Rectangle:
    """A rectangle of `size` (width, height), length, with its lower-left corner at `origin`.

    walls: what hard sides have of their own, by name, as in {"bottom": {"restitution": 0.5}}; kept as pairs (name, Side).
    """

    size: Point
    origin: Point = (0.0, 0.0)
    walls: Sides = ()
    periodic: ClassVar[tuple[bool, bool]]

    if TYPE_CHECKING:  # any two numbers will do

        def __init__(
            self,
            size: Sequence[float] | NDArray[Any],
            origin: Sequence[float] | NDArray[Any] = ...,
            walls: Mapping[str, Any] | Sides = ...,
        ) -> None: ...

    def __post_init__(self) -> None:
        object.__setattr__(self, "walls", _sides(self.walls, hard_sides(self)))  # type: ignore[arg-type]  # a kind of rectangle
        object.__setattr__(self, "size", point(self.size, "domain.size"))
        object.__setattr__(self, "origin", point(self.origin, "domain.origin"))

    @property
    def period(self) -> tuple[float | None, float | None]:
        """The period along x and y; None along an axis without one."""
        (width, height), (along_x, along_y) = self.size, self.periodic
        return (width if along_x else None), (height if along_y else None)


@dataclass(frozen=True, slots=True, init=False)
class Box(_Rectangle):
    """Four hard walls, named left, right, bottom and top."""

    kind: ClassVar[str] = "box"
    periodic: ClassVar[tuple[bool, bool]] = (False, False)


@dataclass(frozen=True, slots=True, init=False)
class Periodic(_Rectangle):
    """A torus: what leaves on one side comes in on the other."""

    kind: ClassVar[str] = "periodic"
    periodic: ClassVar[tuple[bool, bool]] = (True, True)


@dataclass(frozen=True, slots=True, init=False)
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
    walls: ClassVar[Sides] = ()


Domain: TypeAlias = Box | Periodic | Channel | Open
DOMAINS: dict[str, type[Domain]] = {kind.kind: kind for kind in (Box, Periodic, Channel, Open)}
BOUNDARY_NAMES = ("left", "right", "bottom", "top")


def hard_sides(domain: Domain) -> tuple[str, ...]:
    """The names of the sides that are walls: four of a box, two of a channel, else none."""
    if isinstance(domain, Open):
        return ()
    along_x, along_y = domain.periodic
    return (() if along_x else BOUNDARY_NAMES[:2]) + (() if along_y else BOUNDARY_NAMES[2:])


def _sides(given: Any, names: tuple[str, ...]) -> Sides:
    """What sides have of their own, in the order of the sides.

    Raises:
        SceneError: for what no side has.
    """
    pairs = isinstance(given, tuple | list) and all(isinstance(one, tuple | list) and len(one) == 2 for one in given)
    if not (isinstance(given, Mapping) or pairs):
        raise SceneError(f'domain.walls = {given!r}: must be a table of sides, as {{"bottom": {{"restitution": 0.5}}}}')
    table = dict(given)
    problems = [f"domain.walls.{name}: this domain has {_listed(names)}" for name in table if name not in names]
    for name, own in table.items():
        if isinstance(own, Mapping):
            problems += [f"domain.walls.{name}.{key}: unknown key (known: {', '.join(KEYS)})" for key in own if key not in KEYS]
        elif not isinstance(own, Side):
            problems.append(f"domain.walls.{name} = {own!r}: must be a table with {', '.join(KEYS)}")
    if problems:
        raise SceneError(problems)
    made = {name: own if isinstance(own, Side) else Side(**own) for name, own in table.items()}
    return tuple((name, made[name]) for name in names if name in made and made[name].manner)


def _listed(names: tuple[str, ...]) -> str:
    return f"the walls {', '.join(names)}" if names else "no walls"
