"""Disks and the walls they rest on: what is struck, what carries, what is passed."""

import math

import pytest

from eventsim.formulas import rest
from eventsim.formulas.real import NEVER
from eventsim.formulas.rest import AS_AT_START, LEFT, NOT_LAST, STRUCK, SUPPORTED, Held, Support
from eventsim.formulas.walls.face import face
from eventsim.formulas.walls.post import Post

BIT = 2.0**-48
"""TOUCHING and AT_ONCE."""

FLOOR = face(1.0, 2.0, 5.0, 2.0)
"""Along x at y = 2: e = (4, 0), normal (0, 1)."""
SLOPE = face(1.0, 2.0, 5.0, 5.0)
"""e = (4, 3), normal (-3, 4) of length 5."""

SUPPORTS = [None, Support(FLOOR, 0.0, 0.0, 0.0, 16.0, 0), Support(SLOPE, -0.96, -0.72, 0.0, 25.0, 1)]


@pytest.mark.parametrize(
    ("supports", "held", "v", "expected"),
    [
        (None, None, -2.0, (1.0, STRUCK)),
        (SUPPORTS, None, -2.0, (1.0, STRUCK)),
        (SUPPORTS, Held(1, 1, SUPPORTED), -2.0, (NEVER, STRUCK)),
        (SUPPORTS, Held(2, 1, SUPPORTED), -2.0, (1.0, STRUCK)),
        (SUPPORTS, Held(1, 1, LEFT), -2.0, (1.0, STRUCK)),
    ],
)
def test_a_wall_of_the_domain_is_struck_unless_it_carries_the_disk(supports, held, v, expected):
    # 4 + v t - t^2 at 1: from x = 4 to the target 1
    assert rest.border_contact(supports, held, 1, 1.0, 1.0, 4.0, v, -2.0, 8.0, 0.5, 8.0, NOT_LAST) == expected


@pytest.mark.parametrize(
    ("side", "target", "v", "g", "expected"),
    [
        (1.0, 4.0, 4.0 * BIT, -2.0, (8.0 * BIT, SUPPORTED)),
        (-1.0, 4.0, -4.0 * BIT, 2.0, (8.0 * BIT, SUPPORTED)),
        (1.0, 4.0 - 8.0 * BIT, 0.0, -2.0, (0.0, SUPPORTED)),
        (1.0, 4.0 - 16.0 * BIT, 0.0, -32.0, (2.0**-24, STRUCK)),
        (1.0, 4.0, 2.0, -2.0, (2.0, STRUCK)),
        (-1.0, 4.0, -2.0, 2.0, (2.0, STRUCK)),
    ],
)
def test_a_disk_comes_to_rest_on_a_wall_of_the_domain(side, target, v, g, expected):
    found = rest.border_contact(SUPPORTS, None, 1, side, target, 4.0, v, g, 8.0, 0.5, 8.0, AS_AT_START)
    if expected[1] == SUPPORTED:
        assert found == expected
    else:
        assert found == (pytest.approx(expected[0]), STRUCK)


@pytest.mark.parametrize(("since", "delay"), [(0.0, 2.0), (0.5, 2.5)])
def test_a_wall_of_the_domain_is_struck_again_as_the_launch_says(since, delay):
    """The place, here wrong, is not asked."""
    found = rest.border_contact(SUPPORTS, None, 1, 1.0, 1.0, 1.75, 2.0, -2.0, 8.0, 0.5, 8.0, since)
    assert found == (delay, STRUCK)


NEXT_FLOOR = face(5.0, 2.0, 7.0, 2.0)
STEP = face(5.0, 2.0, 7.0, 3.0)
ANOTHER_STEP = face(5.0, 3.0, 7.0, 2.0)
DOWN = 0.0, -2.0


def contact(place, shape, flight, held=None, gravity=DOWN, met=0, radius=1.0, since=NOT_LAST):
    flight = *flight, *gravity
    return rest.shape_contact(SUPPORTS, held, place, shape, flight, radius, met, 0.5, 8.0, since, since == 0.0)


