"""Every wall shape: the gap is zero at the contact, there is no earlier contact, the normal is the gradient of the gap."""

import math

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from eventsim.formulas.motion import position
from eventsim.formulas.real import NEVER
from eventsim.formulas.walls.arc import arc, arc_delay, on_arc
from eventsim.formulas.walls.container import Container
from eventsim.formulas.walls.face import face, face_delay
from eventsim.formulas.walls.post import Post

FACE = face(-1.0, -0.3, 1.2, 0.4)
POST = Post(0.2, -0.1)
CONTAINER = Container(0.1, 0.2, 4.0)
ARC = arc(1.0, 0.0, 0.0, 1.1, -0.9, -0.2)

ROUNDING = 1e-13  # a foot so far beyond an end without a post is on the wall

coordinate = st.floats(-2.5, 2.5)
speed = st.floats(-2.0, 2.0)
radius = st.sampled_from([0.0, 0.1, 0.45])
gravity = st.sampled_from([(None, None), (0.0, -1.0), (0.3, 0.7)])


def face_gap(x, y, r):
    """Distance from the segment, less the radius; inf where the foot lies beyond its ends, which are posts."""
    along = (FACE.ex * (x - FACE.x) + FACE.ey * (y - FACE.y)) / FACE.along2
    if not -ROUNDING <= along <= 1.0 + ROUNDING:
        return math.inf
    return abs(FACE.nx * (x - FACE.x) + FACE.ny * (y - FACE.y)) / FACE.norm - r


def post_gap(x, y, r):
    return math.hypot(x - POST.x, y - POST.y) - r


def container_gap(x, y, r):
    return CONTAINER.radius - r - math.hypot(x - CONTAINER.x, y - CONTAINER.y)


def arc_gap(x, y, r):
    if not on_arc(ARC, x, y, ROUNDING, ROUNDING):
        return math.inf
    return abs(math.hypot(x - ARC.x - ARC.ux, y - ARC.y - ARC.uy) - ARC.radius) - r


SHAPES = {
    "face": (FACE, face_gap),
    "post": (POST, post_gap),
    "container": (CONTAINER, container_gap),
    "arc": (ARC, arc_gap),
}

SAMPLES, HORIZON = 400, 6.0


def at(t, x, y, vx, vy, gx, gy):
    return position(x, vx, t, gx), position(y, vy, t, gy)


@pytest.mark.parametrize("name", SHAPES)
@settings(max_examples=150, deadline=None)
@given(data=st.data())
def test_the_gap_closes_at_the_contact_and_not_before(name, data):
    shape, gap = SHAPES[name]
    x, y, vx, vy = (data.draw(s) for s in (coordinate, coordinate, speed, speed))
    r, (gx, gy) = data.draw(radius), data.draw(gravity)
    assume(gap(x, y, r) > 1e-6)
    if name == "arc":  # a start between the two circles of the contact belongs to neither side
        assume(abs(math.hypot(x - ARC.x - ARC.ux, y - ARC.y - ARC.uy) - ARC.radius) > r + 1e-6)
    if name == "face":
        assume(abs(FACE.nx * (x - FACE.x) + FACE.ny * (y - FACE.y)) / FACE.norm > r + 1e-6)
    delay, side = shape.delay(x, y, vx, vy, gx, gy, r, 0)
    assert delay >= 0.0
    end = min(delay, HORIZON)
    # the gap of a thin wall or of a point is sampled, so only a deep overlap is evidence of a missed contact
    slack = 1e-9 if name == "container" or r == 0.0 else 1e-7 + 0.02 * r
    for k in range(SAMPLES):
        t = end * k / SAMPLES
        px, py = at(t, x, y, vx, vy, gx, gy)
        if name in ("face", "arc") and gap(px, py, r) < -slack:
            # it may be inside the band only where it came in beyond an end, through the post that stands there
            break
        assert gap(px, py, r) > -slack
    if delay < NEVER and delay < 1e3:
        px, py = at(delay, x, y, vx, vy, gx, gy)
        assert gap(px, py, r) == pytest.approx(0.0, abs=1e-7 * (1.0 + delay))
        nx, ny = shape.normal(side, px, py)
        length = math.hypot(nx, ny)
        if length > 1e-6 and r > 0.0:
            step = 1e-5
            rise = gap(px + step * nx / length, py + step * ny / length, r)
            if rise < math.inf:
                assert rise == pytest.approx(step, abs=1e-6)


@given(st.floats(-0.9, 0.9), st.floats(0.1, 1.0))
def test_a_face_is_hard_on_both_sides(along, up):
    middle_x, middle_y = FACE.x + FACE.ex * (0.5 + 0.4 * along), FACE.y + FACE.ey * (0.5 + 0.4 * along)
    for side in (1, -1):
        nx, ny = side * FACE.nx / FACE.norm, side * FACE.ny / FACE.norm
        delay, met = face_delay(FACE, middle_x + up * nx, middle_y + up * ny, -nx, -ny, None, None, 0.05, 0)
        assert met == side
        assert delay == pytest.approx(up - 0.05, abs=1e-12)


def test_a_face_that_was_met_last_is_not_met_again_in_straight_flight():
    assert face_delay(FACE, 0.0, 0.0, 0.1, 0.1, None, None, 0.1, 1)[0] == NEVER


def test_a_parabola_passes_beside_a_wall_and_meets_its_far_side():
    """Thrown up past the right end of a shelf, it lands on top of it."""
    shelf = face(-1.0, 0.0, 1.0, 0.0)
    delay, side = face_delay(shelf, 1.5, -0.5, -0.5, 2.0, 0.0, -2.0, 0.0, 0)
    assert side == 1
    assert delay == pytest.approx(1.0 + math.sqrt(0.5), abs=1e-12)


def test_an_arc_is_met_from_inside_after_passing_through_its_gap():
    half = arc(0.0, -1.0, 1.0, 0.0, 0.0, 1.0)  # the right half of the unit circle
    assert arc_delay(half, -3.0, 0.0, 1.0, 0.0, None, None, 0.1, 0) == (pytest.approx(3.9, rel=1e-15), -1)
    assert arc_delay(half, 3.0, 0.0, -1.0, 0.0, None, None, 0.1, 0) == (pytest.approx(1.9, rel=1e-15), 1)
    delay, side = arc_delay(half, -3.0, 0.0, 1.0, 0.0, 0.0, -1e-12, 0.1, 0)
    assert (delay, side) == (pytest.approx(3.9, abs=1e-9), -1)


def test_an_arc_goes_through_its_three_points():
    made = arc(1.0, 0.0, 1.5, 0.5, 1.0, 1.0)
    assert (made.x + made.ux, made.y + made.uy, made.radius) == (1.0, 0.5, 0.5)
    for x, y in ((1.0, 0.0), (1.5, 0.5), (1.0, 1.0)):
        assert on_arc(made, x, y)
    assert not on_arc(made, 0.5, 0.5)


def test_a_disk_thrown_past_the_end_of_a_wall_lands_on_its_far_side():
    flight = 2.0, -1.5, -1.5, 3.0
    assert face_delay(face(-1.0, 0.0, 1.0, 0.0), *flight, 0.5, -2.0, 0.5, 0) == (2.0, 1)
    turned = -1.5, 2.0, 3.0, -1.5  # x and y exchanged: the normal turns round
    assert face_delay(face(0.0, -1.0, 0.0, 1.0), *turned, -2.0, 0.5, 0.5, 0) == (2.0, -1)
    assert face_delay(face(-1.0, 0.0, 1.0, 0.0), *flight, 1.5, -2.0, 0.5, 0)[0] == NEVER  # beyond the end again
