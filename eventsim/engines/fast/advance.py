"""Time passes without a contact: free flights, wraps around periodic boundaries, the turn of the clock."""

from __future__ import annotations

from eventsim.engines.fast.compiled import inline, real, store, word
from eventsim.engines.fast.last_contact import forget_shapes
from eventsim.engines.fast.layout import (
    COUNT,
    COUNTS,
    FLAGS,
    IMMOVABLE,
    MET,
    REALS,
    RESTING,
    SUPPORT,
    SUPPORT_X,
    SUPPORT_Y,
    VX,
    VY,
    WORDS,
    WRAP_DOWN,
    WRAP_LEFT,
    WRAP_RIGHT,
    WRAPS_X,
    WRAPS_Y,
    T,
    X,
    Y,
)
from eventsim.engines.fast.sides import NOWHERE, keep_sides, keep_sides_behind
from eventsim.formulas.motion import position, velocity


@inline
def pulls(m, rules, i):
    """The acceleration of disk i, (x, y); None without gravity."""
    if rules.gx is None:
        return None, None
    return _pull(m, rules, i, rules.gx, SUPPORT_X), _pull(m, rules, i, rules.gy, SUPPORT_Y)


@inline
def _pull(m, rules, i, g, at):
    if m.supports is not None:
        return _pull_or_slope(m, i, g, at)
    if rules.classes is None:
        return g
    return 0.0 if word(m.disks, i * WORDS + FLAGS) & IMMOVABLE else g


@inline
def _pull_or_slope(m, i, g, at):
    flags = word(m.disks, i * WORDS + FLAGS)
    if flags & RESTING:
        return real(m.supports, SUPPORT * (-1 - word(m.disks, i * WORDS + MET)) + at)
    return 0.0 if flags & IMMOVABLE else g


@inline
def place(m, rules, i, t):
    """The centre of disk i at time t of its present flight."""
    f = i * REALS
    lag = t - real(m.disks, f + T)
    gx, gy = pulls(m, rules, i)
    x = position(real(m.disks, f + X), real(m.disks, f + VX), lag, gx)
    y = position(real(m.disks, f + Y), real(m.disks, f + VY), lag, gy)
    return x, y


@inline
def speed(m, rules, i, t):
    """The velocity of disk i at time t of its present flight."""
    f = i * REALS
    lag = t - real(m.disks, f + T)
    gx, gy = pulls(m, rules, i)
    return velocity(real(m.disks, f + VX), lag, gx), velocity(real(m.disks, f + VY), lag, gy)


@inline
def anchor(m, i, t, x, y, vx, vy):
    """Begin a new flight of disk i; all predictions that rest on the old one are stale from here on."""
    f = i * REALS
    store(m.disks, f + T, t)
    store(m.disks, f + X, x)
    store(m.disks, f + Y, y)
    store(m.disks, f + VX, vx)
    store(m.disks, f + VY, vy)
    store(m.disks, i * WORDS + COUNT, (word(m.disks, i * WORDS + COUNT) + 1) & (COUNTS - 1))


@inline
def wrap(m, rules, i, code, t):
    """Take a disk to the other side of the domain: its coordinate becomes exactly 0 or the period."""
    x, y = place(m, rules, i, t)
    vx, vy = speed(m, rules, i, t)
    if code >= WRAP_LEFT:  # the codes of x come first
        step = 1 if code == WRAP_RIGHT else -1
        if m.sides is not None:
            keep_sides(m, rules, i, t, pulls(m, rules, i), rules.width if step > 0 else 0.0, y, vx, vy, NOWHERE, 0)
        x = 0.0 if step > 0 else rules.width
        store(m.disks, i * WORDS + WRAPS_X, word(m.disks, i * WORDS + WRAPS_X) + step)
    else:
        step = -1 if code == WRAP_DOWN else 1
        if m.sides is not None:
            keep_sides(m, rules, i, t, pulls(m, rules, i), x, rules.height if step > 0 else 0.0, vx, vy, NOWHERE, 0)
        y = 0.0 if step > 0 else rules.height
        store(m.disks, i * WORDS + WRAPS_Y, word(m.disks, i * WORDS + WRAPS_Y) + step)
    if m.images is not None:
        keep_sides_behind(m, rules, i, code)
    anchor(m, i, t, x, y, vx, vy)
    forget_shapes(m, rules, i)
