"""When a parabola meets a circle: gravity against posts, segment ends, arcs, containers and immovable disks.

The squared distance of a falling centre from a fixed point is a quartic of time.  Its derivative is a cubic, whose own
derivative is a quadratic: so the roots of the quadratic bracket those of the cubic, and these bracket those of the
quartic, every one on a monotone piece, where bisection cannot miss.  No root formula of degree 4, hence no cancellation.
Balls enclose the root on such a piece instead, by the interval Newton method.
"""

from typing import NamedTuple

from eventsim.formulas.real import NEVER, Real, is_float, root_between, sqrt

BISECTIONS = 200
"""More halvings than any bracket here survives in float64."""

DOUBLINGS = 2000
"""Enough to leave any float64 behind."""


ANY_OVERLAP, PRESENT_OVERLAP, NO_OVERLAP = 2, 1, 0
"""Which falling pieces that begin with a closed gap are contacts: all; only the first one; none.

The first piece of a flight that begins on the circle, or close to it, may begin with a gap that only rounding has closed."""


class Round(NamedTuple):
    """A circle seen from a point: its centre at (x, y), the square of its radius less that of the centre's distance.

    So a circle through the point has the excess 0, however large it is, and one around the point its radius squared.
    """

    x: Real
    y: Real
    excess: Real


def circle_gap(
    dx: Real,
    dy: Real,
    du: Real,
    dw: Real,
    ax: Real,
    ay: Real,
    radius: Real,
    side: float,
    t: Real,
    touches: bool = False,
) -> Real:
    """h = side (|d + v t + a t^2/2|^2 - radius^2) at delay t; side is +1 outside the circle, -1 inside."""
    return round_gap(dx, dy, du, dw, ax, ay, Round(0.0, 0.0, radius * radius), side, touches, t)


def on_circle(cx: Real, cy: Real, reach: Real, x: Real, y: Real) -> tuple[Real, Real]:
    """The point next to (x, y) that is `reach` from (cx, cy), but for the last bits; where nothing is rounded it is there."""
    dx, dy = x - cx, y - cy
    square = dx * dx + dy * dy
    if not (is_float(x) and square > 0.0 and reach > 0.0):
        return x, y
    share = reach / sqrt(square)
    return cx + share * dx, cy + share * dy


def round_gap(
    dx: Real,
    dy: Real,
    du: Real,
    dw: Real,
    ax: Real,
    ay: Real,
    circle: Round,
    side: float,
    touches: bool,
    t: Real,
) -> Real:
    """h = side (p^2 - 2 p.c - excess), p = d + v t + a t^2/2, at delay t; side is +1 outside the circle, -1 inside.

    touches: h is 0 at the beginning but for rounding, so that it is t (v + a t/2).(2 (d - c) + t (v + a t/2)).
    """
    if touches:
        mx, my = du + (0.5 * ax) * t, dw + (0.5 * ay) * t
        cx, cy = dx - circle.x, dy - circle.y
        return side * (t * (mx * (2.0 * cx + t * mx) + my * (2.0 * cy + t * my)))
    px = dx + t * (du + (0.5 * ax) * t)
    py = dy + t * (dw + (0.5 * ay) * t)
    return side * (((px * px + py * py) - 2.0 * (px * circle.x + py * circle.y)) - circle.excess)


def round_rate(dx: Real, dy: Real, du: Real, dw: Real, ax: Real, ay: Real, circle: Round, side: float, t: Real) -> Real:
    """Half the rate of change of the gap h at delay t: side ((p - c) . v(t))."""
    px = dx + t * (du + (0.5 * ax) * t)
    py = dy + t * (dw + (0.5 * ay) * t)
    return side * ((px - circle.x) * (du + ax * t) + (py - circle.y) * (dw + ay * t))


