"""Points that are kicked at the very time at which they meet a slanted wall or an arc."""

from __future__ import annotations

import math

import eventsim as es
from tests.points.families import NEAR, Verdict
from tests.points.scenes import Generator, point_scene


def kicked(rng: Generator, engine: str) -> Verdict:
    """A point in a triangle, or in an arc with its chord, kicked when it meets a wall: into it, along it or away."""
    round_ = rng.random() < 0.4
    cx, cy, radius = *rng.uniform(3.0, 6.0, 2), rng.uniform(1.0, 2.0)
    a, b = rng.uniform(0.0, 2.0 * math.pi), rng.uniform(1.5, 3.0)
    corners = [(float(cx + radius * math.cos(a + t)), float(cy + radius * math.sin(a + t))) for t in (0.0, 0.5 * b, b)]
    if round_:
        walls: tuple[es.Arc | es.Segment | es.Polygon, ...] = (es.Arc(*corners), es.Segment(corners[0], corners[2]))
    else:
        walls = (es.Polygon(tuple(corners)),)
    share = rng.dirichlet([2.0, 2.0, 2.0])
    start = tuple(float(sum(s * c[k] for s, c in zip(share, corners, strict=True))) for k in (0, 1))
    gravity = (0.0, -1.0) if rng.random() < 0.3 else None
    scene = point_scene(start, tuple(rng.normal(size=2).tolist()), domain=es.Open(), walls=walls, gravity=gravity)
    sim = es.Simulation(scene, engine=engine)
    for _ in range(int(rng.integers(1, 5))):
        sim.step()
        x, y = sim.state.position[0].tolist()
        kick = tuple(rng.normal(size=2).tolist())
        sim.set_velocity(0, kick)
    sim.advance_to(sim.time + 0.3)
    x, y = sim.state.position[0].tolist()
    inside = _is_in(corners, x, y, NEAR)
    if round_:
        chord = _side(corners[0], corners[2], x, y) * _side(corners[0], corners[2], *corners[1])
        inside = chord > -NEAR and math.hypot(x - cx, y - cy) < radius + NEAR
    return Verdict("" if inside else f"outside at ({x}, {y})", "", False)


def _is_in(corners: list[tuple[float, float]], x: float, y: float, slack: float) -> bool:
    sides = [_side(one, other, x, y) for one, other in zip(corners, (*corners[1:], corners[0]), strict=True)]
    return min(sides) > -slack or max(sides) < slack


def _side(one: tuple[float, float], other: tuple[float, float], x: float, y: float) -> float:
    return (other[0] - one[0]) * (y - one[1]) - (other[1] - one[1]) * (x - one[0])
