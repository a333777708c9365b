"""Coming to rest and sliding, on numbers whose results are exact: equality, no tolerance."""

import pytest

from eventsim.formulas import rest
from eventsim.formulas.real import NEVER
from eventsim.formulas.rest import LEFT, STRUCK, SUPPORTED, Held
from eventsim.formulas.walls.face import face, is_in_line, slope

BIT = 2.0**-48
"""TOUCHING and AT_ONCE, both part of every log."""

FLOOR = face(1.0, 2.0, 5.0, 2.0)
"""Along x at y = 2: e = (4, 0), normal (0, 1)."""
WALL = face(1.0, 2.0, 1.0, 6.0)
"""Along y at x = 1: e = (0, 4), normal (-1, 0)."""
SLOPE = face(1.0, 2.0, 5.0, 5.0)
"""e = (4, 3), normal (-3, 4) of length 5."""


def test_what_is_compared_with_the_last_bits():
    assert (rest.AT_ONCE, rest.TOUCHING, rest.LATEST) == (BIT, BIT, 1024.0)


@pytest.mark.parametrize(
    ("flight", "still"),
    [
        ((1.0, 3.0, 1.0, 2.0, 4.0, 1.0, 0.5 * BIT), True),  # 8 lag against 4 last bits
        ((1.0, 3.0, 1.0, 2.0, 4.0, 1.0, 0.625 * BIT), False),
        ((-1.0, -3.0, -1.0, -2.0, -4.0, -1.0, 0.5 * BIT), True),
        ((-1.0, -3.0, -1.0, -2.0, -4.0, -1.0, 0.625 * BIT), False),
        ((0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0), True),
        ((0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.5), False),
    ],
)
def test_a_flight_shorter_than_the_last_bits_of_its_place_is_none(flight, still):
    assert rest.is_still(*flight) is still


@pytest.mark.parametrize(
    ("met", "held"),
    [
        ((), None),
        (((-3, 1, STRUCK),), None),
        (((-3, 1, SUPPORTED),), Held(2, 1, SUPPORTED)),
        (((-1, -1, LEFT),), Held(0, -1, LEFT)),
        (((0, 1, SUPPORTED),), None),  # a disk
        (((1, 1, SUPPORTED),), None),
        (((-3, 1, SUPPORTED), (-4, 1, SUPPORTED)), None),
    ],
)
def test_only_a_single_wall_holds_a_disk(met, held):
    assert rest.held_by(met) == held


