"""A wall and a point: what is decided by signs where the last bits of places cannot tell the side of a wall.

A disk of radius 0, or one that is smaller than the last bits of places, has no side of a wall by its place: that is rounded, and
may be beyond the wall.  So its side is remembered where it is close to a wall, and an end of a wall is passed on the left or on
the right as the exact sign of its flight tells.  Walls that share an end ask the same question, so nothing passes between them.
"""

import math
from typing import NamedTuple

from eventsim.formulas.expansion import added, leading, multiplied, negated, scaled, two_product, two_sum
from eventsim.formulas.real import Acceleration

POINT = 2.0**-42
"""A radius below this part of a wall's coordinates is that of a point: a thousand units in their last place, which no rounding of
a contact's place reaches."""

CLOSE = 2.0**-46
"""A centre closer to a wall than this part of the numbers that its place is made of may be on either side: 64 units in the last
place."""

FILTER, PARABOLA_FILTER = 2.0**-48, 2.0**-44
"""Parts of the sums of products below which a sign is in doubt: 16 and 256 roundings."""

CORNER = 8.0
"""So many times as far as what is close to a wall, from its end, is in the corner there."""

SHORT = 1024.0
"""So many times as far, a flight from there is so short that it may bend next to the end: its beginning tells whence it comes."""

ASLANT = 2.0**-8
"""The angle by which rounding turns the way from the beginning of such a flight: a last bit in less than 64 of them."""

STEEPEST = 2.0**12
"""A point of a radius flies on from its contact with a wall, until its centre is there, at most so many radii along it."""

TINY, HUGE = 1e-200, 1e200
"""Between these, the products that the filter looks at have not underflowed, nor overflowed."""

LEFT_POST, RIGHT_POST, SEALED = 1, 2, 4
"""What the end of a wall is to points that come from its left, or from its right: a post; on both sides closed by another wall.
Those of the second end are END times as large."""

END = 8


def is_point(radius: float, size: float) -> bool:
    """Whether a disk is a point to a wall with coordinates up to `size`."""
    return radius <= POINT * size


def side_known(met: int, beside: int | None) -> int:
    """The side of a wall that a disk remembers, 0 where its place tells; met, beside: as for `Shape.delay`."""
    if beside is None:
        return met
    if met != 0:
        return met
    return 1 if beside > 0 else -1 if beside < 0 else 0


def has_passed(distance: float, radius: float, size: float, beside: int | None) -> bool:
    """Whether a disk has come round an end of a wall since it met it; distance: from the line, on the side that it met.

    Its place tells, unless it is a point that is close to the wall.
    """
    if is_point(radius, size):
        if beside is None:
            return False
        if beside != 0:
            return False
    return bool(distance < 0.0)


def is_cornered(met: int, beside: int | None) -> bool:
    """Whether a point is in the corner of a wall and another one, which it has just met."""
    if beside is None:
        return False
    return met == 0 and abs(beside) == 2


def closeness(size: float, x: float, y: float, u: float, w: float, t: float) -> float:
    """The distance from a wall within which the place (x, y), reached at velocity (u, w) and time t, may be on either side."""
    return CLOSE * (size + abs(x) + abs(y) + (abs(u) + abs(w)) * t)


class End(NamedTuple):
    """An end of a wall at (x, y); (ax, ay), (bx, by): from there along the wall, and along what makes a corner with it."""

    x: float
    y: float
    ax: float
    ay: float
    bx: float
    by: float


