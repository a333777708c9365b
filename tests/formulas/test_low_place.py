"""Places with low parts against exact rationals: nothing is lost to coordinates of millions of diameters."""

import math
import random
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from eventsim.formulas.low_place import finely_apart, low_position, settled, wide_border_delay, wide_pair_delay
from eventsim.formulas.real import NEVER
from tests.formulas.test_digits import exact_delay

LARGE = st.floats(-(2.0**30), 2.0**30).filter(lambda x: x == 0.0 or abs(x) > 1e-30)
SMALL = st.floats(-(2.0**-22), 2.0**-22).filter(lambda x: x == 0.0 or abs(x) > 1e-60)
LAG = st.floats(0.0, 2.0**20).filter(lambda x: x == 0.0 or x > 1e-30)


@given(LARGE, SMALL, LARGE, LAG)
def test_a_flight_loses_nothing_but_low_bits_of_low_parts(x, low, v, lag):
    found = Fraction(x + v * lag) + Fraction(low_position(x, low, v, lag))
    true = Fraction(x) + Fraction(low) + Fraction(v) * Fraction(lag)
    # of two sums, one of last bits of what the flight is made of
    largest = abs(low) + 2.0**-53 * (abs(x) + 2.0 * abs(v * lag))
    assert abs(found - true) <= 2.0**-51 * largest


def test_a_flight_without_end_keeps_its_low_part():
    assert low_position(1.0, 2.0**-60, 1e305, 1e2) == 2.0**-60


@given(LARGE, SMALL)
def test_a_settled_place_is_the_same_one(x, low):
    high, rest = settled(x, low)
    assert Fraction(high) + Fraction(rest) == Fraction(x) + Fraction(low)
    assert high == x + low


@given(LARGE, SMALL, LARGE, SMALL, st.sampled_from([0.0, 2.0**30, -(2.0**30)]))
def test_a_distance_is_that_of_both_parts(x, low, other, other_low, shift):
    high, rest = finely_apart(x, low, other, other_low, shift)
    true = Fraction(x) + Fraction(low) - Fraction(other) - Fraction(other_low) - Fraction(shift)
    # x - other - shift is exact where it is small; else its rounding does not matter
    lowest = 2.0**-104 * (abs(x) + abs(other)) + 2.0**-52 * (abs(low) + abs(other_low))
    assert abs(Fraction(high) + Fraction(rest) - true) <= 2.0**-52 * abs(true) + lowest
    assert (-high, -rest) == finely_apart(other, other_low, x, low, -shift)


def pair_of(kind, rng):
    """(two flights with low parts, their shift): disks of reach 1 that come near each other at a million, or across a border."""
    far = rng.choice([2.0**20, 1e6]) * rng.uniform(0.5, 1.0)
    distance = {"near": 1.0 + 10.0 ** rng.uniform(-20, -3), "far": 10.0 ** rng.uniform(2, 5)}.get(kind, rng.uniform(1.1, 10))
    aim = math.asin(1.0 / distance if distance > 1.0 else 1.0) * rng.uniform(-1.2, 1.2)
    if kind == "graze":
        aim = math.asin((1 + rng.choice([-1, 1]) * 10.0 ** rng.uniform(-17, -8)) / distance)
    angle, later = rng.uniform(0, 7), rng.choice([0.0, rng.uniform(0, 3)])
    drift_u, drift_w = rng.gauss(0, 1), rng.gauss(0, 1)
    u, w = drift_u + math.cos(angle + aim), drift_w + math.sin(angle + aim)
    x, y = far, far + rng.uniform(-10, 10)
    meeting = [Fraction(at) + Fraction(distance) * Fraction(way(angle)) for at, way in ((x, math.cos), (y, math.sin))]
    begun = [Fraction(x) - Fraction(u) * Fraction(later), Fraction(y) - Fraction(w) * Fraction(later)]
    shift = rng.choice([0.0, 2.0**20])
    meeting[0] -= Fraction(shift)
    (xi, exi), (yi, eyi), (xj, exj), (yj, eyj) = map(parts, (*begun, *meeting))
    one = (xi, yi, u, w, 0.0, 0.5, exi, eyi)
    return one, (xj, yj, drift_u, drift_w, later, 0.5, exj, eyj), (shift, 0.0)


def parts(place):
    high = float(place)
    return high, float(place - Fraction(high))


def true_delay(one, other, shift):
    (xi, yi, ui, wi, ti, ri, exi, eyi), (xj, yj, uj, wj, tj, rj, exj, eyj) = (tuple(map(Fraction, each)) for each in (one, other))
    flights = (xi + exi, yi + eyi, ui, wi, ti, ri, xj + exj, yj + eyj, uj, wj, tj, rj)
    return exact_delay(*flights, *shift)


@pytest.mark.parametrize("kind", ["plain", "near", "far", "graze"])
def test_contact_times_are_as_right_as_near_the_corner(kind):
    rng = random.Random(kind)
    hits = misses = 0
    for _ in range(600):
        one, other, shift = pair_of(kind, rng)
        found, true = wide_pair_delay(*one, *other, *shift), true_delay(one, other, shift)
        assert wide_pair_delay(*other, *one, -shift[0], -shift[1]) == found
        if kind != "graze":  # at a graze by less than the last bits of a distance of 1 both are right
            assert (true is None) == (found == NEVER)
        if true is None or found == NEVER:
            misses += 1
        else:
            hits += 1
            # the plain formula loses 12 bits of a distance, the careful one a last bit of the flight's own length, 10
            assert abs(Fraction(found) - true) <= 2e-12 * true + Fraction(2.0**-49)
    assert hits > 100
    assert misses > 20


def test_what_parts_or_misses_by_the_lowest_bit_is_seen():
    far = 2.0**20
    for low, hits in ((0.0, False), (-(2.0**-60), True)):
        one = (far - 3.0, far + 1.0, 1.0, 0.0, 0.0, 0.5, 0.0, low)
        other = (far, far, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0)
        assert (wide_pair_delay(*one, *other, 0.0, 0.0) < NEVER) == hits


def test_a_wall_is_met_at_the_place_of_both_parts():
    assert wide_border_delay(2.0**20 - 1.0, 2.0**-40, 2.0, 2.0**20, 0.5, -1.0) == 0.25 - 2.0**-41
    assert wide_border_delay(1.0, 0.0, -2.0, 0.0, 0.5, 1.0) == 0.25
    assert wide_border_delay(1.0, 0.0, 2.0, 0.0, 0.5, 1.0) == NEVER
