"""A circular arc, hard on both sides; its ends are posts."""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from typing import NamedTuple

from eventsim.formulas.contact import (
    inner_delay,
    pair_delay,
    screened_inner_delay,
    screened_pair_delay,
)
from eventsim.formulas.digits import careful_pair_delay
from eventsim.formulas.doubt import SLACK
from eventsim.formulas.parabola import NO_OVERLAP, PRESENT_OVERLAP, Round, round_delays
from eventsim.formulas.real import NEVER, Acceleration, Real, is_float, sqrt
from eventsim.formulas.roots import Line, Moment, Quartic, less_number, reaches
from eventsim.formulas.walls.face import Face
from eventsim.formulas.walls.point import (
    CLOSE,
    STEEPEST,
    End,
    begins_in_corner,
    end_of,
    has_passed,
    is_cornered,
    is_point,
    passes_end,
    side_known,
    way_to_wall,
)

FLAT = 8.0
"""An arc with a radius of more than so many times its coordinates is nearly flat: floats know less of a distance from its centre
than of places."""


class Arc(NamedTuple):
    """The part of a circle through (x, y) that lies beyond its chord.  Outside of the circle is the side +1, inside -1.

    (ux, uy): from (x, y) to the centre; radius + low: the length of that, so nearly flat arcs keep their digits.
    (ex, ey): the chord, to (x1, y1).  sign: of the cross product of the chord with the way to the arc.  size: of its coordinates.
    ends: what its ends are to points (`walls.point`); first, second: from these along what makes a corner with it.
    """

    x: float
    y: float
    ux: float
    uy: float
    radius: float
    low: float
    ex: float
    ey: float
    sign: float
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
        beside: int | None = None,
    ) -> tuple[Real, int]:
        """(delay, side) of the next contact with the arc: with its outside at radius R + r, with its inside at R - r.

        A disk that is outside may pass through the open part and meet the inside, and the other way round.
        """
        side = side_known(met, beside)
        if side == 0 or (gx is not None and has_passed(side * _excess(self, x, y), radius, self.size, beside)):
            side = arc_side(self, x, y, vx, vy)
        if gx is None:
            return _straight_to_arc(self, side, x, y, vx, vy, None, None, radius, met, beside)
        if gx == 0.0 and gy == 0.0:
            return _straight_to_arc(self, side, x, y, vx, vy, gx, gy, radius, met, beside)
        dx, dy = x - self.x, y - self.y
        beyond = _is_beyond(self, met, beside, side, x, y, radius)
        best, best_side = NEVER, side
        for wall_side in (1, -1):
            reach = self.radius + wall_side * radius
            if not reach > 0.0 and not (reach == 0.0 and wall_side > 0):
                continue
            circle = Round(self.ux, self.uy, (wall_side * radius) * (2.0 * self.radius + wall_side * radius))
            overlap = PRESENT_OVERLAP if wall_side == side else NO_OVERLAP
            on_it = touches and wall_side == side
            first, second = round_delays(dx, dy, vx, vy, gx, gy, circle, reach, float(wall_side), overlap, on_it)
            if wall_side != side and beyond and wall_side * arc_rate(self, x, y, vx, vy) < 0.0:
                first = NEVER  # it leaves the circle on the side where it is, so what it would cross now is rounding
            for delay in (first, second):
                if delay < best:
                    px, py = x + delay * (vx + (0.5 * gx) * delay), y + delay * (vy + (0.5 * gy) * delay)
                    u, w = vx + gx * delay, vy + gy * delay
                    cornered = delay == first and wall_side == side and is_cornered(met, beside)
                    approaches = cornered and side * ((dx - self.ux) * vx + (dy - self.uy) * vy) < 0.0
                    if approaches or _is_met(self, beside, wall_side, x, y, vx, vy, gx, gy, radius, px, py, u, w):
                        best, best_side = delay, wall_side
        return best, best_side

    def side(self, x: Real, y: Real, vx: Real, vy: Real) -> int:
        """+1 outside the circle of the arc, -1 inside; a point exactly on it is on the side that it moves to."""
        excess = _excess(self, x, y)
        if excess > 0.0:
            return 1
        if excess < 0.0:
            return -1
        return 1 if ((x - self.x) - self.ux) * vx + ((y - self.y) - self.uy) * vy > 0.0 else -1

    def distance(self, x: Real, y: Real) -> Real:
        """About the distance of a centre from the circle, where it is close."""
        return abs(_excess(self, x, y)) / (2.0 * self.radius)

    def rate(self, x: Real, y: Real, vx: Real, vy: Real) -> Real:
        """Above 0 where a velocity leads away from the centre, to the side +1."""
        return (x - (self.x + self.ux)) * vx + (y - (self.y + self.uy)) * vy

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
        """As that of a face: the side of a point that is close to the arc after a flight from (x, y)."""
        now = arc_side(self, px, py, u, w)
        if now == before or _is_met(self, beside, before, x, y, vx, vy, gx, gy, radius, px, py, u, w):
            return before
        return now

    def with_ends(self, ends: float, first: tuple[float, float], second: tuple[float, float]) -> Arc:
        """The same arc, with what its ends are to points, and what makes corners with it there."""
        return self._replace(ends=ends, first_x=first[0], first_y=first[1], second_x=second[0], second_y=second[1])

    def edge(self, second: bool) -> tuple[float, float, float, float, int]:
        """(x, y, ax, ay, side) of an end: from there, along the arc, as long as the chord; the side on the left of that."""
        ux, uy = (self.ux - self.ex, self.uy - self.ey) if second else (self.ux, self.uy)
        way = (-self.sign if second else self.sign) * (math.hypot(self.ex, self.ey) / self.radius)
        x, y = (self.x1, self.y1) if second else (self.x, self.y)
        return x, y, -way * uy, way * ux, 1 if way > 0.0 else -1  # who turns right has the centre on the right

    def normal(self, side: int, x: Real, y: Real) -> tuple[Real, Real]:
        """The normal, of any length, that points to a disk at (x, y): away from the centre outside, to it inside."""
        return side * (x - (self.x + self.ux)), side * (y - (self.y + self.uy))

    def touching(self, side: int, x: Real, y: Real, radius: Real) -> tuple[Real, Real]:
        """The centre of a disk on contact, next to (x, y), but for the last bits; from the start, as the centre may be far."""
        dx, dy = (x - self.x) - self.ux, (y - self.y) - self.uy
        square = dx * dx + dy * dy
        if not (is_float(x) and square > 0.0 and self.radius + side * radius > 0.0):
            return x, y
        distance = sqrt(square)
        way = side * radius - _excess(self, x, y) / (distance + self.radius)
        return x + way * (dx / distance), y + way * (dy / distance)

    def nearest(self, x: Real, y: Real) -> tuple[Real, Real, Real]:
        """(nx, ny, distance): the unit normal that points to a centre, and its distance; NEVER beside the arc."""
        dx, dy = (x - self.x) - self.ux, (y - self.y) - self.uy
        distance = sqrt(dx * dx + dy * dy)
        if not distance > 0.0 or not on_arc(self, x, y):
            return 0.0, 0.0, NEVER
        if distance >= self.radius:
            return dx / distance, dy / distance, distance - self.radius
        return -dx / distance, -dy / distance, self.radius - distance

    def moment(self, x: Line, y: Line, side: int, radius: float) -> Moment | Quartic | None:
        """The exact time of a contact; along a parabola the quartic whose root it is."""
        reach = Fraction(self.radius) + Fraction(self.low) + side * Fraction(radius)
        x, y = (
            less_number(x, Fraction(self.x) + Fraction(self.ux)),
            less_number(y, Fraction(self.y) + Fraction(self.uy)),
        )
        return reaches(x, y, reach, -side)

    def line(self) -> Face | None:
        """None: no disk rests on a round wall."""
        return None

    def lies_on(self, line: Face) -> bool:
        """False: an arc is on no line."""
        return False

    def in_numbers(self, number: Callable[[float], Real]) -> Arc:
        """The same arc in other numbers than floats, with both parts of its radius in one."""
        whole = Arc(*map(number, self))
        return whole._replace(radius=whole.radius + whole.low, low=number(0.0), ends=self.ends)


