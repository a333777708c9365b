"""The straight part of a segment, hard on both sides; its ends are posts."""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from typing import NamedTuple

from eventsim.formulas.crossing import closing_delay, reopening_delay
from eventsim.formulas.real import NEVER, Acceleration, Real, is_float, sqrt
from eventsim.formulas.roots import Line, Moment, falls_to, less_number

TOUCHING = 2.0**-48
"""A gap is rounding below this part of the coordinates: 16 units in their last place, as for disks that touch at the start."""


class Face(NamedTuple):
    """A segment from (x, y) along (ex, ey); normal (nx, ny), not of unit length; norm = |n|; norm2 = n.n; along2 = e.e."""

    x: float
    y: float
    ex: float
    ey: float
    nx: float
    ny: float
    norm: float
    norm2: float
    along2: float

    @staticmethod
    def word() -> str:
        """What messages call one such shape."""
        return "straight face"

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
        """(delay, side) of the next contact with the face; met: the side last met, 0 if another contact came since."""
        if gx is None and met != 0:
            return NEVER, met
        distance = self.nx * (x - self.x) + self.ny * (y - self.y)
        rate = self.nx * vx + self.ny * vy
        width = radius * self.norm
        side = met if met != 0 else face_side(self, x, y, vx, vy)
        if gx is None:
            delay = closing_delay(side * distance - width, side * rate, None)
            if delay < NEVER and is_within(self, x + vx * delay, y + vy * delay):
                return delay, side
            return NEVER, side
        fall = self.nx * gx + self.ny * gy
        delay = closing_delay(0.0 if touches else side * distance - width, side * rate, side * fall)
        if delay < NEVER and is_within(
            self, x + delay * (vx + (0.5 * gx) * delay), y + delay * (vy + (0.5 * gy) * delay)
        ):
            return delay, side
        delay = reopening_delay(-(side * distance) - width, -(side * rate), -(side * fall))
        if delay < NEVER and is_within(
            self, x + delay * (vx + (0.5 * gx) * delay), y + delay * (vy + (0.5 * gy) * delay)
        ):
            return delay, -side
        return NEVER, side

    def normal(self, side: int, x: Real, y: Real) -> tuple[Real, Real]:
        """The normal, of any length, that points to the disk."""
        return side * self.nx, side * self.ny

    def touching(self, side: int, x: Real, y: Real, radius: Real) -> tuple[Real, Real]:
        """The centre of a disk on contact, next to (x, y): exactly where the face is along an axis."""
        if self.ey == 0.0:
            return x, self.y + (side * self.ny) * radius
        if self.ex == 0.0:
            return self.x + (side * self.nx) * radius, y
        if not is_float(x):  # nothing is rounded: it is there
            return x, y
        nx, ny = side * self.nx, side * self.ny
        share = ((nx * (x - self.x) + ny * (y - self.y)) - radius * self.norm) / self.norm2
        return x - share * nx, y - share * ny

    def nearest(self, x: Real, y: Real) -> tuple[Real, Real, Real]:
        """(nx, ny, distance): the unit normal that points to a centre, and its distance; NEVER beyond an end."""
        dx, dy = x - self.x, y - self.y
        along = self.ex * dx + self.ey * dy
        if along < 0.0 or along > self.along2:
            return 0.0, 0.0, NEVER
        nx, ny = self.nx / self.norm, self.ny / self.norm
        distance = nx * dx + ny * dy
        side = 1.0 if distance >= 0.0 else -1.0
        return side * nx, side * ny, side * distance

    def moment(self, x: Line, y: Line, side: int, radius: float) -> Moment | None:
        """The exact time of a contact."""
        x, y = less_number(x, self.x), less_number(y, self.y)
        nx, ny = Fraction(self.nx), Fraction(self.ny)
        distance = nx * x[0] + ny * y[0], nx * x[1] + ny * y[1], nx * x[2] + ny * y[2]
        return falls_to(distance, side * (radius * self.norm), side)

    def line(self) -> Face:
        """The face along which disks may rest and slide."""
        return self

    def lies_on(self, line: Face) -> bool:
        """Whether both ends are on the line of another face."""
        return is_in_line(line, self.x, self.y) and is_in_line(line, self.x + self.ex, self.y + self.ey)

    def at_origin(self) -> Face:
        """The same face with its start in the origin."""
        return self._replace(x=0.0, y=0.0)

    def in_numbers(self, number: Callable[[float], Real]) -> Face:
        """The same face in other numbers than floats; what is derived is derived anew, from its corners."""
        exact = Face(*map(number, self))
        norm2 = exact.nx * exact.nx + exact.ny * exact.ny
        return exact._replace(norm=sqrt(norm2), norm2=norm2, along2=exact.ex * exact.ex + exact.ey * exact.ey)


face_delay, face_normal, face_nearest, face_touching = Face.delay, Face.normal, Face.nearest, Face.touching
"""The same for kernels."""


def face(x0: float, y0: float, x1: float, y1: float) -> Face:
    """The face from (x0, y0) to (x1, y1).  Parallel to an axis: a unit normal, so that reflection is exact."""
    ex, ey = x1 - x0, y1 - y0
    if ex == 0.0:
        nx, ny = -math.copysign(1.0, ey), 0.0
    elif ey == 0.0:
        nx, ny = 0.0, math.copysign(1.0, ex)
    else:
        nx, ny = -ey, ex
    norm2 = nx * nx + ny * ny
    return Face(x0, y0, ex, ey, nx, ny, math.sqrt(norm2), norm2, ex * ex + ey * ey)


def face_side(shape: Face, x: Real, y: Real, vx: Real, vy: Real) -> int:
    """The side of the face that a centre is on; a point exactly on the line is on the side that it moves to."""
    distance = shape.nx * (x - shape.x) + shape.ny * (y - shape.y)
    if distance > 0.0:
        return 1
    if distance < 0.0:
        return -1
    return 1 if shape.nx * vx + shape.ny * vy > 0.0 else -1


def is_within(shape: Face, x: Real, y: Real) -> bool:
    """Whether the foot of a centre lies on the segment, ends included."""
    along = shape.ex * (x - shape.x) + shape.ey * (y - shape.y)
    return bool(not along < 0.0 and not along > shape.along2)


def is_in_line(shape: Face, x: Real, y: Real) -> bool:
    """Whether a point is on the line of a face: a disk that slides on the face grazes what ends there, and does not meet it."""
    distance = shape.nx * (x - shape.x) + shape.ny * (y - shape.y)
    scale = shape.norm * (abs(x) + abs(y) + abs(shape.x) + abs(shape.y))
    return bool(not distance > TOUCHING * scale and not distance < -(TOUCHING * scale))


def slope(shape: Face, u: Real, w: Real) -> tuple[Real, Real]:
    """The part of a vector that is along a face; exact where the face is along an axis."""
    if shape.ey == 0.0:
        return u, 0.0
    if shape.ex == 0.0:
        return 0.0, w
    share = (u * shape.ex + w * shape.ey) / (shape.ex * shape.ex + shape.ey * shape.ey)
    return share * shape.ex, share * shape.ey
