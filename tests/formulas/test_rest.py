"""Coming to rest and sliding, on numbers whose results are exact: equality, no tolerance."""

import pytest

from eventsim.formulas import doubt, rest
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
    assert (doubt.AT_ONCE, doubt.TOUCHING, doubt.ROUNDED, doubt.FLOORS) == (BIT, BIT, 2.0**-52, 32.0)
    assert (doubt.LEAST_LOSS, doubt.LONGEST_INSTANT, doubt.LONGEST_STILL) == (2.0**-20, 2.0**-32, 2.0**-30)


@pytest.mark.parametrize(
    ("loss", "instant", "way"),
    [
        (1.0, 2.0**-47, 2.0**-41),  # 32 last bits of the clock; 2 ulp, times 32 times 32
        (0.5, 2.0**-46, 2.0**-40),
        (2.0**-10, 2.0**-37, 2.0**-31),
        (2.0**-11, 2.0**-36, 2.0**-30),
        (2.0**-40, 2.0**-32, 2.0**-30),  # not longer, however little is lost
    ],
)
def test_rounding_keeps_up_the_more_the_less_is_lost(loss, instant, way):
    assert (doubt.kept_up_instant(loss), doubt.kept_up_way(loss)) == (instant, way)


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
    assert doubt.is_still(*flight, BIT) is still
    assert doubt.is_still(*flight, 2.0)


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


LATE = 2.0**-23
"""The delay after which a disk pulled by 2 has fallen TOUCHING of 4: what rests, rests by then."""

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
    # almost elastic: before it would fall through the wall
    ((0.0, 8.0 * BIT, -2.0, 4.0, 1.0, 8.0), LATE),
    ((0.0, 8.0 * BIT, -2.0, 4.0, 1.0 - 2.0**-23, 8.0), LATE),
    ((0.0, 8.0 * BIT, -2.0, 4.0, 1.0 - 2.0**-20, 8.0), 8.0 * 2.0**-28),
    # a longer hop is flown, unless it is no higher than the gap that rounding has left: v^2 against 8 |fall| gap
    ((0.0, 9.0 * BIT, -2.0, 4.0, 0.5, 8.0), NEVER),
    ((0.0, 1.0, -2.0, 4.0, 0.5, 8.0), NEVER),
    ((0.0, -1.0, -2.0, 4.0, 0.5, 8.0), NEVER),
    ((BIT, -(2.0**-22), -2.0, 4.0, 0.0, 8.0), 0.0),  # v^2 = 2^-44 = 16 gap
    ((-BIT, -(2.0**-22), -2.0, 4.0, 0.0, 8.0), 0.0),
    ((BIT, -(2.0**-22), -1.5, 4.0, 0.0, 8.0), NEVER),
    ((-BIT, -(2.0**-22), -1.5, 4.0, 0.0, 8.0), NEVER),
    ((BIT, -(2.0**-22), -1.5, 4.0, 0.5, 8.0), NEVER),  # whatever is lost there
    ((BIT, -(2.0**-22), -2.0, 4.0, 1.0 - 2.0**-40, 8.0), 0.0),
    ((BIT, -(2.0**-22), -1.875, 4.0, 1.0 - 2.0**-40, 8.0), NEVER),
    ((BIT, 2.0**-22, -2.0, 4.0, 0.0, 8.0), 0.0),
    ((BIT, 2.0**-22, -1.5, 4.0, 0.0, 8.0), NEVER),
    ((0.0, 1.0, -(2.0**60), 4.0, 0.5, 1.0), 2.0**-58),
]


@pytest.mark.parametrize(("bounce", "delay"), ZENO)
def test_a_disk_rests_at_its_zeno_time_or_at_once(bounce, delay):
    assert rest.rest_delay(*bounce, rest.AS_AT_START) == delay


@pytest.mark.parametrize(("gap", "delay"), [(0.25 * BIT, 0.0), (0.3125 * BIT, NEVER), (-0.25 * BIT, 0.0), (-BIT, 0.0)])
def test_behind_another_contact_a_gap_is_known_to_a_few_last_bits(gap, delay):
    assert rest.rest_delay(gap, 0.0, -2.0, 1.0, 0.5, 8.0, rest.NOT_LAST) == delay
    assert rest.rest_delay(gap, 0.0, -2.0, 1.0, 0.5, 8.0, rest.AS_AT_START) == 0.0


