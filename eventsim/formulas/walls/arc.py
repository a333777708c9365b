"""A circular arc, hard on both sides; its ends are posts."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import NamedTuple

from eventsim.formulas.contact import circle_delay, leaving_delay
from eventsim.formulas.parabola import NO_OVERLAP, PRESENT_OVERLAP, circle_delays, on_circle
from eventsim.formulas.real import NEVER, Acceleration, Real, sqrt
from eventsim.formulas.roots import Line, Moment, less_number, reaches
from eventsim.formulas.walls.face import Face


class Arc(NamedTuple):
    """The part of a circle that lies beyond its chord: from (x0, y0) along (ex, ey), on the side where the cross product has
    the given sign.  Outside of the circle is the side +1, inside -1."""

    x: float
    y: float
    radius: float
    x0: float
    y0: float
    ex: float
    ey: float
    sign: float

    @staticmethod
    def word() -> str:
        """What messages call one such shape."""
        return "arc"

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
        """(delay, side) of the next contact with the arc: with its outside at radius R + r, with its inside at R - r.

        A disk that is outside may pass through the open part and meet the inside, and the other way round.
        """
        if gx is None:
            return _straight_to_arc(self, x, y, vx, vy, radius, met)
        if gx == 0.0 and gy == 0.0:  # an immovable disk, on which gravity does not act
            return _straight_to_arc(self, x, y, vx, vy, radius, met)
        dx, dy = x - self.x, y - self.y
        side = met if met != 0 else arc_side(self, x, y, vx, vy)
        outer, inner = self.radius + radius, self.radius - radius
        best, best_side = NEVER, side
        for face_side in (1, -1):
            reach = outer if face_side > 0 else inner
            if not reach > 0.0 and not (reach == 0.0 and face_side > 0):
                continue
            overlap = PRESENT_OVERLAP if face_side == side else NO_OVERLAP
            on_it = touches and face_side == side
            first, second = circle_delays(dx, dy, vx, vy, gx, gy, reach, float(face_side), overlap, on_it)
            for delay in (first, second):
                if delay < best and on_arc(
                    self, x + delay * (vx + (0.5 * gx) * delay), y + delay * (vy + (0.5 * gy) * delay)
                ):
                    best, best_side = delay, face_side
        return best, best_side

    def normal(self, side: int, x: Real, y: Real) -> tuple[Real, Real]:
        """The normal, of any length, that points to a disk at (x, y): away from the centre outside, to it inside."""
        return side * (x - self.x), side * (y - self.y)

    def touching(self, side: int, x: Real, y: Real, radius: Real) -> tuple[Real, Real]:
        """The centre of a disk on contact, next to (x, y), but for the last bits."""
        return on_circle(self.x, self.y, self.radius + side * radius, x, y)

    def nearest(self, x: Real, y: Real) -> tuple[Real, Real, Real]:
        """(nx, ny, distance): the unit normal that points to a centre, and its distance; NEVER beside the arc."""
        dx, dy = x - self.x, y - self.y
        distance = sqrt(dx * dx + dy * dy)
        if not distance > 0.0:
            return 0.0, 0.0, NEVER
        ux, uy = dx / distance, dy / distance
        fx, fy = self.x + ux * self.radius - self.x0, self.y + uy * self.radius - self.y0
        if self.sign * (self.ex * fy - self.ey * fx) < 0.0:
            return 0.0, 0.0, NEVER
        if distance >= self.radius:
            return ux, uy, distance - self.radius
        return -ux, -uy, self.radius - distance

    def moment(self, x: Line, y: Line, side: int, radius: float) -> Moment | None:
        """The exact time of a contact; None along a parabola."""
        reach = Fraction(self.radius) + side * Fraction(radius)
        return reaches(less_number(x, self.x), less_number(y, self.y), reach, -side)

    def line(self) -> Face | None:
        """None: no disk rests on a round wall."""
        return None

    def lies_on(self, line: Face) -> bool:
        """False: an arc is on no line."""
        return False

    def at_origin(self) -> Arc:
        """The same arc with its centre in the origin."""
        return self._replace(x=0.0, y=0.0, x0=self.x0 - self.x, y0=self.y0 - self.y)

    def in_numbers(self, number: Callable[[float], Real]) -> Arc:
        """The same arc in other numbers than floats."""
        return Arc(*map(number, self))


def arc(x0: float, y0: float, xm: float, ym: float, x1: float, y1: float) -> Arc:
    """The arc from (x0, y0) through (xm, ym) to (x1, y1): the circle through three points, not on one line."""
    ax, ay = xm - x0, ym - y0
    bx, by = x1 - x0, y1 - y0
    cross = ax * by - ay * bx
    a2, b2 = ax * ax + ay * ay, bx * bx + by * by
    ux, uy = (by * a2 - ay * b2) / (2.0 * cross), (ax * b2 - bx * a2) / (2.0 * cross)
    sign = 1.0 if bx * ay - by * ax > 0.0 else -1.0
    return Arc(x0 + ux, y0 + uy, float(sqrt(ux * ux + uy * uy)), x0, y0, bx, by, sign)


def on_arc(shape: Arc, x: Real, y: Real) -> bool:
    """Whether the ray from the centre of the circle through (x, y) meets the arc: its foot lies beyond the chord."""
    dx, dy = x - shape.x, y - shape.y
    distance = sqrt(dx * dx + dy * dy)
    if not distance > 0.0:
        return False
    scale = shape.radius / distance
    fx, fy = (shape.x + dx * scale) - shape.x0, (shape.y + dy * scale) - shape.y0
    return bool(not shape.sign * (shape.ex * fy - shape.ey * fx) < 0.0)


def arc_side(shape: Arc, x: Real, y: Real, vx: Real, vy: Real) -> int:
    """+1 outside the circle of the arc, -1 inside; a point exactly on it is on the side that it moves to."""
    dx, dy = x - shape.x, y - shape.y
    excess = (dx * dx + dy * dy) - shape.radius * shape.radius
    if excess > 0.0:
        return 1
    if excess < 0.0:
        return -1
    return 1 if dx * vx + dy * vy > 0.0 else -1


def _straight_to_arc(shape: Arc, x: Real, y: Real, vx: Real, vy: Real, radius: Real, met: int) -> tuple[Real, int]:
    side = met if met != 0 else arc_side(shape, x, y, vx, vy)
    best, best_side = NEVER, side
    if side > 0 and met == 0:
        delay = circle_delay(x, y, vx, vy, radius, shape.x, shape.y, shape.radius)
        if delay < best and on_arc(shape, x + vx * delay, y + vy * delay):
            best, best_side = delay, 1
    if shape.radius - radius > 0.0 and (side < 0 or best == NEVER):
        delay = _inner_from(shape, x, y, vx, vy, radius, side)
        if delay < best and on_arc(shape, x + vx * delay, y + vy * delay):
            best, best_side = delay, -1
    return best, best_side


def _inner_from(shape: Arc, x: Real, y: Real, vx: Real, vy: Real, radius: Real, side: int) -> Real:
    """Contact with the inside of a circle, for a disk that is inside or will be: a flight from outside must pass through it."""
    if side > 0:
        entered = circle_delay(x, y, vx, vy, -radius, shape.x, shape.y, shape.radius)
        if not entered < NEVER:
            return NEVER
    return leaving_delay(x, y, vx, vy, radius, shape.x, shape.y, shape.radius)


arc_delay, arc_nearest, arc_touching = Arc.delay, Arc.nearest, Arc.touching
"""The same for kernels; the normal is that of a post."""