def arc(x0: float, y0: float, xm: float, ym: float, x1: float, y1: float) -> Arc:
    """The arc from (x0, y0) through (xm, ym) to (x1, y1): the circle through three points, not on one line; rounded once."""
    ax, ay = Fraction(xm) - Fraction(x0), Fraction(ym) - Fraction(y0)
    bx, by = Fraction(x1) - Fraction(x0), Fraction(y1) - Fraction(y0)
    cross = ax * by - ay * bx
    a2, b2 = ax * ax + ay * ay, bx * bx + by * by
    ux, uy = float((by * a2 - ay * b2) / (2 * cross)), float((ax * b2 - bx * a2) / (2 * cross))
    radius = math.hypot(ux, uy)
    low = (Fraction(ux) ** 2 + Fraction(uy) ** 2 - Fraction(radius) ** 2) / (2 * Fraction(radius))
    size = max(abs(x0), abs(y0), abs(x1), abs(y1))
    return Arc(x0, y0, ux, uy, radius, float(low), x1 - x0, y1 - y0, -1.0 if cross > 0 else 1.0, x1, y1, size)


arc_delay, arc_nearest, arc_normal, arc_touching = Arc.delay, Arc.nearest, Arc.normal, Arc.touching
arc_side, arc_distance, arc_rate, arc_side_after = Arc.side, Arc.distance, Arc.rate, Arc.side_after
"""The same for kernels."""


