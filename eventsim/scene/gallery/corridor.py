"""A gas of equal disks on one line: chaos-free, and solvable for ever.

What happens
    Equal disks in a corridor so narrow that they keep their order. At each contact two neighbours
    exchange their velocities, at the end walls a velocity is reversed.

Why
    Cut the diameters out of the line and the disks become points which pass through each other: each
    velocity travels along the corridor as if it were alone. So the state at any time is known in closed
    form - fold the free paths into the corridor, sort them, put the diameters back - and no other gas
    of many disks tests an engine's clock for so long.

Source
    D. W. Jepsen, Dynamics of a simple many-body system of hard rods, Journal of Mathematical Physics 6,
    405 (1965), doi:10.1063/1.1704288.

A question
    How fast does the mean squared displacement of the middle disk grow, linearly or with the root of
    time? Why?
"""

import numpy as np

from eventsim.scene.disks import Disks
from eventsim.scene.domain import Box
from eventsim.scene.gallery._demand import demand
from eventsim.scene.scene import Scene

RADIUS = 0.25


def scene(*, n: int = 50, seed: int = 1, length: float = 100.0) -> Scene:
    """`n` disks of diameter 1/2 in a corridor of `length`, Maxwell velocities along it from `seed`."""
    demand(n >= 1, "n", n, "must be at least 1")
    free = length - 2 * RADIUS * n
    demand(free > 0, "length", length, f"must be above the {2 * RADIUS * n:g} that {n} diameters take")
    rng = np.random.default_rng(seed)
    x = np.sort(rng.uniform(0.0, free, n)) + RADIUS * (2 * np.arange(n) + 1)
    height = 2.5 * RADIUS
    disks = Disks(
        position=np.column_stack([x, np.full(n, height / 2)]),
        velocity=np.column_stack([rng.standard_normal(n), np.zeros(n)]),
        radius=RADIUS,
    )
    return Scene(disks=disks, domain=Box((length, height)), events=10_000, name="corridor gas")