@pytest.mark.parametrize(
    ("bounce", "since", "blur", "delay"),
    [
        ((0.0, 8.0 * BIT, -2.0, 4.0, 0.5, 8.0), 0.0, 0.0, 16.0 * BIT),
        # 4 bits later it is at its apex, another 2 bits later on its way down: the same time of rest
        ((BIT, 0.0, -2.0, 4.0, 0.5, 8.0), 4.0 * BIT, 0.0, 12.0 * BIT),
        ((BIT, -4.0 * BIT, -2.0, 4.0, 0.5, 8.0), 6.0 * BIT, 0.0, 10.0 * BIT),
        ((0.0, 9.0 * BIT, -2.0, 4.0, 0.5, 8.0), 0.0, 0.0, NEVER),
        # a gap that rounding has left does not matter to who comes from the wall itself
        ((BIT, 2.0**-22, -2.0, 4.0, 0.0, 8.0), 0.0, 0.0, NEVER),
        ((BIT, -(2.0**-22), -2.0, 4.0, 0.0, 8.0), 2.0**-22, 0.0, NEVER),
        # a rate of 64 bits is rounding if that is 1 bit, times 32, and half is lost
        ((0.0, 63.0 * BIT, -2.0, 4.0, 0.5, 8.0), 0.0, BIT, 126.0 * BIT),
        ((0.0, 64.0 * BIT, -2.0, 4.0, 0.5, 8.0), 0.0, BIT, NEVER),
        ((0.0, 16.0 * BIT, -2.0, 4.0, 1.0, 8.0), 0.0, BIT, NEVER),  # elastic: nothing is lost
        # however little is lost, 2^-20 of it counts
        ((0.0, 2.0**-24, -2.0, 4.0, 1.0 - 2.0**-40, 8.0), 0.0, 0.5 * BIT, NEVER),
        ((0.0, 2.0**-24, -2.0, 4.0, 1.0 - 2.0**-40, 8.0), 0.0, BIT, LATE),
    ],
)
def test_a_series_is_told_by_the_speed_at_which_the_disk_left_the_wall(bounce, since, blur, delay):
    assert rest.rest_delay(*bounce, since, False, blur) == delay


@pytest.mark.parametrize(
    ("rate", "restitution", "delay"),
    [(2.0**-25, 0.5, 2.0**-24), (2.0**-24, 0.5, NEVER), (2.0**-26, 0.75, 2.0**-24), (2.0**-25, 0.75, NEVER)],
)
def test_where_places_are_rounded_a_series_is_over_before_they_could_tell_it_from_a_fall(rate, restitution, delay):
    assert rest.rest_delay(0.0, rate, -2.0, 4.0, restitution, 8.0, 0.0, True) == delay
    assert rest.rest_delay(0.0, rate, -2.0, 4.0, restitution, 8.0, 0.0) == NEVER


@pytest.mark.parametrize(
    ("rate", "fall", "since", "launched", "delay"),
    [
        (2.0, -2.0, 0.0, 2.0, 2.0),
        (1.0, -2.0, 0.5, 2.0, 1.5),
        (0.0, -2.0, 1.0, 2.0, 1.0),
        (-2.0, -2.0, 2.0, 2.0, 0.0),
        (-3.0, -2.0, 2.5, 2.0, 0.0),  # overdue
        (2.0**-600, -2.0, 0.0, 2.0**-600, 2.0**-600),  # whose square is no float
        (-1.0, -2.0, 0.0, -1.0, 0.0),
    ],
)
def test_a_hop_lasts_as_long_as_its_launch_says(rate, fall, since, launched, delay):
    assert rest.launch(rate, fall, since) == launched
    assert rest.hop_delay(rate, fall, since) == delay


@pytest.mark.parametrize(
    ("shape", "side", "flight", "since", "delay"),
    [
        (FLOOR, 1, (3.0, 3.0 + BIT, 0.5, 2.0, 0.0, -2.0), 0.0, 2.0),
        (FLOOR, 1, (3.0, 3.0 - BIT, -0.5, 2.0, 0.0, -2.0), 0.0, 2.0),
        (FLOOR, 1, (3.0, 3.75, 0.5, 1.0, 0.0, -2.0), 0.5, 1.5),
        (FLOOR, -1, (3.0, 1.0, 0.5, -2.0, 0.0, 2.0), 0.0, 2.0),
        (FLOOR, 1, (3.0, 3.0, 1.0, 2.0, 0.0, -2.0), 0.0, 2.0),  # down at its very end
        (FLOOR, 1, (3.0, 3.0, 1.25, 2.0, 0.0, -2.0), 0.0, NEVER),  # beside it
        (FLOOR, 1, (3.0, 3.0, 0.0, 2.0, 0.0, 2.0), 0.0, NEVER),  # not pulled
        (FLOOR, 1, (3.0, 3.0, 0.0, 2.0, 1.0, 0.0), 0.0, NEVER),
        (SLOPE, 1, (3.0 - 0.6, 3.5 + 0.8, -0.75, 1.0, 0.0, -2.0), 0.0, 2.0 * 6.25 / 8.0),
    ],
)
def test_a_hop_on_a_face_ends_where_that_goes_on(shape, side, flight, since, delay):
    assert rest.hop_on_face_delay(shape, side, *flight, since, 1.0) == delay


