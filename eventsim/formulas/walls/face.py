"""The straight part of a segment, hard on both sides; its ends are posts."""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from typing import NamedTuple

from eventsim.formulas.crossing import closing_delay, reopening_delay
from eventsim.formulas.doubt import SLACK, TOUCHING
from eventsim.formulas.real import NEVER, Acceleration, Real, is_float, sqrt
from eventsim.formulas.roots import Line, Moment, Quartic, falls_to, less_number, root_of
from eventsim.formulas.walls.point import (
    CLOSE,
    STEEPEST,
    End,
    begins_in_corner,
    careful_line,
    end_of,
    has_passed,
    is_cornered,
    is_point,
    passes_end,
    side_known,
    way_to_wall,
)

CANCELLED = 2.0**-4
"""A part of its terms below which the distance of a point from a face is computed without rounding."""


class Face(NamedTuple):
    """A segment from (x, y) along (ex, ey) to (x1, y1); normal (nx, ny), not of unit length.

    norm = |n|; norm2 = n.n; along2 = e.e.  size: of its coordinates.  ends: what its ends are to points (`walls.point`).
    first, second: from its ends along what makes a corner with it there; 0 where nothing does.
    """

    x: float
    y: float
    ex: float
    ey: float
    nx: float
    ny: float
    norm: float
    norm2: float
    along2: float
    x1: float
    y1: float
    size: float
    ends: float = 0.0
    first_x: float = 0.0
    first_y: float = 0.0
    second_x: float = 0.0
    second_y: float = 0.0

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
        beside: int | None = None,
    ) -> tuple[Real, int]:
        """(delay, side) of the next contact with the face; met: the side last met, 0 if another contact came since.

        beside: of a point that is close to the face, its side, +1 or -1; 2 or -2 in a corner, where it meets the face as soon as
        it approaches; 0: its place tells; None: no disk is a point.
        """
        if gx is None and met != 0:
            return NEVER, met
        distance, rate = _approach(self, beside, x, y, vx, vy, radius)
        width = radius * self.norm
        side = side_known(met, beside)
        if side == 0 or has_passed(side * distance, radius, self.size, beside):
            side = face_side(self, x, y, vx, vy)
        cornered = is_cornered(met, beside) and side * rate < 0.0
        if gx is None:
            delay = closing_delay(side * distance - width, side * rate, None)
            if delay < NEVER and (cornered or is_met(self, beside, side, x, y, vx, vy, None, None, radius, delay)):
                return delay, side
            return NEVER, side
        fall = self.nx * gx + self.ny * gy
        delay = closing_delay(0.0 if touches else side * distance - width, side * rate, side * fall)
        if delay < NEVER and (cornered or is_met(self, beside, side, x, y, vx, vy, gx, gy, radius, delay)):
            return delay, side
        delay = reopening_delay(-(side * distance) - width, -(side * rate), -(side * fall))
        if delay < NEVER and is_met(self, beside, -side, x, y, vx, vy, gx, gy, radius, delay):
            return delay, -side
        return NEVER, side

    def side(self, x: Real, y: Real, vx: Real, vy: Real) -> int:
        """The side of the face that a centre is on; a point exactly on the line is on the side that it moves to."""
        distance = self.nx * (x - self.x) + self.ny * (y - self.y)
        if distance > 0.0:
            return 1
        if distance < 0.0:
            return -1
        return 1 if self.nx * vx + self.ny * vy > 0.0 else -1

    def distance(self, x: Real, y: Real) -> Real:
        """The distance of a centre from the line of the face."""
        return abs(self.nx * (x - self.x) + self.ny * (y - self.y)) / self.norm

    def rate(self, x: Real, y: Real, vx: Real, vy: Real) -> Real:
        """Above 0 where a velocity leads to the side +1."""
        return self.nx * vx + self.ny * vy

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
        """The side of a point that is close to the face after a flight from (x, y), where it was on the side `before`.

        It is the same one, whatever rounding says, unless the flight passed an end of the face.  (u, w): the velocity at its end.
        """
        now = face_side(self, px, py, u, w)
        if now == before or _is_within(self, beside, before, x, y, vx, vy, gx, gy, radius, px, py, u, w):
            return before
        return now

    def with_ends(self, ends: float, first: tuple[float, float], second: tuple[float, float]) -> Face:
        """The same face, with what its ends are to points, and what makes corners with it there."""
        return self._replace(ends=ends, first_x=first[0], first_y=first[1], second_x=second[0], second_y=second[1])

    def edge(self, second: bool) -> tuple[float, float, float, float, int]:
        """(x, y, ax, ay, side) of an end: from there, along the face, and the side that is on the left of that."""
        if second:
            return self.x1, self.y1, -self.ex, -self.ey, -1
        return self.x, self.y, self.ex, self.ey, 1

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

    def moment(self, x: Line, y: Line, side: int, radius: float) -> Moment | Quartic | None:
        """The exact time of a contact, by the exact normal; along a parabola with its length to so many bits that none counts."""
        x, y = less_number(x, self.x), less_number(y, self.y)
        nx, ny = Fraction(self.y) - Fraction(self.y1), Fraction(self.x1) - Fraction(self.x)
        distance = nx * x[0] + ny * y[0], nx * x[1] + ny * y[1], nx * x[2] + ny * y[2]
        at, rate, half = distance
        if radius == 0.0 or half != 0:
            return falls_to(distance, side * Fraction(radius) * root_of(nx * nx + ny * ny), side)
        if rate == 0:
            return None
        reach = Fraction(radius) / rate
        return Moment(-at / rate, side if reach > 0 else -side, reach * reach * (nx * nx + ny * ny))

    def line(self) -> Face:
        """The face along which disks may rest and slide."""
        return self

    def lies_on(self, line: Face) -> bool:
        """Whether both ends are on the line of another face."""
        return is_in_line(line, self.x, self.y) and is_in_line(line, self.x1, self.y1)

    def in_numbers(self, number: Callable[[float], Real]) -> Face:
        """The same face in other numbers than floats; what is derived is derived anew, from its corners."""
        exact = Face(*map(number, self))._replace(ends=self.ends)  # a code, not a length
        norm2 = exact.nx * exact.nx + exact.ny * exact.ny
        return exact._replace(norm=sqrt(norm2), norm2=norm2, along2=exact.ex * exact.ex + exact.ey * exact.ey)


