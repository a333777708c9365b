"""What a contact does: velocities after the normal/tangent update, with restitution, for any masses."""

import math
from typing import Any

from eventsim.formulas.real import Real, is_float, sqrt

LEAST, MOST = 2.0**-900, 2.0**900
"""Squares of velocities within which sums of them are floats to the last bit, and error-free products are exact."""


def mass_fractions(mass_a: float, mass_b: float) -> tuple[float, float]:
    """(m_a, m_b) / (m_a + m_b), by halves so that 1e308 does not overflow; inf: the other one's share is 0; 0: its own is 0.

    Equal masses give exactly 1/2.  Two immovable disks or two tracers do not meet and have no fractions.
    """
    if math.isinf(mass_a) or mass_b == 0.0:
        return 1.0, 0.0
    if math.isinf(mass_b) or mass_a == 0.0:
        return 0.0, 1.0
    total = 0.5 * mass_a + 0.5 * mass_b
    return (0.5 * mass_a) / total, (0.5 * mass_b) / total


def reduced_mass(mass_a: float, mass_b: float) -> float:
    """m_a m_b / (m_a + m_b); the finite mass of a pair with an immovable disk; 0 with a tracer."""
    share_a, share_b = mass_fractions(mass_a, mass_b)
    return share_b * mass_a if math.isinf(mass_b) else share_a * mass_b


def pair_update(
    dx: Real,
    dy: Real,
    ua: Real,
    wa: Real,
    ub: Real,
    wb: Real,
    share_a: Real,
    share_b: Real,
    restitution: Real,
) -> tuple[Real, Real, Real, Real, Real]:
    """(u_a, w_a, u_b, w_b, q) after contact of two disks at d = a - b: v_a - q mu_b d, v_b + q mu_a d.

    q = (1 + e) (d.v) / d^2 with the actual d^2 at contact: so the energy is kept to the last bits however the positions are
    rounded.  A pair that does not approach (a graze, by rounding) is left as it is, q = 0.
    """
    b = dx * (ua - ub) + dy * (wa - wb)
    if not b < 0.0:
        return ua, wa, ub, wb, 0.0
    q = (1.0 + restitution) * (b / (dx * dx + dy * dy))
    return (
        ua - (q * share_b) * dx,
        wa - (q * share_b) * dy,
        ub + (q * share_a) * dx,
        wb + (q * share_a) * dy,
        q,
    )


def wall_update(nx: Real, ny: Real, u: Real, w: Real, restitution: Real) -> tuple[Real, Real, Real]:
    """(u, w, q) after contact with a wall whose normal (nx, ny), of any length, points to the disk: v - q n.

    A disk that does not approach is left as it is, q = 0.
    """
    b = nx * u + ny * w
    if not b < 0.0:
        return u, w, 0.0
    q = (1.0 + restitution) * (b / (nx * nx + ny * ny))
    return u - q * nx, w - q * ny, q


def flat_update(v: Real, side: float, restitution: Real) -> tuple[Real, Real]:
    """(v, change) of the component across a wall of the domain, met from its side +1 or -1; reversal is exact."""
    if not side * v < 0.0:
        return v, 0.0
    after = -(restitution * v)
    return after, after - v


def contact_restitution(usual: Real, law: Any, since_a: Real, since_b: Real, approach: Real, mass: Real) -> Real:
    """The restitution of a contact: what the numbers of a law make of the usual one.

    Args:
        usual: that of these two disks, or of this wall.
        law: `Numbers` of a law; None where every contact has its usual one.
        since_a, since_b: the times since the previous contacts of its disks; at a wall twice the same.
        approach: the speed along the normal; 0 where no law of the scene looks at it.
        mass: the reduced mass, at a wall that of the disk; 0 as well.
    """
    if law is None:
        return usual
    share = _users(usual, approach, since_a, since_b, mass, law.own)
    share = _yielding(share, approach, law.yield_speed)
    return _kept_if_soon(share, since_a, since_b, law.duration)


def _users(restitution: Real, approach: Real, since_a: Real, since_b: Real, mass: Real, own: Any) -> Real:
    """What a law of the user's own makes of the usual restitution."""
    if own is None:
        return restitution
    return own_restitution(own, restitution, approach, since_a if since_a < since_b else since_b, mass)


def own_restitution(own: Any, restitution: Real, approach: Real, since: Real, mass: Real) -> Real:
    """A law of the user's own, called; kernels call the machine code that it is compiled to."""
    return own(restitution, approach, since, mass)


def _kept_if_soon(restitution: Real, since_a: Real, since_b: Real, duration: float | None) -> Real:
    """The TC model: 1 within a duration of the previous contact.

    Source: S. Luding, S. McNamara, Granular Matter 1, 113 (1998), doi:10.1007/s100350050017.
    """
    if duration is None:
        return restitution
    return 1.0 if since_a < duration or since_b < duration else restitution


def _yielding(restitution: Real, approach: Real, yield_speed: float | None) -> Real:
    """Above the speed at which bodies begin to yield, less comes back: as the inverse fourth root of the approach.

    Source: K. L. Johnson, Contact Mechanics (1985), section 11.5, doi:10.1017/CBO9781139171731.
    """
    if yield_speed is None:
        return restitution
    return restitution * sqrt(sqrt(yield_speed / approach)) if approach > yield_speed else restitution


def approach_speed(dx: Real, dy: Real, u: Real, w: Real) -> Real:
    """The speed, along a direction (dx, dy) of any length, of a velocity (u, w) against it; 0 where there is no direction."""
    length = sqrt(dx * dx + dy * dy)
    return -(dx * u + dy * w) / length if length > 0.0 else 0.0


def along(nx: Real, ny: Real, speed: Real) -> tuple[Real, Real]:
    """A velocity of this speed along a direction (nx, ny) of any length; none where there is no direction."""
    length = sqrt(nx * nx + ny * ny)
    if not length > 0.0:
        return 0.0, 0.0
    return speed * (nx / length), speed * (ny / length)


def heated(
    nx: Real, ny: Real, out: float, sideways: float, temperature: float, mass: float, slide: float
) -> tuple[Real, Real]:
    """The velocity that leaves a wall that heats; its normal (nx, ny) has any length.

    Args:
        nx, ny: the normal.
        out, sideways: what chance gives along it, and to its right, over the thermal speed; see `chance.flux`.
        temperature: kT of the wall.
        mass: of the disk.
        slide: the speed of the wall to the right.
    """
    thermal = sqrt(temperature / mass)
    u, w = along(nx, ny, thermal * out)
    right, down = along(ny, -nx, thermal * sideways + slide)
    return u + right, w + down


def wall_impulse(mass: float, du: Real, dw: Real) -> Real:
    """The magnitude of the momentum that a wall gave a disk by changing its velocity by (du, dw); nan for an immovable one.

    Along an axis it is exact.
    """
    if math.isinf(mass):
        return math.nan
    return mass * (abs(du) if dw == 0.0 else abs(dw) if du == 0.0 else _speed(du, dw))


def _speed(u: Real, w: Real) -> Real:
    """The magnitude of a velocity; times a power of two it is exactly that much larger, also where squares are no floats."""
    square = u * u + w * w
    if not is_float(u) or LEAST < square < MOST:
        return sqrt(square)
    power = math.frexp(max(abs(u), abs(w)))[1]
    u, w = math.ldexp(u, -power), math.ldexp(w, -power)
    return math.ldexp(math.sqrt(u * u + w * w), power)
