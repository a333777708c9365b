"""What every shape of a wall knows: all that engines, replay and proofs ask of it.

A shape is a tuple of numbers (a NamedTuple), so that compiled engines can take it as it is.  What kernels need of it is also a
plain function beside the class.  Sides: +1 or -1 for the two sides of a thin wall; 0: the disk has not met this wall last, and
its place says on which side it is.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Protocol, Self

from eventsim.formulas.low_place import Low
from eventsim.formulas.real import Acceleration, Real
from eventsim.formulas.roots import Line, Moment

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
    ) -> tuple[Real, int]:
        """(delay, side) of the next contact of a disk; met: the side last met, 0 if another contact came since.

        touches: the flight, under gravity, begins on contact with that side, wherever rounding has put the disk: then no bounce
        is too low for the digits of its place.
        """

    def normal(self, side: int, x: Real, y: Real) -> tuple[Real, Real]:
        """The normal, of any length, that points to a disk at (x, y)."""

    def touching(self, side: int, x: Real, y: Real, radius: Real) -> tuple[Real, Real]:
        """The centre of a disk on contact, next to (x, y), but for the last bits."""

    def nearest(self, x: Real, y: Real) -> tuple[Real, Real, Real]:
        """(nx, ny, distance): the unit normal that points to a centre, and its distance; NEVER beside the shape."""

    def moment(self, x: Line, y: Line, side: int, radius: float) -> Moment | None:
        """The exact time of a contact; None where it is no root of a quadratic, and counts with its float time.

        x, y: the flight of the centre.
        """

    def line(self) -> Face | None:
        """The face along which disks may rest and slide; None for what is round."""

    def lies_on(self, line: Face) -> bool:
        """Whether a disk that slides on the line of a face passes this shape: all of it is on that line."""

    def at_origin(self) -> Self:
        """The same shape with its point (x, y) in the origin."""

    def in_numbers(self, number: Callable[[float], Real]) -> Self:
        """The same shape in other numbers than floats."""


Seen = tuple[Shape, Real, Real]
"""A shape, and a place as it is told from there."""


def seen(shape: Shape, x: Real, y: Real, low: Low) -> Seen:
    """A shape and the place (x, y) of a disk: relative to the shape's point where places have low parts."""
    if low is None:
        return shape, x, y
    return shape.at_origin(), (x - shape.x) + low[0], (y - shape.y) + low[1]