def round_polynomial(
    dx: Real, dy: Real, du: Real, dw: Real, ax: Real, ay: Real, circle: Round, side: float, touches: bool
) -> tuple[Real, Real, Real, Real, Real]:
    """The coefficients of the gap h, that of t^0 first."""
    cx, cy = dx - circle.x, dy - circle.y
    start = 0.0 if touches else (dx * dx + dy * dy) - 2.0 * (dx * circle.x + dy * circle.y) - circle.excess
    return (
        side * start,
        (2.0 * side) * (cx * du + cy * dw),
        side * ((du * du + dw * dw) + (cx * ax + cy * ay)),
        side * (du * ax + dw * ay),
        (0.25 * side) * (ax * ax + ay * ay),
    )


def stays_open(
    dx: Real, dy: Real, du: Real, dw: Real, ax: Real, ay: Real, reach: Real, side: float, t: Real, margin: Real
) -> bool:
    """Whether the gap h to a circle around (0, 0) surely stays above a margin until delay t; False where that is not clear.

    A polynomial is nowhere below the least of its coefficients in the basis of Bernstein (Farouki, Comput. Aided Geom. Des. 29,
    379 (2012), doi:10.1016/j.cagd.2012.03.001).
    """
    c0, c1, c2, c3, c4 = round_polynomial(dx, dy, du, dw, ax, ay, Round(0.0, 0.0, reach * reach), side, touches=False)
    c1, c2, c3, c4 = t * c1, t * t * c2, t * t * t * c3, t * t * t * t * c4
    second, third = c0 + 0.5 * c1 + c2 / 6.0, c0 + 0.75 * c1 + 0.5 * c2 + 0.25 * c3
    least = min(min(c0, c0 + 0.25 * c1), min(second, third))
    return bool(least > margin and c0 + c1 + c2 + c3 + c4 > margin)


def circle_delays(
    dx: Real,
    dy: Real,
    du: Real,
    dw: Real,
    ax: Real,
    ay: Real,
    radius: Real,
    side: float,
    overlap: int = ANY_OVERLAP,
    touches: bool = False,
) -> tuple[Real, Real]:
    """The first two delays >= 0 at which the gap h to a circle is <= 0 and falling; NEVER where there is none.

    (dx, dy), (du, dw), (ax, ay): position, velocity and acceleration (not zero) relative to the centre.  touches: the flight
    begins on the circle, wherever rounding has put the disk: then no bounce is too low for the digits of its place.
    """
    return round_delays(dx, dy, du, dw, ax, ay, Round(0.0, 0.0, radius * radius), radius, side, overlap, touches)


def round_delays(
    dx: Real,
    dy: Real,
    du: Real,
    dw: Real,
    ax: Real,
    ay: Real,
    circle: Round,
    radius: Real,
    side: float,
    overlap: int,
    touches: bool,
) -> tuple[Real, Real]:
    """The same for a circle that is seen from another point than its centre; radius: about its radius.

    A quartic has at most two falling pieces; the second is for arcs, which may be open where the first one crosses them: there a
    disk can be on the far side of the circle without overlapping it, and `overlap` says which closed gaps count.
    """
    q2 = 1.5 * (ax * ax + ay * ay)
    q1 = 3.0 * (du * ax + dw * ay)
    q0 = (du * du + dw * dw) + ((dx - circle.x) * ax + (dy - circle.y) * ay)
    first, second = _positive_roots(q2, q1, q0)
    start = 0.0
    rate = round_rate(dx, dy, du, dw, ax, ay, circle, side, start)
    falls = rate < 0.0 or (rate == 0.0 and side * q0 < 0.0)
    fall = 0.0
    late = overlap == ANY_OVERLAP
    counts = overlap != NO_OVERLAP
    found = NEVER
    far = _far(dx, dy, du, dw, ax, ay, circle, radius, side, touches, second)
    for end in (first, second, far):
        if not end > start:
            continue
        falls_then = round_rate(dx, dy, du, dw, ax, ay, circle, side, end) < 0.0
        if falls != falls_then:
            turn = _turn(dx, dy, du, dw, ax, ay, circle, side, start, end, falls)
            if falls:
                delay = _closing(dx, dy, du, dw, ax, ay, circle, side, touches, fall, turn, counts)
                if delay < NEVER:
                    if found < NEVER:
                        return found, delay
                    found = delay
                counts = late
            else:
                fall = turn
        start = end
        falls = falls_then
    if falls:
        delay = _closing(dx, dy, du, dw, ax, ay, circle, side, touches, fall, far, counts)
        if found < NEVER:
            return found, delay
        found = delay
    return found, NEVER


