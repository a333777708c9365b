"""Numbers of the certified engine: balls answer or raise, traced numbers know what they stand for."""

from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eventsim.engines.certified.ball import Undecided, ball, traced

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


def test_balls_answer_or_raise():
    third = ball(1.0) / 3.0
    assert third < 0.5
    assert third > 0.25
    assert third <= third
    with pytest.raises(Undecided):
        bool(third * 3.0 < 1.0)
    with pytest.raises(TypeError):
        hash(third)
