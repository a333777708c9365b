"""The contact time that engines use, the plain formula behind its screen, against exact rationals.

What the plain formula doubts goes to careful arithmetic and is right to the last bit: pairs near contact, far away, at a graze,
large, slow and fast.  What it does not doubt is as right as a forward error bound of it says.
"""

import math
import random
from fractions import Fraction

import pytest

from eventsim.formulas.contact import NEAR, screened_pair_delay
from eventsim.formulas.digits import careful_pair_delay
from eventsim.formulas.real import NEVER
from tests.formulas.test_digits import CLASSES, exact_delay, pair_of

ROUNDING = 2.0**-53
RIGHT = 4e-16  # what careful times are held to; they come to half of it
ALWAYS_CAREFUL = {"near", "far", "graze", "large", "slow", "fast"}
"""Pairs of these classes that meet are all told by careful arithmetic."""


def filtered(pair):
    """(delay, whether the plain formula told it), as `engines.reference.predict` computes it."""
    xi, yi, ui, wi, ti, ri, xj, yj, uj, wj, tj, rj, shift_x, shift_y = pair
    lag_i, lag_j = max(ti, tj) - ti, max(ti, tj) - tj
    dx = (xi + ui * lag_i) - (xj + uj * lag_j) - shift_x
    dy = (yi + wi * lag_i) - (yj + wj * lag_j) - shift_y
    delay = screened_pair_delay(dx, dy, ui - uj, wi - wj, ri + rj)
    return (careful_pair_delay(*pair), False) if math.isnan(delay) else (delay, True)


def bound(pair):
    """What rounding may do to a delay told by the plain formula, relative to it: first order, and half as much for the rest."""
    xi, yi, ui, wi, ti, ri, xj, yj, uj, wj, tj, rj, shift_x, shift_y = map(float, pair)
    lag_i, lag_j = max(ti, tj) - ti, max(ti, tj) - tj
    dx, dy = (xi + ui * lag_i) - (xj + uj * lag_j) - shift_x, (yi + wi * lag_i) - (yj + wj * lag_j) - shift_y
    du, dw, reach = ui - uj, wi - wj, ri + rj
    # five roundings, none of a number larger than the sum of the terms
    error_x = 5.0 * ROUNDING * (abs(xi) + 2.0 * abs(ui * lag_i) + abs(xj) + 2.0 * abs(uj * lag_j) + abs(shift_x))
    error_y = 5.0 * ROUNDING * (abs(yi) + 2.0 * abs(wi * lag_i) + abs(yj) + 2.0 * abs(wj * lag_j) + abs(shift_y))
    c = dx * dx + dy * dy - reach * reach
    error_c = 2.0 * (abs(dx) * error_x + abs(dy) * error_y) + 5.0 * ROUNDING * (dx * dx + dy * dy + reach * reach)
    b = abs(dx * du) + abs(dy * dw)
    error_b = abs(du) * error_x + abs(dw) * error_y + 3.0 * ROUNDING * b
    cross, least = abs(dx * dw) + abs(dy * du), abs(dx * dw - dy * du)
    error_cross = abs(dw) * error_x + abs(du) * error_y + 3.0 * ROUNDING * cross
    a_reach2 = (du * du + dw * dw) * reach * reach
    root = math.sqrt(a_reach2 - least * least)
    error_root = (2.0 * least * error_cross + 8.0 * ROUNDING * a_reach2) / (2.0 * root)
    below = root + abs(dx * du + dy * dw)
    return 1.5 * (error_c / c + (error_b + error_root) / below + 3.0 * ROUNDING)


