"""A disk inside a circle, against exact rationals: on the way out near it, along it, across it, at any speed."""

import math
import random
from fractions import Fraction

import pytest

from eventsim.formulas.contact import leaving_delay, screened_inner_delay
from eventsim.formulas.digits import careful_pair_delay
from eventsim.formulas.real import NEVER
from tests.formulas.test_digits import LAST_BIT, root

# c and D lose 12 bits at most, and distances the bits by which coordinates are larger than the circle
ERROR = 64 * 2.0**-53 * 2.0**12
PLAIN, CAREFUL, RESCALED = {"across", "in"}, {"out", "along"}, {"slow"}


def exact_delay(x, y, u, w, radius, cx, cy, circle):
    """The delay to 400 bits."""
    x, y, u, w, radius, cx, cy, circle = map(Fraction, (x, y, u, w, radius, cx, cy, circle))
    dx, dy, reach = x - cx, y - cy, circle - radius
    a, b, c = u * u + w * w, dx * u + dy * w, dx * dx + dy * dy - reach * reach
    if b > 0 and c >= 0:
        return Fraction(0)
    discriminant = b * b - a * c
    return ((root(discriminant) if discriminant > 0 else 0) - b) / a


def flight_of(kind, rng):
    """A disk in a circle: arguments of leaving_delay."""
    circle, radius = rng.uniform(1.0, 10.0), rng.uniform(0.0, 0.9)
    cx, cy, angle, heading = rng.uniform(-5, 5), rng.uniform(-5, 5), rng.uniform(0, 7), rng.uniform(0, 7)
    distance = (circle - radius) * (rng.random() if kind in ("across", "slow") else 1 - 10.0 ** rng.uniform(-17, -4))
    if kind == "out":
        heading = angle + rng.uniform(-1.5, 1.5)
    elif kind == "in":
        heading = angle + math.pi + rng.uniform(-1.4, 1.4)
    elif kind == "along":
        heading = angle + 0.5 * math.pi * rng.choice([-1, 1]) + rng.choice([-1, 1]) * 10.0 ** rng.uniform(-16, -3)
    speed = 1e-160 if kind == "slow" else 1.0
    place = cx + distance * math.cos(angle), cy + distance * math.sin(angle)
    return (*place, speed * math.cos(heading), speed * math.sin(heading), radius, cx, cy, circle)


@pytest.mark.parametrize("kind", sorted(PLAIN | CAREFUL | RESCALED))
def test_the_edge_of_a_circle_is_met_when_the_rationals_say(kind):
    rng = random.Random(kind)
    for _ in range(500):
        flight = x, y, u, w, radius, cx, cy, circle = flight_of(kind, rng)
        found, true = leaving_delay(*flight), exact_delay(*flight)
        doubted = math.isnan(screened_inner_delay(x - cx, y - cy, u, w, circle - radius))
        assert doubted == (kind not in PLAIN) or kind == "across"
        assert abs(Fraction(found) - true) <= true * Fraction(LAST_BIT if doubted and kind not in RESCALED else ERROR)


@pytest.mark.parametrize("sign", [1, -1])
def test_what_only_exact_numbers_tell_is_told(sign):
    """The last bits of place and radius decide on which side of the circle a disk is that moves out or along it."""
    edge = 5.0 + sign * 2.0**-50
    assert leaving_delay(3.0, 4.0, 3.0, 4.0, 1.0, 0.0, 0.0, edge + 1.0) == (2.0**-50 / 5.0 if sign > 0 else 0.0)
    # half a chord: sqrt(edge^2 - 25) along the tangent, nothing from outside
    along = leaving_delay(3.0, 4.0, -4.0, 3.0, 0.0, 0.0, 0.0, edge)
    assert along == (math.sqrt(10.0 * 2.0**-50) / 5.0 if sign > 0 else 0.0)


def test_at_rest_nothing_is_met():
    assert leaving_delay(1.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 5.0) == NEVER
    assert careful_pair_delay(1.0, 1.0, 0.0, 0.0, 0.0, -1.0, *([0.0] * 5), 5.0, 0.0, 0.0, -1.0) == NEVER


def test_on_the_circle_and_on_the_way_in_the_whole_chord_is_ahead():
    assert careful_pair_delay(3.0, 4.0, -3.0, -4.0, 0.0, -1.0, *([0.0] * 5), 6.0, 0.0, 0.0, -1.0) == 2.0
    assert careful_pair_delay(6.0, 8.0, -3.0, -4.0, 0.0, -1.0, *([0.0] * 5), 6.0, 0.0, 0.0, -1.0) == 3.0
