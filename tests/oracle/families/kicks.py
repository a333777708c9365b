"""Kicks: velocities set from outside, at any time and at the very time of a contact."""

from __future__ import annotations

import math

import numpy as np

import eventsim as es
from tests.oracle.families.case import Case, scatter, scene, segment_distance
from tests.oracle.story import Kick


def anywhere(rng: np.random.Generator) -> Case:
    """Kicks in a small gas, at any time and at contacts, in boxes and periodic boxes, also with gravity and walls."""
    n = int(rng.integers(1, 6))
    radii = [float(rng.choice([0.2, 0.4, 0.0])) for _ in range(n)]
    places = scatter(rng, radii, (0.0, 0.0), (5.0, 5.0))
    assert places is not None
    kind = int(rng.integers(3))
    domain = [es.Box((5.0, 5.0)), es.Periodic((5.0, 5.0)), es.Channel((5.0, 5.0))][kind]
    until = float(rng.uniform(3, 12))
    kicks = []
    for _ in range(int(rng.integers(1, 4))):
        i, v = int(rng.integers(n)), tuple(float(c) for c in rng.normal(0, 1, 2))
        if rng.random() < 0.5:
            kicks.append(Kick(i, v, float(rng.uniform(0, until))))
        else:
            kicks.append(Kick(i, v, after=int(rng.integers(0, 4))))
    made = scene(
        position=places,
        velocity=rng.normal(0, 1, (n, 2)),
        radius=radii,
        domain=domain,
        gravity=(0.0, -1.0) if kind == 0 and rng.random() < 0.3 else None,
        restitution=float(rng.choice([1.0, 0.9])),
        until=until,
        events=60,
    )
    return Case(made, tuple(kicks))


def at_walls(rng: np.random.Generator) -> Case:
    """A point or a disk is kicked at the very time of its contact with a slanted wall or an arc: into it, away, along it."""
    r = float(rng.choice([0.0, 0.0, 0.2]))
    bent = rng.random() < 0.4
    if bent:
        a, w = float(rng.uniform(0, 2 * math.pi)), float(rng.uniform(0.4, 1.2))
        wall = es.Arc(*((3 + 1.5 * math.cos(a + s * w), 3 + 1.5 * math.sin(a + s * w)) for s in (-1, 0, 1)))
        goal = (3 + 1.5 * math.cos(a + 0.3 * w), 3 + 1.5 * math.sin(a + 0.3 * w))
        away = (math.cos(a), math.sin(a))
        ends = (wall.start, wall.end)
    else:
        ends = tuple((float(x), float(y)) for x, y in rng.uniform(1, 5, (2, 2)))
        if math.dist(*ends) < 1.0:
            return at_walls(rng)
        wall = es.Segment(*ends)
        share = float(rng.uniform(0.2, 0.8))
        goal = (ends[0][0] + share * (ends[1][0] - ends[0][0]), ends[0][1] + share * (ends[1][1] - ends[0][1]))
        length = math.dist(*ends)
        away = (-(ends[1][1] - ends[0][1]) / length, (ends[1][0] - ends[0][0]) / length)
    side = float(rng.choice([1.0, -1.0]))
    tilt = float(rng.uniform(-0.6, 0.6))
    back = (side * (away[0] - tilt * away[1]), side * (away[1] + tilt * away[0]))
    start = (goal[0] + 0.6 * back[0], goal[1] + 0.6 * back[1])
    kick = tuple(float(c) for c in rng.normal(0, 1, 2))
    seldom = r == 0.0 or rng.random() < 0.2  # a disk that slides over an end grazes it, and floats cannot tell
    if rng.random() < 0.2 and seldom and not bent:  # along the wall, to a last bit
        kick = (ends[1][0] - ends[0][0], ends[1][1] - ends[0][1])
    made = None
    try:
        made = scene(
            position=[start],
            velocity=[(-back[0], -back[1])],
            radius=r,
            domain=es.Box((6.0, 6.0)),
            walls=[wall],
            until=8.0,
            events=40,
        )
    except es.SceneError:
        return at_walls(rng)
    if segment_distance(ends[0], ends[1], *start) < 1.01 * r:
        return at_walls(rng)
    return Case(made, (Kick(0, kick, after=0),))


FAMILIES = {"kicks": anywhere, "kicks-at-walls": at_walls}
