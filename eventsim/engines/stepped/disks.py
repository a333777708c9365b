"""All disks of a stepped run at one time, and what moves them: one step of free flight."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from eventsim.engines.stepped.compiled import part
from eventsim.engines.stepped.ground import Ground
from eventsim.record.events import Floats
from eventsim.scene.stage import Stage


class Moving(NamedTuple):
    """Arrays (n,): positions relative to the corner, velocities, radii, masses, wraps around the domain."""

    x: Floats
    y: Floats
    vx: Floats
    vy: Floats
    radius: Floats
    mass: Floats
    wraps_x: NDArray[np.int64]
    wraps_y: NDArray[np.int64]


def moving_disks(stage: Stage) -> Moving:
    """The disks of a stage at its start."""
    mass = np.full(stage.n, stage.common_mass) if stage.mass is None else stage.mass.copy()
    x, y, vx, vy = (np.array(values, dtype=np.float64) for values in (stage.x, stage.y, stage.vx, stage.vy))
    return Moving(x, y, vx, vy, stage.radius.copy(), mass, np.zeros(stage.n, np.int64), np.zeros(stage.n, np.int64))


@part
def fastest(m: Moving) -> float:
    """The largest speed."""
    most = 0.0
    for i in range(len(m.x)):
        most = max(most, m.vx[i] * m.vx[i] + m.vy[i] * m.vy[i])
    return math.sqrt(most)


@part
def fly(m: Moving, ground: Ground, dt: float) -> float:
    """Move all disks along their flights for dt, exactly; the largest speed before."""
    most = 0.0
    fall_x, fall_y = 0.5 * ground.gx * dt * dt, 0.5 * ground.gy * dt * dt
    for i in range(len(m.x)):
        vx, vy = m.vx[i], m.vy[i]
        most = max(most, vx * vx + vy * vy)
        m.x[i] += vx * dt + fall_x
        m.y[i] += vy * dt + fall_y
        m.vx[i] = vx + ground.gx * dt
        m.vy[i] = vy + ground.gy * dt
    wrap(m, ground)
    return math.sqrt(most)


@part
def wrap(m: Moving, ground: Ground) -> None:
    """Bring disks back into a periodic domain, at most one period from it."""
    if ground.length_x < math.inf:
        wrap_along(m.x, m.wraps_x, ground.length_x)
    if ground.length_y < math.inf:
        wrap_along(m.y, m.wraps_y, ground.length_y)


@part
def wrap_along(x: Floats, wraps: NDArray[np.int64], length: float) -> None:
    """Bring one coordinate of all disks back into [0, length)."""
    for i in range(len(x)):
        if x[i] < 0.0 or x[i] >= length:
            turns = math.floor(x[i] / length)
            x[i] -= turns * length
            wraps[i] += int(turns)
            if x[i] >= length:  # -1e-17 + 1.0
                x[i] = 0.0
                wraps[i] += 1
