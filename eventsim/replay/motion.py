"""Motion: the clock and the flights of a log, however its rows are read."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from eventsim.errors import LogError
from eventsim.formulas.clock import clock_time
from eventsim.record.events import Floats, State
from eventsim.record.places import on_scene_axes
from eventsim.replay.any_log import AnyLog
from eventsim.replay.clock_windows import Changes, Windows, stage_of_log, windows_of
from eventsim.replay.flight import Flights, fly
from eventsim.replay.runs import Runs
from eventsim.scene.stage import Stage

ENDLESS = ("quiet",)
"""Reasons to stop after which the disks fly on: there is no event ahead."""


ROUNDING = 2.0**-50
"""How far beyond its end, as a share of the time, a log may be asked for a time that rounding has moved."""


class Motion:
    """The motion that the rows of a full log tell: where its clock stands, and how flights are looked at."""

    def __init__(self, log: AnyLog, runs: Runs, begin: Callable[[], Changes]) -> None:
        """runs, begin: of its rows, see `clock_windows.windows_of`.  Raises LogError where they fit no clock."""
        self.log = log
        self.stage: Stage = stage_of_log(log.provenance)
        self.windows: Windows = windows_of(log.provenance, self.stage, runs, begin)
        self._runs = runs

    @property
    def span(self) -> tuple[float, float]:
        """The times on the scene's clock where the log begins and ends."""
        return self.stage.start_time, self._clock(*self._end())

    def _end(self) -> tuple[int, float]:
        """Return (window, remainder) of the end of the log."""
        ending, runs = self.log.provenance.ending, self._runs
        if ending is not None:
            return self.windows.window_at(ending.epoch), ending.remainder
        return (self.windows.window_at(int(runs.epoch[-1])), runs.latest) if len(runs) else (0, 0.0)

    def _demand_told(self, time: float) -> None:
        """Raise LogError for a time that the log does not cover."""
        if not math.isfinite(time):
            raise LogError(f"there is no state at time {time}: the time must be a finite number")
        if time < self.stage.start_time:
            raise LogError(f"there is no state at time {time!r}: the run begins at {self.stage.start_time!r}")
        ending = self.log.provenance.ending
        if ending is None or ending.reason not in ENDLESS:
            last = self._end()
            end = self._clock(*last)
            by_rounding = time - end <= ROUNDING * max(abs(time), abs(end))
            if time > end and not (by_rounding and self.windows.place(time) <= last):
                raise LogError(f"there is no state at time {time!r}: the log ends at {end!r}")

    def _clock(self, window: int, remainder: float) -> float:
        return clock_time(self.windows.start[window], remainder, self.stage.epoch_length, self.stage.start_time)

    def _flown(self, flights: Flights, window: int, remainder: float, time: float) -> State:
        """Return the state at (window, remainder), to which the flights are taken."""
        fly(flights, self.stage, self.windows, window, remainder)
        corner, period = self.stage.corner, self.stage.period
        x, y = on_scene_axes(flights.x, corner[0], period[0]), on_scene_axes(flights.y, corner[1], period[1])
        return State(time, np.column_stack([x, y]), np.column_stack([flights.vx, flights.vy]), self.log.scene, flights.spin)


def pull_of(flights: Flights, n: int) -> Floats:
    """Return what gravity does to each disk (n, 2): less where it rests on a wall; zeros without gravity."""
    if flights.gx is None or flights.gy is None:
        return np.zeros((n, 2))
    return np.column_stack([flights.gx, flights.gy])