def passes_end(
    ends: float,
    second: bool,
    end: End,
    near: bool,
    side: int,
    wanted: float,
    x: float,
    y: float,
    vx: float,
    vy: float,
    gx: Acceleration,
    gy: Acceleration,
    u: float,
    w: float,
) -> bool:
    """Whether a flight that comes from a side to a wall next to its end meets the wall, and does not pass the end.

    near: the flight begins in the corner at that end, which it cannot leave past the end.  wanted: its sign is the hand on
    which the flight has the end where it meets the wall.  A wall of a corner is met out of the corner, or another one is first.
    """
    post, sealed = end_of(ends, second, side)
    if sealed:
        return True
    if not post and near:
        return True
    short = is_near(end.x, end.y, x, y, SHORT * CLOSE * (abs(end.x) + abs(end.y) + abs(x) + abs(y)))
    if not post and not (_comes_out_of(end, end.x - x, end.y - y, ASLANT) if short else _comes_out_of(end, u, w, 0.0)):
        return False
    there = hand(x, y, vx, vy, gx, gy, end.x, end.y, u, w)
    if there == 0.0 and not post and end.bx == 0.0 and end.by == 0.0 and not end_of(ends, second, -side)[0]:
        # between others, which may hide it: it is not met by what comes from beyond its end, or goes there
        one, other = u * end.ax, w * end.ay
        across = abs(one + other) <= FILTER * (abs(one) + abs(other))  # straight down: both that go on there are met
        return bool(across or (one + other > 0.0) == short)
    if there == 0.0:
        return not post
    return bool((there > 0.0) == (wanted > 0.0))


def _comes_out_of(end: End, u: float, w: float, slack: float) -> bool:
    """Whether what arrives at an end with (u, w) comes from between the two edges there; yes, where there is only one.

    So it is on the other side of the wall, which has no post there, and nothing that makes a corner with it: it goes straight on.

    slack: the sine of the angle that it may come from beside.
    """
    if end.bx == 0.0 and end.by == 0.0:
        return True
    turn = 1.0 if end.ax * end.by - end.ay * end.bx >= 0.0 else -1.0
    way = slack * (abs(u) + abs(w))
    first, second = way * (abs(end.ax) + abs(end.ay)), way * (abs(end.bx) + abs(end.by))
    return turn * (u * end.ay - w * end.ax) < -first or turn * (end.bx * w - end.by * u) >= -second


def way_to_wall(gap: float, rate: float, along: float, most: float) -> float:
    """How far along a wall the centre of a disk, which is a point to it, flies on from contact until it is on the wall itself.

    On that way it may pass the end: so there, too, its hand tells.  gap: the radius; rate: at which the gap opens; along: the
    speed along the wall; both in one unit.  0 where it does not come to the wall, and at most so much.
    """
    if not rate < 0.0:
        return 0.0
    way = along * (gap / -rate)
    return most if way > most else -most if way < -most else way


def careful_line(
    x: float, y: float, vx: float, vy: float, ax: float, ay: float, bx: float, by: float
) -> tuple[float, float]:
    """(distance, rate) of a flight from a line through two points, both times the length between them; right to the last bits."""
    ex, fx = two_sum(bx, -ax)
    ey, fy = two_sum(by, -ay)
    dx, cx = two_sum(x, -ax)
    dy, cy = two_sum(y, -ay)
    return _cross(ex, fx, ey, fy, dx, cx, dy, cy), _cross(ex, fx, ey, fy, vx, 0.0, vy, 0.0)


def _cross(ax: float, fx: float, ay: float, fy: float, bx: float, gx: float, by: float, gy: float) -> float:
    """The cross product of (ax + fx, ay + fy) and (bx + gx, by + gy), high and low parts."""
    one, rest = two_product(ax, by)
    other, more = two_product(ay, bx)
    high, low = two_sum(one, -other)
    total: float = high + (low + ((rest - more) + ((ax * gy + fx * by) - (ay * gx + fy * bx))))
    return total


def begins_in_corner(beside: int, size: float, px: float, py: float, x: float, y: float) -> bool:
    """Whether a flight from (x, y) begins in a corner at the point (px, py); wider than what is next to the end at its end."""
    return abs(beside) == 2 and is_near(px, py, x, y, 4.0 * CLOSE * (size + abs(x) + abs(y)))


def end_of(ends: float, second: bool, side: int) -> tuple[bool, bool]:
    """(is a post to points on that side, is sealed) of the first or second end of a wall."""
    bits = int(ends) // END if second else int(ends) % END
    post = RIGHT_POST if side < 0 else LEFT_POST
    return bits & post != 0, bits & SEALED != 0


def is_near(px: float, py: float, x: float, y: float, close: float) -> bool:
    """Whether a centre at (x, y) is as good as at the point (px, py)."""
    return abs(x - px) + abs(y - py) <= 2.0 * close


