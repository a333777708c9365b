"""Random scenes with points: aimed at vertices, joints and kinks, kicked at the time of a contact, dropped onto floors."""

from __future__ import annotations

import math

import numpy as np

import eventsim as es
from tests.points.judge import Point

Generator = np.random.Generator


def polygon(rng: Generator) -> list[Point]:
    """A star-shaped polygon of 3 to 8 corners, some of which may be concave."""
    n = int(rng.integers(3, 9))
    while True:
        angles = np.sort(rng.uniform(0.0, 2.0 * math.pi, n))
        gaps = np.diff(np.append(angles, angles[0] + 2.0 * math.pi))
        if gaps.min() > 0.2 and gaps.max() < 2.8:
            break
    radius = rng.uniform(1.0, 3.0, n) if rng.random() < 0.5 else np.full(n, rng.uniform(1.0, 3.0))
    cx, cy = rng.uniform(3.0, 6.0, 2)
    return [(float(cx + r * math.cos(a)), float(cy + r * math.sin(a))) for r, a in zip(radius, angles, strict=True)]


def kinked(rng: Generator) -> list[Point]:
    """A square, some of whose sides have a slight bend, 1e-2 to 1e-15, outwards or inwards."""
    corners = [(1.0, 1.0), (4.0, 1.5), (3.5, 4.5), (0.5, 4.0)]
    found: list[Point] = []
    for (ax, ay), (bx, by) in zip(corners, (*corners[1:], corners[0]), strict=True):
        found.append((ax, ay))
        share, bend = rng.uniform(0.2, 0.8), float(rng.choice([-1.0, 1.0])) * 10.0 ** rng.uniform(-15.0, -2.0)
        found.append((ax + share * (bx - ax) - bend * (by - ay), ay + share * (by - ay) + bend * (bx - ax)))
    return found


def inner_point(rng: Generator, corners: list[Point], inside: object) -> Point:
    """A random place inside a polygon, away from its edges."""
    low, high = np.min(corners, axis=0), np.max(corners, axis=0)
    while True:
        x, y = rng.uniform(low, high)
        if inside(corners, float(x), float(y)) and _margin(corners, x, y) > 0.05:  # type: ignore[operator]
            return float(x), float(y)


def _margin(corners: list[Point], x: float, y: float) -> float:
    from tests.points.judge import margin

    return margin(corners, x, y)


def aimed(rng: Generator, start: Point, target: Point) -> Point:
    """A velocity towards a target, to some units in the last place, or exactly where that can be."""
    if rng.random() < 0.1:  # the exact difference, a hit to the last bit where it is a float
        return target[0] - start[0], target[1] - start[1]
    speed = rng.uniform(0.5, 3.0) / math.dist(start, target)
    u, w = (target[0] - start[0]) * speed, (target[1] - start[1]) * speed
    off = rng.integers(-3, 4, 2)
    return float(u + off[0] * np.spacing(u)), float(w + off[1] * np.spacing(w))


def point_scene(position: Point, velocity: Point, **scene: object) -> es.Scene:
    """One point."""
    return es.Scene(disks=es.Disks([position], [velocity], 0.0, 1.0), **scene)
