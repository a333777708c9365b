"""What every shape of a wall knows: all that engines, replay and proofs ask of it.

A shape is a tuple of numbers (a NamedTuple), so that compiled engines can take it as it is.  What kernels need of it is also a
plain function beside the class.  Sides: +1 or -1 for the two sides of a thin wall; 0: the disk has not met this wall last, and
its place says on which side it is.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Protocol, Self, runtime_checkable

from eventsim.formulas.real import Acceleration, Real
from eventsim.formulas.roots import Line, Moment, Quartic

if TYPE_CHECKING:
    from eventsim.formulas.walls.face import Face


class Shape(Protocol):
    """A shape at rest, told from the point (x, y)."""

    @property
    def x(self) -> float:
        """Where the point is that the shape is told from, along x."""

    @property
    def y(self) -> float:
        """The same along y."""

    def __iter__(self) -> Iterator[float]:
        """Its numbers."""

    @staticmethod
    def word() -> str:
        """What messages call one such shape."""

    def delay(
        self,
        x: Real,
        y: Real,
        vx: Real,
        vy: Real,
        gx: Acceleration,
        gy: Acceleration,
        radius: Real,
        met: int,
        touches: bool = False,
        beside: int | None = None,
    ) -> tuple[Real, int]:
        """(delay, side) of the next contact of a disk; met: the side last met, 0 if another contact came since.

        touches: the flight, under gravity, begins on contact with that side, wherever rounding has put the disk: then no bounce
        is too low for the digits of its place.  beside: of a point that is close to a thin
        wall its side, 2 or -2 in a corner; 0: its place tells; None: no disk of the scene is a point.
        """

    def normal(self, side: int, x: Real, y: Real) -> tuple[Real, Real]:
        """The normal, of any length, that points to a disk at (x, y)."""

    def touching(self, side: int, x: Real, y: Real, radius: Real) -> tuple[Real, Real]:
        """The centre of a disk on contact, next to (x, y), but for the last bits."""

    def nearest(self, x: Real, y: Real) -> tuple[Real, Real, Real]:
        """(nx, ny, distance): the unit normal that points to a centre, and its distance; NEVER beside the shape."""

    def moment(self, x: Line, y: Line, side: int, radius: float) -> Moment | Quartic | None:
        """The exact time of a contact, or the quartic whose root it is; None where it counts with its float time.

        x, y: the flight of the centre.
        """

    def line(self) -> Face | None:
        """The face along which disks may rest and slide; None for what is round."""

    def lies_on(self, line: Face) -> bool:
        """Whether a disk that slides on the line of a face passes this shape: all of it is on that line."""

    def in_numbers(self, number: Callable[[float], Real]) -> Self:
        """The same shape in other numbers than floats."""


@runtime_checkable
class Thin(Shape, Protocol):
    """A wall that is hard on both sides, with two ends: points that are close to it have to remember on which side they are."""

    @property
    def size(self) -> float:
        """Of its coordinates."""

    @property
    def x1(self) -> float:
        """Where its second end is, along x; the first is the point (x, y)."""

    @property
    def y1(self) -> float:
        """The same along y."""

    @property
    def ends(self) -> float:
        """What its ends are to points (`walls.point`)."""

    def side(self, x: Real, y: Real, vx: Real, vy: Real) -> int:
        """The side that a centre is on; exactly on the wall, or its continuation, the one that it moves to."""

    def distance(self, x: Real, y: Real) -> Real:
        """About the distance of a centre from the wall or its continuation, where it is close."""

    def rate(self, x: Real, y: Real, vx: Real, vy: Real) -> Real:
        """Above 0 where a velocity leads to the side +1."""

    def side_after(
        self,
        before: int,
        beside: int,
        x: Real,
        y: Real,
        vx: Real,
        vy: Real,
        gx: Acceleration,
        gy: Acceleration,
        radius: Real,
        px: Real,
        py: Real,
        u: Real,
        w: Real,
    ) -> int:
        """The side of a point close to the wall after a flight from (x, y), where it was on a side, to (px, py), (u, w) there.

        beside: what it remembered.
        """

    def with_ends(self, ends: float, first: tuple[float, float], second: tuple[float, float]) -> Self:
        """The same wall, with what its ends are to points, and directions from there along what makes corners with it."""

    def edge(self, second: bool) -> tuple[float, float, float, float, int]:
        """(x, y, ax, ay, side) of an end: from there, along the wall, and the side that is on the left of that."""


@runtime_checkable
class Closed(Shape, Protocol):
    """A closed wall, hard on both sides: a point stays on the side where it was placed."""

    @property
    def size(self) -> float:
        """Of its coordinates."""

    @property
    def semi_major(self) -> float:
        """Half of its longest way across; by this a closed wall is told from a thin one."""

    def side(self, x: Real, y: Real, vx: Real, vy: Real) -> int:
        """+1 outside, -1 inside; a centre exactly on the wall is on the side that it moves to."""
