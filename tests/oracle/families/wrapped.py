"""Walls in periodic boxes and channels, some across their borders, and disks that close more slowly than they fly."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import numpy as np

import eventsim as es
from tests.oracle.families.case import Case, Place, scatter, scene
from tests.oracle.families.meetings import starts, valid


def wrapped(rng: np.random.Generator) -> Case:
    """Disks and points among segments and arcs in a periodic box or a channel."""
    width, height = (float(side) for side in rng.uniform(2.0, 6.0, 2))
    channel = rng.random() < 0.4
    walls: list[Any] = [_wall(rng, width, height, channel) for _ in range(int(rng.integers(1, 4)))]
    n = int(rng.integers(1, 4))
    radii = [0.0 if rng.random() < 0.5 else float(rng.uniform(0.02, 0.3)) for _ in range(n)]
    places = scatter(rng, radii, (0.0, 0.0), (width, height))
    if places is None:
        return wrapped(rng)
    made = scene(
        position=places,
        velocity=rng.normal(0.0, 1.0, (n, 2)).tolist(),
        radius=radii,
        domain=es.Channel((width, height)) if channel else es.Periodic((width, height)),
        walls=walls,
        gravity=(0.0, -float(rng.uniform(0.2, 3.0))) if channel and rng.random() < 0.4 else None,
        restitution=float(rng.choice([1.0, 1.0, 0.8])),
        until=20.0,
        events=30,
    )
    return Case(made)


def _wall(rng: np.random.Generator, width: float, height: float, channel: bool) -> Any:
    while True:
        x, y, angle = float(rng.uniform(0, width)), float(rng.uniform(0, height)), float(rng.uniform(0, 2 * math.pi))
        half = float(rng.uniform(0.1, 0.6))
        dx, dy = half * math.cos(angle), half * math.sin(angle)
        first, last = (x - dx, y - dy), (x + dx, y + dy)
        if channel and not (0.0 < first[1] < height and 0.0 < last[1] < height):
            continue
        if rng.random() < 0.3:
            bulge = float(rng.uniform(0.1, 0.8))
            return es.Arc(first, (x - bulge * dy, y + bulge * dx), last)
        return es.Segment(first, last)


def boosted(rng: np.random.Generator) -> Case:
    """A tie of pairs that all fly up to a hundred times faster than they close, with spectators that turn the clock."""
    start = starts(rng)
    boost = [float(rng.integers(-8, 9)) * 2.0 ** float(rng.integers(-4, 4)) for _ in range(2)]
    velocities: list[Place] = []
    for u, w in start.velocities:
        velocity = u + boost[0], w + boost[1]
        if Fraction(u) + Fraction(boost[0]) != velocity[0] or Fraction(w) + Fraction(boost[1]) != velocity[1]:
            return boosted(rng)
        velocities.append(velocity)
    far = 2000.0
    speed = 20.0 * float(rng.choice([0.5, 5.0, 50.0])) / start.t
    made = scene(
        position=[*start.places, (far, far)],
        velocity=[*velocities, (0.0, speed)],
        radius=[*start.radii, 0.25],
        mass=[1.0, float(rng.choice([1.0, 2.0])), 1.0, 1.0],
        domain=es.Open(),
        walls=[es.Segment((far - 2.0, y), (far + 2.0, y)) for y in (far - 3.0, far + 3.0)],
        restitution=float(rng.choice([1.0, 0.5])),
        until=1.5 * start.t,
        events=400,
    )
    return Case(made)


FAMILIES = {"wrapped": valid(wrapped), "P2-boosted": valid(boosted)}