ZENO = [
    # gap, rate, fall, scale, restitution, t -> delay
    ((0.0, -1.0, 0.0, 4.0, 0.5, 8.0), NEVER),  # nothing pulls it
    ((0.0, -1.0, 0.5, 4.0, 0.5, 8.0), NEVER),
    ((0.0, 0.0, 0.0, 4.0, 0.5, 8.0), NEVER),
    ((0.0, 0.0, 0.5, 4.0, 0.5, 8.0), NEVER),
    ((5.0 * BIT, -1.0, -2.0, 4.0, 0.5, 8.0), NEVER),  # it does not touch
    ((-5.0 * BIT, -1.0, -2.0, 4.0, 0.5, 8.0), NEVER),
    ((4.0 * BIT, 0.0, -2.0, 4.0, 0.5, 8.0), 0.0),
    ((-4.0 * BIT, 0.0, -2.0, 4.0, 0.5, 8.0), 0.0),
    ((0.0, 0.0, -2.0, 4.0, 1.0, 8.0), 0.0),
    # up with 4 bits, down after 4 bits, which is less than 8; over after twice as long
    ((0.0, 4.0 * BIT, -2.0, 4.0, 0.5, 8.0), 8.0 * BIT),
    ((0.0, 8.0 * BIT, -2.0, 4.0, 0.5, 8.0), 16.0 * BIT),
    ((0.0, 8.0 * BIT, -2.0, 4.0, 0.5, 16.0), 16.0 * BIT),
    ((0.0, 8.0 * BIT, -2.0, 4.0, 0.75, 8.0), 32.0 * BIT),
    ((0.0, 8.0 * BIT, -2.0, 4.0, 0.0, 8.0), 8.0 * BIT),
    # almost elastic: not later than 1024 instants
    ((0.0, 8.0 * BIT, -2.0, 4.0, 1.0, 8.0), 8192.0 * BIT),
    ((0.0, 8.0 * BIT, -2.0, 4.0, 1.0 - 2.0**-20, 8.0), 8192.0 * BIT),
    ((0.0, 8.0 * BIT, -2.0, 4.0, 1.0 - 2.0**-9, 8.0), 4096.0 * BIT),
    # a longer hop is flown, unless it is no higher than what rounding keeps up: loss v^2 against 8 |fall| gap
    ((0.0, 9.0 * BIT, -2.0, 4.0, 0.5, 8.0), NEVER),
    ((0.0, 1.0, -2.0, 4.0, 0.5, 8.0), NEVER),
    ((0.0, -1.0, -2.0, 4.0, 0.5, 8.0), NEVER),
    ((BIT, -(2.0**-22), -2.0, 4.0, 0.0, 8.0), 0.0),  # v^2 = 2^-44 = 16 gap
    ((-BIT, -(2.0**-22), -2.0, 4.0, 0.0, 8.0), 0.0),
    ((BIT, -(2.0**-22), -1.5, 4.0, 0.0, 8.0), NEVER),
    ((-BIT, -(2.0**-22), -1.5, 4.0, 0.0, 8.0), NEVER),
    ((BIT, -(2.0**-22), -1.5, 4.0, 0.5, 8.0), 0.0),  # 3/4 of it
    ((BIT, -(2.0**-22), -1.25, 4.0, 0.5, 8.0), NEVER),
    ((BIT, -(2.0**-22), -1.5, 4.0, 1.0, 8.0), NEVER),  # elastic: all of it
    ((BIT, -(2.0**-22), -2.0, 4.0, 1.0, 8.0), 0.0),
    ((BIT, -(2.0**-22), -1.875, 4.0, 0.0, 8.0), NEVER),
    ((BIT, 2.0**-22, -2.0, 4.0, 0.0, 8.0), 0.0),
    ((BIT, 2.0**-22, -1.5, 4.0, 0.0, 8.0), NEVER),
    ((0.0, 1.0, -(2.0**60), 4.0, 0.5, 1.0), 2.0**-58),
]


@pytest.mark.parametrize(("bounce", "delay"), ZENO)
def test_a_disk_rests_at_its_zeno_time_or_at_once(bounce, delay):
    assert rest.rest_delay(*bounce) == delay


@pytest.mark.parametrize(
    ("shape", "flight", "delay"),
    [
        (FLOOR, (3.0, 3.0, 4.0, 0.0, 0.0, 0.0), 0.5),  # to x = 5
        (FLOOR, (3.0, 3.0, -4.0, 0.0, 0.0, 0.0), 0.5),
        (FLOOR, (4.0, 3.0, -4.0, 7.0, 0.0, 9.0), 0.75),
        (FLOOR, (4.0, 3.0, 0.0, 0.0, 2.0, 0.0), 1.0),
        (FLOOR, (4.0, 3.0, 2.0, 0.0, -2.0, 0.0), 3.0),  # turns at the very end; back over the other one
        (FLOOR, (3.0, 3.0, 0.0, 0.0, 0.0, 0.0), NEVER),
        (WALL, (0.0, 5.0, 0.0, 2.0, 0.0, 0.0), 0.5),
        (WALL, (0.0, 5.0, 0.0, -2.0, 0.0, 0.0), 1.5),
        (WALL, (0.0, 5.0, 7.0, 0.0, 9.0, 2.0), 1.0),
        (SLOPE, (1.0, 2.0, 8.0, 6.0, 0.0, 0.0), 0.5),
        (SLOPE, (5.0, 5.0, -8.0, -6.0, 0.0, 0.0), 0.5),
        (SLOPE, (1.0, 2.0, 0.0, 0.0, 8.0, 6.0), 1.0),
    ],
)
def test_a_sliding_disk_passes_the_end_it_moves_to(shape, flight, delay):
    assert rest.slide_delay(shape, 0.0, shape.along2, *flight) == pytest.approx(delay, rel=2.0**-50)


