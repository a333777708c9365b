"""When the plain formula has lost its digits: the contact of round things by error-free arithmetic, right to the last bit.

Near contact c = d^2 - reach^2 cancels, at a graze D = a reach^2 - (d x v)^2 does, far from the corner already x + v (t - t0) is
rounded, and velocities of 1e-160 have no squares.  So lengths and velocities are scaled by powers of two, and everything is
computed from the two flights themselves in double-double numbers, a pair (high, low) of floats with about 104 bits; what these
cannot decide (a gap of 2**-45 of the coordinates), in exact expansions.  Whether disks hit, graze or miss is exact for the given
floats.

Source: T. J. Dekker, Numer. Math. 18, 224 (1971), doi:10.1007/BF01397083.
"""

import math
from typing import TypeAlias

from eventsim.formulas.expansion import added, grown, leading, multiplied, negated, scaled, two_product, two_sum
from eventsim.formulas.real import NEVER

Two: TypeAlias = tuple[float, float]

ROUNDING = 2.0**-97
"""A bound on the relative error of the double-double sums of products below: at most 2**-104 an operation, 2**6 of them."""

ENOUGH = 2.0**-56
"""A relative error that leaves the last bit of a float to the final rounding."""

SMALL, LARGE = 2.0**-64, 2.0**64
"""Lengths, speeds and times between these need no scaling: their products of any degree that occurs are floats."""

LARGEST, CUT = 1024, 900
"""Exponents of the largest float, and of the largest one whose products with numbers below 1 are safe to split."""


def careful_pair_delay(
    xi: float,
    yi: float,
    ui: float,
    wi: float,
    ti: float,
    ri: float,
    xj: float,
    yj: float,
    uj: float,
    wj: float,
    tj: float,
    rj: float,
    shift_x: float,
    shift_y: float,
    side: float = 1.0,
) -> float:
    """The delay, counted from max(ti, tj), until two straight flights are ri + rj apart; NEVER where they miss or graze.

    (x, y), (u, w), t, r: anchor, velocity, local clock and radius of disks i and j; (shift_x, shift_y): the multiple of the
    periods that is taken off their distance.  The sum ri + rj is not rounded.  An approaching overlap, or contact, is due
    now.  Relative error below 2**-52; exchange of the disks (with the shift's sign) changes no bit.

    side: -1.0 for a disk inside a circle, one radius of which is negative: how long it is less than ri + rj from the centre.
    """
    if ui == uj and wi == wj:
        return NEVER
    size = max(ri, rj, abs(xi), abs(yi), abs(xj), abs(yj), abs(shift_x), abs(shift_y))
    fastest = max(abs(ui), abs(wi), abs(uj), abs(wj))
    length = speed = 0
    if not (SMALL < size < LARGE and SMALL < fastest < LARGE and abs(ti) < LARGE and abs(tj) < LARGE):
        length, speed = _exponent(size), _exponent(fastest)
    clock = length - speed
    lag_i, lag_j = 0.0, 0.0
    rest_i, rest_j = 0.0, 0.0
    if ti < tj:
        lag_i, rest_i = two_sum(tj, -ti)
    else:
        lag_j, rest_j = two_sum(ti, -tj)
    lag_i, rest_i = _shifted(lag_i, -clock), _shifted(rest_i, -clock)
    lag_j, rest_j = _shifted(lag_j, -clock), _shifted(rest_j, -clock)
    ri, rj = _shifted(ri, -length), _shifted(rj, -length)
    xi, yi, xj, yj = _shifted(xi, -length), _shifted(yi, -length), _shifted(xj, -length), _shifted(yj, -length)
    shift_x, shift_y = _shifted(shift_x, -length), _shifted(shift_y, -length)
    ui, wi, uj, wj = _shifted(ui, -speed), _shifted(wi, -speed), _shifted(uj, -speed), _shifted(wj, -speed)
    du, dw = two_sum(ui, -uj), two_sum(wi, -wj)
    reach = two_sum(ri, rj)
    dx, size_x = _apart(xi, ui, lag_i, rest_i, xj, uj, lag_j, rest_j, shift_x)
    dy, size_y = _apart(yi, wi, lag_i, rest_i, yj, wj, lag_j, rest_j, shift_y)
    b, c, d, decided = _quadratic(dx, dy, du, dw, reach, size_x, size_y, side)
    if not decided:
        exact_x = _exactly_apart(xi, ui, lag_i, rest_i, xj, uj, lag_j, rest_j, shift_x)
        exact_y = _exactly_apart(yi, wi, lag_i, rest_i, yj, wj, lag_j, rest_j, shift_y)
        b, c, d = _exact_quadratic(exact_x, exact_y, du, dw, reach)
    if side < 0.0:
        scaled_delay = _until_outside(b, c, d, _square(du, dw))
    else:
        if not b[0] < 0.0:
            return NEVER
        if not c[0] > 0.0:
            return 0.0
        if not d[0] > 0.0:
            return NEVER
        scaled_delay = _quotient(c, _minus(_root(d), b))
    if clock == 0:
        return scaled_delay
    mantissa, exponent = math.frexp(scaled_delay)
    return math.ldexp(mantissa, exponent + clock) if exponent + clock <= LARGEST else NEVER