def test_a_free_disk_meets_a_face_or_comes_to_rest_on_it():
    assert contact(0, FLOOR, (3.0, 4.0, 0.0, 0.0)) == (1.0, 1, STRUCK)  # nothing that supports
    assert contact(1, FLOOR, (3.0, 4.0, 0.0, 0.0)) == (1.0, 1, STRUCK)
    assert contact(0, FLOOR, (3.0, 3.0, 0.0, 2.0), met=1) == (2.0, 1, STRUCK)
    assert contact(1, FLOOR, (3.0, 3.0, 0.0, 4.0 * BIT), met=1) == (8.0 * BIT, 1, SUPPORTED)
    assert contact(1, FLOOR, (3.0, 3.0, 0.0, 4.0 * BIT)) == (8.0 * BIT, 1, SUPPORTED)
    assert contact(1, FLOOR, (3.0, 1.0, 0.0, -4.0 * BIT), gravity=(0.0, 2.0)) == (8.0 * BIT, -1, SUPPORTED)
    assert contact(1, FLOOR, (3.0, 2.0, 0.0, 0.0), met=1, radius=0.0) == (0.0, 1, SUPPORTED)
    assert contact(1, FLOOR, (3.0, 2.0, 0.0, 0.0), met=-1, radius=0.0, gravity=(0.0, 2.0)) == (0.0, -1, SUPPORTED)


def test_a_disk_that_comes_from_a_face_is_back_as_the_launch_says():
    """Whatever rounding has made of its place; a face that supports nobody knows that only of a flight that begins there."""
    flight = 3.0, 3.0 + 2.0**-30, 0.0, 2.0
    assert contact(1, FLOOR, flight, met=1, since=0.0) == (2.0, 1, STRUCK)
    assert contact(0, FLOOR, flight, met=1, since=0.0) == (2.0, 1, STRUCK)
    assert contact(1, FLOOR, (3.0, 3.75, 0.0, 1.0), met=1, since=0.5) == (1.5, 1, STRUCK)
    assert contact(1, FLOOR, (3.0, 3.0, 2.0, 2.0), met=1, since=0.0) == (NEVER, 1, STRUCK)  # down beside it


@pytest.mark.parametrize("side", [1, -1])
def test_a_disk_that_is_carried_slides_over_the_end(side):
    y = 2.0 + side
    assert contact(1, FLOOR, (3.0, y, 4.0, 0.0), Held(1, side, SUPPORTED), (0.0, 0.0)) == (0.5, side, LEFT)
    assert contact(1, FLOOR, (4.0, y, 0.0, 0.0), Held(1, side, SUPPORTED), (2.0, 0.0)) == (1.0, side, LEFT)


@pytest.mark.parametrize("how", [SUPPORTED, LEFT])
@pytest.mark.parametrize("met", [0, 1])
def test_what_is_in_line_with_the_support_is_passed(how, met):
    flight, held = (4.0, 3.0, 1.0, 0.0), Held(1, 1, how)
    assert contact(0, NEXT_FLOOR, flight, held, met=met) == (NEVER, met, STRUCK)
    for beside in (STEP, ANOTHER_STEP):
        assert contact(0, beside, flight, held, met=met) == (*beside.delay(*flight, *DOWN, 1.0, met), STRUCK)


def test_the_post_at_the_end_is_passed_by_who_slides_and_met_by_who_falls():
    flight = 4.0, 3.0, 1.0, 0.0
    on_line, above = Post(5.0, 2.0), Post(5.0, 2.5)
    met = {post: post.delay(*flight, *DOWN, 1.0, 0) for post in (on_line, above)}
    assert min(delay for delay, _ in met.values()) < math.inf

    def to(post, how):
        return contact(0, post, flight, Held(1, 1, how))

    assert to(on_line, SUPPORTED) == (NEVER, 0, STRUCK)
    assert to(on_line, LEFT) == (*met[on_line], STRUCK)
    assert to(above, SUPPORTED) == (*met[above], STRUCK)


def test_a_disk_that_left_its_support_may_strike_or_rest_elsewhere():
    held = Held(2, 1, LEFT)
    assert contact(1, FLOOR, (3.0, 4.0, 0.0, 0.0), held) == (1.0, 1, STRUCK)
    assert contact(1, FLOOR, (3.0, 3.0, 0.0, 4.0 * BIT), held) == (8.0 * BIT, 1, SUPPORTED)
    assert contact(2, SLOPE, (3.0, 8.0, 0.0, 0.0), held) == (NEVER, 0, STRUCK)  # its own line is in line