def test_a_support_may_begin_and_end_elsewhere_than_its_face():
    assert rest.slide_delay(FLOOR, 4.0, 32.0, 3.0, 3.0, -4.0, 0.0, 0.0, 0.0) == 0.25
    assert rest.slide_delay(FLOOR, 4.0, 32.0, 3.0, 3.0, 4.0, 0.0, 0.0, 0.0) == 1.5


def test_gravity_along_a_wall_is_its_projection():
    assert slope(FLOOR, 3.0, -7.0) == (3.0, 0.0)
    assert slope(WALL, 3.0, -7.0) == (0.0, -7.0)
    assert slope(SLOPE, 0.0, -25.0) == (-12.0, -9.0)
    assert slope(SLOPE, 25.0, 0.0) == (16.0, 12.0)
    assert slope(face(0.0, 0.0, 1.0, 1.0), 3.0, 1.0) == (2.0, 2.0)


def test_a_disk_rests_exactly_on_contact_where_that_is_a_coordinate():
    assert rest.resting_place(FLOOR, 1, 3.0, 2.6, 0.5) == (3.0, 2.5)
    assert rest.resting_place(FLOOR, -1, 3.0, 1.4, 0.5) == (3.0, 1.5)
    assert rest.resting_place(WALL, 1, 0.4, 3.0, 0.5) == (0.5, 3.0)
    assert rest.resting_place(WALL, -1, 1.6, 3.0, 0.5) == (1.5, 3.0)
    assert rest.resting_place(SLOPE, 1, 0.4, 3.0, 0.5) == (0.4, 3.0)


def on_slope(along, radius, side=1):
    """The centre of a disk that touches the slope, `along` of its length from the start."""
    return 1.0 + 4.0 * along - side * 0.6 * radius, 2.0 + 3.0 * along + side * 0.8 * radius


@pytest.mark.parametrize(
    ("shape", "side", "place", "speed", "gravity", "delay"),
    [
        (FLOOR, 1, (3.0, 3.0), (0.0, 0.0), (0.0, -2.0), 0.0),
        (FLOOR, -1, (3.0, 1.0), (0.0, 0.0), (0.0, 2.0), 0.0),
        (FLOOR, 1, (3.0, 3.0), (0.0, 0.0), (0.0, 2.0), NEVER),  # pulled off
        (FLOOR, 1, (3.0, 3.0), (0.0, 0.0), (2.0, 0.0), NEVER),
        (FLOOR, 1, (3.0, 3.5), (0.0, 0.0), (0.0, -2.0), NEVER),
        (FLOOR, 1, (3.0, 2.5), (0.0, 0.0), (0.0, -2.0), NEVER),
        (FLOOR, 1, (3.0, 3.0), (0.0, -1.0), (0.0, -2.0), NEVER),  # a bounce
        (FLOOR, 1, (3.0, 3.0), (0.0, 4.0 * BIT), (0.0, -2.0), 8.0 * BIT),
        (FLOOR, 1, (0.75, 3.0), (0.0, 0.0), (0.0, -2.0), NEVER),  # beside its ends
        (FLOOR, 1, (5.25, 3.0), (0.0, 0.0), (0.0, -2.0), NEVER),
        (FLOOR, 1, (1.0, 3.0), (0.0, 0.0), (0.0, -2.0), 0.0),  # on an end, not moving out
        (FLOOR, 1, (5.0, 3.0), (0.0, 0.0), (0.0, -2.0), 0.0),
        (FLOOR, 1, (5.0, 3.0), (1.0, 0.0), (0.0, -2.0), NEVER),
        (FLOOR, 1, (5.0, 3.0), (-1.0, 0.0), (0.0, -2.0), 0.0),
        (FLOOR, 1, (1.0, 3.0), (-1.0, 0.0), (0.0, -2.0), NEVER),
        (FLOOR, 1, (5.0, 3.0), (0.0, 0.0), (1.0, -2.0), NEVER),  # pulled out
        (FLOOR, 1, (5.0, 3.0), (0.0, 0.0), (-1.0, -2.0), 0.0),
        (WALL, 1, (0.0, 3.0), (0.0, 0.0), (2.0, 0.0), 0.0),
        (WALL, -1, (2.0, 3.0), (0.0, 0.0), (-2.0, 0.0), 0.0),
        (WALL, 1, (0.0, 6.0), (0.0, 1.0), (2.0, 0.0), NEVER),
        (WALL, 1, (0.0, 6.0), (0.0, 0.0), (2.0, 1.0), NEVER),
        (SLOPE, 1, on_slope(0.5, 1.0), (0.0, 0.0), (0.0, -2.0), 0.0),
        (SLOPE, -1, on_slope(0.5, 1.0, -1), (0.0, 0.0), (0.0, 2.0), 0.0),
        (SLOPE, 1, on_slope(0.5, 1.0), (0.0, 0.0), (2.0, 0.0), 0.0),
        (SLOPE, 1, on_slope(0.5, 1.0), (0.0, 0.0), (-2.0, 0.0), NEVER),
        (SLOPE, 1, on_slope(0.5, 1.0), (4.0, 3.0), (0.0, -2.0), 0.0),
        (SLOPE, 1, on_slope(0.5, 1.0), (3.0, -4.0), (0.0, -2.0), NEVER),
        (SLOPE, 1, on_slope(-0.25, 1.0), (0.0, 0.0), (0.0, -2.0), NEVER),
        (SLOPE, 1, on_slope(1.25, 1.0), (0.0, 0.0), (0.0, -2.0), NEVER),
    ],
)
def test_a_disk_of_radius_1_rests_where_a_face_carries_it(shape, side, place, speed, gravity, delay):
    found = rest.rest_on_face_delay(shape, side, 0.0, shape.along2, *place, *speed, *gravity, 1.0, 0.5, 8.0)
    assert found == delay


