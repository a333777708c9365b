"""Posts, containers and arcs on numbers whose results are exact; along parabolas to some last bits."""

import math
from fractions import Fraction

import pytest
from mpmath import mp, mpf

from eventsim.formulas.contact import inner_delay
from eventsim.formulas.real import NEVER
from eventsim.formulas.walls.arc import arc, arc_delay, arc_side, on_arc
from eventsim.formulas.walls.container import Container, container_delay
from eventsim.formulas.walls.ellipse import Ellipse
from eventsim.formulas.walls.face import face
from eventsim.formulas.walls.post import Post, post_delay

BITS = 2.0**-45
"""What bisection may leave of a delay along a parabola, in its own units."""

TOP = arc(5.0, 3.0, 2.0, 4.0, -1.0, 3.0)
"""Of the circle of radius 5 around (2, -1) the part above, between the directions (3, 4) and (-3, 4)."""
CUP = arc(5.0, 3.0, 2.0, -6.0, -1.0, 3.0)
"""The rest of the circle."""


@pytest.mark.parametrize(
    ("points", "sign"),
    [
        ((5.0, 3.0, 2.0, 4.0, -1.0, 3.0), -1.0),
        ((5.0, 3.0, 2.0, -6.0, -1.0, 3.0), 1.0),
        ((5.0, 3.0, 6.0, 2.0, 5.0, -5.0), 1.0),
        ((6.0, 2.0, 5.0, 3.0, -1.0, 3.0), -1.0),
        ((-1.0, 3.0, 5.0, 3.0, 6.0, 2.0), 1.0),
    ],
)
def test_an_arc_has_the_circle_through_its_points(points, sign):
    for size in (1.0, 2.0**-5):
        x0, y0, xm, ym, x1, y1 = (value * size for value in points)
        shape = arc(x0, y0, xm, ym, x1, y1)
        assert (shape.x + shape.ux, shape.y + shape.uy) == (2.0 * size, -size)
        assert (shape.radius, shape.low, shape.sign) == (5.0 * size, 0.0, sign)
        assert (shape.x, shape.y, shape.ex, shape.ey) == (x0, y0, x1 - x0, y1 - y0)


def test_a_normal_points_to_the_disk():
    assert Container(1.0, 2.0, 9.0).normal(-1, 4.0, 6.0) == (-3.0, -4.0)
    assert Post(1.0, 2.0).normal(1, 4.0, 6.0) == (3.0, 4.0)


@pytest.mark.parametrize("gravity", [(None, None), (0.0, 0.0)])
def test_a_post_is_met_in_straight_flight_unless_it_was_met_last(gravity):
    flight = -8.0, -10.0, 3.0, 4.0
    assert post_delay(Post(1.0, 2.0), *flight, *gravity, 5.0, 0) == (2.0, 1)
    assert post_delay(Post(1.0, 2.0), *flight, *gravity, 5.0, 1) == (NEVER, 1)


@pytest.mark.parametrize(
    ("place", "gravity"),
    [((1.0, 7.0), (0.0, -2.0)), ((6.0, 2.0), (-2.0, 0.0)), ((-2.0, 2.0), (1.0, 0.0)), ((1.0, -1.0), (0.0, 1.0))],
)
@pytest.mark.parametrize("met", [0, 1])
def test_a_disk_of_radius_1_falls_onto_a_post_from_each_side(place, gravity, met):
    assert post_delay(Post(1.0, 2.0), *place, 0.0, 0.0, *gravity, 1.0, met) == (pytest.approx(2.0, rel=BITS), 1)


INSIDE = [
    # relative place, velocity -> delay to a circle of radius 5
    ((2.0, 2.0, 1.0, 2.0), 1.0),  # outward
    ((2.0, 2.0, 0.125, 0.25), 8.0),
    ((0.0, -2.0, 1.0, 2.0), 3.0),  # inward
    ((0.0, 0.0, 3.0, 4.0), 1.0),
    ((3.0 - 3.0 / 64.0, 4.0 - 4.0 / 64.0, 3.0, 4.0), 1.0 / 64.0),
    ((3.0, 4.0, 3.0, 4.0), 0.0),
    ((6.0, 8.0, 3.0, 4.0), 0.0),  # beyond it, and on its way out
    ((6.0, 8.0, 0.0, 0.0), NEVER),
    ((1.0, 1.0, 0.0, 0.0), NEVER),
    ((10.0, 8.0, -2.0, 0.0), 5.0),  # beyond it, past it: where it is nearest
]


