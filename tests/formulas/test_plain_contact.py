"""The contact of two disks on numbers whose results are exact: equality, no tolerance."""

import math
from decimal import Decimal

import pytest

from eventsim.formulas.contact import DIGITS_LOST, NEAR, SMALLEST, circle_delay, pair_delay, screened_pair_delay
from eventsim.formulas.real import NEVER

PAIRS = [
    # relative place, relative velocity, reach -> delay
    ((-7.0, 3.0, 2.0, 0.0, 5.0), 1.5),
    ((3.0, -7.0, 0.0, 2.0, 5.0), 1.5),
    ((-8.0, 1.0, 2.0, 1.0, 5.0), 2.0),
    ((1.0, -8.0, 1.0, 2.0, 5.0), 2.0),
    ((-8.0, 1.0, 0.125, 0.0625, 5.0), 32.0),
    ((2.0, 0.0, 0.25, 0.0, 1.0), NEVER),  # they recede
    ((2.0, 0.0, 0.0, 0.25, 1.0), NEVER),
    ((-8.0, 1.0, -2.0, -1.0, 5.0), NEVER),
    ((-7.0, 6.0, 2.0, 0.0, 5.0), NEVER),  # they miss
    ((-7.0, -6.0, 0.125, 0.0, 5.0), NEVER),
]


@pytest.mark.parametrize(("pair", "delay"), PAIRS)
def test_what_floats_can_tell(pair, delay):
    assert pair_delay(*pair) == delay
    assert screened_pair_delay(*pair) == delay


@pytest.mark.parametrize(
    ("pair", "delay"),
    [
        ((-1.25, 0.0, 1.0, 0.0, 1.0), 0.25),
        ((-1.0, 0.0, 1.0, 0.0, 1.0), 0.0),
        ((-0.5, 0.0, 1.0, 0.0, 1.0), 0.0),
        ((0.5, 0.0, 1.0, 0.0, 1.0), NEVER),
        ((0.5, 0.0, 0.0, 1.0, 1.0), NEVER),
        ((0.0, 0.0, 1.0, 0.0, 1.0), NEVER),
        ((-3.0, 1.0, 1.0, 0.0, 1.0), NEVER),  # tangent
        ((-4.0, 2.0, 0.25, 0.0, 2.0), NEVER),
    ],
)
def test_signs_decide_before_numbers(pair, delay):
    assert pair_delay(*pair) == delay


def test_the_limits_of_the_screen():
    assert (DIGITS_LOST, NEAR, SMALLEST) == (2.0**-12, 2.01e-3, 1e-290)
    assert math.isnan(screened_pair_delay(-64.0, -2.0, 1.0, 0.0, 64.0))  # c = 4, 2^-10 of 4096
    assert screened_pair_delay(-64.0, -3.0, 1.0, 0.0, 64.0) == 9.0 / (math.sqrt(4087.0) + 64.0)
    assert screened_pair_delay(-64.0, -2.0, -1.0, 0.0, 64.0) == NEVER  # b^2 is 4096, and needs no more than 1
    assert screened_pair_delay(-64.0, 0.0, -0.015625, 0.25, 64.0) == NEVER  # 1 and more than .0625
    assert math.isnan(screened_pair_delay(-64.0, 0.0, -0.0039, 0.25, 64.0))  # less than that
    # a reach^2 is 4096 and a d^2 three times and a half as much: a D of that many 2^-12 is lost
    assert math.isnan(screened_pair_delay(-100.0, 63.98, 1.0, 0.0, 64.0))  # D = 2.6, lost 3.4
    assert screened_pair_delay(-100.0, 63.97, 1.0, 0.0, 64.0) < NEVER
    assert math.isnan(screened_pair_delay(-100.0, 64.00390625, 1.0, 0.0, 64.0))
    assert screened_pair_delay(-100.0, 64.015625, 1.0, 0.0, 64.0) == NEVER
    # beyond 64 reaches no hit is told, but misses are
    assert screened_pair_delay(-63.9, 0.0, 1.0, 0.0, 1.0) == pytest.approx(62.9, rel=1e-15)
    assert math.isnan(screened_pair_delay(-64.0, 0.0, 1.0, 0.0, 1.0))
    assert screened_pair_delay(-1e9, 1.001, 1.0, 0.0, 1.0) == NEVER


def test_squares_that_vanish_are_doubted_except_at_rest():
    assert math.isnan(screened_pair_delay(-3.0, 0.0, 0.0, 1e-200, 1.0))
    assert math.isnan(screened_pair_delay(-3.0, 0.0, 1e-200, 0.0, 1.0))
    assert math.isnan(screened_pair_delay(-3.0, 0.5, 1e-146, 0.0, 1.0))
    assert screened_pair_delay(-3.0, 0.0, 0.0, 0.0, 1.0) == NEVER


CIRCLE = 2.0, 10.0, 20.0, 3.0
"""Radius of the disk; centre and radius of the circle."""


@pytest.mark.parametrize(
    ("flight", "delay"),
    [
        ((2.0, 21.0, 2.0, 1.0), 2.0),
        ((11.0, 12.0, 1.0, 2.0), 2.0),
        ((2.0, 21.0, -2.0, -1.0), NEVER),
        ((2.0, 26.0, 2.0, 0.0), NEVER),
        ((7.0, 16.0, 3.0, 4.0), 0.0),
        # what floats cannot tell: near contact, and at a graze
        ((7.0 - 3.0 * 2.0**-40, 16.0 - 4.0 * 2.0**-40, 3.0, 4.0), 2.0**-40),
        ((7.0 - 4.0 * 2.0**-40, 16.0, 4.0, 0.0), 2.0**-40),
        ((0.0, 25.0, 2.0, 0.0), NEVER),
        ((15.0, 0.0, 0.0, 2.0), NEVER),
    ],
)
def test_a_disk_meets_a_circle_from_outside(flight, delay):
    assert circle_delay(*flight, *CIRCLE) == delay
    if delay not in (0.0, 2.0**-40):  # decimal digits are no powers of two
        assert circle_delay(*map(Decimal, flight), *map(Decimal, CIRCLE)) == delay


def test_other_numbers_take_the_plain_formula():
    third = Decimal(1) / 3
    assert circle_delay(*map(Decimal, (2, 21)), 2 * third, third, *map(Decimal, CIRCLE)) == pytest.approx(Decimal(6))
    assert circle_delay(*map(Decimal, (7, 16, 3, 4)), *map(Decimal, CIRCLE)) == 0.0