def _excess(shape: Arc, x: Real, y: Real) -> Real:
    """The square of the distance from the centre less that of the radius; nothing cancels where the arc is nearly flat."""
    dx, dy = x - shape.x, y - shape.y
    return (dx * dx + dy * dy) - 2.0 * (dx * shape.ux + dy * shape.uy)


def on_arc(shape: Arc, x: Real, y: Real, before: Real = 0.0, beyond: Real = 0.0) -> bool:
    """Whether the ray from the centre of the circle through (x, y) meets the arc, or comes that close to its ends.

    It does where it is beyond both ends, along the circle from each of them; one of them, where that is more than a half.
    """
    if (x - shape.x) - shape.ux == 0.0 and (y - shape.y) - shape.uy == 0.0:  # the centre has no ray
        return False
    size = abs(shape.ux) + abs(shape.uy)
    beyond_first, beyond_second = (
        not from_start(shape, x, y) < -before * size,
        not from_end(shape, x, y) < -beyond * size,
    )
    if is_minor(shape):
        return bool(beyond_first and beyond_second)
    return bool(beyond_first or beyond_second)


def is_minor(shape: Arc) -> bool:
    """Whether an arc is at most half of its circle."""
    return bool(not shape.sign * (shape.ex * shape.uy - shape.ey * shape.ux) > 0.0)


def from_start(shape: Arc, x: Real, y: Real) -> Real:
    """How far a point is along the tangent from the start of an arc, times the radius."""
    return shape.sign * (shape.ux * (y - shape.y) - shape.uy * (x - shape.x))


def from_end(shape: Arc, x: Real, y: Real) -> Real:
    """The same back from its end."""
    return shape.sign * ((shape.uy - shape.ey) * (x - shape.x1) - (shape.ux - shape.ex) * (y - shape.y1))


