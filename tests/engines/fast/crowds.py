"""Random scenes of some size: every kind of domain, walls, gravity, restitution, radii and masses, with ties and without."""

from __future__ import annotations

import math

import numpy as np

import eventsim as es
from eventsim.errors import SceneError
from tests.engines.scenes import wide_mixture

DOMAINS = (es.Box, es.Periodic, es.Channel, es.Open)


FAMILIES = 36
"""What scenes have is one of so many draws: each asks for kernels of its own, which take seconds to compile."""


def crowd(seed: int) -> es.Scene:
    """A scene of 4 to 250 disks that the seed alone decides; seeds that leave the same rest by `FAMILIES` have the same."""
    rng, traits = np.random.default_rng(seed), np.random.default_rng(seed % FAMILIES)
    domain = DOMAINS[seed % 4]
    rules: dict[str, object] = {}
    if traits.random() < 0.3:
        rules["gravity"] = tuple(rng.choice([-1.0, -0.5, 0.25], 2))
    if traits.random() < 0.3:
        rules["restitution"] = es.Restitution(float(rng.choice([0.5, 0.9])), 0.75)
        rules["contact_duration"] = 2.0**-10
    if traits.random() < 0.2:
        return wide_mixture(int(rng.integers(60, 250)), seed, domain, **rules)
    scene = lattice(rng, traits, domain, rules)
    for kind in traits.integers(4, size=2) if traits.random() < 0.4 else ():
        scene = with_wall(scene, rng, int(kind), rules)
    return scene


def lattice(rng: np.random.Generator, traits: np.random.Generator, domain: type, rules: dict[str, object]) -> es.Scene:
    """Disks of radius up to 1/2 on a square lattice; velocities are often small multiples of 1/4, so that instants are shared."""
    columns, rows = rng.integers(5, 15, 2).tolist() if traits.random() < 0.8 else rng.integers(2, 5, 2).tolist()
    pitch = float(rng.choice([1.0, 1.03125, 1.25, 1.6, 2.7]))
    n = columns * rows
    place = np.stack(np.divmod(np.arange(n), rows), axis=1) * pitch + 0.5 * pitch
    kind = int(rng.integers(4))
    velocity = (rng.integers(-2, 3, (n, 2)) / 4.0, rng.normal(size=(n, 2)), rng.choice([-1.0, 1.0], (n, 2)))[kind % 3]
    radius = (np.full(n, 0.5), 0.5 * rng.uniform(1 / 3, 1, n), rng.choice([0.5, 0.25, 0.0], n))[int(rng.integers(3))]
    mass = np.ones(n)
    if traits.random() < 0.5:
        mass = rng.choice([(1.0, 3.0), (1.0, math.inf), (1.0, 0.0), (1.0, 1e9)][int(traits.integers(4))], n)
    disks = es.Disks(place, velocity, radius, mass)
    return es.Scene(disks, es.Open() if domain is es.Open else domain((columns * pitch, rows * pitch)), **rules)


def with_wall(scene: es.Scene, rng: np.random.Generator, kind: int, rules: dict[str, object]) -> es.Scene:
    """The scene with one wall of a kind more, if there is room for the one that is drawn."""
    low, high = scene.disks.position.min(axis=0), scene.disks.position.max(axis=0)
    points = np.round(rng.uniform(low - 0.5, high + 0.5, (3, 2)) * 2.0) / 2.0
    middle, radius = 0.5 * (low + high), float(np.hypot(*(high - low))) + 1.0
    start, second, third = (tuple(map(float, point)) for point in points)
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
