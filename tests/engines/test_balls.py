"""Numbers of the certified engine: balls answer or raise, traced numbers know what they stand for."""

from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eventsim.engines.certified.ball import Undecided, ball, working_precision
from eventsim.engines.certified.traced import traced

NUMBERS = st.fractions(-100, 100, max_denominator=1000)


@settings(max_examples=60, deadline=None)
@given(NUMBERS, NUMBERS, st.sampled_from(["+", "-", "*", "/"]))
def test_traced_numbers_are_the_rational_numbers_that_they_stand_for(a, b, operation):
    one, other = traced(float(a)), traced(float(b))
    a, b = Fraction(float(a)), Fraction(float(b))
    if operation == "/" and b == 0:
        return
    number = {"+": lambda: one + other, "-": lambda: one - other, "*": lambda: one * other, "/": lambda: one / other}
    true = {"+": lambda: a + b, "-": lambda: a - b, "*": lambda: a * b, "/": lambda: a / b}
    result, exact = number[operation](), true[operation]()
    assert result.rational == exact
    assert (result < 1.0) == (exact < 1)
    assert (result == other) == (exact == b)


def test_equal_expressions_are_equal_and_others_undecided():
    root2, root3 = traced(2.0).sqrt(), traced(3.0).sqrt()
    assert root2 * root3 == root3 * root2
    assert root2 - root3 == -(root3 - root2)
    assert (root2 + 1.0) - root3 == 1.0 + root2 - root3
    assert root2 - root2 == 0.0
    assert not root2 < root2
    with pytest.raises(Undecided):
        bool(root2 * root3 == traced(6.0).sqrt())


def test_sums_products_and_quotients_of_equal_numbers_are_equal():
    """As where a disk that falls straight down leaves a slope of 45 degrees: its speed goes over into one along an axis."""
    speed, other = traced(7.0).sqrt(), traced(3.0).sqrt()
    assert speed - 2.0 * (speed * 1.0 + other * 0.0) / 2.0 == 0.0
    assert (speed + other) / 3.0 - speed / 3.0 == other / 3.0
    assert (2.0 * speed) * other == speed * (2.0 * other)
    assert (4.0 * (speed + other)).sqrt() == 2.0 * (speed + other).sqrt()
    assert (3.0 * speed / speed).rational == 3
    assert (speed * other - other * speed).rational == 0


@pytest.mark.parametrize("number", [ball, traced])
@pytest.mark.parametrize("root", [Fraction(1, 3), Fraction(2), Fraction(1, 1024)])
def test_a_root_on_a_monotone_piece_is_enclosed(number, root):
    """Of (t - root) (t^2 + 1), whatever bracket it comes from."""
    with working_precision(256):
        exact = number(float(root.numerator)) / float(root.denominator)
        found = exact.root_between((-exact, number(1.0), -exact, number(1.0)), 0.0, number(5.0))
        assert abs(found.value - exact.value) < 1e-70
        assert found.value.overlaps(exact.value)
        assert found.value.rad() < 1e-70


def test_a_double_root_is_undecided():
    third = ball(1.0) / 3.0
    with pytest.raises(Undecided):
        third.root_between((third * third * third, -3.0 * third * third, 3.0 * third, ball(-1.0)), 0.0, ball(1.0))


def test_roots_of_equal_polynomials_are_equal():
    one, other = (
        traced(2.0).root_between((traced(-2.0), traced(1.0), traced(1.0).sqrt()), 0.0, traced(3.0)) for _ in range(2)
    )
    assert one == other
    assert one - other == 0.0


def test_balls_answer_or_raise():
    third = ball(1.0) / 3.0
    assert third < 0.5
    assert third > 0.25
    assert third <= third
    with pytest.raises(Undecided):
        bool(third * 3.0 < 1.0)
    with pytest.raises(TypeError):
        hash(third)
