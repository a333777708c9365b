"""Points that fly past others, or hit them: on which side, exactly, and when."""

import math

import pytest

from eventsim.formulas.walls.point import hand, is_still_rising, is_upright, post_delay_of_point, way_to_wall

BIT = 2.0**-52


@pytest.mark.parametrize("gravity", [(None, None), (0.0, 0.0)])
@pytest.mark.parametrize(("py", "side"), [(1.0, 0), (1.0 + BIT, 1), (1.0 - BIT, -1), (4.0, 1), (-4.0, -1)])
def test_a_straight_flight_has_a_point_on_its_left_or_on_its_right(gravity, py, side):
    found = hand(0.0, 0.0, 3.0, 3.0, *gravity, 1.0, py, 3.0, 3.0)
    assert (found > 0.0) - (found < 0.0) == side


@pytest.mark.parametrize(("py", "side"), [(1.0, 0), (1.0 + BIT, 1), (1.0 - BIT, -1)])
def test_a_parabola_has_a_point_on_its_left_or_on_its_right(py, side):
    found = hand(0.0, 0.0, 1.0, 2.0, 0.0, -2.0, 1.0, py, 1.0, 0.0)  # at its top at the time 1
    assert (found > 0.0) - (found < 0.0) == side


@pytest.mark.parametrize(
    ("velocity", "gravity", "upright"),
    [
        ((0.0, 3.0), (0.0, -1.0), True),
        ((BIT, 3.0), (0.0, -1.0), False),
        ((3.0, 0.0), (-1.0, 0.0), True),
        ((3.0, BIT), (-1.0, 0.0), False),
        ((3.0, -6.0), (1.0, -2.0), True),
        ((3.0, -6.0 * (1.0 + BIT)), (1.0, -2.0), False),
        ((3.0, 6.0), (1.0, -2.0), False),
        ((0.0, 0.0), (1.0, -2.0), True),
    ],
)
def test_a_velocity_is_along_gravity_exactly_or_not(velocity, gravity, upright):
    assert is_upright(*velocity, *gravity) == upright


@pytest.mark.parametrize(
    ("flight", "gravity", "post", "delay"),
    [
        ((0.0, 0.0, 1.0, 1.0), (None, None), (2.0, 2.0), 2.0),
        ((0.0, 0.0, 1.0, 1.0), (0.0, 0.0), (2.0, 2.0), 2.0),
        ((0.0, 0.0, 1.0, 1.0), (None, None), (2.0, 2.0 + 2.0 * BIT), math.inf),
        ((0.0, 0.0, 1.0, 1.0), (None, None), (-2.0, -2.0), math.inf),
        ((0.0, 0.0, 0.0, 0.0), (None, None), (2.0, 2.0), math.inf),
        ((0.0, 0.0, 1.0, 1.0), (0.0, -2.0), (1.0, 0.0), 1.0),
        ((0.0, 0.0, 1.0, 1.0), (0.0, -2.0), (1.0, BIT), math.inf),
        ((0.0, 0.0, 1.0, 1.0), (0.0, -2.0), (-1.0, -2.0), math.inf),
        ((0.0, 0.0, 1.0, 1.0), (0.0, -2.0), (0.0, 0.0), math.inf),
        ((0.0, 0.0, 0.0, 2.0), (0.0, -1.0), (0.0, 1.5), 1.0),
        ((0.0, 0.0, 0.0, 2.0), (0.0, -1.0), (0.0, 2.5), math.inf),
        ((0.0, 0.0, 0.0, 2.0), (0.0, -1.0), (0.0, 0.0), 4.0),
        ((0.0, 0.0, 0.0, 2.0), (0.0, -1.0), (1.0, 1.5), math.inf),
        ((0.0, 0.0, 0.0, -2.0), (0.0, -1.0), (0.0, 1.5), math.inf),
        ((0.0, 0.0, 0.0, -2.0), (0.0, -1.0), (0.0, 0.0), math.inf),
        ((0.0, 0.0, 0.0, -0.5), (0.0, -1.0), (0.0, -1.0), 1.0),
        ((0.0, 0.0, 0.0, 0.5), (0.0, -1.0), (0.0, -1.0), 2.0),
    ],
)
def test_a_point_hits_another_one_exactly_or_never(flight, gravity, post, delay):
    assert post_delay_of_point(*flight, *gravity, *post) == delay


def test_a_point_that_is_back_where_it_began_has_turned():
    assert is_still_rising(1.0, 1.0, 0.0, -1.0, 1.0, 1.0, 0.0, 0.5)
    assert not is_still_rising(1.0, 1.0, 0.0, -1.0, 1.0, 1.0, 0.0, -0.5)
    assert not is_still_rising(1.0, 1.0, 0.0, -1.0, 1.0, 2.0, 0.0, 0.5)
    assert not is_still_rising(1.0, 1.0, None, None, 1.0, 1.0, 0.0, 0.5)


def test_a_small_disk_flies_on_along_a_wall_until_its_centre_is_there():
    assert way_to_wall(1.0, -2.0, 6.0, 10.0) == 3.0
    assert way_to_wall(1.0, -2.0, 60.0, 10.0) == 10.0
    assert way_to_wall(1.0, -2.0, -60.0, 10.0) == -10.0
    assert way_to_wall(1.0, 0.0, 6.0, 10.0) == 0.0
