"""P5: drops that bounce ever lower: on sides of a box, on segments, slopes, vertices."""

from __future__ import annotations

import math

import numpy as np

import eventsim as es
from tests.oracle.families.case import Case, scene


def _law(rng: np.random.Generator) -> tuple[float, float]:
    usual = float(rng.choice([0.9, 0.95, 0.98, 0.99, rng.uniform(0.9, 0.99)]))
    e = usual if rng.random() < 0.93 else float(rng.choice([0.995, 0.999]))  # these have thousands of rows
    g = float(rng.choice([1.0, 9.81, 10.0 ** rng.uniform(0, 3)]))
    return e, g


def on_floors(rng: np.random.Generator) -> Case:
    """On a side of a box, straight down or with a velocity along it."""
    e, g = _law(rng)
    r = float(rng.choice([0.1, 0.0, 0.25]))
    y = r + float(rng.choice([1.0, 10.0 ** rng.uniform(-2, 0.3)]))
    t = math.sqrt(2 * (y - r) / g) * (1 + e) / (1 - e)
    along = 0.0 if rng.random() < 0.6 else float(rng.uniform(0, 18.0)) / (1.3 * t)
    made = scene(
        position=[(0.5 + r, y)],
        velocity=[(along, 0.0)],
        radius=r,
        domain=es.Box((40.0, 5.0)),
        gravity=(0.0, -g),
        restitution=e,
        until=1.3 * t,
        events=int(40 / (1 - e)) + 100,
    )
    return Case(made)


def on_segments(rng: np.random.Generator) -> Case:
    """On a segment, level or sloped, anywhere in a box or in the open."""
    e, g = _law(rng)
    r = float(rng.choice([0.1, 0.0, 0.25]))
    slope = float(rng.choice([0.0, 0.0, rng.uniform(-1.5, 1.5)]))
    length, x0, y0 = 400.0, float(rng.uniform(-3, 3)), float(rng.uniform(-2, 2))
    ex, ey = math.cos(slope), math.sin(slope)
    far = length if slope else 5.0
    start, end = (x0 - far * ex, y0 - far * ey), (x0 + far * ex, y0 + far * ey)
    high = float(rng.choice([1.0, 10.0 ** rng.uniform(-2, 0.3)]))
    place = (x0 - ey * (r + high), y0 + ex * (r + high))
    normal = g * ex
    t = math.sqrt(2 * high / normal) * (1 + e) / (1 - e)
    until = 1.2 * t
    slide = abs(g * ey) * until * until / 2
    if slide > 0.9 * far:  # a segment long enough would lose the digits
        e = float(rng.uniform(0.9, 0.95)) if slide < 200 * far else 0.9
        t = math.sqrt(2 * high / normal) * (1 + e) / (1 - e)
        until = min(1.2 * t, math.sqrt(1.8 * far / max(abs(g * ey), 1e-9)))
    made = scene(
        position=[place],
        radius=r,
        domain=es.Open(),
        walls=[es.Segment(start, end)],
        gravity=(0.0, -g),
        restitution=e,
        until=until,
        events=int(40 / (1 - e)) + 100,
    )
    return Case(made)


def on_vertices(rng: np.random.Generator) -> Case:
    """On the vertex of a polygon or the end of a segment, central or not."""
    e, g = float(rng.uniform(0.5, 0.99)), float(rng.choice([1.0, 9.81, 100.0]))
    r = float(rng.choice([0.1, 0.25, 0.5]))
    x, y = float(rng.integers(-2, 3)), float(rng.uniform(-1, 1))
    off = 0.0 if rng.random() < 0.7 else float(rng.normal(0, 1e-3))
    high = float(rng.uniform(0.2, 2.0))
    wall = (
        es.Polygon(((x, y), (x - 1.0, y - 1.5), (x + 1.5, y - 1.2)))
        if rng.random() < 0.6
        else es.Segment((x, y), (x + float(rng.uniform(-0.5, 0.5)), y - 1.0))
    )
    t = math.sqrt(2 * high / g) * (1 + e) / (1 - e)
    made = scene(
        position=[(x + off, y + r + high)],
        radius=r,
        domain=es.Open() if rng.random() < 0.5 else es.Box((10.0, 10.0), (-5.0, -5.0)),
        walls=[wall],
        gravity=(0.0, -g),
        restitution=e,
        until=1.3 * t,
        events=int(60 / (1 - e)) + 100,
    )
    return Case(made)


FAMILIES = {"P5-floors": on_floors, "P5-segments": on_segments, "P5-vertices": on_vertices}
