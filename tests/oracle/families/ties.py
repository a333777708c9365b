"""P2: exact ties of pairs and of walls in the starting floats, with spectators that move the clock."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

import eventsim as es
from tests.oracle.families.case import Case, scene

TRIPLES = ((3, 4, 5), (5, 12, 13), (8, 15, 17), (7, 24, 25))


def _dyadic(rng: np.random.Generator, low: float, high: float, bits: int = 8) -> float:
    """A number with few bits."""
    return float(np.round(rng.uniform(low, high) * 2**bits) / 2**bits)


def _when(rng: np.random.Generator) -> float:
    """The time of the tie: a power of two, from 1e-6 to 1e3, or a number of few bits."""
    return float(2.0 ** rng.integers(-20, 11)) if rng.random() < 0.7 else max(_dyadic(rng, 0, 8), 2.0**-8)


def _spectators(rng: np.random.Generator, until: float) -> list[tuple[tuple[float, float], tuple[float, float]]]:
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


def pairs(rng: np.random.Generator) -> Case:
    """A disk meets two others at once: at mirror images, or where numbers of few bits say so."""
    t = _when(rng)
    r = float(rng.choice([0.5, 1.0, 0.25]))
    kind = int(rng.integers(3))
    if kind == 0:  # at rest, at Pythagorean distances of the place where the first one meets both
        (a, b, c), (p, q, s) = (TRIPLES[int(k)] for k in rng.choice(len(TRIPLES), 2, replace=False))
        one, two = float(2.0 ** rng.integers(-3, 0)), float(2.0 ** rng.integers(-3, 0))
        radii = [one * 1.0, one * (c - 1.0), two * s - one * 1.0]
        if radii[2] <= 0:
            return pairs(rng)
        fast = float(2.0 ** rng.integers(-8, 9))
        far = 10.0 ** float(rng.uniform(-5, 1))
        bit = 2.0**-50 * 2.0 ** float(np.ceil(np.log2(far + one * c + two * s)))
        way = float(np.round(far / bit)) * bit
        places = [(0.0, 0.0), (way + one * a, one * b), (way + two * p, -two * q)]
        velocities = [(fast, 0.0), (0.0, 0.0), (0.0, 0.0)]
        t = way / fast
        if t <= 0.0:
            return pairs(rng)
    elif kind == 1:  # mirror images: the numbers may be any
        x, y = float(rng.uniform(0.3, 1.9)) * r, 0.0
        y = float(rng.uniform(1.01, 1.9)) * r
        if math.hypot(x, y) < 2.02 * r:
            x = math.sqrt(4.2 * r * r - y * y) + float(rng.uniform(0, 1)) if y < 2 * r else x
        v = (x - math.sqrt(max(4 * r * r - y * y, 0.0))) / t
        places = [(0.0, 0.0), (x, y), (x, -y)]
        velocities = [(v, 0.0), (0.0, 0.0), (0.0, 0.0)]
        radii = [r, r, r]
    else:  # at the tie the others are at Pythagorean distances; all come from t before
        a, b, c = TRIPLES[int(rng.integers(len(TRIPLES)))]
        unit = 2.0 ** -int(rng.integers(2, 5))
        one, two = (a * unit, b * unit), (a * unit, -b * unit) if rng.random() < 0.5 else (-b * unit, a * unit)
        reach = c * unit
        radii = [reach / 2] * 3
        if math.dist(one, two) < reach * 1.001:
            two = (-b * unit, -a * unit)
        places, velocities = [], []
        for at in ((0.0, 0.0), one, two):
            v = (
                _dyadic(rng, -1, 1, 5) / t if t > 1 else _dyadic(rng, -1, 1, 5),
                _dyadic(rng, -1, 1, 5) / t if t > 1 else _dyadic(rng, -1, 1, 5),
            )
            if at != (0.0, 0.0):
                n = math.hypot(*at)
                if (v[0] - velocities[0][0]) * at[0] / n + (v[1] - velocities[0][1]) * at[1] / n > 0:
                    v = (2 * velocities[0][0] - v[0], 2 * velocities[0][1] - v[1])
            places.append((at[0] - v[0] * t, at[1] - v[1] * t))
            velocities.append(v)
    until = 2.0 * t
    try:
        made = _made(rng, places, velocities, radii, [1.0, float(rng.choice([1.0, 2.0])), 1.0], until, [])
    except es.SceneError:
        return pairs(rng)
    return Case(made)


def walls(rng: np.random.Generator) -> Case:
    """A disk or point meets two walls at once: mirror images of each other, or two sides of a box."""
    t = _when(rng)
    r = float(rng.choice([0.5, 0.25, 0.0]))
    if rng.random() < 0.7:
        x = float(rng.choice([3.0, 1.0, 0.625]))
        rise, wide = float(rng.uniform(0.2, 3.0)), float(rng.choice([3.0, 2.0]))
        low = _dyadic(rng, -1, 1)
        norm = math.hypot(rise, wide)
        at = low + r * norm / wide  # where it meets both
        drop = float(rng.uniform(0.2, 2.0))
        joined = rng.random() < 0.5
        points = [(x - wide, low + rise), (x, low), (x + wide, low + rise)]
        chain = (
            [es.Polyline(tuple(points))]
            if joined
            else [es.Segment(points[0], points[1]), es.Segment(points[1], points[2])]
        )
        if r == 0.0 and rng.random() < 0.5:  # a gap between them: no end is met
            r = 0.25
            at = low + r * norm / wide
        try:
            made = _made(rng, [(x, at + drop)], [(0.0, -drop / t)], [r], [1.0], 2.0 * t, chain)
        except es.SceneError:
            return walls(rng)
        return Case(made)
    size = 4.0
    way = _dyadic(rng, 0.25, 1.5)
    v = 2.0 ** float(np.floor(np.log2(way / t)))
    share = _dyadic(rng, 0.25, 1.0, 4)
    r = 0.25
    place = (r + v * t, r + share * v * t)
    if not (r <= place[0] <= size - r and r <= place[1] <= size - r):
        return walls(rng)
    e = float(rng.choice([1.0, 0.5]))
    made = scene(
        position=[place],
        velocity=[(-v, -share * v)],
        radius=r,
        domain=es.Box((size, size)),
        restitution=e,
        until=2.0 * t,
        events=60,
    )
    return Case(made)


FAMILIES = {"P2-pairs": pairs, "P2-walls": walls}
