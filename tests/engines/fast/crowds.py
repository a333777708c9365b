"""Random scenes of some size: every kind of domain, walls, gravity, restitution, radii and masses, with ties and without."""

from __future__ import annotations

import math

import numpy as np

import eventsim as es
from eventsim.errors import SceneError
from tests.engines.scenes import wide_mixture

DOMAINS = (es.Box, es.Periodic, es.Channel, es.Open)


def crowd(seed: int) -> es.Scene:
    """A scene of 4 to 250 disks that the seed alone decides."""
    rng = np.random.default_rng(seed)
    domain = DOMAINS[seed % 4]
    gravity = tuple(rng.choice([-1.0, -0.5, 0.0, 0.25], 2)) if rng.random() < 0.3 else None
    restitution = es.Restitution(float(rng.choice([0.5, 0.9])), 0.75) if rng.random() < 0.3 else None
    rules = {"gravity": gravity, "restitution": restitution}
    if restitution is not None:
        rules["contact_duration"] = 2.0**-10
    if rng.random() < 0.2:
        return wide_mixture(int(rng.integers(60, 250)), seed, domain, **rules)
    scene = lattice(rng, domain, rules)
    for _ in range(int(rng.integers(1, 6)) if rng.random() < 0.4 else 0):
        scene = with_wall(scene, rng, rules)
    return scene


def lattice(rng: np.random.Generator, domain: type, rules: dict[str, object]) -> es.Scene:
    """Disks of radius up to 1/2 on a square lattice; velocities are often small multiples of 1/4, so that instants are shared."""
    columns, rows = rng.integers(2, 15, 2).tolist()
    pitch = float(rng.choice([1.0, 1.03125, 1.25, 1.6, 2.7]))
    n = columns * rows
    place = np.stack(np.divmod(np.arange(n), rows), axis=1) * pitch + 0.5 * pitch
    kind = int(rng.integers(4))
    velocity = (rng.integers(-2, 3, (n, 2)) / 4.0, rng.normal(size=(n, 2)), rng.choice([-1.0, 1.0], (n, 2)))[kind % 3]
    radius = (np.full(n, 0.5), 0.5 * rng.uniform(1 / 3, 1, n), rng.choice([0.5, 0.25, 0.0], n))[int(rng.integers(3))]
    mass = np.ones(n)
    if rng.random() < 0.5:
        mass = rng.choice([(1.0, 3.0), (1.0, math.inf), (1.0, 0.0), (1.0, 1e9)][int(rng.integers(4))], n)
    disks = es.Disks(place, velocity, radius, mass)
    return es.Scene(disks, es.Open() if domain is es.Open else domain((columns * pitch, rows * pitch)), **rules)


def with_wall(scene: es.Scene, rng: np.random.Generator, rules: dict[str, object]) -> es.Scene:
    """The scene with one wall more, if there is room for the one that was drawn."""
    low, high = scene.disks.position.min(axis=0), scene.disks.position.max(axis=0)
    points = np.round(rng.uniform(low - 0.5, high + 0.5, (3, 2)) * 2.0) / 2.0
    middle, radius = 0.5 * (low + high), float(np.hypot(*(high - low))) + 1.0
    start, second, third = (tuple(map(float, point)) for point in points)
    kind = int(rng.integers(4))
    try:
        wall = (
            es.Segment(start, second),
            es.Polygon((start, second, third)),
            es.Arc(start, second, third),
            es.Circle((float(middle[0]), float(middle[1])), radius),
        )[kind]
        return es.Scene(scene.disks, scene.domain, walls=(*scene.walls, wall), **rules)
    except SceneError:
        return scene
