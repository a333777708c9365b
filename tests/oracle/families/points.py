"""P1: points, and disks smaller than the last bits of their places, at floors, in polygons, at vertices and joints."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np

import eventsim as es
from tests.oracle.families.case import Case, Place, aim, polygon_distance, scene

SIDE = 1e-9
"""On the wrong side is what is further behind a wall than this."""


def radius(rng: np.random.Generator) -> float:
    """0 mostly; or below the last bits of a place, or tiny."""
    return float(rng.choice([0.0, 0.0, 0.0, 1e-18, 1e-12]))


def missed(rng: np.random.Generator, goal: Place) -> Place:
    """A goal, or a place beside it: at any distance from a last bit on."""
    if rng.random() < 0.04:
        return goal
    off, angle = 10.0 ** float(rng.uniform(-11, 0)), float(rng.uniform(0, 2 * math.pi))
    return goal[0] + off * math.cos(angle), goal[1] + off * math.sin(angle)


def ulps_of(rng: np.random.Generator) -> int:
    """By how many last bits an aim may be missed."""
    return int(rng.choice([0, 2, 6]))


def floors(rng: np.random.Generator) -> Case:
    """Points on a random polyline floor in a box, under gravity."""
    count = int(rng.integers(3, 7))
    width, height = float(rng.choice([5.0, 4.0, 3.7])), 8.0
    xs = np.sort(rng.uniform(0.05 * width, 0.95 * width, count - 2))
    xs = [0.0, *(float(x) for x in xs), width]
    if min(b - a for a, b in pairwise(xs)) < 0.05 * width:
        return floors(rng)
    grid = rng.random() < 0.3
    ys = [float(round(y * 4) / 4) if grid else float(y) for y in rng.uniform(0.5, 4.0, count)]
    points = [(x, y) for x, y in zip(xs, ys, strict=True)]

    def ground(x: float) -> float:
        return float(np.interp(x, xs, ys))

    n = int(rng.integers(1, 4))
    places = []
    for _ in range(n):
        x = float(rng.choice(xs[1:-1])) if rng.random() < 0.3 and count > 2 else float(rng.uniform(0.1, width - 0.1))
        places.append((x, ground(x) + float(rng.uniform(0.2, 2.0))))
    velocities = [(float(u), float(w)) if rng.random() < 0.5 else (0.0, 0.0) for u, w in rng.normal(0, 1, (n, 2))]

    def inside(x: float, y: float) -> bool:
        steep = max(abs((b - a) / (d - c)) for a, b, c, d in zip(ys, ys[1:], xs, xs[1:], strict=False))
        return y > ground(x) - SIDE * (1.0 + steep)

    return Case(
        scene(
            position=places,
            velocity=velocities,
            radius=radius(rng),
            domain=es.Box((width, height)),
            walls=[es.Polyline(tuple(points), name="floor")],
            gravity=(0.0, -float(rng.choice([1.0, 9.81]))),
            restitution=float(rng.choice([0.3, 0.6, 0.8, 1.0])),
            until=float(rng.uniform(2.0, 8.0)),
            events=60,
        ),
        inside=inside,
    )


def _polygon(rng: np.random.Generator) -> list[Place]:
    """Corners around a middle: convex or not, regular or not."""
    count = int(rng.integers(3, 7))
    middle = (float(rng.uniform(2, 8)), float(rng.uniform(2, 8))) if rng.random() < 0.7 else (5.0, 5.0)
    turn = float(rng.uniform(0, 1))
    regular = rng.random() < 0.4
    corners = []
    for k in range(count):
        angle = 2 * math.pi * (k + turn + (0 if regular else float(rng.uniform(-0.3, 0.3)))) / count
        far = 3.0 if regular else float(rng.uniform(1.0, 4.0))
        corners.append((middle[0] + far * math.cos(angle), middle[1] + far * math.sin(angle)))
    return corners


def _inner(rng: np.random.Generator, corners: list[Place]) -> Place:
    for _ in range(1000):
        x, y = (float(c) for c in rng.uniform(-2, 14, 2))
        if polygon_distance(corners, x, y) > 0.1:
            return x, y
    return float(np.mean([c[0] for c in corners])), float(np.mean([c[1] for c in corners]))


def polygons(rng: np.random.Generator) -> Case:
    """A point in a polygon, aimed at a vertex to some last bits, or anywhere."""
    corners = _polygon(rng)
    start = _inner(rng, corners)
    goal = corners[int(rng.integers(len(corners)))]
    velocity = aim(rng, start, missed(rng, goal), float(rng.uniform(0.5, 3)), ulps_of(rng))
    return Case(
        scene(
            position=[start],
            velocity=[velocity],
            radius=radius(rng),
            domain=es.Open(),
            walls=[es.Polygon(tuple(corners))],
            until=10.0,
            events=30,
        ),
        inside=lambda x, y: polygon_distance(corners, x, y) > -SIDE,
    )


def joints(rng: np.random.Generator) -> Case:
    """A point aimed at where walls of different kinds meet: chain and border, chord and container, arc and chord."""
    which = int(rng.integers(3))
    ulps = ulps_of(rng)
    events, until = 30, 10.0
    walls: list[Any]
    if which == 0:
        width, height = 4.0, 3.0
        at = float(rng.uniform(0.3, 2.7))
        top = (float(rng.uniform(1.0, 3.0)), height)
        walls = [es.Segment((0.0, at), top)]
        start = (float(rng.uniform(0.2, 3.8)), float(rng.uniform(0.1, 2.9)))
        cross = (top[0] - 0.0) * (start[1] - at) - (top[1] - at) * (start[0] - 0.0)
        goal = (0.0, at) if rng.random() < 0.5 else top
        velocity = aim(rng, start, missed(rng, goal), 1.0, ulps)
        above = cross > 0

        def inside(x: float, y: float) -> bool:
            return (
                ((top[0] * (y - at) - (top[1] - at) * x) > -SIDE)
                if above
                else ((top[0] * (y - at) - (top[1] - at) * x) < SIDE)
            )

        return Case(
            scene(
                position=[start],
                velocity=[velocity],
                radius=radius(rng),
                domain=es.Box((width, height)),
                walls=walls,
                until=until,
                events=events,
            ),
            inside=inside,
        )
    angle, width = float(rng.uniform(0, 2 * math.pi)), float(rng.uniform(0.5, 2.5))
    r, centre = float(rng.choice([1.0, 2.0, 1.3])), (0.0, 0.0) if rng.random() < 0.5 else (0.3, -0.2)
    ends = [(centre[0] + r * math.cos(angle + s * width), centre[1] + r * math.sin(angle + s * width)) for s in (-1, 1)]
    if which == 1:
        walls = [es.Circle(centre, r), es.Segment(*ends)]
    else:
        walls = [
            es.Arc(ends[0], (centre[0] + r * math.cos(angle), centre[1] + r * math.sin(angle)), ends[1]),
            es.Segment(*ends),
        ]
    middle = ((ends[0][0] + ends[1][0]) / 2, (ends[0][1] + ends[1][1]) / 2)
    away = r - math.hypot(middle[0] - centre[0], middle[1] - centre[1]) * (1 if width < math.pi / 2 else -1)
    depth = float(rng.uniform(0.2, 0.8)) * away
    start = (middle[0] + depth * math.cos(angle), middle[1] + depth * math.sin(angle))
    velocity = aim(rng, start, missed(rng, ends[int(rng.integers(2))]), 1.0, ulps)
    nx, ny = math.cos(angle), math.sin(angle)

    def within(x: float, y: float) -> bool:
        return (
            math.hypot(x - centre[0], y - centre[1]) < r + SIDE and (x - middle[0]) * nx + (y - middle[1]) * ny > -SIDE
        )

    return Case(
        scene(
            position=[start],
            velocity=[velocity],
            radius=radius(rng),
            domain=es.Open(),
            walls=walls,
            until=until,
            events=events,
        ),
        inside=within,
    )


FAMILIES = {"P1-floors": floors, "P1-polygons": polygons, "P1-joints": joints}
