"""What a contact of rough disks does along their surfaces: a share of the sliding velocity comes back, and spins change.

g_t, the velocity at which the surfaces slide past each other, becomes -beta g_t: beta = -1 is smooth, 1 perfectly rough.  The
normal part is that of `impulse`; this one comes on top of it.  The arms of the torque are the radii times the actual distance
over the reach, so angular momentum and, at beta = -1 or 1, energy are kept to the last bits however places are rounded.

Source: J. T. Jenkins, M. W. Richman, Phys. Fluids 28, 3485 (1985), doi:10.1063/1.865302, section II; S. Luding, M. Huthmann,
S. McNamara, A. Zippelius, Phys. Rev. E 58, 3416 (1998), doi:10.1103/PhysRevE.58.3416, equation 2.
"""

from typing import NamedTuple

from eventsim.formulas.real import Real, sqrt

SMOOTH, PERFECTLY_ROUGH = -1.0, 1.0


class Roughness(NamedTuple):
    """The tangential restitution beta of contacts between disks, and of those at walls."""

    pair: float
    wall: float

    def keeps_energy(self, pairs: bool = True, walls: bool = True) -> bool:
        """Whether what is lost along surfaces goes into spin, and back, as a whole."""
        return not ((pairs and abs(self.pair) != 1.0) or (walls and abs(self.wall) != 1.0))


def pair_grip(
    dx: Real,
    dy: Real,
    u: Real,
    w: Real,
    spin_a: Real,
    spin_b: Real,
    share_a: Real,
    share_b: Real,
    radius_a: Real,
    radius_b: Real,
    moment_a: Real,
    moment_b: Real,
    tangential: Real,
) -> tuple[Real, Real, Real]:
    """(spin_a, spin_b, k) after contact of two disks at d = a - b; velocities get -k mu_b T and +k mu_a T, T = (-d_y, d_x).

    (u, w) is the relative velocity before it, moments are I / m r^2, shares those of the sum of the masses.  With T the sliding
    velocity is g.T = v.T - d^2 (r_a w_a + r_b w_b) / (r_a + r_b).  A pair that does not approach does not grip, k = 0.
    """
    if not dx * u + dy * w < 0.0:
        return spin_a, spin_b, 0.0
    square, reach = dx * dx + dy * dy, radius_a + radius_b
    sliding = (dx * w - dy * u) - square * ((radius_a * spin_a + radius_b * spin_b) / reach)
    turning = (square / (reach * reach)) * (share_b / moment_a + share_a / moment_b)
    k = (1.0 + tangential) * (sliding / (square * (1.0 + turning)))
    turn = k * (square / reach)
    return (
        spin_a + (turn * share_b) / (moment_a * radius_a),
        spin_b + (turn * share_a) / (moment_b * radius_b),
        k,
    )


def gripped(
    dx: Real, dy: Real, ua: Real, wa: Real, ub: Real, wb: Real, share_a: Real, share_b: Real, k: Real
) -> tuple[Real, Real, Real, Real]:
    """The velocities of a pair after the normal part of its contact, with the tangential part."""
    one, other = k * share_b, k * share_a
    return ua + one * dy, wa - one * dx, ub - other * dy, wb + other * dx


def heated_spin(other: float, temperature: float, mass: float, radius: float, moment: float) -> Real:
    """The spin behind a wall that heats: `other` times the root of kT / I."""
    return other * sqrt(temperature / (moment * mass * (radius * radius)))


def wall_grip(
    nx: Real, ny: Real, u: Real, w: Real, spin: Real, radius: Real, moment: Real, tangential: Real
) -> tuple[Real, Real]:
    """(spin, k) after contact with a wall whose normal, of any length, points to the disk; its velocity gets -k (-ny, nx).

    (u, w) is the velocity before it.  A disk that does not approach does not grip, k = 0.
    """
    if not nx * u + ny * w < 0.0:
        return spin, 0.0
    square = nx * nx + ny * ny
    length = sqrt(square)
    sliding = (nx * w - ny * u) - length * (radius * spin)
    k = (1.0 + tangential) * (sliding / (square * (1.0 + 1.0 / moment)))
    return spin + (k * length) / (moment * radius), k


def grip_strength(q: Real, k: Real, mass: Real, length: Real) -> Real:
    """The magnitude of the momentum q d normal and k d tangential, times a mass."""
    return (mass * length) * sqrt(q * q + k * k)
