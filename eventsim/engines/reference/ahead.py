"""Whether anything is ahead of disks on the open plane, where cells alone make no end of looking."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eventsim.engines.base import Motion, Snapshot
from eventsim.engines.reference.calendar import Calendar
from eventsim.engines.reference.predict import Predictor
from eventsim.engines.reference.state import EngineState
from eventsim.scene.stage import Stage

SLACK = 2.0**-20
"""What a screen of floats allows for, relative to the numbers: far more than they are rounded by."""


def meets_again(stage: Stage, saved: Snapshot, motion: Motion) -> bool:
    """Whether a disk on the open plane will meet another one or a wall; motion: where all are at the snapshot.

    O(n^2) where none will; so ask only where no contact is known.
    """
    state, calendar = EngineState(stage), Calendar()
    state.restore(saved)
    predictor = Predictor(stage, state, calendar, None)
    straight = _falls_alike(state)
    for i in range(stage.n):
        predictor.predict_walls(i)
        later = np.arange(i + 1, stage.n)
        predictor.predict_pairs(i, later[_may_meet(stage, motion, i)].tolist() if straight else later.tolist())
        if calendar.first() is not None:
            return True
    return False


def _falls_alike(state: EngineState) -> bool:
    """Whether all disks fly straight as seen from each other."""
    return len(set(state.gravity_x)) == 1 and len(set(state.gravity_y)) == 1


def _may_meet(stage: Stage, motion: Motion, i: int) -> NDArray[np.bool_]:
    """Which of the disks behind i may meet it on a straight way, a few too many."""
    with np.errstate(all="ignore"):
        dx, dy = motion.x[i + 1 :] - motion.x[i], motion.y[i + 1 :] - motion.y[i]
        du, dw = motion.vx[i + 1 :] - motion.vx[i], motion.vy[i + 1 :] - motion.vy[i]
        speed, distance = np.hypot(du, dw), np.hypot(dx, dy)
        reach = stage.radius[i + 1 :] + stage.radius[i]
        recedes = dx * du + dy * dw > SLACK * distance * speed
        misses = np.abs(dx * dw - dy * du) > speed * (reach + SLACK * (distance + reach))
    meets: NDArray[np.bool_] = ~(recedes | misses)
    return meets
