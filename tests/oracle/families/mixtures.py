"""Disks of many masses and sizes; small periodic boxes; squeezes."""

from __future__ import annotations

import math

import numpy as np

import eventsim as es
from tests.oracle.families.case import Case, scatter, scene


def mixture(rng: np.random.Generator) -> Case:
    """Masses from 1e-6 to 1e6, some infinite, some 0; radii up to a factor 10; elastic, or not, or by contact duration."""
    n = int(rng.integers(2, 8))
    size = float(rng.choice([1.0, 10.0]))
    radii = [float(r) * size for r in rng.choice([0.02, 0.05, 0.1, 0.15], n)]
    masses = [float(10.0 ** rng.uniform(-6, 6)) for _ in range(n)]
    if rng.random() < 0.3:
        masses[0] = math.inf
    if rng.random() < 0.2:
        masses[-1] = 0.0
    places = scatter(rng, radii, (0.0, 0.0), (size, size))
    if places is None:
        return mixture(rng)
    domain = [es.Box((size, size)), es.Periodic((size, size)), es.Channel((size, size))][int(rng.integers(3))]
    e = float(rng.choice([1.0, 1.0, 0.9]))
    speeds = rng.normal(0, 1, (n, 2)) * (
        1.0
        if rng.random() < 0.5
        else np.minimum(1e3, np.array([[m**-0.5 if 0 < m < math.inf else 1.0] for m in masses]))
    )
    made = scene(
        position=places,
        velocity=speeds,
        radius=radii,
        mass=masses,
        domain=domain,
        restitution=None if e == 1.0 else {"pair": e, "wall": float(rng.choice([1.0, 0.8]))},
        contact_duration=float(10.0 ** rng.uniform(-4, -1)) * size if e < 1 and rng.random() < 0.4 else None,
        until=float(rng.uniform(1, 5)) * size,
        events=12 if n < 5 else 24,  # errors grow tenfold with each contact, more where free paths are long
    )
    return Case(made)


def small_boxes(rng: np.random.Generator) -> Case:
    """Up to four disks in a periodic box of few diameters, so that they meet each other's images."""
    n = int(rng.integers(1, 5))
    size = (float(rng.uniform(1.05, 4.0)), float(rng.uniform(1.05, 4.0)))
    radii = [0.5] * n if rng.random() < 0.7 else [float(r) for r in rng.uniform(0.2, 0.5, n)]
    places: list[tuple[float, float]] = []
    placed: list[float] = []
    for r in radii:
        for _ in range(200):
            x, y = float(rng.uniform(0, size[0])), float(rng.uniform(0, size[1]))
            if all(
                math.hypot(x - px + i * size[0], y - py + j * size[1]) > 1.0001 * (r + pr)
                for (px, py), pr in zip(places, placed, strict=True)
                for i in (-1, 0, 1)
                for j in (-1, 0, 1)
            ):
                places.append((x, y))
                placed.append(r)
                break
    n = len(places)
    made = scene(
        position=places,
        velocity=rng.normal(0, 1, (n, 2)),
        radius=placed,
        domain=es.Periodic(size),
        restitution=float(rng.choice([1.0, 1.0, 0.9])),
        until=float(rng.uniform(3, 20)),
        events=60,
    )
    return Case(made)


def squeezes(rng: np.random.Generator) -> Case:
    """A light disk between a heavy or immovable one and a wall, or between two that close in."""
    light, heavy = float(rng.choice([0.1, 0.25])), float(rng.choice([0.3, 0.5, 1.0]))
    mass = float(rng.choice([math.inf, 10.0 ** rng.uniform(1, 6)]))
    off = 0.0 if rng.random() < 0.5 else float(rng.uniform(-0.05, 0.05))
    gap = float(rng.uniform(0.05, 1.0))
    x = light + gap
    far = x + light + heavy + float(rng.uniform(0.05, 1.0))
    closing = float(rng.uniform(0.3, 2.0))
    until = 0.98 * (far - heavy - 2 * light) / closing if mass == math.inf else float(rng.uniform(1, 5))
    places, velocities = (
        [(x, 2.0 + off), (far, 2.0)],
        [(float(rng.normal()), 0.0 if off == 0.0 else float(rng.normal()) * 0.1), (-closing, 0.0)],
    )
    masses, radii = [1.0, mass], [light, heavy]
    walls = [es.Segment((0.0, -2.0), (0.0, 6.0))]
    if rng.random() < 0.4:  # from both sides
        walls = []
        places.append((-heavy, 2.0))
        velocities.append((float(rng.choice([0.0, closing])), 0.0))
        masses.append(math.inf)
        radii.append(heavy)
        if mass == math.inf:
            until = 0.9 * (far - heavy - 2 * light) / (closing + velocities[-1][0])
    made = scene(
        position=places,
        velocity=velocities,
        radius=radii,
        mass=masses,
        domain=es.Open(),
        walls=walls,
        restitution=float(rng.choice([1.0, 1.0, 0.9])),
        until=until,
        events=100,
    )
    return Case(made)


FAMILIES = {"mixtures": mixture, "small-boxes": small_boxes, "squeezes": squeezes}
