"""Plain gases in boxes, channels, periodic boxes."""

from __future__ import annotations

import numpy as np

import eventsim as es
from tests.oracle.families.case import Case, scatter, scene


def gas(rng: np.random.Generator) -> Case:
    """Equal disks, a few, at any density."""
    n = int(rng.integers(3, 11))
    size = float(rng.choice([1.0, 4.0, 10.0]))
    eta = float(rng.uniform(0.02, 0.45))
    r = float(np.sqrt(eta * size * size / (n * np.pi)))
    places = scatter(rng, [r] * n, (0.0, 0.0), (size, size))
    if places is None:
        return gas(rng)
    kind = int(rng.integers(4))
    domain = [es.Box((size, size)), es.Periodic((size, size)), es.Channel((size, size)), es.Open()][kind]
    e = float(rng.choice([1.0, 1.0, 0.9, 0.5]))
    made = scene(
        position=places,
        velocity=rng.normal(0, 1, (n, 2)),
        radius=r,
        domain=domain,
        restitution=None if e == 1.0 else e,
        until=float(rng.uniform(1, 6)) * size,
        events=40 * n,
    )
    return Case(made)


FAMILIES = {"gases": gas}
