"""Walls at an angle, with and without gravity: wedges, slopes, posts."""

from __future__ import annotations

import math

import numpy as np

import eventsim as es
from tests.oracle.families.case import Case, scatter, scene, segment_distance


def wedges(rng: np.random.Generator) -> Case:
    """Disks and points in a wedge of two walls."""
    angle = float(rng.choice([math.pi / 2, math.pi / 3, rng.uniform(0.3, 2.8)]))
    turn = float(rng.choice([0.0, rng.uniform(0, 2 * math.pi)]))
    apex = (0.0, 0.0) if rng.random() < 0.5 else (float(rng.uniform(-2, 2)), float(rng.uniform(-2, 2)))
    ends = [
        (apex[0] + 5 * math.cos(turn + s * angle / 2), apex[1] + 5 * math.sin(turn + s * angle / 2)) for s in (-1, 1)
    ]
    joined = rng.random() < 0.6
    walls = (
        [es.Polyline((ends[0], apex, ends[1]))] if joined else [es.Segment(ends[0], apex), es.Segment(apex, ends[1])]
    )
    n = int(rng.integers(1, 4))
    radii = [float(rng.choice([0.0, 0.2, 0.3])) for _ in range(n)]
    radii = [r if angle > 0.6 else 0.5 * r for r in radii]
    places, velocities = [], []
    for k, r in enumerate(radii):
        far = 1.5 + 0.9 * k + r / math.sin(angle / 2)
        side = 0.0 if r > 0 and rng.random() < 0.3 else float(rng.uniform(-0.3, 0.3)) * angle
        places.append((apex[0] + far * math.cos(turn + side), apex[1] + far * math.sin(turn + side)))
        speed = float(rng.uniform(0.3, 2))
        course = turn + math.pi + (side if r > 0 and rng.random() < 0.5 else float(rng.uniform(-0.5, 0.5)))
        velocities.append((speed * math.cos(course), speed * math.sin(course)))
    try:
        made = scene(
            position=places,
            velocity=velocities,
            radius=radii,
            domain=es.Open(),
            walls=walls,
            restitution=float(rng.choice([1.0, 1.0, 0.8])),
            until=float(rng.uniform(2, 10)),
            events=60,
        )
    except es.SceneError:
        return wedges(rng)
    return Case(made)


def slopes(rng: np.random.Generator) -> Case:
    """Disks that fall on slopes in a box, come to rest, slide, meet."""
    width, height = 6.0, 8.0
    walls, spans = [], []
    for k in range(int(rng.integers(1, 4))):
        a = (float(rng.uniform(0.2, 5.0)), 1.0 + 1.6 * k + float(rng.uniform(0, 0.5)))
        b = (a[0] + float(rng.uniform(0.6, 2.0)), a[1] + float(rng.choice([0.0, rng.uniform(-0.8, 0.8)])))
        walls.append(es.Segment(a, b))
        spans.append((a, b))
    n = int(rng.integers(1, 4))
    radii = [float(rng.choice([0.1, 0.2, 0.05])) for _ in range(n)]
    places = scatter(
        rng,
        radii,
        (0.0, 1.0),
        (width, height),
        lambda x, y, r: all(segment_distance(a, b, x, y) > 1.01 * r for a, b in spans),
    )
    if places is None:
        return slopes(rng)
    still = rng.random() < 0.5
    made = scene(
        position=places,
        velocity=None if still else rng.normal(0, 1, (n, 2)),
        radius=radii,
        domain=es.Box((width, height)),
        walls=walls,
        gravity=(float(rng.choice([0.0, 0.0, 0.3])), -float(rng.choice([1.0, 9.81]))),
        restitution=float(rng.choice([0.3, 0.5, 0.8, 1.0])),
        until=float(rng.uniform(1, 6)),
        events=300,
    )
    return Case(made)


def posts(rng: np.random.Generator) -> Case:
    """Disks that fall through posts (immovable disks) and on ends of walls."""
    m, n = int(rng.integers(1, 5)), int(rng.integers(1, 4))
    radii = [float(r) for r in rng.choice([0.1, 0.3, 0.0], m)] + [float(r) for r in rng.choice([0.1, 0.2], n)]
    places = scatter(rng, radii, (0.0, 0.5), (4.0, 7.0))
    if places is None:
        return posts(rng)
    moving = rng.normal(0, 1, (n, 2)) if rng.random() < 0.6 else np.zeros((n, 2))
    velocities = np.concatenate([np.zeros((m, 2)), moving])
    if rng.random() < 0.2:
        velocities[0] = rng.normal(0, 0.3, 2)  # a moving obstacle
    made = scene(
        position=places,
        velocity=velocities,
        radius=radii,
        mass=[math.inf] * m + [1.0] * n,
        domain=es.Box((4.0, 8.0)),
        gravity=None if rng.random() < 0.15 else (0.0, -float(rng.choice([1.0, 9.81]))),
        restitution=float(rng.choice([1.0, 0.9, 0.6])),
        until=float(rng.uniform(1, 8)),
        events=100,
    )
    return Case(made)


FAMILIES = {"wedges": wedges, "slopes": slopes, "posts": posts}
