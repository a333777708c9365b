"""Where the domain is very wide: a coordinate carries what its rounding left, in a low part, so that no digit of a gap is lost.

A coordinate of a million diameters has twenty bits less for the gap between two disks than one near the corner.  So the place of
a disk is the unrounded sum of two floats: the high part is the coordinate with which disks fly and are logged, as everywhere,
the low part some last bits of it.  Free flight keeps what its rounding takes (Dekker's error-free sum and product); distances
are taken of both parts, so each disk is its own anchor.  Without gravity.

Source: T. J. Dekker, Numer. Math. 18, 224 (1971), doi:10.1007/BF01397083.
"""

from typing import TypeAlias

from eventsim.formulas.contact import SMALLEST, rescaled_pair_delay, screened_pair_delay
from eventsim.formulas.crossing import closing_delay
from eventsim.formulas.digits import careful_pair_delay
from eventsim.formulas.expansion import two_product, two_sum
from eventsim.formulas.real import NEVER, Real

ROUGH = 2.0**-44
"""What a dozen roundings may take from numbers, relative to the largest of them, and much more."""

Low: TypeAlias = tuple[float, float] | None
"""The low parts of a place; None where places have none."""

Fine: TypeAlias = tuple[float, float, float, float, float, float, float, float]
"""A flight: x, y, vx, vy, t, the radius of the disk, and the low parts of x and y."""


def low_position(x: float, low: float, v: float, lag: float) -> float:
    """The low part of a coordinate after a flight: what belongs to the high part x + v lag."""
    step, fine = two_product(v, lag)
    _, rest = two_sum(x, step)
    left = low + (rest + fine)
    return left if left == left else low  # not a number where the splitting of a huge lag or speed overflows


def settled(x: float, low: float) -> tuple[float, float]:
    """The same place with the high part rounded to nearest."""
    return two_sum(x, low)


def finely_apart(x: float, low: float, other: float, other_low: float, shift: float) -> tuple[float, float]:
    """x - other - shift as an unrounded sum; exchange changes its sign and no bit."""
    apart, rest = two_sum(x, -other)
    return two_sum(apart - shift, rest + (low - other_low))


def apart(
    place: tuple[Real, Real], other: tuple[Real, Real], shifts: tuple[float, float], low: Low, other_low: Low
) -> tuple[Real, Real]:
    """place - other - shifts, rounded; from places with low parts where there are such."""
    if low is not None and other_low is not None:
        dx, _ = finely_apart(place[0], low[0], other[0], other_low[0], shifts[0])
        dy, _ = finely_apart(place[1], low[1], other[1], other_low[1], shifts[1])
        return dx, dy
    dx, dy = place[0] - other[0], place[1] - other[1]
    return dx - shifts[0] if shifts[0] else dx, dy - shifts[1] if shifts[1] else dy


def wide_pair_delay(
    xi: float,
    yi: float,
    ui: float,
    wi: float,
    ti: float,
    ri: float,
    exi: float,
    eyi: float,
    xj: float,
    yj: float,
    uj: float,
    wj: float,
    tj: float,
    rj: float,
    exj: float,
    eyj: float,
    shift_x: float,
    shift_y: float,
) -> float:
    """The delay, counted from max(ti, tj), until two straight flights are ri + rj apart; NEVER where they miss or graze.

    As `careful_pair_delay`, with (ex, ey) the low parts of the anchor (x, y): from the distance by the plain formula, by
    careful arithmetic where that is in doubt.  Most pairs part or miss by far, which is seen without low parts.  Exchange of
    the disks changes no bit.
    """
    begin = ti if ti > tj else tj
    lag, other = begin - ti, begin - tj
    near_x, near_y = (xi + ui * lag) - (xj + uj * other) - shift_x, (yi + wi * lag) - (yj + wj * other) - shift_y
    du, dw = ui - uj, wi - wj
    size = (abs(xi) + abs(xj)) + (abs(yi) + abs(yj)) + (abs(shift_x) + abs(shift_y))
    size = size + ((abs(ui) + abs(wi)) * lag + (abs(uj) + abs(wj)) * other)
    slack = (ROUGH * size + ((abs(exi) + abs(exj)) + (abs(eyi) + abs(eyj)))) * (abs(du) + abs(dw))
    if near_x * du + near_y * dw > slack:
        return NEVER
    cross = abs(near_x * dw - near_y * du) - slack
    reach = ri + rj
    if cross > 0.0 and cross * cross > (1.0 + ROUGH) * ((du * du + dw * dw) * (reach * reach)) + SMALLEST:
        return NEVER
    dx, ex = finely_apart(
        xi + ui * lag, low_position(xi, exi, ui, lag), xj + uj * other, low_position(xj, exj, uj, other), shift_x
    )
    dy, ey = finely_apart(
        yi + wi * lag, low_position(yi, eyi, wi, lag), yj + wj * other, low_position(yj, eyj, wj, other), shift_y
    )
    delay = screened_pair_delay(dx, dy, du, dw, reach)
    if delay != delay:
        delay = rescaled_pair_delay(dx, dy, du, dw, reach)
    if delay == delay:
        return delay
    return careful_pair_delay(dx, dy, ui, wi, 0.0, ri, -ex, -ey, uj, wj, 0.0, rj, 0.0, 0.0)


def wide_border_delay(x: float, low: float, v: float, border: float, radius: float, side: float) -> float:
    """The delay until the centre of a disk is a radius from a border of the domain, on its side; as `crossing_delay`."""
    return float(closing_delay(side * ((x - border) + low) - radius, side * v, None))