@pytest.mark.parametrize(
    ("offset", "touches"),
    [(13.0, True), (15.0, False), (-13.0, True), (-15.0, False)],  # 3 + 5 + 1 + 4, and the radius: 14 last bits
)
def test_touching_is_measured_by_all_coordinates(offset, touches):
    floor = face(-1.0, -4.0, -5.0, -4.0)  # normal (0, -1)
    place = -3.0, -5.0 - offset * BIT
    delay = rest.rest_on_face_delay(floor, 1, 0.0, 16.0, *place, 0.0, 0.0, 0.0, 2.0, 1.0, 0.5, 8.0)
    assert delay == (0.0 if touches else NEVER)


@pytest.mark.parametrize(
    ("shape", "place", "is_on"),
    [
        (FLOOR, (9.0, 2.0), True),
        (FLOOR, (-9.0, 2.0), True),
        (FLOOR, (9.0, 2.5), False),
        (FLOOR, (9.0, 1.5), False),
        (FLOOR, (0.0, 2.0 + 5.0 * BIT), True),  # 0 + 2 + 1 + 2 last bits
        (FLOOR, (0.0, 2.0 - 4.0 * BIT), True),
        (FLOOR, (0.0, 2.0 + 6.0 * BIT), False),
        (FLOOR, (0.0, 2.0 - 6.0 * BIT), False),
        (FLOOR, (-3.0, 2.0 + 8.0 * BIT), True),
        (FLOOR, (-3.0, 2.0 + 9.0 * BIT), False),
        (face(-1.0, -2.0, -5.0, -2.0), (0.0, -2.0 - 5.0 * BIT), True),
        (face(-1.0, -2.0, -5.0, -2.0), (0.0, -2.0 - 6.0 * BIT), False),
        (SLOPE, (-7.0, -4.0), True),
        (SLOPE, (9.0, 8.0), True),
        (SLOPE, (9.0, -4.0), False),
        (SLOPE, (-7.0, 8.0), False),
        (SLOPE, (9.0, 8.0 + 24.0 * BIT), True),  # 4/5 of it is the distance: 19.2 of 20 last bits
        (SLOPE, (9.0, 8.0 + 28.0 * BIT), False),
    ],
)
def test_a_point_is_in_line_with_a_face_but_for_rounding(shape, place, is_on):
    assert is_in_line(shape, *place) is is_on