def _positive_roots(q2: Real, q1: Real, q0: Real) -> tuple[Real, Real]:
    """The roots of q2 t^2 + q1 t + q0 in ascending order, those that are not positive as 0."""
    discriminant = q1 * q1 - (4.0 * q2) * q0
    if not discriminant > 0.0:
        return 0.0, 0.0
    root = sqrt(discriminant)
    outer = -0.5 * (q1 + root) if q1 > 0.0 else -0.5 * (q1 - root)
    one = outer / q2
    other = q0 / outer if outer != 0.0 else 0.0
    low = one if one < other else other
    high = other if one < other else one
    return (low if low > 0.0 else 0.0), (high if high > 0.0 else 0.0)


def _far(
    dx: Real,
    dy: Real,
    du: Real,
    dw: Real,
    ax: Real,
    ay: Real,
    circle: Round,
    radius: Real,
    side: float,
    touches: bool,
    last: Real,
) -> Real:
    """A delay after which the gap only opens (outside) or stays closed (inside)."""
    speed = sqrt(du * du + dw * dw)
    acceleration = sqrt(ax * ax + ay * ay)
    cx, cy = dx - circle.x, dy - circle.y
    distance = sqrt(cx * cx + cy * cy) + radius
    t = last + speed / acceleration + sqrt(distance / acceleration)
    for _ in range(DOUBLINGS):
        rate = side * round_rate(dx, dy, du, dw, ax, ay, circle, side, t)
        gap = side * round_gap(dx, dy, du, dw, ax, ay, circle, side, touches, t)
        if rate > 0.0 and gap > 0.0:
            break
        t = 2.0 * t
    return t


def _turn(
    dx: Real,
    dy: Real,
    du: Real,
    dw: Real,
    ax: Real,
    ay: Real,
    circle: Round,
    side: float,
    low: Real,
    high: Real,
    falling: bool,
) -> Real:
    """Where the rate changes its sign between low, where the gap is falling or not, and high."""
    if not is_float(dx):
        _, c1, c2, c3, c4 = round_polynomial(dx, dy, du, dw, ax, ay, circle, side, False)
        return root_between(dx, (c1, 2.0 * c2, 3.0 * c3, 4.0 * c4), low, high)
    for _ in range(BISECTIONS):
        middle = low + 0.5 * (high - low)
        if not (low < middle < high):
            break
        if (round_rate(dx, dy, du, dw, ax, ay, circle, side, middle) < 0.0) == falling:
            low = middle
        else:
            high = middle
    return high


def _closing(
    dx: Real,
    dy: Real,
    du: Real,
    dw: Real,
    ax: Real,
    ay: Real,
    circle: Round,
    side: float,
    touches: bool,
    low: Real,
    high: Real,
    counts: bool,
) -> Real:
    """Where a gap that falls from low to high closes; NEVER if it stays open.

    A gap that is closed from the beginning closes at low, if such an overlap counts.
    """
    if not round_gap(dx, dy, du, dw, ax, ay, circle, side, touches, low) > 0.0:
        return low if counts else NEVER
    if round_gap(dx, dy, du, dw, ax, ay, circle, side, touches, high) > 0.0:
        return NEVER
    if not is_float(dx):
        return root_between(dx, round_polynomial(dx, dy, du, dw, ax, ay, circle, side, touches), low, high)
    for _ in range(BISECTIONS):
        middle = low + 0.5 * (high - low)
        if not (low < middle < high):
            break
        if round_gap(dx, dy, du, dw, ax, ay, circle, side, touches, middle) > 0.0:
            low = middle
        else:
            high = middle
    return high
