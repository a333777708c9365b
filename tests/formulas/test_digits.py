"""Careful arithmetic against exact rationals, for every class of pairs on which the plain formula loses digits."""

import math
import random
from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eventsim.formulas.digits import careful_pair_delay
from eventsim.formulas.expansion import added, grown, leading, multiplied, scaled, two_product
from eventsim.formulas.real import NEVER

CLASSES = ("plain", "near", "far", "graze", "large", "slow", "fast")
LAST_BIT = 2.0**-52  # half a unit in the last place, and the root and quotient of rounded leading digits
STILL = (0.0, 0.0)


def exact_delay(xi, yi, ui, wi, ti, ri, xj, yj, uj, wj, tj, rj, shift_x, shift_y):
    """The delay to 400 bits; None for a miss, a graze or a pair that recedes."""
    xi, yi, ui, wi, ti, ri, xj, yj, uj, wj, tj, rj, shift_x, shift_y = map(
        Fraction, (xi, yi, ui, wi, ti, ri, xj, yj, uj, wj, tj, rj, shift_x, shift_y)
    )
    begin = max(ti, tj)
    dx = (xi + ui * (begin - ti)) - (xj + uj * (begin - tj)) - shift_x
    dy = (yi + wi * (begin - ti)) - (yj + wj * (begin - tj)) - shift_y
    du, dw, reach = ui - uj, wi - wj, ri + rj
    b, c = dx * du + dy * dw, dx * dx + dy * dy - reach * reach
    if b >= 0:
        return None
    if c <= 0:
        return Fraction(0)
    discriminant = (du * du + dw * dw) * reach * reach - (dx * dw - dy * du) ** 2
    if discriminant <= 0:
        return None
    return c / (root(discriminant) - b)


