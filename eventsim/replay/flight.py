"""Flying many disks at once: the operations of `formulas.motion` and `formulas.crossing`, for arrays.

NumPy's float64 operations are those of Python's floats, so the bits are those of the engine; a test compares.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eventsim.formulas.motion import position, velocity
from eventsim.formulas.real import NEVER
from eventsim.record.events import Column, Floats
from eventsim.replay.windows import Windows
from eventsim.scene.stage import Stage


@dataclass(slots=True)
class Flights:
    """Free flights of disks, arrays (n,): window of the clock, remainder t in it, place and velocity at t.

    gx, gy: each disk's own acceleration, 0 where it is immovable, that along its wall where it rests on one; None in a scene
    without gravity.
    """

    window: NDArray[np.int64]
    t: Floats
    x: Floats
    y: Floats
    vx: Floats
    vy: Floats
    gx: Floats | None
    gy: Floats | None

    def take(self, chosen: Column) -> Flights:
        """Return copies of some of the flights."""
        values: list[Any] = [getattr(self, field.name) for field in fields(self)]
        parts: list[Any] = [None if value is None else value[chosen] for value in values]
        return Flights(*parts)

    def put(self, chosen: Column, others: Flights) -> None:
        """Replace some of the flights."""
        for name in ("window", "t", "x", "y", "vx", "vy"):
            getattr(self, name)[chosen] = getattr(others, name)

    def advance(self, t: Floats) -> None:
        """Take every flight to its remainder t in its window."""
        lag = t - self.t
        self.t = t
        self.x, self.y = position(self.x, self.vx, lag, self.gx), position(self.y, self.vy, lag, self.gy)
        self.vx, self.vy = velocity(self.vx, lag, self.gx), velocity(self.vy, lag, self.gy)


def start_flights(stage: Stage) -> Flights:
    """Return the flights that disks begin with."""
    window, t = np.zeros(stage.n, dtype=np.int64), np.zeros(stage.n)
    gx = gy = None
    if stage.gravity is not None:
        falls = np.ones(stage.n) if stage.mass is None else np.isfinite(stage.mass)
        gx, gy = np.where(falls, stage.gravity[0], 0.0), np.where(falls, stage.gravity[1], 0.0)
    return Flights(window, t, stage.x.copy(), stage.y.copy(), stage.vx.copy(), stage.vy.copy(), gx, gy)


def fly(flights: Flights, stage: Stage, windows: Windows, window: int, remainder: float) -> None:
    """Take every flight to (window, remainder), through the wraps and turnovers on its way, as the engine does."""
    lengths = np.array(windows.length[: window + 1])
    busy = np.arange(len(flights.t))
    while len(busy):
        now = flights.take(busy)
        behind = now.window < window
        limit = np.where(behind, lengths[now.window], remainder)
        wraps = np.zeros(len(busy), dtype=np.bool_)
        if stage.periodic:
            due, axis, edge = next_wrap(now, stage.period)
            wraps = np.where(behind, due < limit, due <= limit)  # at the same time, the clock turns over first
            limit = np.where(wraps, due, limit)
        now.advance(limit)
        if stage.periodic:
            now.x[wraps & (axis == 0)] = edge[wraps & (axis == 0)]
            now.y[wraps & (axis == 1)] = edge[wraps & (axis == 1)]
        turns = behind & ~wraps
        now.t[turns] = 0.0
        now.window[turns] += 1
        flights.put(busy, now)
        busy = busy[behind | wraps]


def next_wrap(flights: Flights, period: tuple[float | None, float | None]) -> tuple[Floats, Column, Floats]:
    """Return, for every flight, when it next passes a periodic boundary, along which axis, and where it comes in."""
    count = len(flights.t)
    due, axis, edge = np.full(count, np.inf), np.zeros(count, dtype=np.int8), np.zeros(count)
    coordinates = ((flights.x, flights.vx, flights.gx), (flights.y, flights.vy, flights.gy))
    for number, (length, (x, v, g)) in enumerate(zip(period, coordinates, strict=True)):
        if length is None:
            continue
        for target, side in ((length, -1.0), (0.0, 1.0)):
            time = flights.t + crossing_delays(x, v, g, target, side)
            sooner = time < due
            due[sooner] = time[sooner]
            axis[sooner] = number
            edge[sooner] = length - target
    return due, axis, edge


def crossing_delays(x: Floats, v: Floats, g: Floats | None, target: float, side: float) -> Floats:
    """Return `formulas.crossing.crossing_delay` of many coordinates."""
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
