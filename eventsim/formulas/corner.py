"""A corner of two walls that holds a disk under gravity: when what is left of its bounces there is below the digits.

Between two walls that bear it together a disk loses energy at each bounce, and never leaves.  The series of its bounces is over
after a finite time, at rest on both walls.  How they share its weight is no question of impulses, so there the run ends.  It ends
before, once a last bit of the disk's place is worth as much energy as it has left.
"""

from eventsim.formulas.doubt import LEAST_LOSS, NO_SPEED, ROUNDED, rounding_of
from eventsim.formulas.real import Real

SPENT = 8.0
"""Energy so many times that of a fall by the last bit of a place, over 1 - e^2, is what rounding may keep up in a corner."""


def holds(ax: Real, ay: Real, bx: Real, by: Real, gx: Real, gy: Real) -> bool:
    """Whether gravity presses a disk onto two walls at once: -g lies between their normals a and b.

    Walls along the axes do not: places on these are exact, and bounces on one do not feel the other.
    """
    if (ax == 0.0 or ay == 0.0) and (bx == 0.0 or by == 0.0):
        return False
    turn = ax * by - ay * bx
    return bool(turn * (gy * bx - gx * by) > 0.0 and turn * (gx * ay - gy * ax) > 0.0)


def slides_into(ax: Real, ay: Real, bx: Real, by: Real, gx: Real, gy: Real) -> bool:
    """Whether a disk that comes to rest on wall a is pressed onto wall b as well: gravity along a leads into b.

    So it does where b is level, which holds what falls onto it alone.  Walls along the axes: as for `holds`.
    """
    if (ax == 0.0 or ay == 0.0) and (bx == 0.0 or by == 0.0):
        return False
    return bool((ax * by - ay * bx) * (gx * ay - gy * ax) > 0.0)


def passes_sliding(ax: Real, ay: Real, bx: Real, by: Real, u: Real, w: Real, gx: Real, gy: Real) -> bool:
    """Whether a disk with velocity (u, w), whose bounces on wall a are over, does not meet wall b, which it is above as well.

    Along a it comes no nearer to b; off a it is further from both.
    """
    turn = ax * by - ay * bx
    if not ax * bx + ay * by > 0.0:
        return False
    return not _leads(turn, ax, ay, u, w) and not _leads(turn, ax, ay, gx, gy)


def _leads(turn: Real, ax: Real, ay: Real, u: Real, w: Real) -> bool:
    """Whether a vector has a part along wall a towards another wall, on the left (turn < 0) or right of a's normal."""
    one, other = ax * w, ay * u
    slack = NO_SPEED * rounding_of(one, other)
    return bool(one - other < -slack) if turn > 0.0 else bool(turn < 0.0 and one - other > slack)


def is_spent(
    ax: Real,
    ay: Real,
    bx: Real,
    by: Real,
    gx: Real,
    gy: Real,
    u: Real,
    w: Real,
    lag: Real,
    size: Real,
    restitution: Real,
) -> bool:
    """Whether a disk that comes at (u, w) to wall b has no energy left that its place, known to last bits of `size`, can tell.

    It left wall a, with which b holds it, `lag` ago.  So far it came from a; along b that is a climb out of the corner.
    """
    way = ax * (lag * (u - (0.5 * gx) * lag)) + ay * (lag * (w - (0.5 * gy) * lag))
    climb = way * ((gy * bx - gx * by) / (ax * by - ay * bx))
    energy = 0.5 * (u * u + w * w) + (climb if climb > 0.0 else 0.0)
    return bool(energy < kept_up_energy(gx, gy, size, restitution))


def kept_up_energy(gx: Real, gy: Real, size: Real, restitution: Real) -> Real:
    """The energy that rounding may keep up: places are known to the last bits of `size`."""
    loss = 1.0 - restitution * restitution
    return (SPENT * ROUNDED) * (size * (abs(gx) + abs(gy))) / (loss if loss > LEAST_LOSS else LEAST_LOSS)
