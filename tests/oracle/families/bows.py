"""Round walls: P7 (nearly flat arcs), containers and arcs, whispering galleries."""

from __future__ import annotations

import math

import numpy as np

import eventsim as es
from tests.oracle.families.case import Case, Place, scatter, scene


def flat(rng: np.random.Generator) -> Case:
    """P7: disks and points at an arc whose sagitta is a small part of its chord."""
    sagitta = 10.0 ** float(rng.uniform(-12, -1)) * float(rng.choice([1.0, -1.0]))
    turn = float(rng.choice([0.0, 0.0, rng.uniform(0, 2 * math.pi)]))
    x0, y0 = (1.0, 1.0) if rng.random() < 0.5 else (float(rng.uniform(-3, 3)), float(rng.uniform(-3, 3)))
    ex, ey = math.cos(turn), math.sin(turn)

    def place(along: float, up: float) -> Place:
        return x0 + along * ex - up * ey, y0 + along * ey + up * ex

    wall = es.Arc(place(0.0, 0.0), place(float(rng.choice([1.0, rng.uniform(0.3, 1.7)])), sagitta), place(2.0, 0.0))
    n = int(rng.integers(1, 3))
    radii = [float(rng.choice([0.0, 0.1, 0.25])) for _ in range(n)]
    places, velocities = [], []
    for k, r in enumerate(radii):
        side = float(rng.choice([1.0, -1.0]))
        start = float(rng.uniform(0.2, 0.8)) + k
        places.append(place(start, side * (r + abs(sagitta) + float(rng.uniform(0.1, 1.0)))))
        goal = place(float(rng.uniform(-0.2, 2.2)), 0.0)
        speed = float(rng.uniform(0.3, 2.0))
        dx, dy = goal[0] - places[-1][0], goal[1] - places[-1][1]
        length = math.hypot(dx, dy)
        velocities.append((speed * dx / length, speed * dy / length))
    pull = (0.3 * float(rng.normal()), -1.0) if rng.random() < 0.2 else None
    made = scene(
        position=places,
        velocity=velocities,
        radius=radii,
        domain=es.Open(),
        walls=[wall],
        gravity=pull,
        restitution=float(rng.choice([1.0, 0.8])),
        until=float(rng.uniform(2, 6)),
        events=30,
    )
    return Case(made, close=1e-12 / (max(radii) or 1.0))  # 1e-12 of lengths of 1


def containers(rng: np.random.Generator) -> Case:
    """Disks in a container, some under gravity, some with an arc or a chord inside."""
    size = float(rng.choice([1.0, 3.0, 2.7]))
    centre = (0.0, 0.0) if rng.random() < 0.5 else (float(rng.uniform(-2, 2)), float(rng.uniform(-2, 2)))
    n = int(rng.integers(1, 6))
    radii = [float(rng.choice([0.1, 0.15, 0.2, 0.0])) * size for _ in range(n)]
    walls = [es.Circle(centre, size)]
    arc = rng.random() < 0.4
    if arc:
        walls.append(
            es.Arc(
                (centre[0] - 0.3 * size, centre[1]),
                (centre[0], centre[1] + 0.3 * size),
                (centre[0] + 0.3 * size, centre[1]),
            )
        )

    def allowed(x: float, y: float, r: float) -> bool:
        away = math.hypot(x - centre[0], y - centre[1])
        if away > 0.999 * size - r:
            return False
        if not arc:
            return True
        from_end = math.hypot(abs(x - centre[0]) - 0.3 * size, y - centre[1])
        return abs(away - 0.3 * size) > 1.01 * r and from_end > 1.01 * r

    places = scatter(rng, radii, (centre[0] - size, centre[1] - size), (centre[0] + size, centre[1] + size), allowed)
    if places is None:
        return containers(rng)
    pull = (0.0, -float(rng.choice([1.0, 9.81]))) if rng.random() < 0.3 else None
    made = scene(
        position=places,
        velocity=rng.normal(0, 1, (n, 2)),
        radius=radii,
        domain=es.Open(),
        walls=walls,
        gravity=pull,
        restitution=float(rng.choice([1.0, 1.0, 0.9])),
        until=float(rng.uniform(1, 8)) * size,
        events=60,
    )
    return Case(made)


def arcs(rng: np.random.Generator) -> Case:
    """Disks and points among arcs in a box."""
    walls = []
    for _ in range(int(rng.integers(1, 4))):
        x, y, r = float(rng.uniform(1, 5)), float(rng.uniform(1, 5)), float(rng.uniform(0.2, 0.9))
        a, w = float(rng.uniform(0, 2 * math.pi)), float(rng.uniform(0.3, 2.9))
        walls.append(es.Arc(*((x + r * math.cos(a + s * w), y + r * math.sin(a + s * w)) for s in (-1, 0, 1))))
    n = int(rng.integers(1, 5))
    radii = [float(rng.choice([0.0, 0.1, 0.2])) for _ in range(n)]
    places = scatter(rng, radii, (0.0, 0.0), (6.0, 6.0))
    assert places is not None
    pull = (0.0, -1.0) if rng.random() < 0.3 else None
    try:
        made = scene(
            position=places,
            velocity=rng.normal(0, 1, (n, 2)),
            radius=radii,
            domain=es.Box((6.0, 6.0)),
            walls=walls,
            gravity=pull,
            restitution=float(rng.choice([1.0, 0.9])),
            until=float(rng.uniform(4, 20)),
            events=30,
        )
    except es.SceneError:  # a disk across an arc
        return arcs(rng)
    return Case(made)


def galleries(rng: np.random.Generator) -> Case:
    """A disk that creeps along the inside of a container, or of an arc."""
    size, r = float(rng.choice([1.0, 2.0, 1.7])), float(rng.choice([0.1, 0.3, 0.0]))
    room = size - r
    start, angle = float(rng.uniform(0, 2 * math.pi)), 10.0 ** float(rng.uniform(-4, -0.3))
    away = room * (1 - float(rng.choice([1e-3, 1e-6, rng.uniform(0, 0.01)])))
    place = (away * math.cos(start), away * math.sin(start))
    speed, course = float(rng.choice([1.0, 2.5])), start + math.pi / 2 + angle * float(rng.choice([1, -1]))
    walls = [es.Circle((0.0, 0.0), size)]
    if rng.random() < 0.3:
        walls = [es.Arc((-size, 0.0), (0.0, -size), (size, 0.0))]
    made = scene(
        position=[place],
        velocity=[(speed * math.cos(course), speed * math.sin(course))],
        radius=r,
        domain=es.Open(),
        walls=walls,
        restitution=float(rng.choice([1.0, 1.0, 1.0, 0.9])),
        until=float(rng.uniform(1, 5)) * size / speed,
        events=100,
    )
    return Case(made)


FAMILIES = {"P7": flat, "containers": containers, "arcs": arcs, "galleries": galleries}