face_delay, face_normal, face_nearest, face_touching = Face.delay, Face.normal, Face.nearest, Face.touching
face_side, face_distance, face_rate, face_side_after = Face.side, Face.distance, Face.rate, Face.side_after
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
    size = max(abs(x0), abs(y0), abs(x1), abs(y1))
    return Face(x0, y0, ex, ey, nx, ny, math.sqrt(norm2), norm2, ex * ex + ey * ey, x1, y1, size)


def _approach(shape: Face, beside: int | None, x: Real, y: Real, vx: Real, vy: Real, radius: Real) -> tuple[Real, Real]:
    """(distance, rate) of a flight from the line of the face, in terms of its normal; of points right to the last bits.

    So a point that flies past the tip of two walls meets first the one that comes first.
    """
    across, along = shape.nx * (x - shape.x), shape.ny * (y - shape.y)
    distance, rate = across + along, shape.nx * vx + shape.ny * vy
    if beside is None:
        return distance, rate
    if not is_point(radius, shape.size) or shape.ex == 0.0 or shape.ey == 0.0:
        return distance, rate
    if abs(distance) > CANCELLED * (abs(across) + abs(along)):
        return distance, rate
    return careful_line(x, y, vx, vy, shape.x, shape.y, shape.x1, shape.y1)


def is_met(
    shape: Face,
    beside: int | None,
    side: int,
    x: Real,
    y: Real,
    vx: Real,
    vy: Real,
    gx: Acceleration,
    gy: Acceleration,
    radius: Real,
    delay: Real,
) -> bool:
    """Whether a disk that comes to the line of the face from a side, after a delay, meets the face there."""
    if gx is None:
        return _is_within(shape, beside, side, x, y, vx, vy, None, None, radius, x + vx * delay, y + vy * delay, vx, vy)
    px, py = x + delay * (vx + (0.5 * gx) * delay), y + delay * (vy + (0.5 * gy) * delay)
    return _is_within(shape, beside, side, x, y, vx, vy, gx, gy, radius, px, py, vx + gx * delay, vy + gy * delay)