def hand(
    x: float,
    y: float,
    vx: float,
    vy: float,
    gx: Acceleration,
    gy: Acceleration,
    px: float,
    py: float,
    u: float,
    w: float,
) -> float:
    """Above 0 where the point (px, py) is on the left of a flight from (x, y), below 0 on the right, 0 exactly on it.

    (u, w): the velocity there; it matters only where the flight goes up and down one line.
    """
    if gx is None:
        return _straight_hand(x, y, vx, vy, px, py)
    if gx == 0.0 and gy == 0.0:
        return _straight_hand(x, y, vx, vy, px, py)
    return _parabola_hand(x, y, vx, vy, gx, gy, px, py, u, w)


def _straight_hand(x: float, y: float, vx: float, vy: float, px: float, py: float) -> float:
    """The sign of v x (p - (x, y))."""
    one, other = vx * (py - y), vy * (px - x)
    size = abs(vx) * (abs(py) + abs(y)) + abs(vy) * (abs(px) + abs(x))
    sure = one - other
    if TINY < size < HUGE and abs(sure) > FILTER * size:
        return sure
    return exact_hand(x, y, vx, vy, 0.0, 0.0, px, py)


def _parabola_hand(
    x: float, y: float, vx: float, vy: float, gx: float, gy: float, px: float, py: float, u: float, w: float
) -> float:
    """The same for a parabola, which bends to the side of g: the point is on the left of one that bends left, inside of it.

    With d = p - (x, y): at t = (d x g) / (v x g) the flight is in line with the point along g, and inside means that
    (d.g) - (v.g) t - g^2 t^2 / 2 > 0.
    """
    dx, dy = px - x, py - y
    turn = vx * gy - vy * gx
    across, along, rate, pull = dx * gy - dy * gx, dx * gx + dy * gy, vx * gx + vy * gy, gx * gx + gy * gy
    inside = (along * turn - rate * across) * turn - (0.5 * pull) * (across * across)
    far_x, far_y = abs(px) + abs(x), abs(py) + abs(y)
    least = abs(vx * gy) + abs(vy * gx)
    most = far_x * abs(gy) + far_y * abs(gx)
    length = far_x * abs(gx) + far_y * abs(gy)
    size = (length * least + (abs(vx * gx) + abs(vy * gy)) * most) * least + (0.5 * pull) * (most * most)
    if abs(turn) > FILTER * least and TINY < size < HUGE and abs(inside) > PARABOLA_FILTER * size and least > TINY:
        return inside if turn > 0.0 else -inside
    exact = exact_hand(x, y, vx, vy, gx, gy, px, py)
    if is_upright(vx, vy, gx, gy):  # up and down along g: left and right change at the top
        return exact if u * gx + w * gy > 0.0 else -exact
    return exact


def is_upright(vx: float, vy: float, gx: float, gy: float) -> bool:
    """Whether a velocity is along gravity, exactly, or zero."""
    if gx == 0.0:
        return vx == 0.0
    if gy == 0.0:
        return vy == 0.0
    turn = vx * gy - vy * gx
    if abs(turn) > FILTER * (abs(vx * gy) + abs(vy * gx)):
        return False
    return exact_hand(0.0, 0.0, vx, vy, 0.0, 0.0, gx, gy) == 0.0


