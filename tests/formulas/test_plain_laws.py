"""Flight, clock, crossings, impulses and faces on numbers whose results are exact: equality, no tolerance."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest

from eventsim.formulas import clock, crossing, impulse, motion
from eventsim.formulas.image import nearest_image
from eventsim.formulas.laws import Numbers
from eventsim.formulas.real import NEVER, is_float, sqrt
from eventsim.formulas.roots import Moment, quadratic_root
from eventsim.formulas.walls import face as faces

INF = math.inf


@pytest.mark.parametrize(
    ("x", "v", "lag", "g", "place", "speed"),
    [(1.0, 2.0, 3.0, None, 7.0, 2.0), (1.0, 2.0, 3.0, -4.0, -11.0, -10.0), (0.5, -2.0, 0.5, 8.0, 0.5, 2.0)],
)
def test_a_flight_is_a_line_or_a_parabola(x, v, lag, g, place, speed):
    assert motion.position(x, v, lag, g) == place
    assert motion.velocity(v, lag, g) == speed


@pytest.mark.parametrize(
    ("exponent", "rows", "expected"),
    [
        (5, 79, 6),
        (5, 80, 5),
        (5, 320, 5),
        (5, 321, 4),
        (0, 321, 0),
        (1, 321, 0),
        (7, 0, 7),
        (6, 0, 7),
        (7, 80, 7),
        (0, 0, 1),
    ],
)
def test_windows_grow_when_little_happens_and_shrink_when_much_does(exponent, rows, expected):
    assert clock.next_window(exponent, rows, n=10, cap=7) == expected


def test_the_constants_of_the_clock_are_part_of_every_log():
    assert (clock.FIRST_WINDOW, clock.FEW, clock.MANY, clock.MOST_EPOCHS) == (5, 8, 32, 2**61)


def test_the_length_of_a_window_is_a_power_of_two_times_an_epoch():
    assert clock.window_length(5, 0.25) == 8.0


def test_a_clock_far_on_keeps_the_digits_of_its_remainder():
    assert clock.remainder_since(3, 0.5, 2.0) == 0.5
    assert clock.remainder_since(3, 0.5, 2.0, 0.25) == 0.25
    assert clock.remainder_since(2**60, 2.0**-10, 2.0**50) == 0.0
    assert clock.remainder_since(5, 1.0, INF) == INF
    assert clock.clock_time(3, 0.125, 0.5) == 1.625
    assert clock.clock_time(3, 0.125, 0.5, 0.25) == 1.875
    assert clock.clock_time(2**60, 2.0**-60, 1.0, -(2.0**60)) == 2.0**-60


def test_a_time_beyond_all_floats_is_infinite_with_its_sign():
    assert clock.clock_time(2**1030, 0.0, 1.0) == INF
    assert clock.clock_time(0, 0.0, 1.0, -1.7e308) == -1.7e308
    assert clock.remainder_since(2**1030, 1.0, 0.0) == -INF


CLOSING = [
    # gap, rate, acceleration -> delay; signs first
    (1.0, -2.0, None, 0.5),
    (0.0, -2.0, None, 0.0),
    (-1.0, -2.0, None, 0.0),
    (1.0, 0.0, None, NEVER),
    (-1.0, 2.0, None, NEVER),
    (0.0, 0.0, None, NEVER),
    (3.0, -1.0, -4.0, 1.0),  # 3 - t - 2 t^2
    (1.0, -3.0, 4.0, 0.5),  # 1 - 3 t + 2 t^2: the first root
    (1.0, -2.0, 2.0, NEVER),  # (1 - t)^2 touches with its apex
    (2.0, -2.0, 2.0, NEVER),
    (1.0, -3.0, 4.5, NEVER),
    (-1.0, -3.0, 4.0, 0.0),
    (0.0, -3.0, 4.0, 0.0),
    (6.0, 1.0, -2.0, 3.0),  # rises, then falls: 6 + t - t^2
    (0.0, 2.0, -2.0, 2.0),
    (1.5, 0.0, -3.0, 1.0),
    (0.0, 0.0, -3.0, 0.0),
    (1.0, 2.0, 0.0, NEVER),
    (1.0, 2.0, 1.0, NEVER),
    (-1.0, 2.0, -2.0, 1.0),  # closed, and its apex only touches: due when it falls
    (-5.0, 2.0, -2.0, 1.0),  # never opens: due when it begins to fall
    (0.0, 0.5, -2.0, 0.5),
]


@pytest.mark.parametrize(("gap", "rate", "acceleration", "delay"), CLOSING)
def test_a_gap_closes_where_it_is_zero_and_falls(gap, rate, acceleration, delay):
    assert crossing.closing_delay(gap, rate, acceleration) == delay


@pytest.mark.parametrize(
    ("gap", "rate", "acceleration", "delay"),
    [
        (-1.0, 3.0, None, NEVER),
        (-1.0, 3.0, -4.0, 1.0),  # -1 + 3 t - 2 t^2 is open from 1/2 to 1
        (-1.0, 3.0, 4.0, NEVER),
        (-1.0, 3.0, 0.0, NEVER),
        (-1.0, -3.0, -4.0, NEVER),
        (-1.0, 0.0, -4.0, NEVER),
        (-1.0, 2.0, -2.0, NEVER),  # its apex touches
        (-5.0, 2.0, -2.0, NEVER),
        (0.0, 1.0, -2.0, 1.0),
    ],
)
def test_a_closed_gap_that_opens_closes_again_at_the_far_root(gap, rate, acceleration, delay):
    assert crossing.reopening_delay(gap, rate, acceleration) == delay


def test_a_coordinate_is_watched_from_its_side():
    assert crossing.crossing_delay(3.0, -2.0, None, 1.0, 1.0) == 1.0
    assert crossing.crossing_delay(3.0, 2.0, None, 1.0, 1.0) == NEVER
    assert crossing.crossing_delay(1.0, 2.0, None, 3.0, -1.0) == 1.0
    assert crossing.crossing_delay(3.0, 0.0, -4.0, 1.0, 1.0) == 1.0
    assert crossing.crossing_delay(1.0, 0.0, 4.0, 3.0, -1.0) == 1.0
    assert crossing.crossing_delay(1.0, 0.0, -4.0, 3.0, -1.0) == NEVER


@pytest.mark.parametrize(
    ("one", "other", "shares", "reduced"),
    [
        (1.0, 3.0, (0.25, 0.75), 0.75),
        (2.0, 2.0, (0.5, 0.5), 1.0),
        (3.0, 1.0, (0.75, 0.25), 0.75),
        (INF, 3.0, (1.0, 0.0), 3.0),
        (3.0, INF, (0.0, 1.0), 3.0),
        (0.0, 3.0, (0.0, 1.0), 0.0),
        (3.0, 0.0, (1.0, 0.0), 0.0),
        (1e308, 1e308, (0.5, 0.5), 5e307),
        (INF, 0.0, (1.0, 0.0), 0.0),
        (0.0, INF, (0.0, 1.0), 0.0),
    ],
)
def test_shares_of_a_pair(one, other, shares, reduced):
    assert impulse.mass_fractions(one, other) == shares
    assert impulse.reduced_mass(one, other) == reduced


@pytest.mark.parametrize("restitution", [1.0, 0.5, 0.0])
def test_a_pair_keeps_momentum_and_turns_its_approach_round(restitution):
    dx, dy, share_a, share_b = 3.0, 4.0, 0.25, 0.75
    before = 2.0, -1.0, 5.0, 7.0
    ua, wa, ub, wb, q = impulse.pair_update(dx, dy, *before, share_a, share_b, restitution)
    b = dx * (before[0] - before[2]) + dy * (before[1] - before[3])
    expected = (1 + Fraction(restitution)) * Fraction(b) / 25
    assert q == float(expected)
    assert [ua, wa, ub, wb] == pytest.approx(
        [
            float(2 - expected * Fraction(3, 4) * 3),
            float(-1 - expected * Fraction(3, 4) * 4),
            float(5 + expected * Fraction(1, 4) * 3),
            float(7 + expected * Fraction(1, 4) * 4),
        ],
        rel=2.0**-50,  # three roundings
    )


@pytest.mark.parametrize(
    "before", [(1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 1.0), (0.0, 0.0, 0.0, 0.0), (0.5, 0.0, 0.0, 0.0)]
)
def test_a_pair_that_does_not_approach_is_left_alone(before):
    assert impulse.pair_update(1.0, 0.0, *before, 0.5, 0.5, 1.0) == (*before, 0.0)


def test_walls_reflect():
    assert impulse.wall_update(0.0, 2.0, 3.0, -4.0, 1.0) == (3.0, 4.0, -4.0)
    assert impulse.wall_update(2.0, 0.0, -3.0, 4.0, 0.5) == (1.5, 4.0, -2.25)
    assert impulse.wall_update(1.0, 1.0, -2.0, 0.0, 1.0) == (0.0, 2.0, -2.0)
    assert impulse.wall_update(1.0, 1.0, 2.0, -1.0, 1.0) == (2.0, -1.0, 0.0)
    assert impulse.wall_update(1.0, 1.0, 1.0, -1.0, 1.0) == (1.0, -1.0, 0.0)
    assert impulse.flat_update(-3.0, 1.0, 1.0) == (3.0, 6.0)
    assert impulse.flat_update(3.0, -1.0, 0.5) == (-1.5, -4.5)
    assert impulse.flat_update(3.0, 1.0, 1.0) == (3.0, 0.0)
    assert impulse.flat_update(0.0, 1.0, 1.0) == (0.0, 0.0)
    assert impulse.flat_update(0.25, 1.0, 1.0) == (0.25, 0.0)
    assert impulse.wall_update(1.0, 1.0, 0.25, 0.25, 1.0) == (0.25, 0.25, 0.0)


@pytest.mark.parametrize(
    ("duration", "since_a", "since_b", "expected"),
    [(None, 0.0, 0.0, 0.5), (1.0, 2.0, 3.0, 0.5), (1.0, 0.5, 3.0, 1.0), (1.0, 3.0, 0.5, 1.0), (1.0, 1.0, 1.0, 0.5)],
)
def test_contacts_in_quick_succession_are_elastic(duration, since_a, since_b, expected):
    assert impulse.contact_restitution(0.5, Numbers(duration), since_a, since_b, 1.0, 1.0) == expected


class Ball:
    """A number that is no float."""

    def sqrt(self):
        return "its own root"


def test_a_number_that_is_no_float_takes_its_own_root():
    assert sqrt(6.25) == 2.5
    assert sqrt(Ball()) == "its own root"
    assert is_float(1.0)
    assert not is_float(Ball())
    assert NEVER == INF


@pytest.mark.parametrize(
    ("ends", "normal", "norm2", "along2"),
    [
        ((1.0, 2.0, 4.0, 6.0), (-4.0, 3.0), 25.0, 25.0),
        ((1.0, 2.0, 1.0, 5.0), (-1.0, 0.0), 1.0, 9.0),
        ((1.0, 5.0, 1.0, 2.0), (1.0, 0.0), 1.0, 9.0),
        ((1.0, 2.0, 4.0, 2.0), (0.0, 1.0), 1.0, 9.0),
        ((4.0, 2.0, 1.0, 2.0), (0.0, -1.0), 1.0, 9.0),
    ],
)
def test_a_face_knows_its_normal(ends, normal, norm2, along2):
    shape = faces.face(*ends)
    assert (shape.x, shape.y) == ends[:2]
    assert (shape.ex, shape.ey) == (ends[2] - ends[0], ends[3] - ends[1])
    assert (shape.nx, shape.ny) == normal
    assert (shape.norm, shape.norm2, shape.along2) == (math.sqrt(norm2), norm2, along2)
    assert shape.normal(1, 0.0, 0.0) == normal
    assert shape.normal(-1, 0.0, 0.0) == (-normal[0], -normal[1])


SLOPE = faces.face(1.0, 2.0, 5.0, 5.0)
"""Along (4, 3), normal (-3, 4) of length 5."""


@pytest.mark.parametrize(
    ("place", "speed", "side"),
    [
        ((1.0, 3.0), (0.0, 0.0), 1),
        ((2.0, 2.0), (0.0, 0.0), -1),
        ((5.0, 5.0), (0.0, 1.0), 1),
        ((5.0, 5.0), (0.0, -1.0), -1),
        ((5.0, 5.0), (4.0, 3.0), -1),
        ((1.0, 2.125), (0.0, 0.0), 1),
        ((1.0, 2.0), (0.0, 0.125), 1),
        ((5.0, 5.0), (-1.0, 0.0), 1),
        ((0.0, 0.0), (0.0, 0.0), -1),
    ],
)
def test_a_centre_is_on_a_side_of_a_face_or_on_the_one_it_moves_to(place, speed, side):
    assert faces.face_side(SLOPE, *place, *speed) == side


FLOOR = faces.face(0.0, 1.0, 4.0, 1.0)
"""Along x at y = 1, normal (0, 1)."""


@pytest.mark.parametrize(
    ("flight", "gravity", "radius", "met", "expected"),
    [
        ((1.0, 4.0, 0.0, -2.0), None, 1.0, 0, (1.0, 1)),
        ((1.0, -2.0, 0.0, 2.0), None, 1.0, 0, (1.0, -1)),
        ((1.0, 4.0, 0.0, 2.0), None, 1.0, 0, (NEVER, 1)),
        ((1.0, 4.0, 0.0, -2.0), None, 1.0, 1, (NEVER, 1)),  # it met this face last and flies straight
        ((1.0, 4.0, 3.0, -2.0), None, 1.0, 0, (1.0, 1)),  # the foot at the very end counts
        ((1.0, 4.0, 4.0, -2.0), None, 1.0, 0, (NEVER, 1)),
        ((0.0, 4.0, 0.0, -2.0), None, 1.0, 0, (1.0, 1)),
        ((0.0, 4.0, -1.0, -2.0), None, 1.0, 0, (NEVER, 1)),
        ((1.0, 4.0, 0.0, 0.0), (0.0, -4.0), 1.0, 0, (1.0, 1)),
        ((1.0, 2.0, 1.0, 2.0), (0.0, -4.0), 1.0, 1, (1.0, 1)),  # a hop from the face that it met last
        ((1.0, 2.0, 1.0, 2.0), (2.0, -4.0), 1.0, 1, (1.0, 1)),
        ((1.0, 2.0, 2.0, 2.0), (4.0, -4.0), 1.0, 1, (NEVER, 1)),  # the foot is beyond the end by then
        ((1.0, 4.0, 0.0, 0.0), (0.0, 4.0), 1.0, 0, (NEVER, 1)),
        ((1.0, 0.0, 0.0, 0.0), (0.0, 4.0), 0.5, 0, (0.5, -1)),
        # A point below the floor, beside it, that rises past it and falls back onto it.
        ((-3.0, 0.0, 3.0, 3.0), (0.0, -4.0), 0.0, 0, (1.0, 1)),
    ],
)
def test_a_disk_meets_a_face_where_its_foot_is_on_it(flight, gravity, radius, met, expected):
    gx, gy = gravity or (None, None)
    assert faces.face_delay(FLOOR, *flight, gx, gy, radius, met) == expected


def test_a_slanted_face_is_met_at_its_distance():
    # From (0, 7): the distance is (-3 (0 - 1) + 4 (7 - 2)) / 5 = 4.6, and the disk comes along the normal.
    delay, side = faces.face_delay(SLOPE, 1.5, 6.5, 3.0, -4.0, None, None, 0.5, 0)
    distance = (-3.0 * 0.5 + 4.0 * 4.5) / 5.0
    assert side == 1
    assert delay == pytest.approx((distance - 0.5) / 5.0, rel=2.0**-50)


@pytest.mark.parametrize(
    ("mass", "du", "dw", "expected"),
    [(2.0, 3.0, -4.0, 10.0), (2.0, -0.1, 0.0, 0.2), (2.0, 0.0, 1e-200, 2e-200), (0.0, 1.0, 1.0, 0.0), (3.0, 0.0, 0.0, 0.0)],
)
def test_a_wall_gives_the_mass_times_the_change_of_velocity(mass, du, dw, expected):
    assert impulse.wall_impulse(mass, du, dw) == expected


@pytest.mark.parametrize("power", [-800, 0, 800])
def test_what_a_wall_gives_is_known_where_squares_are_no_floats(power):
    size = 2.0**power
    assert impulse.wall_impulse(2.0, 3.0 * size, -4.0 * size) == 10.0 * size


def test_where_there_is_no_direction_there_is_no_speed_along_it():
    assert impulse.along(3.0, 4.0, 10.0) == (6.0, 8.0)
    assert impulse.along(0.0, 0.0, 10.0) == (0.0, 0.0)
    assert impulse.approach_speed(3.0, 4.0, -5.0, 0.0) == 3.0
    assert impulse.approach_speed(0.0, 0.0, -5.0, 0.0) == 0.0


@pytest.mark.parametrize(
    ("difference", "period", "image"),
    [(0.75, 1.0, -0.25), (-0.75, 1.0, 0.25), (0.5, 1.0, 0.5), (-0.5, 1.0, -0.5), (0.75, None, 0.75), (0.75, INF, 0.75)],
)
def test_the_nearest_image_is_within_half_a_period(difference, period, image):
    assert nearest_image(difference, period) == image


@pytest.mark.parametrize(
    ("parabola", "side", "moment"),
    [
        ((1, -3, 8), -1, Moment(Fraction(3), -1, Fraction(1))),
        ((-1, 3, -8), -1, Moment(Fraction(3), 1, Fraction(1))),
        ((1, 0, 8), 1, None),
        ((0, 2, -8), 1, Moment(Fraction(2))),
        ((0, 0, 8), 1, None),
    ],
)
def test_exact_roots_of_a_parabola_and_of_a_line(parabola, side, moment):
    assert quadratic_root(*map(Fraction, parabola), side) == moment


def test_what_a_wall_gives_an_immovable_disk_is_not_known():
    assert math.isnan(impulse.wall_impulse(INF, 1.0, 0.0))