def _until_outside(b: Two, c: Two, d: Two, a: Two) -> float:
    """The later root of a t^2 + 2 b t + c, now if it is past: where nothing cancels, on the way out and on the way in."""
    root = _root(d) if d[0] > 0.0 else (0.0, 0.0)
    if not b[0] > 0.0:
        return _quotient(_minus(root, b), a)
    if not c[0] < 0.0:
        return 0.0
    return _quotient((-c[0], -c[1]), _plus(b, root))


def _exponent(size: float) -> int:
    """The power of two that brings a size to [1/2, 1)."""
    return math.frexp(size)[1]


def _shifted(x: float, power: int) -> float:
    """x times a power of two; so large a lag that its products would overflow belongs to a disk at rest, and is cut."""
    if power == 0:
        return x
    mantissa, exponent = math.frexp(x)
    return math.ldexp(mantissa, min(exponent + power, CUT))


def _apart(
    xi: float, ui: float, lag_i: float, rest_i: float, xj: float, uj: float, lag_j: float, rest_j: float, shift: float
) -> tuple[Two, float]:
    """(x_i + u_i lag_i) - (x_j + u_j lag_j) - shift, and the size of what it is the difference of; one of the lags is 0."""
    at_i = _plus((xi, 0.0), _times((lag_i, rest_i), (ui, 0.0)))
    at_j = _plus((xj, 0.0), _times((lag_j, rest_j), (uj, 0.0)))
    size = (abs(xi) + abs(ui * lag_i)) + (abs(xj) + abs(uj * lag_j)) + abs(shift)
    return _minus(_minus(at_i, at_j), (shift, 0.0)), size


def _quadratic(
    dx: Two, dy: Two, du: Two, dw: Two, reach: Two, size_x: float, size_y: float, side: float
) -> tuple[Two, Two, Two, bool]:
    """b = d.v, c = d^2 - reach^2, D = a reach^2 - (d x v)^2, and whether their signs and leading digits are certain.

    size_x, size_y bound the terms that dx and dy are differences of, and so the error that these carry.  Outside of a circle
    only b < 0 matters, inside it the size of |b| + sqrt D.
    """
    b = _plus(_times(dx, du), _times(dy, dw))
    reach2 = _times(reach, reach)
    c = _minus(_plus(_times(dx, dx), _times(dy, dy)), reach2)
    cross = _minus(_times(dx, dw), _times(dy, du))
    a_reach2 = _times(_square(du, dw), reach2)
    d = _minus(a_reach2, _times(cross, cross))
    u, w = abs(du[0]), abs(dw[0])
    error_b = ROUNDING * (size_x * u + size_y * w)
    if b[0] > error_b and side > 0.0:
        return b, c, d, True
    error_c = ROUNDING * ((size_x * size_x + size_y * size_y) + reach2[0])
    least_b = -b[0] if side > 0.0 else abs(b[0])
    if not (error_b < ENOUGH * least_b and error_c < ENOUGH * abs(c[0])):
        return b, c, d, False
    error_cross = ROUNDING * (size_x * w + size_y * u)
    error_d = ROUNDING * (a_reach2[0] + cross[0] * cross[0]) + 3.0 * (abs(cross[0]) + error_cross) * error_cross
    return b, c, d, (c[0] < 0.0 and side > 0.0) or error_d < ENOUGH * abs(d[0])


def _exactly_apart(
    xi: float, ui: float, lag_i: float, rest_i: float, xj: float, uj: float, lag_j: float, rest_j: float, shift: float
) -> list[float]:
    """The same distance without rounding."""
    apart = added(scaled([rest_i, lag_i], ui), scaled([rest_j, lag_j], -uj))
    return grown(grown(grown(apart, xi), -xj), -shift)


def _exact_quadratic(dx: list[float], dy: list[float], du: Two, dw: Two, reach: Two) -> tuple[Two, Two, Two]:
    """The leading digits of b, c and D without rounding."""
    u, w, r = [du[1], du[0]], [dw[1], dw[0]], [reach[1], reach[0]]
    b = added(multiplied(dx, u), multiplied(dy, w))
    reach2 = multiplied(r, r)
    c = added(added(multiplied(dx, dx), multiplied(dy, dy)), negated(reach2))
    cross = added(multiplied(dx, w), negated(multiplied(dy, u)))
    a = added(multiplied(u, u), multiplied(w, w))
    d = added(multiplied(a, reach2), negated(multiplied(cross, cross)))
    return leading(b), leading(c), leading(d)


def _square(u: Two, w: Two) -> Two:
    """u^2 + w^2."""
    return _plus(_times(u, u), _times(w, w))


def _plus(p: Two, q: Two) -> Two:
    s, e = two_sum(p[0], q[0])
    f, g = two_sum(p[1], q[1])
    s, e = two_sum(s, e + f)
    return two_sum(s, e + g)


def _minus(p: Two, q: Two) -> Two:
    return _plus(p, (-q[0], -q[1]))


def _times(p: Two, q: Two) -> Two:
    s, e = two_product(p[0], q[0])
    return two_sum(s, e + (p[0] * q[1] + p[1] * q[0]))


def _root(p: Two) -> Two:
    """The square root of a positive number: one Newton step beyond the float one."""
    s = math.sqrt(p[0])
    square, rest = two_product(s, s)
    return two_sum(s, (((p[0] - square) - rest) + p[1]) / (2.0 * s))


def _quotient(p: Two, q: Two) -> float:
    """p / q rounded."""
    s = p[0] / q[0]
    product, rest = two_product(s, q[0])
    return s + ((((p[0] - product) - rest) + p[1]) - s * q[1]) / q[0]
