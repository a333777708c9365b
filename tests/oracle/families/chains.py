"""P6: slides along chains whose links are in line."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

import eventsim as es
from tests.oracle.families.case import Case, scene


def slides(rng: np.random.Generator) -> Case:
    """A disk that touches a straight chain and moves along it, with or without gravity."""
    count = int(rng.integers(2, 6))
    marks = np.sort(rng.uniform(0.0, 3.0, count))
    if np.min(np.diff(marks)) < 0.05:
        return slides(rng)
    slope = float(rng.choice([0.0, 0.0, math.pi / 2, rng.uniform(-1.3, 1.3)]))
    ex, ey = (1.0, 0.0) if slope == 0.0 else (0.0, 1.0) if slope == math.pi / 2 else (math.cos(slope), math.sin(slope))
    x0, y0 = float(rng.uniform(-1, 1)), float(rng.choice([0.2, rng.uniform(-1, 1)]))
    points = [(x0 + float(m) * ex, y0 + float(m) * ey) for m in marks]
    r = float(rng.choice([0.1, 0.3, 0.07]))
    s = float(rng.uniform(marks[0], marks[-1]))
    backwards = rng.random() < 0.3
    speed = float(rng.choice([1.0, rng.uniform(0.2, 3)])) * (-1 if backwards else 1)
    place = (x0 + s * ex - r * ey, y0 + s * ey + r * ex)
    pull = None
    restitution = float(rng.choice([1.0, 0.5, 0.9]))
    if slope != math.pi / 2 and rng.random() < 0.5:
        pull = (0.0, -float(rng.choice([1.0, 9.81])))
    split = rng.random() < 0.4
    walls = [es.Segment(a, b) for a, b in pairwise(points)] if split else [es.Polyline(tuple(points))]
    made = scene(
        position=[place],
        velocity=[(speed * ex, speed * ey)],
        radius=r,
        domain=es.Open(),
        walls=walls,
        gravity=pull,
        restitution=restitution,
        until=float(rng.uniform(1.0, 5.0)),
        events=30,
    )
    return Case(made)


def skims(rng: np.random.Generator) -> Case:
    """Disks that bounce along a straight chain: joints must not be felt."""
    case = slides(rng)
    old = case.scene
    u, w = old.disks.velocity[0].tolist()
    x, y = old.disks.position[0].tolist()
    tilt = 10.0 ** float(rng.uniform(-6, -0.5))
    speed = math.hypot(u, w)
    nx, ny = -w / speed, u / speed
    if rng.random() < 0.5:
        nx, ny = -nx, -ny
    first = old.walls[0]
    a = first.start if isinstance(first, es.Segment) else first.points[0]
    side = 1.0 if (x - a[0]) * nx + (y - a[1]) * ny > 0 else -1.0
    nx, ny = side * nx, side * ny
    high = float(rng.uniform(0.0, 0.3)) * tilt + 1e-3 * tilt
    made = scene(
        position=[(x + high * nx, y + high * ny)],
        velocity=[(u - tilt * speed * nx, w - tilt * speed * ny)],
        radius=float(old.disks.radius[0]),
        domain=es.Open(),
        walls=old.walls,
        gravity=old.gravity,
        restitution=old.restitution,
        until=old.until,
        events=40,
    )
    return Case(made)


FAMILIES = {"P6-slides": slides, "P6-skims": skims}
