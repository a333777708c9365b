"""P3: what comes after a long spell of nothing."""

from __future__ import annotations

import numpy as np

import eventsim as es
from tests.oracle.families.case import Case, scatter, scene
from tests.oracle.story import Kick


def _spell(rng: np.random.Generator) -> float:
    return float(rng.choice([1e6, 1e9, 1e12, 1e15])) * float(rng.choice([1.0, rng.uniform(0.5, 2.0)]))


def kicked(rng: np.random.Generator) -> Case:
    """Disks at rest in a box or open plane; one is kicked after a long time."""
    n = int(rng.integers(2, 5))
    radii = [float(r) for r in rng.choice([0.5, 0.3], n)]
    places = scatter(rng, radii, (0.0, 0.0), (10.0, 10.0))
    assert places is not None
    late = _spell(rng)
    speed = float(rng.choice([1.0, 0.1, 30.0]))
    angle = float(rng.uniform(0, 2 * np.pi))
    domain = es.Box((10.0, 10.0)) if rng.random() < 0.7 else es.Periodic((10.0, 10.0))
    gravity = None
    made = scene(
        position=places,
        radius=radii,
        domain=domain,
        gravity=gravity,
        restitution=float(rng.choice([1.0, 0.9])),
        until=late + float(rng.uniform(20, 100)) / speed,
        events=40,
    )
    return Case(made, (Kick(int(rng.integers(n)), (speed * float(np.cos(angle)), speed * float(np.sin(angle))), late),))


def approaching(rng: np.random.Generator) -> Case:
    """A slow or a far disk comes at others that are at rest, and then goes on."""
    late = _spell(rng)
    n = int(rng.integers(1, 4))
    radii = [0.5] * (n + 1)
    if rng.random() < 0.5:  # slow, in a box
        places = scatter(rng, radii, (0.0, 0.0), (8.0, 8.0))
        assert places is not None
        angle = float(rng.uniform(0, 2 * np.pi))
        speed = 4.0 / late
        velocity = [(speed * float(np.cos(angle)), speed * float(np.sin(angle)))] + [(0.0, 0.0)] * n
        made = scene(
            position=places,
            velocity=velocity,
            radius=radii,
            domain=es.Box((8.0, 8.0)),
            until=late * float(rng.uniform(5, 50)),
            events=40,
        )
    else:  # one after the other on the way of a fast one
        places = [(0.0, 0.0)] + [
            (3.0 + 4.0 * k + float(rng.uniform(0, 1)), float(rng.uniform(-0.6, 0.6))) for k in range(n)
        ]
        velocity = [(1.0, 0.0)] + [(0.0, 0.0)] * n
        back = float(np.ldexp(1.0, int(np.log2(min(late, 1e12)))))
        places[0] = (-back, 0.0)
        made = scene(position=places, velocity=velocity, radius=radii, domain=es.Open(), until=back * 3.0, events=40)
    return Case(made)


def lone(rng: np.random.Generator) -> Case:
    """A lone disk that wraps, or one that bounces between two walls of a channel."""
    size = (1.3, 0.7) if rng.random() < 0.3 else tuple(float(s) for s in rng.uniform(0.5, 2.0, 2))
    velocity = (0.7, 0.3) if rng.random() < 0.3 else tuple(float(v) for v in rng.normal(0, 1, 2))
    spell = float(rng.choice([1e3, 1e5, 1e6]))
    slow = min(1.0, 5e3 / spell)  # not more than some thousand wraps
    velocity = tuple(v * slow for v in velocity)
    kicks = (Kick(0, (0.5 * slow, 0.25 * slow), spell),) if rng.random() < 0.5 else ()
    made = scene(
        position=[(0.3, 0.2)],
        velocity=[velocity],
        radius=0.1,
        domain=es.Periodic(size),
        until=spell * 1.5,
        events=60,
    )
    return Case(made, kicks)


FAMILIES = {"P3-kicked": kicked, "P3-approaching": approaching, "P3-lone": lone}
