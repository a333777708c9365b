"""A pile that comes to rest: the scene that an event-driven engine should not be asked for, and how far a state is from rest."""

from __future__ import annotations

import math

import numpy as np

from eventsim.record.events import Floats
from eventsim.scene import Box, Disks, Scene
from eventsim.scene.stage import Stage
from eventsim.validation.follow import distances

COLUMNS, ROWS = 5, 4
PITCH, HEIGHT = 1.06, 1.25
"""Diameters between the starting places along x and y."""


def pile(contact_duration: float | None = 0.01, until: float = 60.0, seed: int = 1) -> Scene:
    """Twenty disks of diameter 1 that fall into a box under gravity 1, restitution 1/2.

    contact_duration: what lets an event-driven engine go on when contacts accumulate; stepped engines do not need it.
    """
    rng = np.random.default_rng(seed)
    sites = np.array([(i, j) for j in range(ROWS) for i in range(COLUMNS)], dtype=float)
    position = np.column_stack([0.55 + PITCH * sites[:, 0], 0.7 + HEIGHT * sites[:, 1]])
    position[:, 0] += rng.uniform(-0.02, 0.02, len(sites))
    return Scene(
        disks=Disks(position, radius=0.5),
        domain=Box((0.1 + PITCH * COLUMNS, 1.0 + HEIGHT * ROWS)),
        gravity=(0.0, -1.0),
        restitution=0.5,
        contact_duration=contact_duration,
        until=until,
        name="pile",
    )


def unrest(stage: Stage, position: Floats, velocity: Floats) -> float:
    """How far a state is from rest: the larger of speed / sqrt(g d), root mean square, and the deepest overlap / d.

    position, velocity: (n, 2) on the scene's axes.  A pile at rest that does not overlap has 0.
    """
    diameter = 2.0 * float(stage.radius.mean())
    pull = math.hypot(*stage.gravity) if stage.gravity is not None else 1.0
    speed = float(np.sqrt(np.mean(np.sum(velocity**2, axis=-1)))) / math.sqrt(pull * diameter)
    apart = distances(stage, position[:, None, :].copy(), position[None, :, :])
    reach = stage.radius[:, None] + stage.radius[None, :]
    deepest = float(np.max((reach - apart)[~np.eye(stage.n, dtype=bool)], initial=0.0))
    for axis, wall, side, _ in stage.boundaries:
        gap = side * (position[:, axis] - stage.corner[axis] - wall) - stage.radius
        deepest = max(deepest, float(-gap.min()))
    return max(speed, deepest / diameter)
