"""What theory says, against values from the literature and against itself."""

import math

import pytest

from eventsim.measure import theory

B3 = 4.0 / 3.0 - math.sqrt(3.0) / math.pi
B4 = 2.0 - 4.5 * math.sqrt(3.0) / math.pi + 10.0 / math.pi**2


@pytest.mark.parametrize(
    ("eta", "z"), [(0.1, 1.23614), (0.3, 2.06326), (0.5, 4.10636), (0.6, 6.45534), (0.65, 8.40804)]
)
def test_the_equation_of_state_gives_the_tabulated_values(eta, z):
    assert theory.compressibility_factor(eta) == pytest.approx(z, abs=6e-6)  # five decimals are tabulated


def test_the_equation_of_state_begins_with_the_exact_virial_coefficients():
    # Z = 1 + 2 eta + 4 b3 eta^2 + 8 b4 eta^3 + ..., b_k = B_k / B2^(k-1); at eta = 1e-3 the next term is 1e-11
    eta = 1e-3
    rest = (theory.compressibility_factor(eta) - 1.0 - 2.0 * eta) / eta**2
    assert rest == pytest.approx(4.0 * B3 + 8.0 * B4 * eta, rel=1e-5)


@pytest.mark.parametrize("eta", [0.1, 0.45, 0.66])
def test_derivatives_are_those_of_the_value(eta):
    h = 1e-4
    low, high = theory.fluid(eta - h), theory.fluid(eta + h)
    here = theory.fluid(eta)
    # central differences are off by h^2 / 6 times the third derivative
    assert (high.value - low.value) / (2.0 * h) == pytest.approx(here.first, rel=1e-5)
    assert (high.first - low.first) / (2.0 * h) == pytest.approx(here.second, rel=1e-4)


def test_two_disks_on_a_torus():
    area = 2.288228082**2
    assert theory.two_disk_torus(area, 1.0) == pytest.approx(1.75, rel=1e-8)
    assert theory.collision_rate(1.75, 1.0, 1.0, 1.0, 2) == pytest.approx(1.909859317, rel=1e-9)


def test_two_disks_in_a_box():
    exact = theory.two_disk_box(0.6, 0.6, 0.4, 1.0, 1.0)
    assert exact.pair_rate == pytest.approx(4.15547414, rel=1e-8)
    assert exact.wall_rate == pytest.approx(9.57666101, rel=1e-8)
    assert exact.force_x == exact.force_y == pytest.approx(5.64111898, rel=1e-8)
    # virial theorem: force x width + force x height = 2 N kT Z
    assert 0.6 * (exact.force_x + exact.force_y) == pytest.approx(4.0 * exact.z, rel=1e-14)


def test_a_mixture_of_one_kind_is_hendersons_fluid():
    density = 0.5 / (0.25 * math.pi)
    parts = [theory.Component(0.25 * density, 1.0, 1.0), theory.Component(0.75 * density, 1.0, 1.0)]
    assert theory.mixture_compressibility_factor(parts) == pytest.approx(1.03125 / 0.25, rel=1e-14)
    z = theory.mixture_compressibility_factor(parts)
    rate = sum(theory.mixture_rate(parts, 0, j, 1.0) for j in (0, 1))
    assert rate == pytest.approx(4.0 * (z - 1.0) / math.sqrt(math.pi), rel=1e-14)


@pytest.mark.parametrize("power", [1.0, 2.5, 60.0])
def test_the_mean_speed_is_that_of_the_distribution(power):
    edges = [k * 1e-3 for k in range(12001)]
    mean = 1e-3 * (sum(theory.survival(v, 1.3, 0.7, 0.9, power) for v in edges) - 0.5)
    # the trapezoidal rule is off by h^2 / 12 times the slope, and by as much at the edge of the support
    assert theory.mean_speed(1.3, 0.7, 0.9, power) == pytest.approx(mean, rel=1e-5)


def test_many_disks_have_maxwells_speeds():
    # 1 / (4 f) is the first correction of the mean, 1 / N that of the tail
    assert theory.survival(1.0, 1.0, 1.0, 1.0, 1e7) == pytest.approx(math.exp(-0.5), rel=1e-6)
    assert theory.mean_speed(1.0, 1.0, 1.0, 1e7) == pytest.approx(math.sqrt(0.5 * math.pi), rel=1e-6)
    assert theory.fixed_energy_speed(1000) == pytest.approx(1.0 + 0.25 / 1000, abs=1e-7)


@pytest.mark.parametrize("unit", [1e-150, 1e-90, 1e90, 1e150])
def test_two_disks_in_a_box_are_the_same_in_any_unit_of_length(unit):
    one = theory.two_disk_box(2.0, 3.0, 1.0, kt=1.0, mass=1.0)
    # Z2 = 36 - 6 pi + 20/3 - 1/2, d ln Z2 / d ln d = (-12 pi + 20 - 2) / Z2
    assert one.z == pytest.approx(1.0 + (12.0 * math.pi - 18.0) / (36.0 - 6.0 * math.pi + 37.0 / 6.0) / 4.0, rel=1e-14)
    other = theory.two_disk_box(2.0 * unit, 3.0 * unit, unit, kt=1.0, mass=1.0)
    assert other.z == pytest.approx(one.z, rel=1e-14)
    assert [rate * unit for rate in other[1:]] == pytest.approx(list(one[1:]), rel=1e-14)
