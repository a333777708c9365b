"""A parabola against a circle: bracketing finds every falling crossing, and the first one first."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from eventsim.formulas.parabola import (
    ANY_OVERLAP,
    NO_OVERLAP,
    PRESENT_OVERLAP,
    _positive_roots,
    circle_delays,
    circle_gap,
    stays_open,
)
from eventsim.formulas.real import NEVER

value = st.floats(-3.0, 3.0)


@settings(max_examples=300, deadline=None)
@given(value, value, value, value, value, value, st.floats(0.1, 2.0), st.sampled_from([1.0, -1.0]))
def test_it_finds_the_first_two_falling_crossings_that_a_scan_finds(dx, dy, du, dw, ax, ay, radius, side):
    assume(math.hypot(ax, ay) > 0.05)
    flight = (dx, dy, du, dw, ax, ay, radius, side)
    assume(circle_gap(*flight, 0.0) > 1e-3)
    first, second = circle_delays(*flight, NO_OVERLAP)
    steps, far = 4000, 20.0
    crossings = []
    before = circle_gap(*flight, 0.0)
    for k in range(1, steps + 1):
        after = circle_gap(*flight, far * k / steps)
        if before > 0.0 >= after:
            crossings.append(far * k / steps)
        before = after
    for found, scanned in zip((first, second), crossings, strict=False):
        # a scan may step over a shallow crossing, never find one that is not there
        assert found <= scanned + 1e-9
    for found in (first, second):
        if found < NEVER:
            scale = max(1.0, found**3)
            assert circle_gap(*flight, found) == pytest.approx(0.0, abs=1e-10 * scale)
    assert first <= second


def test_dropped_onto_a_post_from_rest():
    assert circle_delays(0.0, 3.0, 0.0, 0.0, 0.0, -2.0, 1.0, 1.0) == (pytest.approx(math.sqrt(2.0), rel=1e-15), NEVER)


def test_thrown_up_from_a_post_it_comes_back():
    first, _ = circle_delays(0.0, 1.0, 0.0, 1.0, 0.0, -2.0, 1.0, 1.0)
    assert first == pytest.approx(1.0, rel=1e-15)


def test_inside_a_circle_it_falls_to_the_bottom():
    assert circle_delays(0.0, 0.0, 0.0, 0.0, 0.0, -2.0, 1.0, -1.0)[0] == pytest.approx(1.0, rel=1e-15)


def test_an_overlap_that_falls_is_due_now():
    assert circle_delays(0.0, 0.9, 0.0, -1.0, 0.0, -2.0, 1.0, 1.0)[0] == 0.0


@pytest.mark.parametrize(
    ("polynomial", "roots"),
    [
        ((1.0, -4.0, 3.0), (1.0, 3.0)),
        ((4.0, -4.0, 0.75), (0.25, 0.75)),
        ((0.5, -0.5, 0.09375), (0.25, 0.75)),  # its discriminant is 1/16
        ((1.0, 2.0, -3.0), (0.0, 1.0)),
        ((1.0, -2.0, -3.0), (0.0, 3.0)),
        ((1.0, 0.5, -0.5), (0.0, 0.5)),
        ((1.0, 0.0, -4.0), (0.0, 2.0)),
        ((1.0, 4.0, 3.0), (0.0, 0.0)),
        ((1.0, -4.0, 0.0), (0.0, 4.0)),
        ((1.0, 4.0, 0.0), (0.0, 0.0)),
        ((1.0, -3.0, 2.0), (1.0, 2.0)),
        ((1.0, -1.5, 0.5), (0.5, 1.0)),
        ((1.0, 2.0**28, -1.0), (0.0, 2.0**-28)),  # where the difference of q1 and the root is 0
        ((1.0, 0.5, -(2.0**-60)), (0.0, 2.0**-59)),
        ((1.0, -4.0, 5.0), (0.0, 0.0)),
        ((1.0, -4.0, 4.0), (0.0, 0.0)),  # it does not change its sign there
    ],
)
def test_what_brackets_the_cubic(polynomial, roots):
    assert _positive_roots(*polynomial) == roots


@pytest.mark.parametrize(
    ("speed", "any_overlap", "present", "none"),
    [
        (-1.0, 0.0, 0.0, NEVER),  # it falls
        (0.0, 0.0, 0.0, NEVER),  # it is about to
        (0.25, 0.125, 0.125, NEVER),  # it rises by 1/64 and falls again, closed all the time
        (0.5, 0.25, 0.25, NEVER),
    ],
)
def test_a_closed_gap_counts_as_the_caller_says(speed, any_overlap, present, none):
    flight = 0.0, 0.5, 0.0, speed, 0.0, -2.0, 1.0, 1.0
    for overlap, delay in ((ANY_OVERLAP, any_overlap), (PRESENT_OVERLAP, present), (NO_OVERLAP, none)):
        assert circle_delays(*flight, overlap)[0] == pytest.approx(delay, rel=1e-12)


def test_what_rests_on_the_top_or_hangs_below():
    assert circle_delays(0.0, 1.0, 0.0, 0.0, 0.0, -2.0, 1.0, 1.0)[0] == 0.0
    assert circle_delays(0.0, -1.0, 0.0, 0.0, 0.0, -2.0, 1.0, 1.0)[0] == NEVER
    assert circle_delays(0.0, -1.0, 0.0, 0.0, 0.0, -2.0, 1.0, -1.0)[0] == 0.0
    assert circle_delays(0.0, 1.0, 0.0, 0.0, 0.0, -2.0, 1.0, -1.0)[0] == pytest.approx(2.0**0.5, rel=1e-12)
    # as fast round the top as gravity bends the way: d.v = 0 and v^2 + d.a = 0, and it leaves
    assert circle_delays(0.0, 1.0, 2.0, 0.0, 0.0, -4.0, 1.0, 1.0)[0] == NEVER


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("speed", [1.0, 2.0**-20, 2.0**-60, 2.0**-300])
def test_a_bounce_that_begins_on_the_circle_is_exact_however_low(side, speed):
    """Straight up from a circle of radius 1, outside or inside: back after 2 v / g, wherever rounding has put the disk."""
    for shift in (0.0, 2.0**-52, -(2.0**-52)):
        flight = 0.0, side * (1.0 + shift), 0.0, speed, 0.0, -2.0, 1.0, side
        delay, _ = circle_delays(*flight, ANY_OVERLAP, True)
        assert delay == pytest.approx(speed, rel=2.0**-50)


@given(value, st.floats(1e-9, 1.0), st.floats(-0.5, 0.5))
def test_a_flight_from_the_circle_comes_back_where_the_distance_is_the_same(angle, speed, turned):
    x, y = math.cos(angle), math.sin(angle)
    u, w = speed * math.cos(angle + turned), speed * math.sin(angle + turned)
    fall = -4.0 * x, -4.0 * y  # back onto it
    delay, _ = circle_delays(x, y, u, w, *fall, 1.0, 1.0, ANY_OVERLAP, True)
    assert 0.0 < delay < 1.0
    gap = circle_gap(x, y, u, w, *fall, 1.0, 1.0, delay, True)
    before = circle_gap(x, y, u, w, *fall, 1.0, 1.0, 0.5 * delay, True)
    assert before > 0.0
    assert abs(gap) <= 2.0**-40 * before


def test_a_gap_that_stays_open_is_not_closed_until_then():
    """Whatever the flight; and where nothing is met for far longer, that is seen."""
    rng = np.random.default_rng(5)
    seen = 0
    for _ in range(2000):
        side = float(rng.choice((1, -1)))
        angle, away = rng.uniform(0, 2 * math.pi), math.sqrt(rng.random()) if side < 0 else 1.0 + 3.0 * rng.random() ** 3
        dx, dy = away * math.cos(angle), away * math.sin(angle)
        du, dw, ax, ay = rng.normal(0.0, 1.0, 4)
        delay, _ = circle_delays(dx, dy, du, dw, ax, ay, 1.0, side)
        for share in (0.25, 0.9, 1.0, 1.1, 4.0):
            t = share * min(delay, 10.0)
            stays = stays_open(dx, dy, du, dw, ax, ay, 1.0, side, t, 1e-9)
            assert not (stays and delay <= t)
            seen += stays and share == 0.25
    assert seen > 1200
    assert not stays_open(0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 1.0, -1.0, math.inf, 0.0)
    assert not stays_open(0.5, 0.0, 0.0, 0.0, 0.0, -1.0, 1.0, -1.0, 0.1, 0.8)
