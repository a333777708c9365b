"""Contacts of very uneven masses: what rounding leaves is carried on, so that nothing is lost from contact to contact."""

import math
from fractions import Fraction

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from eventsim.formulas.careful_impulse import careful_pair_update, careful_wall_update
from eventsim.formulas.impulse import mass_fractions, pair_update, wall_update

LOST = Fraction(1, 2**96)
"""Of energy and momentum, relative: some ten roundings of low parts, 2**-105 each of what they belong to, in cancelling terms."""

sizes = st.floats(1.0, 2.0) | st.floats(-2.0, -1.0)
numbers = st.builds(math.ldexp, sizes, st.integers(-20, 20)) | st.just(0.0)
lengths = st.tuples(numbers, numbers).filter(any)
parts = st.floats(-(2.0**-54), 2.0**-54)
masses = st.builds(math.ldexp, st.floats(1.0, 2.0), st.integers(-50, 50))


def exact(velocities: tuple[float, ...], low: tuple[float, ...]) -> list[Fraction]:
    return [Fraction(v) + Fraction(e) for v, e in zip(velocities, low, strict=True)]


@given(lengths, st.tuples(numbers, numbers, numbers, numbers), st.tuples(parts, parts, parts, parts), masses, masses)
def test_a_contact_keeps_energy_and_momentum_far_below_the_last_bit(d, speeds, shares, mass_a, mass_b):
    low = tuple(v * share for v, share in zip(speeds, shares, strict=True))
    after = careful_pair_update(*d, *speeds, *low, mass_a, mass_b, 1.0)
    plain = pair_update(*d, *speeds, *mass_fractions(mass_a, mass_b), 1.0)
    assert after[8] == pytest.approx(plain[4], rel=2**-50)
    assume(after[8] != 0.0)
    before, then = exact(speeds, low), exact(after[:4], after[4:8])
    weights = [Fraction(mass_a)] * 2 + [Fraction(mass_b)] * 2
    energy = sum(m * v * v for m, v in zip(weights, before, strict=True))
    changed = sum(m * v * v for m, v in zip(weights, then, strict=True))
    assert abs(changed - energy) <= LOST * energy
    for axis in (0, 1):
        own = [(m * v, m * w) for m, v, w in zip(weights[axis::2], before[axis::2], then[axis::2], strict=True)]
        size = sum(m * abs(v) for m, v in zip(weights, before, strict=True))
        assert abs(sum(w - v for v, w in own)) <= LOST * size
    assert list(after[:4]) == [float(v) for v in then]  # the high part is the velocity rounded to nearest


@given(
    lengths, st.tuples(numbers, numbers, numbers, numbers), st.tuples(parts, parts, parts, parts), st.floats(0.0, 1.0)
)
def test_restitution_takes_its_part_of_the_change_far_below_the_last_bit(d, speeds, shares, restitution):
    """Beside a disk that nothing deflects: what the other one's velocity changes by is (1 + e) / 2 of the elastic change."""
    low = tuple(v * share for v, share in zip(speeds, shares, strict=True))
    elastic = careful_pair_update(*d, *speeds, *low, 1.0, math.inf, 1.0)
    assume(elastic[8] != 0.0)
    after = careful_pair_update(*d, *speeds, *low, 1.0, math.inf, restitution)
    before, whole, then = (exact(v[:2], e[:2]) for v, e in ((speeds, low), (elastic, elastic[4:]), (after, after[4:])))
    part = (1 + Fraction(restitution)) / 2
    size = max(map(abs, (*before, *whole)))
    for v, w, u in zip(before, whole, then, strict=True):
        assert abs((u - v) - part * (w - v)) <= LOST * size


@given(lengths, st.tuples(numbers, numbers, numbers, numbers), st.tuples(parts, parts, parts, parts), masses, masses)
def test_exchange_of_the_disks_changes_no_bit(d, speeds, low, mass_a, mass_b):
    for other in (mass_a, mass_b):  # equal masses, too
        ua, wa, ub, wb, ea, fa, eb, fb, q = careful_pair_update(*d, *speeds, *low, mass_a, other, 1.0)
        swapped = careful_pair_update(-d[0], -d[1], *speeds[2:], *speeds[:2], *low[2:], *low[:2], other, mass_a, 1.0)
        assert swapped == (ub, wb, ua, wa, eb, fb, ea, fa, q)


@given(lengths, st.tuples(numbers, numbers), st.tuples(parts, parts))
def test_a_wall_keeps_the_speed_far_below_the_last_bit(normal, speed, shares):
    low = speed[0] * shares[0], speed[1] * shares[1]
    after = careful_wall_update(*normal, *speed, *low, 1.0)
    assert after[4] == pytest.approx(wall_update(*normal, *speed, 1.0)[2], rel=2**-50)
    before, then = exact(speed, low), exact(after[:2], after[2:4])
    square = before[0] ** 2 + before[1] ** 2
    assert abs(then[0] ** 2 + then[1] ** 2 - square) <= LOST * square
    along = before[1] * Fraction(normal[0]) - before[0] * Fraction(normal[1])
    stays = then[1] * Fraction(normal[0]) - then[0] * Fraction(normal[1])
    # Along the wall nothing changes but by the rounding of the normal's direction.
    assert abs(along - stays) <= Fraction(1, 2**50) * (abs(Fraction(normal[0])) + abs(Fraction(normal[1]))) * max(
        map(abs, before)
    )


def test_a_wall_along_an_axis_reverses_exactly():
    assert careful_wall_update(3.0, 0.0, -0.1, 0.7, 1e-18, 2e-18, 1.0)[:4] == (0.1, 0.7, -1e-18, 2e-18)
    assert careful_wall_update(0.0, -3.0, 0.1, 0.7, 1e-18, 2e-18, 1.0)[:4] == (0.1, -0.7, 1e-18, -2e-18)
    assert careful_wall_update(3.0, 0.0, 0.1, 0.7, 1e-18, 2e-18, 1.0) == (0.1, 0.7, 1e-18, 2e-18, 0.0)


@pytest.mark.parametrize(("mass_a", "mass_b"), [(1.0, math.inf), (0.0, 1.0), (0.0, math.inf)])
def test_what_cannot_be_deflected_keeps_every_bit(mass_a, mass_b):
    after = careful_pair_update(-1.0, 0.0, 0.5, 0.25, -0.1, 0.3, 1e-18, 0.0, 2e-18, 3e-18, mass_a, mass_b, 1.0)
    assert (after[2], after[3], after[6], after[7]) == (-0.1, 0.3, 2e-18, 3e-18)
    # The relative velocity along x is reversed: u_a' = 2 u_b - u_a = -0.7, up to the rounding of -0.1.
    assert Fraction(after[0]) + Fraction(after[4]) == pytest.approx(
        2 * (Fraction(-0.1) + Fraction(2e-18)) - Fraction(0.5) - Fraction(1e-18), abs=2.0**-100
    )


@pytest.mark.parametrize("k", [-500, -450, 450, 500])
def test_speeds_whose_squares_are_no_floats_are_updated_plainly(k):
    speeds = [math.ldexp(v, k) for v in (0.7, 0.1, -0.3, 0.2)]
    after = careful_pair_update(-3.0, 4.0, *speeds, 0.0, 0.0, 0.0, 0.0, 1.0, 1e6, 1.0)
    plain = pair_update(-3.0, 4.0, *speeds, *mass_fractions(1.0, 1e6), 1.0)
    assert after[:4] == pytest.approx(plain[:4], rel=2**-50)
    assert all(math.isfinite(value) for value in after)
