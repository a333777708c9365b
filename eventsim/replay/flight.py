"""Flying many disks at once: the operations of `formulas.motion` and `formulas.crossing`, for arrays.

NumPy's float64 operations are those of Python's floats, so the bits are those of the engine; a test compares.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from eventsim.engines.turnover import Anchors, next_wraps
from eventsim.formulas.motion import position, velocity
from eventsim.record.events import Column, Floats
from eventsim.scene.stage import Stage

if TYPE_CHECKING:
    from eventsim.replay.clock_windows import Windows


@dataclass(slots=True)
class Flights:
    """Free flights of disks, arrays (n,): window of the clock, remainder t in it, place and velocity at t.

    gx, gy: each disk's own acceleration, 0 where it is immovable, that along its wall where it rests on one; None in a scene
    without gravity.  spin: None where disks have none.
    """

    window: NDArray[np.int64]
    t: Floats
    x: Floats
    y: Floats
    vx: Floats
    vy: Floats
    gx: Floats | None
    gy: Floats | None
    spin: Floats | None = None

    def take(self, chosen: Column) -> Flights:
        """Return copies of some of the flights."""
        values: list[Any] = [getattr(self, field.name) for field in fields(self)]
        parts: list[Any] = [None if value is None else value[chosen] for value in values]
        return Flights(*parts)

    def put(self, chosen: Column, others: Flights) -> None:
        """Replace some of the flights."""
        for field in fields(self):
            if getattr(self, field.name) is not None:
                getattr(self, field.name)[chosen] = getattr(others, field.name)

    def anchors(self) -> Anchors:
        """Return the flights as those of one window."""
        return Anchors(self.t, self.x, self.y, self.vx, self.vy, self.gx, self.gy)

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
    spin = None if stage.spin is None else stage.spin.copy()
    return Flights(window, t, stage.x.copy(), stage.y.copy(), stage.vx.copy(), stage.vy.copy(), gx, gy, spin)


def fly(flights: Flights, stage: Stage, windows: Windows, window: int, remainder: float) -> None:
    """Take every flight to (window, remainder), through the wraps and turnovers on its way, as the engine does."""
    follow(flights, stage, windows, window, remainder, True)
    flights.advance(np.full(stage.n, remainder))


def follow(flights: Flights, stage: Stage, windows: Windows, window: int, limit: float, inclusive: bool) -> None:
    """Let every flight begin at its last wrap or turnover before a remainder of a window, or up to it (inclusive)."""
    least = int(flights.window.min())
    ends, begins = np.array([*windows.end[least:window], limit]), np.array([*windows.begin[least : window + 1], 0.0])
    busy = np.arange(len(flights.t))
    while len(busy):
        now = flights.take(busy)
        behind = now.window < window
        limits = ends[now.window - least]
        wraps = np.zeros(len(busy), dtype=np.bool_)
        if stage.periodic:
            due, axis, edge = next_wraps(now.anchors(), stage.period)
            early = due < limits  # at the same time, the clock turns over first
            wraps = early | (~behind & (due == limits)) if inclusive else early
            limits = np.where(wraps, due, limits)
        goes = behind | wraps
        now.advance(np.where(goes, limits, now.t))
        if stage.periodic:
            now.x[wraps & (axis == 0)] = edge[wraps & (axis == 0)]
            now.y[wraps & (axis == 1)] = edge[wraps & (axis == 1)]
        turns = behind & ~wraps
        now.window[turns] += 1
        now.t[turns] = begins[now.window[turns] - least]
        going = np.flatnonzero(goes)
        flights.put(busy[going], now.take(going))
        busy = busy[going]