def _is_within(
    shape: Face,
    beside: int | None,
    side: int,
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
) -> bool:
    """Whether the foot of a centre at (px, py) lies on the segment; of a point near an end, how its flight passes that tells.

    side: where the disk comes from.  (u, w): its velocity there.
    """
    along = shape.ex * (px - shape.x) + shape.ey * (py - shape.y)
    if not is_float(x):
        return bool(not along < 0.0 and not along > shape.along2)
    reach = (shape.size + abs(x) + abs(y)) * (abs(shape.ex) + abs(shape.ey))
    if beside is None:
        return _holds(shape, side, along, SLACK * reach)
    if not is_point(radius, shape.size):
        return _holds(shape, side, along, SLACK * reach)
    low = high = along
    if radius > 0.0:
        rate, most = side * (shape.nx * u + shape.ny * w), STEEPEST * radius * (abs(shape.ex) + abs(shape.ey))
        way = way_to_wall(radius * shape.norm, rate, shape.ex * u + shape.ey * w, most)
        low, high = min(along, along + way), max(along, along + way)
    if high < -CLOSE * reach or low > shape.along2 + CLOSE * reach:
        return False
    before, beyond = low < CLOSE * reach, high > shape.along2 - CLOSE * reach
    if before:
        end = End(shape.x, shape.y, shape.ex, shape.ey, shape.first_x, shape.first_y)
        near = begins_in_corner(beside, shape.size, end.x, end.y, x, y)
        if not passes_end(shape.ends, False, end, near, side, -side, x, y, vx, vy, gx, gy, u, w):
            return False
    if not beyond:
        return True
    end = End(shape.x1, shape.y1, -shape.ex, -shape.ey, shape.second_x, shape.second_y)
    near = begins_in_corner(beside, shape.size, end.x, end.y, x, y)
    return passes_end(shape.ends, True, end, near, side, side, x, y, vx, vy, gx, gy, u, w)


def is_in_line(shape: Face, x: Real, y: Real) -> bool:
    """Whether a point is on the line of a face: a disk that slides on the face grazes what ends there, and does not meet it."""
    distance = shape.nx * (x - shape.x) + shape.ny * (y - shape.y)
    scale = shape.norm * (abs(x) + abs(y) + abs(shape.x) + abs(shape.y))
    return bool(not distance > TOUCHING * scale and not distance < -(TOUCHING * scale))


def side_in_line(shape: Face, line: Face, side: int) -> int:
    """The side of a face that is the given one of another face in line with it."""
    return side if shape.nx * line.nx + shape.ny * line.ny > 0.0 else -side


def _holds(shape: Face, side: int, along: Real, slack: Real) -> bool:
    """Whether a foot is on the face; up to a slack beyond the ends that are no posts on that side."""
    before, _ = end_of(shape.ends, False, side)
    beyond, _ = end_of(shape.ends, True, side)
    least = 0.0 if before else -slack
    return bool(along >= least and along <= shape.along2 + (0.0 if beyond else slack))


def flight_side(
    shape: Face, met: int, beside: int | None, x: Real, y: Real, vx: Real, vy: Real, radius: Real
) -> int:
    """The side of the line of a face that a flight begins on; met, beside: as for `Shape.delay`."""
    side = side_known(met, beside)
    distance = side * (shape.nx * (x - shape.x) + shape.ny * (y - shape.y))
    if side == 0 or has_passed(distance, radius, shape.size, beside):
        return face_side(shape, x, y, vx, vy)
    return side


def hangs_below(line: Face, side: int, x0: Real, y0: Real, x1: Real, y1: Real) -> bool:
    """Whether a face ends on the line of another one and does not stick out on a side of that: who slides there passes it."""
    first, second = is_in_line(line, x0, y0), is_in_line(line, x1, y1)
    if not first and not second:
        return False
    x, y = (x1, y1) if first else (x0, y0)
    return (first and second) or not side * (line.nx * (x - line.x) + line.ny * (y - line.y)) > 0.0


def slope(shape: Face, u: Real, w: Real) -> tuple[Real, Real]:
    """The part of a vector that is along a face; exact where the face is along an axis."""
    if shape.ey == 0.0:
        return u, 0.0
    if shape.ex == 0.0:
        return 0.0, w
    share = (u * shape.ex + w * shape.ey) / (shape.ex * shape.ex + shape.ey * shape.ey)
    return share * shape.ex, share * shape.ey
