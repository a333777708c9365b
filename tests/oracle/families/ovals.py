"""Points in and around ellipses, where the version has them."""

from __future__ import annotations

import math

import numpy as np

import eventsim as es
from tests.oracle.families.case import Case, aim, scene


def ellipses(rng: np.random.Generator) -> Case:
    """A point in an ellipse or outside of it: anywhere, through a focus, nearly along it."""
    a, b = sorted((float(s) for s in rng.uniform(0.3, 3.0, 2)), reverse=True)
    turn = float(rng.choice([0.0, rng.uniform(0, 2 * math.pi)]))
    e = (math.cos(turn), math.sin(turn))
    x0, y0 = (0.0, 0.0) if rng.random() < 0.5 else (float(c) for c in rng.uniform(-2, 2, 2))

    def place(x: float, y: float) -> tuple[float, float]:
        return x0 + x * e[0] - y * e[1], y0 + x * e[1] + y * e[0]

    angle, inside = float(rng.uniform(0, 2 * math.pi)), rng.random() < 0.8
    far = float(rng.uniform(0.1, 0.99)) if inside else float(rng.uniform(1.1, 2.0))
    start = place(far * a * math.cos(angle), far * b * math.sin(angle))
    focus = math.sqrt(a * a - b * b)
    goal = place(focus, 0.0) if rng.random() < 0.3 else place(*(float(c) for c in rng.uniform(-1, 1, 2)))
    made = scene(
        position=[start],
        velocity=[aim(rng, start, goal, float(rng.uniform(0.3, 3)), 0)],
        radius=0.0,
        domain=es.Open() if inside else es.Box((20.0, 20.0), (-10.0, -10.0)),
        walls=[es.Ellipse((x0, y0), (a, b), e)],
        restitution=float(rng.choice([1.0, 1.0, 0.9])),
        until=float(rng.uniform(3, 20)),
        events=40,
    )
    return Case(made)


FAMILIES = {"ellipses": ellipses} if hasattr(es, "Ellipse") else {}
