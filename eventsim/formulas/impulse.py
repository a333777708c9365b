"""What a contact does: velocities after the normal/tangent update, with restitution, for any masses."""

import math

from eventsim.formulas.real import Real


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


def normal_change(approach: Real, distance2: Real, restitution: Real) -> Real:
    """The factor q of the update v_a - q mu_b d, v_b + q mu_a d: (1 + e) (d.v) / d^2, with the actual d^2 at contact.

    Dividing by the actual distance, not by the reach, keeps the energy to the last bits however the position is rounded.
    """
    return (1.0 + restitution) * (approach / distance2)


def flat_reflection(v: Real, restitution: Real) -> Real:
    """The velocity component after contact with a wall across the axis."""
    return -(restitution * v)