def judged(kind, rng, count):
    """(largest error of careful delays, of plain ones; shares of hits told plainly, and told so with an error above RIGHT)."""
    careful = plain = 0.0
    told = above = hits = 0
    for _ in range(count):
        pair = pair_of(kind, rng)
        true, (found, plainly) = exact_delay(*pair), filtered(pair)
        assert (true is None) == (found == NEVER)  # neither a false hit nor a miss
        if true is None or true == 0:
            assert found == (NEVER if true is None else 0.0)
            continue
        hits += 1
        error = float(abs(Fraction(found) - true) / true)
        if plainly:
            assert error <= bound(pair)
            told, plain, above = told + 1, max(plain, error), above + (error > RIGHT)
        else:
            careful = max(careful, error)
    return careful, plain, told / hits, above / hits


def check(kind, rng, count):
    careful, plain, told, above = judged(kind, rng, count)
    print(f"{kind}: careful {careful:.1e}; plain {plain:.1e}, {told:.1%} of hits, {above:.1%} above {RIGHT}")
    assert careful <= RIGHT
    assert told == 0.0 if kind in ALWAYS_CAREFUL else told > 0.0
    assert careful > 0.0 or kind == "plain"


@pytest.mark.parametrize("kind", CLASSES)
def test_engines_contact_times_are_right_within_their_bounds(kind):
    check(kind, random.Random(f"{kind} of engines"), 500)


@pytest.mark.slow
@pytest.mark.parametrize("kind", CLASSES)
def test_1e5_contact_times_of_every_class_are_right_within_their_bounds(kind):
    check(kind, random.Random(f"{kind} of engines at length"), 100_000)


TABLE = {
    "plain": (-3.0, 0.3, 1.0, 0.0, 1.0),
    "far, 1e6 d": (-1e6, 0.3, 1.0, 0.0, 1.0),
    "far, 1e8 d": (-1e8, 0.3, 1.0, 0.0, 1.0),
    "gap 1e-9 d": (-1.0 - 1e-9, 0.0, 0.9, 0.3, 1.0),
    "gap 1e-12 d": (-1.0 - 1e-12, 0.0, 0.9, 0.3, 1.0),
    "graze, 1 - 1e-14": (-3.0, 1.0 - 1e-14, 1.0, 0.0, 1.0),
    "graze, 1 - 2^-53": (-3.0, 1.0 - 2.0**-53, 1.0, 0.0, 1.0),
    "miss by 2^-52": (-3.0, 1.0 + 2.0**-52, 1.0, 0.0, 1.0),
    "d = 1e8, gap 1": (-1e8 - 1.0, 0.0, 0.9, 0.3, 1e8),
    "speed 1e-160": (-3.0, 0.3, 1e-160, 0.0, 1.0),
    "speed 1e160": (-3.0, 0.3, 1e160, 0.0, 1.0),
}
"""Relative place and velocity, and the reach, of the pairs on which formulas are compared."""


@pytest.mark.parametrize("row", TABLE)
def test_pairs_on_which_formulas_differ(row):
    dx, dy, du, dw, reach = TABLE[row]
    pair = (dx, dy, du, dw, 0.0, 0.5 * reach, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5 * reach, 0.0, 0.0)
    true, (found, _) = exact_delay(*pair), filtered(pair)
    if true is None:
        assert row.startswith("miss")
        assert found == NEVER
    else:
        assert abs(Fraction(found) - true) / true <= RIGHT


def test_the_least_that_is_right_lies_just_outside_of_doubt():
    """A disk in the origin and one almost in contact with it: nine bits are lost where the plain formula begins."""
    rng = random.Random(12)
    errors = []
    for _ in range(2000):
        gap = 0.5 * NEAR * rng.uniform(1.001, 1.5)
        angle = rng.uniform(0, 7)
        x, y = math.cos(angle), math.sin(angle)
        pair = (0.0, 0.0, x, y, 0.0, 0.5, (1 + gap) * x, (1 + gap) * y, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0)
        found, plainly = filtered(pair)
        if plainly:
            true = exact_delay(*pair)
            errors.append(float(abs(Fraction(found) - true) / true))
    assert len(errors) > 1000
    assert 1e-14 < max(errors) <= 2e-13