def _is_met(
    shape: Arc,
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
    """Whether a centre that comes to (px, py) from a side meets the arc; of a point, next to an end, how it passes that tells.

    (u, w): its velocity there.
    """
    if not is_float(px):
        return on_arc(shape, px, py)
    reach = shape.size + abs(x) + abs(y)
    if beside is None:
        return _holds(shape, side, px, py, SLACK * reach)
    if not is_point(radius, shape.size):
        return _holds(shape, side, px, py, SLACK * reach)
    slack = 2.0 * CLOSE * reach
    qx, qy = _on_wall(shape, side, radius, px, py, u, w) if radius > 0.0 else (px, py)
    at_first, at_second = _at_end(shape, False, px, py, qx, qy, slack), _at_end(shape, True, px, py, qx, qy, slack)
    if at_first:
        turn = shape.sign * (u * shape.ux + w * shape.uy)  # of the velocity to the tangent into the arc
        ax, ay = -shape.sign * shape.uy, shape.sign * shape.ux
        end = End(shape.x, shape.y, ax, ay, shape.first_x, shape.first_y)
        near = begins_in_corner(beside, shape.size, end.x, end.y, x, y)
        return passes_end(shape.ends, False, end, near, side, -turn, x, y, vx, vy, gx, gy, u, w)
    if at_second:
        turn = -shape.sign * (u * (shape.ux - shape.ex) + w * (shape.uy - shape.ey))
        ax, ay = shape.sign * (shape.uy - shape.ey), -shape.sign * (shape.ux - shape.ex)
        end = End(shape.x1, shape.y1, ax, ay, shape.second_x, shape.second_y)
        near = begins_in_corner(beside, shape.size, end.x, end.y, x, y)
        return passes_end(shape.ends, True, end, near, side, -turn, x, y, vx, vy, gx, gy, u, w)
    return on_arc(shape, px, py)


def _on_wall(shape: Arc, side: int, radius: Real, x: Real, y: Real, u: Real, w: Real) -> tuple[Real, Real]:
    """Where the centre of a disk at (x, y), which is a point to the arc and touches it from a side, is on the arc itself."""
    nx, ny = (x - shape.x) - shape.ux, (y - shape.y) - shape.uy
    fast = abs(u) + abs(w)
    if not fast > 0.0:
        return x, y
    way = way_to_wall(radius * shape.radius, side * (nx * u + ny * w), fast, STEEPEST * radius)
    return x + way * (u / fast), y + way * (w / fast)


def _at_end(shape: Arc, second: bool, x: Real, y: Real, qx: Real, qy: Real, slack: Real) -> bool:
    """Whether one of two places is next to an end, or the end is between them."""
    ex, ey = (shape.x1, shape.y1) if second else (shape.x, shape.y)
    if abs(x - ex) + abs(y - ey) < slack or abs(qx - ex) + abs(qy - ey) < slack:
        return True
    if qx == x and qy == y:
        return False
    if abs(x - ex) + abs(y - ey) > abs(qx - x) + abs(qy - y):
        return False
    if second:
        return bool((from_end(shape, x, y) < 0.0) != (from_end(shape, qx, qy) < 0.0))
    return bool((from_start(shape, x, y) < 0.0) != (from_start(shape, qx, qy) < 0.0))


def _holds(shape: Arc, side: int, x: Real, y: Real, slack: Real) -> bool:
    """Whether a centre is over the arc; up to a slack beyond the ends that are no posts on that side."""
    before, _ = end_of(shape.ends, False, side)
    beyond, _ = end_of(shape.ends, True, side)
    return on_arc(shape, x, y, 0.0 if before else slack, 0.0 if beyond else slack)


def _is_beyond(shape: Arc, met: int, beside: int | None, side: int, x: Real, y: Real, radius: Real) -> bool:
    """Whether a point that remembers its side of the circle is on the other one by its place, which is rounded."""
    if beside is None:
        return False
    if not is_point(radius, shape.size) or side_known(met, beside) == 0:
        return False
    return bool(side * _excess(shape, x, y) < 0.0)


def _straight_to_arc(
    shape: Arc,
    side: int,
    x: Real,
    y: Real,
    vx: Real,
    vy: Real,
    gx: Acceleration,
    gy: Acceleration,
    radius: Real,
    met: int,
    beside: int | None,
) -> tuple[Real, int]:
    best, best_side = NEVER, side
    cornered = (
        is_cornered(met, beside) and side * (((x - shape.x) - shape.ux) * vx + ((y - shape.y) - shape.uy) * vy) < 0.0
    )
    if side > 0 and met == 0:
        delay = _outer_delay(shape, x, y, vx, vy, radius)
        if delay < best:
            px, py = x + vx * delay, y + vy * delay
            if cornered or _is_met(shape, beside, 1, x, y, vx, vy, gx, gy, radius, px, py, vx, vy):
                best, best_side = delay, 1
    if shape.radius - radius > 0.0 and (side < 0 or best == NEVER):
        delay = _inner_from(shape, x, y, vx, vy, radius, side)
        if delay < best:
            px, py = x + vx * delay, y + vy * delay
            if (cornered and side < 0) or _is_met(shape, beside, -1, x, y, vx, vy, gx, gy, radius, px, py, vx, vy):
                best, best_side = delay, -1
    return best, best_side


def _outer_delay(shape: Arc, x: Real, y: Real, vx: Real, vy: Real, radius: Real) -> Real:
    """As `circle_delay`, for the circle of an arc: its centre and its radius have more digits than floats."""
    dx, dy, reach = x - (shape.x + shape.ux), y - (shape.y + shape.uy), shape.radius + radius
    if not is_float(x):
        return pair_delay(dx, dy, vx, vy, reach + shape.low)
    if shape.radius <= FLAT * shape.size:
        delay = screened_pair_delay(dx, dy, vx, vy, reach)
        if delay == delay:
            return delay
    more = radius + shape.low
    return careful_pair_delay(
        x, y, vx, vy, 0.0, more, shape.x, shape.y, 0.0, 0.0, 0.0, shape.radius, shape.ux, shape.uy
    )


def _inner_delay(shape: Arc, x: Real, y: Real, vx: Real, vy: Real, radius: Real) -> Real:
    """As `leaving_delay`, for the circle of an arc."""
    dx, dy, inner = x - (shape.x + shape.ux), y - (shape.y + shape.uy), shape.radius - radius
    if not is_float(x):
        return inner_delay(dx, dy, vx, vy, inner + shape.low)
    if shape.radius <= FLAT * shape.size:
        delay = screened_inner_delay(dx, dy, vx, vy, inner)
        if delay == delay:
            return delay
    less = shape.low - radius
    return careful_pair_delay(
        x, y, vx, vy, 0.0, less, shape.x, shape.y, 0.0, 0.0, 0.0, shape.radius, shape.ux, shape.uy, -1.0
    )


def _inner_from(shape: Arc, x: Real, y: Real, vx: Real, vy: Real, radius: Real, side: int) -> Real:
    """Contact with the inside of a circle, for a disk that is inside or will be: a flight from outside must pass through it."""
    if side > 0:
        entered = _outer_delay(shape, x, y, vx, vy, -radius)
        if not entered < NEVER:
            return NEVER
    return _inner_delay(shape, x, y, vx, vy, radius)
