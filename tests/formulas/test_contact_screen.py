"""The screen before the plain formula: what it tells is right, what it cannot tell it says."""

import math
import random

import pytest

from eventsim.formulas.contact import DIGITS_LOST, screened_pair_delay
from eventsim.formulas.digits import careful_pair_delay
from eventsim.formulas.real import NEVER

# c and D lose 12 bits at most, and each is a sum of a few rounded products
ERROR = 16 * 2.0**-53 / DIGITS_LOST


def delays(dx, dy, du, dw, reach=1.0):
    """(screened, careful) delay of a disk at (dx, dy) and one at rest in the origin."""
    return (
        screened_pair_delay(dx, dy, du, dw, reach),
        careful_pair_delay(dx, dy, du, dw, 0.0, 0.5 * reach, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5 * reach, 0.0, 0.0),
    )


@pytest.mark.parametrize("far", [1.001, 1.1, 3.0, 100.0, 1e6])
def test_the_screen_never_tells_a_wrong_thing(far):
    rng = random.Random(far)
    told = 0
    for _ in range(3000):
        distance = 1.0 + (far - 1.0) * rng.random()
        angle, aim = (
            rng.uniform(0, 7),
            math.asin(1.0 / distance) * rng.choice([rng.uniform(-2, 2), 1 + rng.gauss(0, 1e-4)]),
        )
        speed = 10.0 ** rng.uniform(-3, 3)
        screened, careful = delays(
            -distance * math.cos(angle),
            -distance * math.sin(angle),
            speed * math.cos(angle + aim),
            speed * math.sin(angle + aim),
        )
        if not math.isnan(screened):
            told += 1
            assert screened == careful or abs(screened - careful) <= ERROR * careful
    assert told > 500


@pytest.mark.parametrize(
    "pair",
    [
        (-1.0 - 1e-9, 0.0, 1.0, 0.0),  # near contact
        (-1.0, 0.0, 1.0, 0.0),  # contact
        (-0.9, 0.0, 1.0, 0.0),  # overlap
        (-3.0, 1.0 - 2.0**-53, 1.0, 0.0),  # a graze that is a hit
        (-3.0, 1.0, 1.0, 0.0),  # tangent
        (-3.0, 1.0 + 2.0**-52, 1.0, 0.0),  # a miss
        (-3.0, 0.0, 1e-200, 0.0),  # squares underflow
        (-3.0, 0.0, 1e200, 0.0),  # squares overflow
        (-3.0, 0.3, 1e-320, 0.0),
    ],
)
def test_what_floats_cannot_tell_is_doubted(pair):
    assert math.isnan(delays(*pair)[0])


def test_what_recedes_or_passes_far_away_is_told():
    assert delays(3.0, 0.0, 1.0, 0.0)[0] == NEVER
    assert delays(-3.0, 2.0, 1.0, 0.0)[0] == NEVER
    assert delays(-3.0, 0.0, 0.0, 1.0)[0] == NEVER


def test_exchange_changes_no_bit():
    rng = random.Random(5)
    for _ in range(500):
        dx, dy, du, dw = (rng.gauss(0, 3) for _ in range(4))
        one, other = screened_pair_delay(dx, dy, du, dw, 1.0), screened_pair_delay(-dx, -dy, -du, -dw, 1.0)
        assert one == other or (math.isnan(one) and math.isnan(other))