def root(square):
    """The square root of a rational to at least 400 bits."""
    shift = max(0, 2 * (400 - (square.numerator.bit_length() - square.denominator.bit_length())))
    return Fraction(math.isqrt((square.numerator << (2 * shift)) // square.denominator), 1 << shift)


def exchanged(pair):
    return (*pair[6:12], *pair[:6], -pair[12], -pair[13])


def relative_error(pair):
    """Of the careful delay; the decision must be the exact one, and exchange must change no bit."""
    found, true = careful_pair_delay(*pair), exact_delay(*pair)
    assert careful_pair_delay(*exchanged(pair)) == found
    if true is None:
        assert found == NEVER
        return 0.0
    if true == 0:
        assert found == 0.0
        return 0.0
    return float(abs(Fraction(found) - true) / true)


def pair_of(kind, rng):
    """Two flights of a class that come near each other, or nearly: arguments of careful_pair_delay."""
    unit = {"large": 1e8}.get(kind, 1.0)
    speed = {"slow": 2.0**-900, "fast": 2.0**900}.get(kind, 1.0) * 10.0 ** rng.uniform(-1, 1)
    ri, rj = rng.choice([(0.5 * unit, 0.5 * unit), (rng.uniform(0.1, 1) * unit, rng.uniform(0, 1) * unit)])
    reach = ri + rj
    distance = {
        "near": reach * (1 + 10.0 ** rng.uniform(-17, -3)),
        "large": reach + 10.0 ** rng.uniform(-3, 3),
        "far": reach * 10.0 ** rng.uniform(2, 9),
    }.get(kind, reach * rng.uniform(1.1, 10))
    aim = math.asin(reach / distance if distance > reach else 1.0) * rng.uniform(-1.2, 1.2)
    if kind == "graze":
        aim = math.asin(reach / distance * (1 + rng.choice([-1, 1]) * 10.0 ** rng.uniform(-17, -8)))
    angle = rng.uniform(0, 2 * math.pi)
    x, y = rng.uniform(0, 10), rng.uniform(0, 10)
    drift_u, drift_w = speed * rng.gauss(0, 1), speed * rng.gauss(0, 1)
    u, w = drift_u + speed * math.cos(angle + aim), drift_w + speed * math.sin(angle + aim)
    later = rng.choice([0.0, rng.uniform(0, 3) / speed])
    period = rng.choice([0.0, 16.0])
    meeting = x + distance * math.cos(angle) - period, y + distance * math.sin(angle)
    return (x - u * later, y - w * later, u, w, 0.0, ri, *meeting, drift_u, drift_w, later, rj, period, 0.0)


@pytest.mark.parametrize("kind", CLASSES)
def test_every_class_is_right_to_the_last_bit(kind):
    rng = random.Random(kind)
    pairs = [pair_of(kind, rng) for _ in range(500)]
    errors = [relative_error(pair) for pair in pairs]
    assert max(errors) < LAST_BIT
    assert sum(error > 0.0 for error in errors) > 50  # the class is not all misses


@pytest.mark.slow
@pytest.mark.parametrize("kind", CLASSES)
def test_1e5_pairs_of_every_class_are_right_to_the_last_bit(kind):
    rng = random.Random(f"{kind} at length")
    assert max(relative_error(pair_of(kind, rng)) for _ in range(100_000)) < LAST_BIT


COORDINATE = st.floats(-1e3, 1e3).filter(lambda x: x == 0.0 or abs(x) > 1e-30)
RADIUS = st.floats(1e-3, 10.0)
LATTICE = st.integers(-8, 8).map(lambda k: 0.25 * k)


@settings(max_examples=200, deadline=None)
@given(st.tuples(*[COORDINATE] * 4, st.floats(0, 10), RADIUS, *[COORDINATE] * 4, st.floats(0, 10), RADIUS))
def test_any_two_flights_are_right_to_the_last_bit(flights):
    assert relative_error((*flights, 0.0, 0.0)) < LAST_BIT


@settings(max_examples=300, deadline=None)
@given(*[LATTICE] * 8, st.integers(-900, 900))
def test_ties_of_a_lattice_are_decided_exactly_at_any_speed(xi, yi, ui, wi, xj, yj, uj, wj, k):
    def at(scale):
        v = [math.ldexp(value, scale) for value in (ui, wi, uj, wj)]
        return xi, yi, v[0], v[1], 0.0, 0.5, xj, yj, v[2], v[3], 0.0, 0.5, 0.0, 0.0

    slow = at(0)
    assert relative_error(slow) < LAST_BIT
    assert careful_pair_delay(*at(k)) == math.ldexp(careful_pair_delay(*slow), -k)


@pytest.mark.parametrize("k", [-200, -70, 70, 200])
def test_lengths_and_speeds_that_are_scaled_first_give_the_bits_of_those_that_are_not(k):
    rng = random.Random(k)
    for kind in ("plain", "near", "graze"):
        for _ in range(100):
            xi, yi, ui, wi, ti, ri, xj, yj, uj, wj, tj, rj, shift_x, shift_y = pair = pair_of(kind, rng)
            long = [math.ldexp(value, k) for value in (xi, yi, ri, xj, yj, rj, shift_x, shift_y, ti, tj)]
            delay = careful_pair_delay(*long[:2], ui, wi, long[8], long[2], *long[3:5], uj, wj, long[9], *long[5:8])
            assert delay == math.ldexp(careful_pair_delay(*pair), k)


def straight(x, dy, radius=0.5, speed=1.0):
    """Disk A at (x, dy) flies along x towards B at rest in the origin."""
    return x, dy, speed, 0.0, 0.0, radius, 0.0, 0.0, *STILL, 0.0, radius, 0.0, 0.0


def test_a_graze_by_half_a_bit_is_a_hit_and_a_miss_by_one_is_none():
    assert relative_error(straight(-3.0, 1.0 - 2.0**-53)) < LAST_BIT
    assert careful_pair_delay(*straight(-3.0, 1.0 - 2.0**-53)) == 3.0 - 2.0**-26
    assert careful_pair_delay(*straight(-3.0, 1.0)) == NEVER
    assert careful_pair_delay(*straight(-3.0, 1.0 + 2.0**-52)) == NEVER


def test_a_miss_that_only_the_exact_flight_shows():
    """At the time of the other one x + u t is rounded onto the tangent; the exact flight passes beside it by 2**-80."""
    for above, hits in ((2.0**-80, False), (-(2.0**-80), True)):
        pair = (-3.0, 1.0, 1.0, above, 0.0, 0.5, 0.0, 0.0, *STILL, 1.0, 0.5, 0.0, 0.0)
        assert (careful_pair_delay(*pair) < NEVER) == hits == (exact_delay(*pair) is not None)


@pytest.mark.parametrize(
    ("pair", "delay"),
    [
        ((-5.0, 0.0, 1.0, 0.0, 1.0, 0.5, 0.0, 0.0, *STILL, 3.0, 0.5, 0.0, 0.0), 2.0),
        # 1 - 2**-60 is no float, and what its rounding takes is the gap
        ((-2.0, 0.0, 1.0, 0.0, 2.0**-60, 0.5, 0.0, 0.0, *STILL, 1.0, 0.5, 0.0, 0.0), 2.0**-60),
        ((13.0, 0.0, 1.0, 0.0, 0.0, 0.5, 0.0, 0.0, *STILL, 0.0, 0.5, 16.0, 0.0), 2.0),
        ((0.0, 13.0, 0.0, 1.0, 0.0, 0.5, 0.0, 0.0, *STILL, 0.0, 0.5, 0.0, 16.0), 2.0),
    ],
)
def test_clocks_and_periods_are_taken_off_exactly(pair, delay):
    assert careful_pair_delay(*pair) == careful_pair_delay(*exchanged(pair)) == delay


def test_a_far_pair_keeps_its_digits():
    assert careful_pair_delay(*straight(-1e8, 0.3)) == 99999999.0460607985830543  # by 30-digit arithmetic


def test_gaps_below_the_last_bit_of_the_coordinates():
    for gap in (1e-9, 1e-12, 2.0**-52):
        assert relative_error(straight(-1.0 - gap, 0.0)) < LAST_BIT
    assert relative_error(straight(-1.0 - 1e-9, 0.4)) < LAST_BIT


def test_giants_and_dwarfs_keep_their_gap():
    assert careful_pair_delay(*straight(-(1e8 + 1.0), 0.0, 0.5e8)) == 1.0
    assert relative_error((1e8 + 1.5, 0.0, -1.0, 0.0, 0.0, 1.0, 0.0, 0.0, *STILL, 0.0, 1e8, 0.0, 0.0)) < LAST_BIT


def test_speeds_and_gaps_at_the_end_of_the_range():
    tiny = 1e-310
    assert careful_pair_delay(*straight(-3.0, 0.0, speed=1e-320)) == NEVER  # after 2e320, which no clock shows
    assert careful_pair_delay(0.0, 0.0, 0.0, 0.0, 0.0, 0.5, 3.0, 0.0, -1e200, 0.0, 1e200, 0.5, 0.0, 0.0) == 2.0 / 1e200
    pair = (-tiny, 0.0, tiny, 0.0, 0.0, 0.0, 0.0, 0.0, *STILL, 0.0, tiny / 2, 0.0, 0.0)
    assert relative_error(pair) < LAST_BIT


def test_an_approaching_overlap_is_due_now_and_a_receding_one_never():
    assert careful_pair_delay(*straight(-0.9, 0.0)) == 0.0
    assert careful_pair_delay(*straight(0.9, 0.0)) == NEVER
    assert careful_pair_delay(*straight(-1.0, 0.0)) == 0.0
    # in contact, moving tangentially: (3, 4) and (-4, 3)
    assert careful_pair_delay(0.0, 0.0, 4.0, -3.0, 0.0, 2.5, 3.0, 4.0, *STILL, 0.0, 2.5, 0.0, 0.0) == NEVER


def test_an_expansion_has_no_zeros_and_nothing_is_the_empty_one():
    assert grown([], 0.0) == []
    assert grown([1.0], -1.0) == []
    assert grown([], 3.0) == [3.0]
    assert grown([2.0**-60], 1.0) == [2.0**-60, 1.0]
    assert scaled([2.0**-60, 1.0], 4.0) == [2.0**-58, 4.0]
    assert scaled([], 3.0) == scaled([1.0], 0.0) == multiplied([], [1.0]) == multiplied([1.0], []) == []
    assert multiplied([2.0**-60, 1.0], [2.0]) == [2.0**-59, 2.0]
    assert leading([]) == (0.0, 0.0)
    assert leading([2.0**-130, 2.0**-70, 2.0**-60, 1.0]) == (1.0, 2.0**-60 + 2.0**-70)
    assert leading([3.0 * 2.0**-110, 2.0**-56, 2.0**-2, 2.0**52]) == (2.0**52, 0.25 + 2.0**-56)
    assert leading([2.0**-60, 1.0 + 2.0**-50, 4.0]) == (5.0 + 2.0**-50, 2.0**-60)


FLOATS = st.floats(-1e10, 1e10).filter(lambda x: x == 0.0 or abs(x) > 1e-10)


@settings(max_examples=100, deadline=None)
@given(st.lists(FLOATS, max_size=6), st.lists(FLOATS, max_size=6), FLOATS)
def test_expansions_are_exact(numbers, others, factor):
    e, f = added([], numbers), added([], others)
    one, two = sum(map(Fraction, numbers)), sum(map(Fraction, others))
    assert sum(map(Fraction, e)) == one
    assert sum(map(Fraction, scaled(e, factor))) == one * Fraction(factor)
    assert sum(map(Fraction, multiplied(e, f))) == one * two
    product, rest = two_product(factor, factor)
    assert Fraction(product) + Fraction(rest) == Fraction(factor) ** 2
    high, low = leading(multiplied(e, f))
    assert abs(Fraction(high) + Fraction(low) - one * two) <= abs(one * two) * Fraction(2) ** -100