@pytest.mark.parametrize(("flight", "delay"), INSIDE)
@pytest.mark.parametrize("gravity", [(None, None), (0.0, 0.0)])
def test_a_container_is_met_from_inside(flight, delay, gravity):
    dx, dy, vx, vy = flight
    assert inner_delay(*flight, 5.0) == delay
    assert container_delay(Container(1.0, 2.0, 7.0), 1.0 + dx, 2.0 + dy, vx, vy, *gravity, 2.0, 0) == (delay, -1)


@pytest.mark.parametrize("gravity", [(0.0, -2.0), (-2.0, 0.0), (0.0, 2.0), (2.0, 0.0)])
def test_a_disk_falls_from_the_middle_of_a_container_to_its_edge(gravity):
    assert container_delay(Container(1.0, 2.0, 10.0), 1.0, 2.0, 0.0, 0.0, *gravity, 1.0, 0) == (
        pytest.approx(3.0, rel=BITS),
        -1,
    )
    half = gravity[0] / 2, gravity[1] / 2
    assert container_delay(Container(1.0, 2.0, 10.0), 1.0, 2.0, 0.0, 0.0, *half, 2.0, 0)[0] == pytest.approx(
        4.0, rel=BITS
    )


@pytest.mark.parametrize(
    ("shape", "place", "is_on"),
    [
        (TOP, (2.0, 0.0), True),
        (TOP, (2.0, -2.0), False),
        (TOP, (2.0, -1.0), False),  # the centre has no ray
        (TOP, (8.0, 7.0), True),  # through an end
        (TOP, (3.5, 1.0), True),
        (TOP, (8.0, 6.75), False),
        (TOP, (3.5, 0.75), False),
        (TOP, (-4.0, 7.0), True),
        (TOP, (-4.0, 6.75), False),
        (CUP, (2.0, 0.0), False),
        (CUP, (2.0, -2.0), True),
        (CUP, (8.0, 6.75), True),
        (CUP, (8.0, 7.25), False),
        (arc(6.0, 2.0, 5.0, 3.0, -1.0, 3.0), (10.0, 5.0), True),
        (arc(6.0, 2.0, 5.0, 3.0, -1.0, 3.0), (10.0, 4.75), False),
        (arc(6.0, 2.0, 5.0, 3.0, -1.0, 3.0), (-4.0, 7.0), True),
        (arc(6.0, 2.0, 5.0, 3.0, -1.0, 3.0), (-4.0, 6.75), False),
        (arc(5.0, 3.0, 6.0, 2.0, 5.0, -5.0), (3.0, -1.0), True),
        (arc(5.0, 3.0, 6.0, 2.0, 5.0, -5.0), (1.0, -1.0), False),
        (arc(5.0, 3.0, 6.0, 2.0, 5.0, -5.0), (8.0, -9.0), True),
        (arc(5.0, 3.0, 6.0, 2.0, 5.0, -5.0), (7.75, 7.0), False),
    ],
)
def test_a_ray_from_the_centre_meets_the_arc_or_its_gap(shape, place, is_on):
    assert on_arc(shape, *place) is is_on


@pytest.mark.parametrize(
    ("place", "speed", "side"),
    [
        ((2.0, -1.0), (0.0, 0.0), -1),
        ((9.0, 9.0), (0.0, 0.0), 1),
        ((5.0625, 3.0), (-1.0, 0.0), 1),
        ((4.9375, 3.0), (1.0, 0.0), -1),
        # on the circle, at (3, 4) from its centre: where it moves to
        ((5.0, 3.0), (1.0, 0.0), 1),
        ((5.0, 3.0), (-1.0, 0.0), -1),
        ((5.0, 3.0), (0.0, 0.0), -1),
        ((5.0, 3.0), (4.0, -3.0), -1),
        ((5.0, 3.0), (0.125, 0.0), 1),
        ((5.0, 3.0), (-3.0, 2.5), 1),
        ((5.0, 3.0), (3.0, -2.5), -1),
    ],
)
def test_a_centre_is_outside_or_inside_the_circle_of_an_arc(place, speed, side):
    assert arc_side(TOP, *place, *speed) == side


