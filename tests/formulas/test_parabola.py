"""A parabola against a circle: bracketing finds every falling crossing, and the first one first."""

import math

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from eventsim.formulas.parabola import NO_OVERLAP, circle_delays, circle_gap
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
