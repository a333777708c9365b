"""When two disks meet, by the images that see each other."""

from __future__ import annotations

from eventsim.engines.fast.advance import place, pulls
from eventsim.engines.fast.compiled import inline, part, real, word
from eventsim.engines.fast.last_contact import just_met
from eventsim.engines.fast.layout import (
    CLASSES,
    CONTACT_TIME,
    FLAGS,
    IMMOVABLE,
    RADIUS,
    REALS,
    VX,
    VY,
    WORDS,
    T,
    X,
    Y,
)
from eventsim.formulas.contact import screened_pair_delay
from eventsim.formulas.digits import careful_pair_delay
from eventsim.formulas.motion import position, velocity
from eventsim.formulas.parabola import ANY_OVERLAP, circle_delays
from eventsim.formulas.real import NEVER


@inline
def image(d, length):
    """-1, 0 or 1: the image that brings a distance along a period below half of it."""
    if length is None:
        return 0
    if d > 0.5 * length:
        return 1
    return -1 if d < -(0.5 * length) else 0


@inline
def shift(k, length):
    """The distance of an image; 0 without a period."""
    return 0.0 if length is None else k * length


@inline
def shifts(rules, kx, ky):
    """The distance of an image, along x and y."""
    return shift(kx, rules.length_x), shift(ky, rules.length_y)


@inline
def images(m, rules, i, j, now, x, y):
    """The image (kx, ky) of disk j that is nearest to disk i, which is at (x, y)."""
    if rules.length_x is None and rules.length_y is None:
        return 0, 0
    other_x, other_y = place(m, rules, j, now)
    return image(x - other_x, rules.length_x), image(y - other_y, rules.length_y)


@inline
def flight_of(m, i):
    """x, y, vx, vy, t, radius."""
    f = i * REALS
    return (
        real(m.disks, f + X),
        real(m.disks, f + Y),
        real(m.disks, f + VX),
        real(m.disks, f + VY),
        real(m.disks, f + T),
        real(m.disks, f + RADIUS),
    )


@inline
def pair_time(m, rules, i, j, kx, ky):
    """The contact time of two disks; symmetric under their exchange, bit for bit."""
    (xi, yi, ui, wi, ti, _), (xj, yj, uj, wj, tj, _) = flight_of(m, i), flight_of(m, j)
    begin = ti if ti > tj else tj
    ax, ay = pulls(m, rules, i)
    bx, by = pulls(m, rules, j)
    lag, other_lag = begin - ti, begin - tj
    dx, dy = (
        position(xi, ui, lag, ax) - position(xj, uj, other_lag, bx),
        position(yi, wi, lag, ay) - position(yj, wj, other_lag, by),
    )
    shift_x, shift_y = shifts(rules, kx, ky)
    dx, dy = dx - shift_x, dy - shift_y
    du = velocity(ui, lag, ax) - velocity(uj, other_lag, bx)
    dw = velocity(wi, lag, ay) - velocity(wj, other_lag, by)
    return begin + _pair_delay(m, rules, i, j, kx, ky, dx, dy, du, dw, ax, ay, bx, by)


@inline
def _pair_delay(m, rules, i, j, kx, ky, dx, dy, du, dw, ax, ay, bx, by):
    ri, rj = real(m.disks, i * REALS + RADIUS), real(m.disks, j * REALS + RADIUS)
    all_fall_alike = rules.classes is None and m.supports is None
    if ax is not None and not all_fall_alike and (ax != bx or ay != by):
        touches = rules.still is not None and _touch(m, i, j, kx, ky)
        return circle_delays(dx, dy, du, dw, ax - bx, ay - by, ri + rj, 1.0, ANY_OVERLAP, touches)[0]
    delay = screened_pair_delay(dx, dy, du, dw, ri + rj)
    if delay == delay:
        return delay
    if ax is not None:
        return careful_pair_delay(dx, dy, du, dw, 0.0, ri, 0.0, 0.0, 0.0, 0.0, 0.0, rj, 0.0, 0.0)
    return _careful_delay(m, rules, i, j, kx, ky)


@inline
def _touch(m, i, j, kx, ky):
    """Whether the flights of both disks began at their contact with each other; told where disks settle."""
    begun = real(m.disks, i * REALS + T)
    alike = begun == real(m.disks, j * REALS + T) and begun == real(m.disks, i * REALS + CONTACT_TIME)
    return alike and begun == real(m.disks, j * REALS + CONTACT_TIME) and just_met(m, i, j, kx, ky)


@part
def _careful_delay(m, rules, i, j, kx, ky):
    """The delay of a pair in straight flight from the two flights themselves, right to the last bit."""
    flights = flight_of(m, i) + flight_of(m, j) + shifts(rules, kx, ky)
    return careful_pair_delay(*flights)


@inline
def flies_alike(m, rules, i, j):
    """Whether the relative flight of two disks is straight."""
    if rules.gx is None or (rules.classes is None and m.supports is None):
        return True
    if m.supports is not None:
        ax, ay = pulls(m, rules, i)
        bx, by = pulls(m, rules, j)
        return not (ax != bx or ay != by)
    return (word(m.disks, i * WORDS + FLAGS) ^ word(m.disks, j * WORDS + FLAGS)) & IMMOVABLE == 0


@inline
def pair_is_due(m, rules, i, j, kx, ky):
    """The contact time of a pair, NEVER if it has just met or never meets."""
    if rules.classes is not None and word(m.disks, i * WORDS + FLAGS) & word(m.disks, j * WORDS + FLAGS) & CLASSES != 0:
        return NEVER  # two immovable disks, or two tracers
    time = pair_time(m, rules, i, j, kx, ky)
    if time < NEVER and flies_alike(m, rules, i, j) and just_met(m, i, j, kx, ky):
        return NEVER
    return time
