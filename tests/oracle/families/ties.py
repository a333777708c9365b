"""P2: exact ties of pairs and of walls in the starting floats, with spectators that move the clock."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

import eventsim as es
from tests.oracle.families.case import Case, Place, scene

TRIPLES = ((3, 4, 5), (5, 12, 13), (8, 15, 17), (7, 24, 25))


def dyadic(rng: np.random.Generator, low: float, high: float, bits: int = 8) -> float:
    """A number with few bits."""
    return float(np.round(rng.uniform(low, high) * 2**bits) / 2**bits)


def _when(rng: np.random.Generator) -> float:
    """The time of the tie: a power of two, from 1e-6 to 1e3, or a number of few bits."""
    return float(2.0 ** rng.integers(-20, 11)) if rng.random() < 0.7 else max(dyadic(rng, 0, 8), 2.0**-8)


def _spectators(rng: np.random.Generator, until: float) -> list[tuple[Place, Place]]:
    """Disks that bounce to and fro far away, some fast: the clock turns over by them."""
    found = []
    for k in range(int(rng.integers(0, 3))):
        speed = float(rng.choice([0.3, 5.0])) * 20.0 / max(until, 1e-3) * float(rng.uniform(0.5, 2))
        found.append(((1100.0 + 3.0 * k, 1100.0), (0.0, speed)))
    return found


def _made(
    rng: np.random.Generator,
    places: list[Any],
    velocities: list[Any],
    radii: list[float],
    masses: list[float],
    until: float,
    walls: list[Any],
) -> Any:
    e = float(rng.choice([1.0, 1.0, 0.5]))
    for place, velocity in _spectators(rng, until):
        places.append(place)
        velocities.append(velocity)
        radii.append(0.25)
        masses.append(1.0)
    cage = [es.Segment((1090.0, 1095.0), (1120.0, 1095.0)), es.Segment((1090.0, 1105.0), (1120.0, 1105.0))]
    return scene(
        position=places,
        velocity=velocities,
        radius=radii,
        mass=masses,
        domain=es.Open(),
        walls=[*walls, *cage],
        restitution=e,
        until=until,
        events=60,
    )


class Start(NamedTuple):
    """Three disks, the first of which meets the others at the same time t."""

    places: list[Place]
    velocities: list[Place]
    radii: list[float]
    t: float


def at_rest(rng: np.random.Generator) -> Start | None:
    """Two at rest, at Pythagorean distances of the place where the first one meets both; all places are floats."""
    (a, b, c), (p, q, s) = (TRIPLES[int(k)] for k in rng.choice(len(TRIPLES), 2, replace=False))
    one, two = float(2.0 ** rng.integers(-3, 0)), float(2.0 ** rng.integers(-3, 0))
    radii = [one, one * (c - 1.0), two * s - one]
    fast = float(2.0 ** rng.integers(-8, 9))
    far = 10.0 ** float(rng.uniform(-5, 1))
    bit = math.ulp(far + max(one * a, two * p))  # the last one that all places have
    way = float(np.round(far / bit)) * bit
    if radii[2] <= 0.0 or way <= 0.0:
        return None
    places = [(0.0, 0.0), (way + one * a, one * b), (way + two * p, -two * q)]
    return Start(places, [(fast, 0.0), (0.0, 0.0), (0.0, 0.0)], radii, way / fast)


def mirrored(rng: np.random.Generator) -> Start | None:
    """Two that are mirror images of each other: the numbers may be any."""
    t, r = _when(rng), float(rng.choice([0.5, 1.0, 0.25]))
    x, y = float(rng.uniform(0.3, 3.0)) * r, float(rng.uniform(1.01, 1.9)) * r
    first = x - math.sqrt(4 * r * r - y * y)  # where the first one meets them
    if first <= 0.02 * r:
        return None
    return Start([(0.0, 0.0), (x, y), (x, -y)], [(first / t, 0.0), (0.0, 0.0), (0.0, 0.0)], [r, r, r], t)


def moving(rng: np.random.Generator) -> Start | None:
    """All move, and are at Pythagorean distances at the tie; numbers of few bits."""
    t = _when(rng)
    a, b, c = TRIPLES[int(rng.integers(len(TRIPLES)))]
    unit = 2.0 ** -int(rng.integers(2, 5))
    one = (a * unit, b * unit)
    two = (a * unit, -b * unit) if rng.random() < 0.5 else (-b * unit, -a * unit)
    if math.dist(one, two) < c * unit * 1.001:
        return None
    pace = 2.0 ** math.ceil(math.log2(max(t, 1.0)))
    places, velocities = [], []
    for at in ((0.0, 0.0), one, two):
        u, w = dyadic(rng, -1, 1, 5) / pace, dyadic(rng, -1, 1, 5) / pace
        if velocities and (u - velocities[0][0]) * at[0] + (w - velocities[0][1]) * at[1] > 0:
            u, w = 2 * velocities[0][0] - u, 2 * velocities[0][1] - w  # let it approach
        places.append((at[0] - u * t, at[1] - w * t))
        velocities.append((u, w))
    return Start(places, velocities, [c * unit / 2] * 3, t)


def pairs(rng: np.random.Generator) -> Case:
    """A disk meets two others at once: at mirror images, or where numbers of few bits say so."""
    start = (at_rest, mirrored, moving)[int(rng.integers(3))](rng)
    if start is None:
        return pairs(rng)
    masses = [1.0, float(rng.choice([1.0, 2.0])), 1.0]
    try:
        return Case(_made(rng, start.places, start.velocities, start.radii, masses, 2.0 * start.t, []))
    except es.SceneError:
        return pairs(rng)


def walls(rng: np.random.Generator) -> Case:
    """A disk or point meets two walls at once: mirror images of each other, or two sides of a box."""
    return _in_a_valley(rng) if rng.random() < 0.7 else _in_a_corner(rng)


def _in_a_valley(rng: np.random.Generator) -> Case:
    """On the axis of two walls that are mirror images."""
    t, r = _when(rng), float(rng.choice([0.5, 0.25, 0.0]))
    x, low = float(rng.choice([3.0, 1.0, 0.625])), dyadic(rng, -1, 1)
    rise, wide = float(rng.uniform(0.2, 3.0)), float(rng.choice([3.0, 2.0]))
    points = [(x - wide, low + rise), (x, low), (x + wide, low + rise)]
    at = low + r * math.hypot(rise, wide) / wide  # where it meets both
    drop = float(rng.uniform(0.2, 2.0))
    chain: list[Any] = [es.Polyline(tuple(points))]
    if rng.random() < 0.5:
        chain = [es.Segment(points[0], points[1]), es.Segment(points[1], points[2])]
    try:
        return Case(_made(rng, [(x, at + drop)], [(0.0, -drop / t)], [r], [1.0], 2.0 * t, chain))
    except es.SceneError:
        return _in_a_valley(rng)


def _in_a_corner(rng: np.random.Generator) -> Case:
    """Into a corner of a box, in numbers of few bits."""
    t, r, size = _when(rng), 0.25, 4.0
    v = 2.0 ** float(np.floor(np.log2(dyadic(rng, 0.25, 1.5) / t)))
    share = dyadic(rng, 0.25, 1.0, 4)
    place = (r + v * t, r + share * v * t)
    if max(place) > size - r:
        return _in_a_corner(rng)
    made = scene(
        position=[place],
        velocity=[(-v, -share * v)],
        radius=r,
        domain=es.Box((size, size)),
        restitution=float(rng.choice([1.0, 0.5])),
        until=2.0 * t,
        events=60,
    )
    return Case(made)


FAMILIES = {"P2-pairs": pairs, "P2-walls": walls}
