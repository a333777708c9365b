"""When the clock turns over and how long the next window is: what follows from rows, and, where there are none, from the flights.

At the end of a window with rows the clock turns over.  A window without one stays open: nothing needs digits while nothing
happens.  Then the clock jumps, by whole epochs: to shortly before the next wrap; to shortly before the next contact, once that
has come; at a kick to the present.  So what comes after a long time has the digits of what comes early, and when the clock turns
over follows from scene and rows.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from eventsim.formulas.clock import FEW, MOST_EPOCHS, epochs_before, next_window, window_after_idle
from eventsim.formulas.real import NEVER
from eventsim.record.events import Floats
from eventsim.scene.stage import Stage


class Anchors(NamedTuple):
    """Where the flights of all disks begin in the present window, arrays (n,); gx, gy: None without gravity, or one for all."""

    t: Floats
    x: Floats
    y: Floats
    vx: Floats
    vy: Floats
    gx: Any
    gy: Any

    @property
    def fastest(self) -> float:
        """The largest component of a velocity."""
        return max(float(np.abs(self.vx).max()), float(np.abs(self.vy).max()))

    def kicked(self, i: int, vx: float, vy: float) -> Anchors:
        """The same with another velocity of disk i."""
        velocities = self.vx.copy(), self.vy.copy()
        velocities[0][i], velocities[1][i] = vx, vy
        return self._replace(vx=velocities[0], vy=velocities[1])


Look = Callable[[], Anchors]
"""Gives the anchors; only who needs them looks."""


def exponent_after(stage: Stage, exponent: int, rows: int, look: Look) -> int:
    """The exponent of the window behind one that has ended, or that a contact has ended behind its end; rows: logged in it."""
    clock = stage.clock
    if rows:
        if exponent >= clock.paced and rows < FEW * stage.n:
            return clock.window_at_pace(exponent, look().fastest)
        return next_window(exponent, rows, stage.n, clock.window_cap)
    anchors = look()
    return window_after_idle(exponent, bool(np.any(anchors.t > 0.0)), _idle_cap(stage, anchors))


def exponent_kicked(stage: Stage, exponent: int, look: Look) -> int:
    """The exponent that a window has after a kick, not larger than before; look: at the flights after it."""
    return exponent if exponent <= stage.clock.idle_cap else min(exponent, _idle_cap(stage, look()))


def epochs_to_kick(stage: Stage, epoch: int, now: float, rows: int, shortened: bool) -> int:
    """By how many epochs the clock jumps at a kick; 0: it does not turn over.

    It does where its window had no row, and where that is to be shorter (shortened), unless it has just begun.
    """
    epochs = now / stage.epoch_length
    if (rows and not shortened) or not 1.0 <= epochs <= MOST_EPOCHS - epoch:
        return 0
    return math.floor(epochs)


def epochs_to_wrap(stage: Stage, epoch: int, exponent: int, anchors: Anchors) -> int | None:
    """Where a window without a row ends, from the flights at its end; None where no disk will wrap any more."""
    if not stage.periodic:
        return None
    due = float(next_wraps(anchors, stage.period)[0].min())
    if due == NEVER:
        return None
    return max(min(epochs_before(due, exponent, stage.epoch_length), MOST_EPOCHS - epoch), 1 << exponent)


def _idle_cap(stage: Stage, anchors: Anchors) -> int:
    return min(stage.clock.idle_cap + stage.clock.slowing(anchors.fastest), MOST_EPOCHS.bit_length() - 1)


def next_wraps(anchors: Anchors, period: tuple[float | None, float | None]) -> tuple[Floats, Any, Floats]:
    """When each disk next passes a periodic boundary, along which axis, and where it comes in."""
    count = len(anchors.t)
    due, axis, edge = np.full(count, np.inf), np.zeros(count, dtype=np.int8), np.zeros(count)
    coordinates = ((anchors.x, anchors.vx, anchors.gx), (anchors.y, anchors.vy, anchors.gy))
    for number, (length, (x, v, g)) in enumerate(zip(period, coordinates, strict=True)):
        if length is None:
            continue
        for target, side in ((length, -1.0), (0.0, 1.0)):
            time = anchors.t + crossing_delays(x, v, g, target, side)
            sooner = time < due
            due[sooner] = time[sooner]
            axis[sooner] = number
            edge[sooner] = length - target
    return due, axis, edge


def crossing_delays(x: Floats, v: Floats, g: Any, target: float, side: float) -> Floats:
    """`formulas.crossing.crossing_delay` of many coordinates."""
    gap, rate = side * (x - target), side * v
    falling, closed = rate < 0.0, ~(gap > 0.0)
    with np.errstate(all="ignore"):  # the branches that are not taken are computed, too
        if g is None:
            return np.where(falling, np.where(closed, 0.0, gap / -rate), NEVER)
        pull = side * g
        discriminant = rate * rate - (2.0 * pull) * gap
        crosses = discriminant > 0.0
        root = np.sqrt(discriminant)
        direct = np.where(closed, 0.0, np.where(crosses, (2.0 * gap) / (root - rate), NEVER))
        returning = np.where(crosses, (rate + root) / -pull, rate / -pull)
        return np.where(falling, direct, np.where(pull < 0.0, returning, NEVER))
