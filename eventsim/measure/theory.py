"""What theory knows about hard disks: equations of state, rates, closed forms.  Scalars in, scalars out.

Symbols: eta packing fraction, d diameter, Z = P V / (N kT), g contact value of the pair distribution, N disks, f degrees of
freedom.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

KOLAFA_ROTTNER = {
    0: 1.0,
    1: 2.0,
    2: 1.12801775,
    3: 0.00181895291,
    4: -0.0526134737,
    5: 0.0504960168,
    6: -0.0325537792,
    7: 0.0134578632,
    8: 0.00140888182,
    9: -0.00834273601,
    10: 0.00694127367,
    11: -0.00262254723,
    12: 0.000355746352,
    22: -5.24672938e-9,
    57: 5.88054639e-23,
}
"""Power of x = eta / (1 - eta) -> coefficient."""

KOLAFA_ROTTNER_UP_TO, KOLAFA_ROTTNER_ACCURACY = 0.67, 1e-5
MIXTURE_ACCURACY, MIXTURE_UP_TO = 1e-2, 0.6


class Derivatives(NamedTuple):
    """Z and its first two derivatives by eta."""

    value: float
    first: float
    second: float


def fluid(eta: float) -> Derivatives:
    """Z of the fluid of equal disks, good to 1e-5 for eta <= 0.67.

    Source: J. Kolafa, M. Rottner, Mol. Phys. 104, 3435 (2006), doi:10.1080/00268970600967963.
    """
    x = eta / (1.0 - eta)
    terms = KOLAFA_ROTTNER.items()
    by_x = sum(k * c * x ** (k - 1) for k, c in terms if k > 0)
    by_x2 = sum(k * (k - 1) * c * x ** (k - 2) for k, c in terms if k > 1)
    slope, bend = (1.0 - eta) ** -2, 2.0 * (1.0 - eta) ** -3
    return Derivatives(sum(c * x**k for k, c in terms), by_x * slope, by_x2 * slope * slope + by_x * bend)


def compressibility_factor(eta: float) -> float:
    """Z of the bulk fluid of equal disks."""
    return fluid(eta).value


def finite_compressibility_factor(eta: float, n: int) -> float:
    """Z of n equal disks in a periodic box at zero total momentum, with kT = E / (n - 1).

    Z + (1/2n) d ln S / d ln eta with S = 1 / (Z + eta Z'): a fixed number of disks lacks the bulk's fluctuations of density.
    Good to about 1e-3 of Z - 1 at n = 64 for eta <= 0.6.  Source: J. J. Salacuse, A. R. Denton, P. A. Egelstaff,
    Phys. Rev. E 53, 2382 (1996), doi:10.1103/PhysRevE.53.2382.
    """
    z, first, second = fluid(eta)
    bulk = z + eta * first
    log_slope = -eta * (2.0 * first + eta * second) / bulk
    return z + log_slope / (2.0 * n)


def contact_value(eta: float, z: float) -> float:
    """g at contact, from the virial: Z = 1 + 2 eta g."""
    return (z - 1.0) / (2.0 * eta)


def fixed_energy_speed(f: int) -> float:
    """Mean of |v_x| at fixed energy over its canonical value, f degrees of freedom: 1 + 1/(4 f) + ..."""
    return math.sqrt(0.5 * f) * math.exp(math.lgamma(0.5 * f) - math.lgamma(0.5 * (f + 1)))


def collision_rate(z: float, d: float, kt: float, mass: float, f: int) -> float:
    """Pair contacts of one disk per time: 4 (Z - 1) / (sqrt(pi) d) sqrt(kT / m), at fixed energy."""
    return 4.0 * (z - 1.0) / (math.sqrt(math.pi) * d) * math.sqrt(kt / mass) * fixed_energy_speed(f)


def mean_speed(kt: float, mass: float, share: float, power: float) -> float:
    """Mean |v| of a disk at fixed energy: the mean of the speed distribution `survival`.

    share: 1 - m / M where the total momentum is zero, else 1.  power: as in `survival`.
    """
    top = math.sqrt(2.0 * kt * share * (power + 1.0) / mass)
    beta = math.exp(math.lgamma(power + 1.0) - math.lgamma(power + 1.5))
    return top * 0.5 * math.sqrt(math.pi) * beta


def survival(speed: float, kt: float, mass: float, share: float, power: float) -> float:
    """The probability that a disk is faster than `speed`: (1 - v^2 / vmax^2)^power, Maxwell's exp(-m v^2 / 2 kT) for many disks.

    At fixed energy all velocities of the system lie evenly on a sphere; power = f/2 - 1.
    """
    top2 = 2.0 * kt * share * (power + 1.0) / mass
    left = 1.0 - speed * speed / top2
    return left**power if left > 0.0 else 0.0


def enskog_diffusion(kt: float, mass: float, rate: float) -> float:
    """Self-diffusion kT / (m rate): right at low density only.

    Source: S. Chapman, T. G. Cowling, The Mathematical Theory of Non-uniform Gases (1970), chapter 16.
    """
    return kt / (mass * rate)


def cooling_exponent(restitution: float) -> float:
    """-d ln T / ds while homogeneous, s contacts per disk: (1 - e^2) / 2.

    Source: P. K. Haff, J. Fluid Mech. 134, 401 (1983), doi:10.1017/S0022112083003419.
    """
    return 0.5 * (1.0 - restitution * restitution)


def enskog_viscosity(eta: float, d: float, kt: float, mass: float) -> float:
    """Shear viscosity of equal disks, mass / time: 1.022 sqrt(m kT / pi) / 2 d (1/g + 2 eta + 0.8729 g (2 eta)^2).

    1.022: Sonine polynomials beyond the first; 1.022 x 0.8729 = 1.022 / 4 + 2 / pi.
    Source: D. M. Gass, J. Chem. Phys. 54, 1898 (1971), doi:10.1063/1.1675116.
    """
    g, cover = contact_value(eta, compressibility_factor(eta)), 2.0 * eta
    return 0.511 * math.sqrt(mass * kt / math.pi) / d * (1.0 / g + cover + 0.8729 * g * cover * cover)


def enskog_conductivity(eta: float, d: float, kt: float, mass: float) -> float:
    """Heat conductivity of equal disks over Boltzmann's constant, 1 / time.

    1.029 (2 / d) sqrt(kT / pi m) (1/g + 3/2 (2 eta) + 0.8718 g (2 eta)^2), where 1.029 x 0.8718 = 1.029 x 9 / 16 + 1 / pi.
    Source: as of `enskog_viscosity`.
    """
    g, cover = contact_value(eta, compressibility_factor(eta)), 2.0 * eta
    return 2.058 * math.sqrt(kt / (math.pi * mass)) / d * (1.0 / g + 1.5 * cover + 0.8718 * g * cover * cover)


def shear_damping(eta: float) -> float:
    """Nu / (omega d^2): how fast shear flow dies out, per contact of a disk, kinematic viscosity nu and rate omega by Enskog.

    Source: as of `enskog_viscosity`.
    """
    z = compressibility_factor(eta)
    density = 4.0 * eta / math.pi  # times d^2
    rate = 4.0 * (z - 1.0) / math.sqrt(math.pi)
    return enskog_viscosity(eta, 1.0, 1.0, 1.0) / (density * rate)


class Component(NamedTuple):
    """One species of a mixture: number per area, diameter, mass."""

    density: float
    diameter: float
    mass: float


def mixture_contact_value(components: Sequence[Component], i: int, j: int) -> float:
    """g_ij at contact.

    Source: J. T. Jenkins, F. Mancini, J. Appl. Mech. 54, 27 (1987), doi:10.1115/1.3172990.
    """
    eta = sum(0.25 * math.pi * c.density * c.diameter**2 for c in components)
    first = sum(c.density * c.diameter for c in components)
    second = sum(c.density * c.diameter**2 for c in components)
    s_i, s_j = components[i].diameter, components[j].diameter
    s_ij = 0.5 * (s_i + s_j)
    return 1.0 / (1.0 - eta) + 0.5625 * eta / (1.0 - eta) ** 2 * (s_i * s_j / s_ij) * first / second


def mixture_compressibility_factor(components: Sequence[Component]) -> float:
    """Z of a mixture, good to about 1 %: 1 + (pi rho / 2) sum x_i x_j s_ij^2 g_ij."""
    rho = sum(c.density for c in components)
    total = 0.0
    for i, a in enumerate(components):
        for j, b in enumerate(components):
            s_ij = 0.5 * (a.diameter + b.diameter)
            total += a.density * b.density * s_ij**2 * mixture_contact_value(components, i, j)
    return 1.0 + 0.5 * math.pi * total / rho


def mixture_rate(components: Sequence[Component], i: int, j: int, kt: float) -> float:
    """Contacts per time of one disk of species i with disks of species j."""
    return ideal_rate(components, i, j, kt) * mixture_contact_value(components, i, j)


def ideal_rate(components: Sequence[Component], i: int, j: int, kt: float) -> float:
    """The same for a contact value of 1: 2 rho_j s_ij sqrt(pi kT / 2 mu_ij)."""
    a, b = components[i], components[j]
    reduced = a.mass * (b.mass / (a.mass + b.mass))
    reach = 0.5 * (a.diameter + b.diameter)
    return 2.0 * b.density * reach * math.sqrt(0.5 * math.pi * kt / reduced)


def two_disk_torus(area: float, d: float) -> float:
    """Z of two equal disks in a periodic box with zero momentum, kT = E; d at most half a period."""
    hole = math.pi * d * d
    return 1.0 + 0.5 * hole / (area - hole)


class TwoDisksInABox(NamedTuple):
    """Closed forms for two equal disks in a hard box: all rates for the pair together."""

    z: float
    pair_rate: float
    wall_rate: float
    force_x: float
    force_y: float


def two_disk_box(a: float, b: float, d: float, kt: float, mass: float) -> TwoDisksInABox:
    """The closed forms; a, b: the rectangle of the centres, each at least d.

    From Z2 = a^2 b^2 - pi d^2 a b + (4/3) d^3 (a + b) - d^4 / 2, the configuration integral.
    """
    # in shares of the sides, since fourth powers of lengths may be no floats: z2 = Z2 / (a b)^2
    u, v = d / a, d / b
    z2 = 1.0 - math.pi * u * v + 4.0 / 3.0 * u * v * (u + v) - 0.5 * (u * v) ** 2
    by_a = (2.0 - math.pi * u * v + 4.0 / 3.0 * u * v * v) / (z2 * a)
    by_b = (2.0 - math.pi * u * v + 4.0 / 3.0 * u * u * v) / (z2 * b)
    by_d = (-2.0 * math.pi * u * v + 4.0 * u * v * (u + v) - 2.0 * (u * v) ** 2) / (z2 * d)
    speed = math.sqrt(2.0 * kt / (math.pi * mass)) * fixed_energy_speed(4)
    return TwoDisksInABox(
        z=1.0 - by_d * d / 4.0,
        pair_rate=-by_d * math.sqrt(2.0) * speed / 2.0,
        wall_rate=(by_a + by_b) * speed,
        force_x=kt * by_a,
        force_y=kt * by_b,
    )


def rotation_ratio(restitution: float, tangential: float, moment: float) -> tuple[float, float, float]:
    """(kT of spins over kT of flights, decay, loss) in a homogeneous gas of equal rough disks, moments I / m r^2.

    decay: by which factor exp(-decay) a contact of a disk brings a ratio nearer to it; loss: half of what one takes of the
    energy then.  With Maxwell's distributions of velocities and spins, independent of each other, contacts change the
    temperatures T and R, a contact of a disk being the unit of time, by T' = -2 a T + 2 b R and R' = 4 b T - 4 c R, where
    h = q (1 + beta) / (2 (1 + q)), b = h^2 / 2 q, a = (1 - e^2) / 4 + h (1 - h) / 2, c = h (1 - h / q) / 2 q.
    Source: M. Huthmann, A. Zippelius, Phys. Rev. E 56, R6275 (1997), doi:10.1103/PhysRevE.56.R6275; S. Luding, M. Huthmann,
    S. McNamara, A. Zippelius, Phys. Rev. E 58, 3416 (1998), doi:10.1103/PhysRevE.58.3416, equations 12-15.
    """
    h = moment * (1.0 + tangential) / (2.0 * (1.0 + moment))
    a = (1.0 - restitution**2) / 4.0 + h * (1.0 - h) / 2.0
    b, c = h * h / (2.0 * moment), h * (1.0 - h / moment) / (2.0 * moment)
    root = math.sqrt((a - 2.0 * c) ** 2 + 8.0 * b * b)
    ratio = ((a - 2.0 * c) + root) / (2.0 * b) if b > 0.0 else 0.0
    return ratio, 2.0 * root, a - b * ratio