STRAIGHT = [
    # place relative to the centre, velocity, radius, side met last -> delay, side
    (TOP, (0.0, 12.0, 0.0, -3.0), 1.0, 0, (2.0, 1)),
    (TOP, (-2.0, 14.0, 1.0, -2.0), 5.0, 0, (2.0, 1)),
    (TOP, (0.0, 12.0, 0.0, 3.0), 1.0, 0, (NEVER, 1)),
    (TOP, (20.0, 0.0, -2.0, 0.0), 5.0, 0, (NEVER, 1)),
    (TOP, (20.0, 0.0, -2.0, 0.0), 1.0, 0, (NEVER, 1)),
    (TOP, (0.0, -16.0, 0.0, 2.0), 1.0, 0, (10.0, -1)),  # through the open part
    (TOP, (-8.0, -11.0, 1.0, 2.0), 0.0, 0, (8.0, -1)),
    (TOP, (-2.0, 1.0, 1.0, 2.0), 0.0, 0, (2.0, -1)),
    (TOP, (0.0, 1.0, 0.0, -1.0), 0.0, 0, (NEVER, -1)),
    (TOP, (0.0, -22.0, 0.0, 2.0), 6.0, 0, (NEVER, 1)),  # too large for the inside
    (TOP, (-20.0, 4.5, 2.0, 0.0), 1.0, 0, (NEVER, 1)),  # beside its end, where a post stands
    (TOP, (0.0, 5.0, 0.0, 1.0), 0.0, 0, (NEVER, 1)),  # points on the circle
    (TOP, (0.0, 5.0, 0.0, -1.0), 0.0, 0, (NEVER, -1)),
    (TOP, (0.0, 5.0, 0.0, 1.0), 0.0, -1, (0.0, -1)),
    (TOP, (0.0, 6.0, 0.0, -1.0), 1.0, 1, (NEVER, 1)),
    (CUP, (0.0, -4.0, 2.0, 2.0), 1.0, -1, (2.0, -1)),
    (CUP, (3.0, -4.0, -3.0, 0.0), 0.0, 1, (2.0, -1)),
    (CUP, (20.0, 0.0, -2.0, 0.0), 1.0, 0, (7.0, 1)),
    (TOP, (-3.0, 16.0, 32.0, -16.0), 8.0, 0, (0.25, 1)),  # at (5, 12) and (12, 5) from the centre
    (TOP, (-3.0, 16.0, 2.0, -1.0), 8.0, 0, (4.0, 1)),
    (CUP, (16.0, 13.0, -1.0, -2.0), 8.0, 0, (4.0, 1)),
]


@pytest.mark.parametrize(("shape", "flight", "radius", "met", "expected"), STRAIGHT)
@pytest.mark.parametrize("gravity", [(None, None), (0.0, 0.0)])
def test_an_arc_is_met_where_it_is(shape, flight, radius, met, expected, gravity):
    dx, dy, vx, vy = flight
    assert arc_delay(shape, 2.0 + dx, dy - 1.0, vx, vy, *gravity, radius, met) == expected


LITTLE = 2.0**-40

FALLING = [
    # place relative to the centre, velocity, gravity, radius, side met last -> delay, side
    (TOP, (0.0, 10.0, 0.0, 0.0), (0.0, -2.0), 1.0, 0, (2.0, 1)),
    (TOP, (0.0, 0.0, 0.0, 0.0), (0.0, 2.0), 1.0, 0, (2.0, -1)),
    (TOP, (0.0, 0.0, 0.0, 0.0), (0.0, -2.0), 1.0, 0, (NEVER, -1)),
    (TOP, (0.0, 14.0, 0.0, 0.0), (0.0, -2.0), 5.0, 0, (2.0, 1)),
    (TOP, (0.0, -22.0, 0.0, 0.0), (0.0, 2.0), 6.0, 0, (NEVER, 1)),
    (TOP, (0.0, 0.0, -2.0, 3.0), (2.0, -1.0), 1.0, 0, (2.0, -1)),
    (CUP, (0.0, 0.0, 0.0, 0.0), (1.0, 0.0), 3.0, 0, (2.0, -1)),
    (CUP, (0.0, 0.0, 0.0, 0.0), (0.0, -1.0), 3.0, 0, (2.0, -1)),
    (CUP, (0.0, 0.0, 2.0, 4.0), (0.0, -4.0), 1.0, 0, (2.0, -1)),
    (CUP, (0.0, 0.0, 2.0, -4.0), (0.0, 4.0), 1.0, 0, (2.0, -1)),
    (TOP, (0.0, 0.0, 0.0, 0.0), (0.0, 1.0), 3.0, 0, (2.0, -1)),
    (CUP, (0.0, 20.0, 0.0, 0.0), (0.0, -2.0), 1.0, 0, (24.0**0.5, -1)),  # through the open part
    # an overlap that falls is due now on the side where the disk is, and no contact on the other one
    (TOP, (0.0, 6.0 - LITTLE, 0.0, -1.0), (0.0, -2.0), 1.0, 1, (0.0, 1)),
    (TOP, (0.0, 6.0 - LITTLE, 0.0, -1.0), (0.0, -2.0), 1.0, 0, (0.0, 1)),
    (TOP, (0.0, 5.0 - LITTLE, 0.0, -1.0), (0.0, -2.0), 0.0, 1, (0.0, 1)),
    (TOP, (0.0, 5.0 + LITTLE, 0.0, 1.0), (0.0, 2.0), 0.0, -1, (0.0, -1)),
    (TOP, (0.0, 5.0, 0.0, -1.0), (0.0, -2.0), 0.0, 0, (NEVER, -1)),  # points on the circle
    (TOP, (0.0, 5.0, 0.0, 1.0), (0.0, -2.0), 0.0, 0, (1.0, 1)),
]


