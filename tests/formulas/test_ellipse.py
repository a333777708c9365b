"""Ellipses: points meet them from both sides, and what is nearest on them is found."""

import math
from fractions import Fraction

import numpy as np
import pytest

from eventsim.formulas.real import NEVER
from eventsim.formulas.walls.ellipse import Ellipse


def ellipse(a: float = 2.0, b: float = 1.0, x: float = 0.0, y: float = 0.0, ex: float = 1.0, ey: float = 0.0) -> Ellipse:
    return Ellipse(x, y, ex, ey, math.hypot(ex, ey), a, b, abs(x) + abs(y) + max(a, b))


@pytest.mark.parametrize(
    ("flight", "met", "expected"),
    [
        ((0.0, 0.0, 1.0, 0.0), 0, (2.0, -1)),
        ((0.0, 0.0, 0.0, -0.5), 0, (2.0, -1)),
        ((2.0, 0.0, -1.0, 0.0), -1, (4.0, -1)),
        ((2.0, 0.0, -1.0, 0.0), 0, (4.0, -1)),
        ((2.0, 0.0, 1.0, 0.0), 0, (NEVER, 1)),
        ((4.0, 0.0, -1.0, 0.0), 0, (2.0, 1)),
        ((4.0, 0.0, -1.0, 0.0), 1, (NEVER, 1)),
        ((4.0, 2.0, -1.0, 0.0), 0, (NEVER, 1)),
    ],
)
def test_a_point_meets_an_ellipse_from_inside_and_from_outside(flight, met, expected):
    assert ellipse().delay(*flight, None, None, 0.0, met) == expected
    x, y, vx, vy = flight
    turned = ellipse(x=5.0, y=3.0, ex=0.0, ey=2.0)  # its first axis points up
    assert turned.delay(5.0 - y, 3.0 + x, -vy, vx, None, None, 0.0, met) == expected


@pytest.mark.parametrize("semi_axes", [(2.0, 1.0), (1.0, 2.0), (1.0, 1.0)])
@pytest.mark.parametrize("place", [(0.5, 0.0), (0.0, 0.5), (-0.25, 0.125), (3.0, 0.0), (-3.0, -2.0), (0.0, 1.75), (1.0, -1.0)])
def test_the_nearest_place_of_an_ellipse_is_the_one_that_a_search_finds(semi_axes, place):
    angle = np.linspace(0.0, 2.0 * np.pi, 200_001)
    around = np.stack([semi_axes[0] * np.cos(angle), semi_axes[1] * np.sin(angle)])
    way = np.array(place)[:, None] - around
    nx, ny, distance = ellipse(*semi_axes).nearest(*place)
    assert distance == pytest.approx(np.hypot(*way).min(), abs=1e-8)
    assert math.hypot(nx, ny) == pytest.approx(1.0)
    x, y = place[0] - distance * nx, place[1] - distance * ny
    assert (x / semi_axes[0]) ** 2 + (y / semi_axes[1]) ** 2 == pytest.approx(1.0)


def test_the_centre_of_curvature_at_a_vertex_is_nearest_to_that():
    nx, ny, distance = ellipse().nearest(1.5, 0.0)
    assert (nx, ny, distance) == (-1.0, pytest.approx(0.0, abs=1e-7), pytest.approx(0.5))


def test_the_middle_of_an_ellipse_is_near_nothing_and_stays_where_it_is():
    assert ellipse(x=1.0).nearest(1.0, 0.0) == (0.0, 0.0, NEVER)
    assert ellipse(x=1.0).touching(-1, 1.0, 0.0, 0.0) == (1.0, 0.0)
    assert ellipse(x=1.0).touching(1, 4.0, 0.0, 0.0) == (3.0, 0.0)


def test_the_exact_time_of_a_contact_is_known_in_straight_flight():
    rest = Fraction(0), Fraction(0), Fraction(0)
    moment = ellipse().moment((Fraction(0), Fraction(1), Fraction(0)), rest, -1, 0.0)
    assert moment is not None
    assert (moment.place, moment.side, moment.square) == (0, 1, 4)
    assert ellipse().moment(rest, (Fraction(0), Fraction(1), Fraction(-1)), -1, 0.0) is None
    assert ellipse().moment(rest, rest, -1, 0.0) is None
