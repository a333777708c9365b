"""Time passes without a contact: free flights, wraps around periodic boundaries, the turn of the clock."""

from __future__ import annotations

from eventsim.engines.fast.compiled import inline
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
from eventsim.engines.fast.memory import real, store, word
from eventsim.engines.fast.sides import NOWHERE, keep_sides, keep_sides_behind
from eventsim.formulas.expansion import two_sum
from eventsim.formulas.low_place import low_position, settled
from eventsim.formulas.motion import position, velocity


@inline
def pulls(m, rules, i):
    """The acceleration of disk i, (x, y); None without gravity."""
    return (
        _pull(m, i, rules.gx, rules.classes, SUPPORT_X, m.supports),
        _pull(m, i, rules.gy, rules.classes, SUPPORT_Y, m.supports),
    )


@inline
def _pull(m, i, g, classes, at, supports):
    if g is None:
        return None
    if supports is not None:
        return _pull_or_slope(m, i, g, at)
    if classes is None:
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
def low_place(m, i, t, low):
    """The low parts of `place`."""
    f = i * REALS
    lag = t - real(m.disks, f + T)
    return (
        low_position(real(m.disks, f + X), real(low, 2 * i), real(m.disks, f + VX), lag),
        low_position(real(m.disks, f + Y), real(low, 2 * i + 1), real(m.disks, f + VY), lag),
    )


@inline
def keep_low_place(m, i, t, low):
    """Let the low parts of a place be those of time t, where a new flight is about to begin."""
    if low is not None:
        low_x, low_y = low_place(m, i, t, low)
        store(low, 2 * i, low_x)
        store(low, 2 * i + 1, low_y)


@inline
def settle(m, rules, i, t, low):
    """Where places have low parts: begin the flight of disk i anew at time t, the high parts rounded to nearest."""
    if low is not None:
        f = i * REALS
        x, y = place(m, rules, i, t)
        low_x, low_y = low_place(m, i, t, low)
        x, low_x = settled(x, low_x)
        y, low_y = settled(y, low_y)
        store(m.disks, f + T, t)
        store(m.disks, f + X, x)
        store(m.disks, f + Y, y)
        store(low, 2 * i, low_x)
        store(low, 2 * i + 1, low_y)


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
    keep_low_place(m, i, t, m.low_places)
    if code >= WRAP_LEFT:  # the codes of x come first
        step = 1 if code == WRAP_RIGHT else -1
        _keep_beyond(2 * i, x - (rules.width if step > 0 else 0.0), m.low_places)
        keep_sides(m, rules, i, t, pulls(m, rules, i), rules.width if step > 0 else 0.0, y, vx, vy, NOWHERE, 0, m.sides)
        x = 0.0 if step > 0 else rules.width
        store(m.disks, i * WORDS + WRAPS_X, word(m.disks, i * WORDS + WRAPS_X) + step)
    else:
        step = -1 if code == WRAP_DOWN else 1
        _keep_beyond(2 * i + 1, y - (rules.height if step > 0 else 0.0), m.low_places)
        keep_sides(
            m, rules, i, t, pulls(m, rules, i), x, rules.height if step > 0 else 0.0, vx, vy, NOWHERE, 0, m.sides
        )
        y = 0.0 if step > 0 else rules.height
        store(m.disks, i * WORDS + WRAPS_Y, word(m.disks, i * WORDS + WRAPS_Y) + step)
    keep_sides_behind(m, rules, i, code, m.sides)
    anchor(m, i, t, x, y, vx, vy)
    forget_shapes(m, rules, i, m.supports)


@inline
def _keep_beyond(at, beyond, low):
    """Add to a low part what is taken off the high part, because that is set exactly onto the boundary."""
    if low is not None:
        store(low, at, real(low, at) + beyond)


@inline
def lay_on(at, size, side, r, low):
    """Let a low part be what the place of a disk on a wall of the domain leaves when it is rounded."""
    if low is not None:
        _, rest = two_sum(size, -r)
        store(low, at, rest if side < 0 else 0.0)