def test_a_disk_leaves_a_wall_at_the_speed_that_is_said():
    assert rest.rebound(0.0, 1.0, 3.0, -7.0, 2.0) == (3.0, 2.0)
    assert rest.rebound(0.0, -1.0, 3.0, 7.0, 2.0) == (3.0, -2.0)
    assert rest.rebound(-1.0, 0.0, 7.0, 3.0, 2.0) == (-2.0, 3.0)
    assert rest.rebound(-3.0, 4.0, 0.0, -25.0, 50.0) == (-18.0, -1.0)  # n.v from -100 to 50


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


def test_a_disk_is_laid_exactly_on_contact_where_that_is_a_coordinate():
    assert FLOOR.touching(1, 3.0, 2.6, 0.5) == (3.0, 2.5)
    assert FLOOR.touching(-1, 3.0, 1.4, 0.5) == (3.0, 1.5)
    assert WALL.touching(1, 0.4, 3.0, 0.5) == (0.5, 3.0)
    assert WALL.touching(-1, 1.6, 3.0, 0.5) == (1.5, 3.0)


@pytest.mark.parametrize("side", [1, -1])
def test_a_disk_is_laid_onto_a_slope_along_its_normal(side):
    x, y = on_slope(0.5, 1.0, side)
    for shift in (0.0, 2.0**-20, -(2.0**-20)):
        at = SLOPE.touching(side, x - 3.0 * shift, y + 4.0 * shift, 1.0)
        assert at == pytest.approx((x, y), abs=2.0**-51)


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
    found = rest.rest_on_face_delay(shape, side, 0.0, shape.along2, *place, *speed, *gravity, 1.0, 0.5, 8.0, rest.NOT_LAST)
    assert found == delay


def test_a_series_is_over_at_the_end_of_the_face_if_that_comes_first():
    """Up with 8 bits it would rest 16 bits later; 8 bits before the end, at speed 1 or 1/4."""
    flight = 5.0 - 8.0 * BIT, 3.0
    ends = [
        rest.rest_on_face_delay(FLOOR, 1, 0.0, 16.0, *flight, u, 8.0 * BIT, 0.0, -2.0, 1.0, 0.5, 8.0, 0.0)
        for u in (1.0, 0.25, -1.0)
    ]
    assert ends == [8.0 * BIT, 16.0 * BIT, 16.0 * BIT]


def test_a_slope_blurs_the_rate_by_the_speed_along_it():
    """n.v = -3 u + 4 w; along the slope at 2^24 such a rate is rounding, at 1 it is a bounce."""
    for along, rests in ((2.0**24, True), (1.0, False)):
        speed = 4.0 * along - 3.0 * 2.0**-24, 3.0 * along + 4.0 * 2.0**-24
        place = on_slope(0.5, 1.0)
        found = rest.rest_on_face_delay(SLOPE, 1, -1e30, 1e30, *place, *speed, 0.0, -2.0, 1.0, 0.5, 8.0, 0.0)
        assert (found < NEVER) is rests


@pytest.mark.parametrize(
    ("offset", "touches"),
    [(13.0, True), (15.0, False), (-13.0, True), (-15.0, False)],  # 3 + 5 + 1 + 4, and the radius: 14 last bits
)
def test_touching_is_measured_by_all_coordinates(offset, touches):
    floor = face(-1.0, -4.0, -5.0, -4.0)  # normal (0, -1)
    place = -3.0, -5.0 - offset * BIT
    delay = rest.rest_on_face_delay(floor, 1, 0.0, 16.0, *place, 0.0, 0.0, 0.0, 2.0, 1.0, 0.5, 8.0, rest.AS_AT_START)
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
