"""The time of the first event of two disks, in both engines, against exact rationals."""

from __future__ import annotations

import math
import random
from fractions import Fraction

import pytest

import eventsim as es
from eventsim.engines import ENGINES
from eventsim.engines.base import Stop
from eventsim.scene.stage import stage_of
from tests.formulas.test_digits import exact_delay

RIGHT = 4e-16
TABLE = {
    # place and velocity of a disk that flies towards one at rest in the origin, radius of both
    "plain": (-3.0, 0.3, 1.0, 0.0, 0.5),
    "plain, aslant": (-3.1, 0.7, 0.9, -0.1, 0.5),
    "far, 1e6 d": (-1e6, 0.3, 1.0, 0.0, 0.5),
    "far, 1e8 d": (-1e8, 0.3, 1.0, 0.0, 0.5),
    "gap 1e-9 d": (-1.0 - 1e-9, 0.0, 1.0, 0.0, 0.5),
    "gap 1e-12 d": (-1.0 - 1e-12, 0.0, 1.0, 0.0, 0.5),
    "gap 1e-9 d, aslant": (-0.6 - 1e-9, 0.8, 1.0, 0.25, 0.5),
    "graze, 1 - 1e-14": (-3.0, 1.0 - 1e-14, 1.0, 0.0, 0.5),
    "graze, 1 - 2^-53": (-3.0, 1.0 - 2.0**-53, 1.0, 0.0, 0.5),
    "d = 1e8, gap 1": (-(1e8 + 1.0), 0.0, 1.0, 0.0, 0.5e8),
    "d = 1e8, gap 1, aslant": (-(0.6e8 + 1.0), 0.8e8, 1.0, 0.1, 0.5e8),
    "speed 1e-75": (-3.0, 0.3, 1e-75, 0.0, 0.5),
    "speed 1e75": (-3.0, 0.3, 1e75, 0.0, 0.5),  # a scene takes no more
}
MISSES = {"tangent": 1.0, "miss by 2^-52": 1.0 + 2.0**-52}
ENGINE = pytest.mark.parametrize("engine", ["reference", "fast"])


def scene_of(x, y, u, w, radius):
    return es.Scene(es.Disks([(x, y), (0.0, 0.0)], [(u, w), (0.0, 0.0)], radius), es.Open())


def first_event(engine, scene):
    """The exact time of the first event; None where there is none."""
    if engine == "fast":
        pytest.importorskip("numba")
    stage = stage_of(scene)
    session = ENGINES[engine].open(stage)
    while session.advance(Stop(None, 1), 10**6) is None:
        pass
    rows = session.take_rows()
    return int(rows["epoch"][0]) * Fraction(stage.epoch_length) + Fraction(rows["remainder"][0]) if len(rows) else None


def true_time(scene):
    s = stage_of(scene)
    one, other = ((s.x[i], s.y[i], s.vx[i], s.vy[i], 0.0, s.radius[i]) for i in (0, 1))
    return exact_delay(*map(float, one), *map(float, other), 0.0, 0.0)


@ENGINE
@pytest.mark.parametrize("name", TABLE)
def test_every_row_of_the_table_is_right_to_the_last_bit(engine, name):
    scene = scene_of(*TABLE[name])
    true = true_time(scene)
    assert float(abs(first_event(engine, scene) - true) / true) <= RIGHT


@ENGINE
@pytest.mark.parametrize("name", MISSES)
def test_what_does_not_hit_has_no_event(engine, name):
    assert first_event(engine, scene_of(-3.0, MISSES[name], 1.0, 0.0, 0.5)) is None


@ENGINE
@pytest.mark.parametrize("kind", ["near", "graze"])
def test_pairs_that_only_careful_arithmetic_can_tell_are_right_to_the_last_bit(engine, kind):
    rng = random.Random(kind)
    hits = 0
    for _ in range(60):
        angle, reach = rng.uniform(0.0, 7.0), rng.uniform(0.5, 1.0)
        far, aim = reach * (1.0 + 10.0 ** rng.uniform(-15.0, -5.0)), rng.uniform(-1.5, 1.5)
        if kind == "graze":
            far = rng.uniform(1.5, 3.0)
            aim = math.asin(reach / far * (1.0 - rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-16.0, -9.0)))
        x, y, u, w = -far * math.cos(angle), -far * math.sin(angle), math.cos(angle + aim), math.sin(angle + aim)
        scene = scene_of(x, y, u, w, 0.5 * reach)
        true, found = true_time(scene), first_event(engine, scene)
        assert (true is None) == (found is None)
        if true:
            hits += 1
            assert float(abs(found - true) / true) <= RIGHT
    assert hits > 10