@pytest.mark.parametrize(("shape", "flight", "gravity", "radius", "met", "expected"), FALLING)
def test_a_falling_disk_meets_an_arc_where_it_is(shape, flight, gravity, radius, met, expected):
    dx, dy, vx, vy = flight
    delay, side = arc_delay(shape, 2.0 + dx, dy - 1.0, vx, vy, *gravity, radius, met)
    assert (delay, side) == (pytest.approx(expected[0], rel=BITS), expected[1])


@pytest.mark.parametrize("angle", [0.0, 0.3, 2.0, 4.0])
def test_a_disk_is_laid_onto_a_round_wall_along_its_normal(angle):
    along = math.cos(angle), math.sin(angle)
    for shape, side, distance in (
        (Post(1.0, 2.0), 1, 0.5),
        (Container(1.0, 2.0, 3.0), -1, 2.5),
        (arc(4.0, 2.0, 1.0, 5.0, -2.0, 2.0), 1, 3.5),
        (arc(4.0, 2.0, 1.0, 5.0, -2.0, 2.0), -1, 2.5),
    ):
        x, y = 1.0 + distance * along[0], 2.0 + distance * along[1]
        for shift in (0.0, 1e-6, -1e-6):
            at = shape.touching(side, x + shift * along[0], y + shift * along[1], 0.5)
            assert at == pytest.approx((x, y), abs=2.0**-50)


def test_a_point_stays_where_it_meets_a_post():
    assert Post(1.0, 2.0).touching(1, 1.0, 2.0, 0.0) == (1.0, 2.0)
    assert Post(1.0, 2.0).touching(1, 1.0 + 2.0**-50, 2.0, 0.0) == (1.0 + 2.0**-50, 2.0)


@pytest.mark.parametrize("sagitta", [1e-1, 1e-6, 1e-11, -1e-11])
@pytest.mark.parametrize("side", [1, -1])
def test_a_disk_is_laid_onto_a_nearly_flat_arc_as_exactly_as_onto_a_line(sagitta, side):
    """The centre is up to 1e11 away, so places relative to it have no digits left."""
    shape = arc(1.0, 1.0, 2.0, 1.0 + sagitta, 3.0, 1.0)
    x, y = shape.touching(side, 1.75, 1.0 + 1e-9, 0.25)
    with mp.workdps(50):
        reach = mpf(shape.radius) + mpf(shape.low) + mpf(side) * mpf(0.25)
        gap = mp.hypot((mpf(x) - mpf(shape.x)) - mpf(shape.ux), (mpf(y) - mpf(shape.y)) - mpf(shape.uy)) - reach
    assert abs(gap) < 2.0**-51


