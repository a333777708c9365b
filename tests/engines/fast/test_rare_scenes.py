"""Scenes that random ones seldom are have one log: points where walls join, rests on walls in line, ends of walls."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import pytest

import eventsim as es
from eventsim.engines.base import Stop
from eventsim.scene.stage import stage_of
from tests.engines.fast.test_same_log import assert_same

pytestmark = pytest.mark.kernels

BOX, TORUS = es.Box((10.0, 8.0)), es.Periodic((10.0, 8.0))
FALL = (0.0, -1.0)
LOW: dict[str, object] = {"gravity": FALL, "restitution": 0.3}


def one(place: tuple[float, float], velocity: tuple[float, float], domain: object, *walls: object, **rules: object) -> es.Scene:
    radius = rules.pop("radius", 0.0)
    return es.Scene(es.Disks([place], [velocity], radius), domain, list(walls), **rules)


def line(*places: tuple[float, float]) -> list[es.Segment]:
    return [es.Segment(a, b) for a, b in pairwise(places)]


LEVEL = line((1.0, 2.0), (3.0, 2.0), (5.0, 2.0), (8.0, 2.0))
SLOPE = line((1.0, 4.0), (3.0, 3.0), (5.0, 2.0))
GAPS = [es.Segment((1.0, 4.0), (3.0, 3.0)), es.Segment((4.0, 2.5), (7.0, 1.0))]
TEE = [es.Segment((1.0, 2.0), (8.0, 2.0)), es.Segment((4.0, 2.0), (4.0, 6.0))]
LEANING = [es.Segment((1.0, 2.0), (8.0, 2.0)), es.Segment((4.0, 2.0), (6.0, 6.0))]
CROSS = [es.Segment((1.0, 2.0), (8.0, 2.0)), es.Segment((4.0, 1.0), (4.0, 6.0))]

CHANNEL = es.Channel((10.0, 8.0))
AROUND = line((0.0, 2.0), (1.0, 2.0), (3.0, 2.0)) + line((5.0, 2.0), (9.0, 2.0), (10.0, 2.0))
HIGH = es.Segment((4.0, 5.0), (5.0, 6.0))
VALLEY = [es.Segment((8.0, 4.0), (10.0, 2.0)), es.Segment((0.0, 2.0), (2.0, 4.0))]
VALLEY_INSIDE = line((3.0, 4.0), (5.0, 2.0), (7.0, 4.0))
VALLEY_OPEN = [es.Segment((8.0, 3.0), (8.75, 2.0)), es.Segment((9.25, 2.0), (10.0, 3.0))]
STAR = [es.Segment((4.0, 4.0), end) for end in ((7.0, 5.0), (7.0, 3.0), (6.0, 1.0))]
BEND = line((2.0, 2.0), (5.0, 2.0), (8.0, 4.0))

BOTH_WAYS = [es.Segment((1.0, 2.0), (3.0, 2.0)), es.Segment((5.0, 2.0), (3.0, 2.0)), es.Segment((5.5, 2.0), (8.0, 2.0))]


def above_a_disk(place: tuple[float, float], walls: list[es.Segment]) -> es.Scene:
    """A point that rests on walls, and a disk on the floor whose contacts let the clock turn over."""
    disks = es.Disks([place, (5.0, 0.5)], [(0.3, 0.0), (8.0, 0.0)], [0.0, 0.5])
    return es.Scene(disks, BOX, [es.Segment(one.start, one.end, restitution=0.3) for one in walls], gravity=FALL)


SCENES: dict[str, Callable[[], es.Scene]] = {
    "a point onto a joint of walls in line": lambda: one((3.0, 4.0), (0.0, -1.0), BOX, *LEVEL),
    "a point aslant onto a joint of walls in line": lambda: one((2.0, 3.0), (1.0, -1.0), BOX, *LEVEL),
    "a point that falls onto a joint": lambda: one((3.0, 4.0), (0.0, 0.0), BOX, *LEVEL, gravity=FALL, restitution=0.5),
    "a point that slides over joints": lambda: one((1.5, 2.5), (0.3, 0.0), BOX, *LEVEL, gravity=FALL, restitution=0.5),
    "a point that slides down a slope": lambda: one((1.5, 4.0), (0.0, 0.0), BOX, *SLOPE, gravity=FALL, restitution=0.5),
    "a point that slides down a slope with a gap": lambda: one((1.5, 4.0), (0.0, 0.0), BOX, *GAPS, gravity=FALL, restitution=0.5),
    "a point into the corner of a tee": lambda: one((6.0, 4.0), (-1.0, -1.0), BOX, *TEE),
    "a point into the corner of a tee, from the left": lambda: one((2.0, 4.0), (1.0, -1.0), BOX, *TEE),
    "a point under a tee": lambda: one((4.0, 1.0), (0.0, 1.0), BOX, *TEE),
    "a point into the corner of a leaning tee": lambda: one((6.0, 4.0), (-1.0, -1.0), BOX, *LEANING),
    "a point under a leaning tee": lambda: one((4.0, 1.0), (0.0, 1.0), BOX, *LEANING),
    "a point into a cross": lambda: one((6.0, 4.0), (-1.0, -1.0), BOX, *CROSS),
    "a point that falls beside a tee": lambda: one((4.5, 4.0), (-0.25, 0.0), BOX, *TEE, gravity=FALL, restitution=0.5),
    "a point around an ellipse on a torus": lambda: one((1.0, 1.0), (1.0, 0.37), TORUS, es.Ellipse((5.0, 4.0), (3.0, 2.0))),
    "a point on walls in line over the border": lambda: one((6.0, 2.5), (1.0, 0.0), CHANNEL, *AROUND, **LOW),
    "a disk on a floor over the border": lambda: one((6.0, 2.5), (1.0, 0.0), CHANNEL, HIGH, **LOW, radius=0.3),
    "a point into a corner on the border": lambda: one((8.5, 5.0), (0.5, -1.0), TORUS, *VALLEY),
    "a point along the border into a corner": lambda: one((9.9375, 5.0), (0.0, -1.0), TORUS, *VALLEY),
    "a disk into a corner of a box": lambda: one(
        (2.0, 2.0), (-1.0, -1.0), BOX, gravity=(-0.5, -0.5), restitution=0.3, radius=0.5
    ),
    "a disk into a slanted corner": lambda: one((5.0, 5.0), (0.0, -1.0), BOX, *VALLEY_INSIDE, **LOW, radius=0.5),
    "a disk into a slanted corner, pulled aside": lambda: one(
        (5.0, 5.0), (0.0, 0.0), BOX, *VALLEY_INSIDE, gravity=(-0.5, -1.0), restitution=0.3, radius=0.5
    ),
    "a disk between a floor and a slope": lambda: one(
        (5.0, 3.0), (1.0, 0.0), BOX, es.Segment((3.0, 0.0), (10.0, 3.0)), gravity=(-0.5, -1.0), restitution=0.3, radius=0.5
    ),
    "a disk between a level wall and a slope": lambda: one(
        (5.0, 5.0), (1.0, 0.0), BOX, *BEND, gravity=(-0.5, -1.0), restitution=0.3, radius=0.5
    ),
    "a point in an ellipse that takes energy": lambda: one(
        (5.0, 4.0), (1.0, 0.37), BOX, es.Ellipse((5.0, 4.0), (3.0, 2.0)), restitution=0.5
    ),
    "a disk that meets two walls, and wraps": lambda: one((9.0, 5.0), (0.0, -1.0), TORUS, *VALLEY_OPEN, radius=0.5),
    "a disk on a floor, pulled into a slope": lambda: one(
        (3.0, 1.0), (1.0, 0.0), BOX, es.Segment((5.0, 0.0), (9.0, 3.0)), gravity=(0.5, -1.0), restitution=0.3, radius=0.5
    ),
    "a disk that is swept along a floor up a slope": lambda: one(
        (3.0, 1.0), (1.0, 0.0), BOX, es.Segment((5.0, 0.0), (9.0, 3.0)), gravity=(1.0, -0.2), restitution=0.3, radius=0.5
    ),
    "a disk that is swept up a slope from a corner": lambda: one(
        (4.5, 0.5), (0.0, 0.0), BOX, es.Segment((5.0, 0.0), (9.0, 3.0)), gravity=(1.0, -0.2), restitution=0.3, radius=0.5
    ),
    "a point onto the end of three walls": lambda: one((3.0, 6.0), (0.5, -1.0), BOX, *STAR),
    "a point onto the end of three walls, from the left": lambda: one((1.0, 4.0), (1.0, -0.5), BOX, *STAR),
    "a point onto the end of three walls, from below": lambda: one((4.0, 1.0), (0.0, 1.0), BOX, *STAR),
    "a point falls on walls in line above a disk that turns the clock": lambda: above_a_disk((1.5, 2.5), LEVEL),
    "a point lies on walls in line above a disk that turns the clock": lambda: above_a_disk((1.5, 2.0), LEVEL),
    "a point lies on walls in line that go both ways": lambda: above_a_disk((1.5, 2.0), BOTH_WAYS),
    "a point falls beside a slope": lambda: above_a_disk((1.5, 4.0), SLOPE),
    "a point that falls onto the end of a wall late on the clock": lambda: one(
        (2.1, 6.3),
        (0.0, 0.0),
        BOX,
        es.Segment((2.1, 4.0), (2.1, 2.0)),
        gravity=FALL,
        restitution=0.5,
        start_time=2.0**30,
    ),
    "a heavy point onto the end of a wall": lambda: es.Scene(
        es.Disks(
            [(2.0, 6.0), (5.0, 2.0), (8.0, 2.0)],
            [(0.0, -1.0), (1.0, 0.25), (0.0, 0.0)],
            [0.0, 0.5, 0.5],
            [2.0**30, 1.0, 2.0**20],
        ),
        BOX,
        [es.Segment((2.0, 4.0), (2.0, 2.0))],
    ),
    "a point onto the end of a wall that shakes": lambda: one(
        (2.0, 6.0), (0.0, -1.0), BOX, es.Segment((2.0, 4.0), (2.0, 2.0), shaking=0.5)
    ),
    "a point that falls onto the end of a wall": lambda: one(
        (2.0, 6.0), (0.0, 0.0), BOX, es.Segment((2.0, 4.0), (2.0, 2.0)), gravity=FALL, restitution=0.5
    ),
    "a point that falls onto the end of a wall without loss": lambda: one(
        (2.1, 6.3), (0.0, 0.0), BOX, es.Segment((2.1, 4.0), (2.1, 2.0)), gravity=FALL
    ),
}


@pytest.mark.parametrize("name", SCENES)
def test_a_rare_scene_has_one_log(name: str) -> None:
    scene = SCENES[name]()
    assert_same(stage_of(scene), Stop(until=scene.start_time + 40.0, events=60))