def exact_hand(x: float, y: float, vx: float, vy: float, gx: float, gy: float, px: float, py: float) -> float:
    """`hand` without rounding: -1.0, 0.0 or 1.0.  Along g: that of a point which falls."""
    length = _exponent(max(abs(x), abs(y), abs(px), abs(py)))
    x, y, px, py = _shifted(x, -length), _shifted(y, -length), _shifted(px, -length), _shifted(py, -length)
    high_x, low_x = two_sum(px, -x)
    high_y, low_y = two_sum(py, -y)
    dx, dy = [low_x, high_x], [low_y, high_y]
    if gx == 0.0 and gy == 0.0:
        speed = _exponent(max(abs(vx), abs(vy)))
        vx, vy = _shifted(vx, -speed), _shifted(vy, -speed)
        return _sign(added(scaled(dy, vx), scaled(dx, -vy)))
    pull = _exponent(max(abs(gx), abs(gy)))
    if (length + pull) % 2 != 0:
        pull = pull + 1
    speed = (length + pull) // 2  # v^2 is a length times an acceleration
    gx, gy = _shifted(gx, -pull), _shifted(gy, -pull)
    vx, vy = _shifted(vx, -speed), _shifted(vy, -speed)
    turn = added(scaled([vx], gy), scaled([vy], -gx))
    across = added(scaled(dx, gy), scaled(dy, -gx))
    bends = _sign(turn)
    if bends == 0.0:
        return -_sign(across)
    along = added(scaled(dx, gx), scaled(dy, gy))
    rate = added(scaled([vx], gx), scaled([vy], gy))
    half = added(scaled([0.5 * gx], gx), scaled([0.5 * gy], gy))
    first = multiplied(added(multiplied(along, turn), negated(multiplied(rate, across))), turn)
    inside = added(first, negated(multiplied(half, multiplied(across, across))))
    return bends * _sign(inside)


def _sign(number: list[float]) -> float:
    high, _ = leading(number)
    if high > 0.0:
        return 1.0
    return -1.0 if high < 0.0 else 0.0


def _exponent(size: float) -> int:
    return math.frexp(size)[1]


def _shifted(x: float, power: int) -> float:
    mantissa, exponent = math.frexp(x)
    return math.ldexp(mantissa, exponent + power)


def post_delay_of_point(
    x: float,
    y: float,
    vx: float,
    vy: float,
    gx: Acceleration,
    gy: Acceleration,
    px: float,
    py: float,
) -> float:
    """When a point hits another one, (px, py), exactly, if it does; else inf."""
    if gx is None:
        return _straight_hit(x, y, vx, vy, px, py)
    if gx == 0.0 and gy == 0.0:
        return _straight_hit(x, y, vx, vy, px, py)
    dx, dy, turn = px - x, py - y, vx * gy - vy * gx
    if turn == 0.0 or is_upright(vx, vy, gx, gy):
        if dx * gy - dy * gx != 0.0 or _parabola_hand(x, y, vx, vy, gx, gy, px, py, gx, gy) != 0.0:
            return math.inf
        return _fall_delay(dx * gx + dy * gy, vx * gx + vy * gy, gx * gx + gy * gy)
    if dx == 0.0 and dy == 0.0:
        return math.inf
    delay: float = (dx * gy - dy * gx) / turn
    if not delay > 0.0 or _parabola_hand(x, y, vx, vy, gx, gy, px, py, vx, vy) != 0.0:
        return math.inf
    return delay


def _straight_hit(x: float, y: float, vx: float, vy: float, px: float, py: float) -> float:
    dx, dy, fast = px - x, py - y, max(abs(vx), abs(vy))
    if not fast > 0.0:
        return math.inf
    ux, uy = vx / fast, vy / fast
    ahead = dx * ux + dy * uy
    if not ahead > 0.0 or _straight_hand(x, y, vx, vy, px, py) != 0.0:
        return math.inf
    delay: float = ahead / (ux * ux + uy * uy) / fast
    return delay


def _fall_delay(way: float, rate: float, pull: float) -> float:
    """When a way down has been fallen, from above or from below; at the end of a way of 0 it is to come back from above."""
    if way < 0.0 and not rate < 0.0:
        return math.inf
    if way == 0.0 and rate > 0.0:
        return math.inf
    discriminant = rate * rate + 2.0 * pull * way
    if discriminant < 0.0:
        return math.inf
    root = math.sqrt(discriminant)
    if way < 0.0:  # upwards
        return (2.0 * way) / (rate - root)
    return (root - rate) / pull if rate < 0.0 else (2.0 * way) / (rate + root) if way > 0.0 else 0.0


def is_still_rising(
    x: float, y: float, gx: Acceleration, gy: Acceleration, px: float, py: float, u: float, w: float
) -> bool:
    """Whether a point that is back at (px, py), where its flight began, has not yet turned, by rounding of the clock."""
    if gx is None or x != px or y != py:
        return False
    return not u * gx + w * gy > 0.0