@pytest.mark.parametrize("sagitta", [1e-2, 5e-4, 1e-5, 1e-7, -5e-4])
@pytest.mark.parametrize(("height", "side"), [(0.5, 1), (-0.5, -1)])
def test_the_time_of_a_nearly_flat_arc_is_known_as_well_as_places(sagitta, height, side):
    """Not as well as distances from its centre, which have ten digits more to lose."""
    shape = arc(1.0, 1.0, 2.0, 1.0 + sagitta, 3.0, 1.0)
    for k in range(20):
        x, y, u, w, r = 1.3 + 0.05 * k, 1.0 + height, 0.3 - 0.02 * k, -height - 0.03 * k * height, 0.05
        delay, met = arc_delay(shape, x, y, u, w, None, None, r, 0)
        with mp.workdps(50):
            circle = mpf(shape.radius) + mpf(shape.low)
            dx, dy = mpf(x) - shape.x - mpf(shape.ux), mpf(y) - shape.y - mpf(shape.uy)
            outside = met if sagitta > 0 else -met
            reach = circle + met * mpf(r)
            a, b, c = mpf(u) ** 2 + mpf(w) ** 2, dx * u + dy * w, dx * dx + dy * dy - reach**2
            true = (-b - met * mp.sqrt(b * b - a * c)) / a
        assert outside == side
        assert abs(delay - true) < 2.0**-52


SLOPE = face(1.0, 2.0, 5.0, 5.0)
MANY_DIGITS = [
    # shape, straight flight, radius, side met last -> delay, side
    (SLOPE, (-1.5, 9.5, 1.5, -2.0), 2.5, 0, (2.0, 1)),
    (SLOPE, (20.0, 11.0, 1.5, -2.0), 2.5, 0, (NEVER, -1)),
    (TOP, (2.0, 10.0, 0.0, -2.0), 1.0, 0, (2.5, 1)),
    (TOP, (2.0, -1.0, 0.0, 2.0), 1.0, 0, (2.0, -1)),
    (Container(2.0, -1.0, 5.0), (2.0, -1.0, 0.0, 2.0), 1.0, -1, (2.0, -1)),
    (Post(1.0, 2.0), (-8.0, -10.0, 3.0, 4.0), 5.0, 0, (2.0, 1)),
    (Ellipse(0.0, 0.0, 1.0, 0.0, 1.0, 2.0, 1.0, 2.0), (0.0, 0.0, 1.0, 0.0), 0.0, 0, (2.0, -1)),
]


@pytest.mark.parametrize(("shape", "flight", "radius", "met", "expected"), MANY_DIGITS)
def test_shapes_are_met_alike_in_numbers_of_more_digits(shape, flight, radius, met, expected):
    with mp.workdps(40):
        delay, side = shape.in_numbers(mpf).delay(*map(mpf, flight), None, None, mpf(radius), met)
        assert side == expected[1]
        assert delay == expected[0] or abs(delay - expected[0]) < mpf(10) ** -30


def test_a_disk_on_a_wall_in_numbers_of_more_digits_is_there():
    for shape in (SLOPE, TOP):
        assert shape.in_numbers(mpf).touching(1, mpf(3), mpf(8), mpf(2)) == (3, 8)


def test_the_middle_of_a_container_and_of_an_arc_is_near_nothing():
    assert Container(2.0, -1.0, 5.0).nearest(2.0, -1.0) == (0.0, 0.0, NEVER)
    assert Container(2.0, -1.0, 5.0).nearest(2.0, 2.0) == (0.0, -1.0, 2.0)
    assert TOP.nearest(2.0, -1.0) == (0.0, 0.0, NEVER)
    assert TOP.nearest(2.0, -5.0) == (0.0, 0.0, NEVER)  # beside it
    assert TOP.nearest(2.0, 2.0) == (0.0, -1.0, 2.0)
    assert TOP.nearest(2.0, 5.0) == (0.0, 1.0, 1.0)
    assert Post(1.0, 2.0).nearest(1.0, 2.0) == (0.0, 0.0, NEVER)
    assert Post(1.0, 2.0).nearest(4.0, 6.0) == (0.6, 0.8, 5.0)


def test_the_centre_of_an_arc_is_laid_onto_no_place_of_it():
    assert TOP.touching(-1, 2.0, -1.0, 1.0) == (2.0, -1.0)
    assert TOP.touching(-1, 2.0, 3.0, 5.0) == (2.0, 3.0)  # of a disk as large as the circle


def test_exact_times_of_contacts_with_an_arc_and_a_slope():
    one, none = Fraction(1), Fraction(0)
    rising = TOP.moment((Fraction(2), none, none), (-one, 2 * one, none), -1, 1.0)
    assert rising is not None
    assert (rising.place, rising.side * math.isqrt(int(rising.square))) == (0, 2)
    assert SLOPE.moment((none, 4 * one, none), (none, 3 * one, none), 1, 1.0) is None  # along the slope
