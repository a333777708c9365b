"""Replay: the state of all disks at any time, from a log alone."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eventsim.errors import LogError
from eventsim.formulas.clock import clock_time
from eventsim.record.events import Column, Floats, Kind, Rows, State
from eventsim.record.places import on_scene_axes
from eventsim.replay.clock_windows import Windows, changes_in, stage_of_log, windows_of
from eventsim.replay.flight import Flights, fly, start_flights
from eventsim.replay.log import EventLog
from eventsim.scene.stage import Stage

ENDLESS = ("quiet",)
"""Reasons to stop after which the disks fly on: there is no event ahead."""


class Replay:
    """The motion that a log tells, bit for bit that of the engine which wrote it.

    A compact log is expanded first. Between rows a disk is in free flight; its last row is found by bisection.
    """

    def __init__(self, log: EventLog) -> None:
        """Index the rows of each disk: O(rows log rows) time, 16 bytes per row and disk in it."""
        self.log = log.expand()
        self.stage: Stage = stage_of_log(log.provenance)
        self.windows: Windows = windows_of(log.provenance, self.stage, self.log.rows, self._changes, self._velocity)
        self._window = self.windows.known(log.epoch)
        self._rows, self._first = _rows_of_disks(self.log.rows, self.stage.n)

    def _changes(self, windows: Windows, first: int, last: int) -> tuple[Column, Flights]:
        rows = self.log.rows[first:last]
        return changes_in(self.stage, rows, windows.known(rows["epoch"]))

    def _velocity(self, row: int) -> tuple[float, float]:
        return float(self.log.rows["vxa"][row]), float(self.log.rows["vya"][row])

    def state_at(self, time: float) -> State:
        """Return the state at a time on the scene's clock; at the time of an event, the state after it.

        The time of an event is the one in the log's column `time`: the exact clock behind it decides, not its rounding.
        O(log rows) per disk. Raises LogError for a time that the log does not cover.
        """
        time = float(time)
        return self._state(*self._place_of(time), time)

    def acceleration_at(self, time: float) -> Floats:
        """Return what gravity does to each disk (n, 2) after a time on the scene's clock: less where it rests on a wall.

        Zeros without gravity. Raises LogError as `state_at`.
        """
        flights = self._anchors(*self._place_of(time))
        if flights.gx is None or flights.gy is None:
            return np.zeros((self.stage.n, 2))
        return np.column_stack([flights.gx, flights.gy])

    def _place_of(self, time: float) -> tuple[int, float]:
        """Return (window, remainder) of a time on the scene's clock."""
        if not math.isfinite(time):
            raise LogError(f"there is no state at time {time}: the time must be a finite number")
        if time < self.stage.start_time:
            raise LogError(f"there is no state at time {time!r}: the run begins at {self.stage.start_time!r}")
        row = int(np.searchsorted(self.log.time, time, side="right")) - 1
        if row >= 0 and self.log.time[row] == time:
            return int(self._window[row]), float(self.log.remainder[row])
        ending = self.log.provenance.ending
        if ending is None or ending.reason not in ENDLESS:
            last = self._end()
            if time > self._clock(*last) and self.windows.place(time) > last:
                raise LogError(f"there is no state at time {time!r}: the log ends at {self._clock(*last)!r}")
        return self.windows.place(time)

    @property
    def span(self) -> tuple[float, float]:
        """The times on the scene's clock where the log begins and ends."""
        return self.stage.start_time, self._clock(*self._end())

    def final(self) -> State:
        """Return the state where the run stopped; of a log that still grows, the state after its last row."""
        return self._at(self._end())

    def state_after(self, event: int) -> State:
        """Return the state at the exact time of a row, after the last row of that time."""
        row = self.log.rows[event]
        return self._at((int(self._window[event]), float(row["remainder"])))

    def _at(self, place: tuple[int, float]) -> State:
        return self._state(*place, self._clock(*place))

    def _end(self) -> tuple[int, float]:
        """Return (window, remainder) of the end of the log."""
        ending = self.log.provenance.ending
        if ending is not None:
            return self.windows.window_at(ending.epoch), ending.remainder
        if len(self.log) == 0:
            return 0, 0.0
        last = int(self._window[-1])
        return last, float(self.log.remainder[self._window == last].max())

    def _clock(self, window: int, remainder: float) -> float:
        return clock_time(self.windows.start[window], remainder, self.stage.epoch_length, self.stage.start_time)

    def _state(self, window: int, remainder: float, time: float) -> State:
        flights = self._anchors(window, remainder)
        fly(flights, self.stage, self.windows, window, remainder)
        corner, period = self.stage.corner, self.stage.period
        x, y = on_scene_axes(flights.x, corner[0], period[0]), on_scene_axes(flights.y, corner[1], period[1])
        return State(time, np.column_stack([x, y]), np.column_stack([flights.vx, flights.vy]))

    def _anchors(self, window: int, remainder: float) -> Flights:
        """Return the flight of each disk that was valid at (window, remainder)."""
        flights = start_flights(self.stage)
        row = self._last_rows(window, remainder)
        disks = np.flatnonzero(row >= 0)
        chosen = row[disks]
        rows = self.log.rows[chosen]
        is_a = rows["a"] == disks
        flights.window[disks] = self._window[chosen]
        flights.t[disks] = rows["remainder"]
        if self.stage.supports is not None and flights.gx is not None and flights.gy is not None:
            rests = rows["kind"] == Kind.REST
            flights.gx[disks[rests]], flights.gy[disks[rests]] = self.stage.slopes[rows["wall"][rests]].T
        for target, name in ((flights.x, "x"), (flights.y, "y"), (flights.vx, "vx"), (flights.vy, "vy")):
            target[disks] = np.where(is_a, rows[name + "a"], rows[name + "b"])
        return flights

    def _last_rows(self, window: int, remainder: float) -> NDArray[np.int64]:
        """Return each disk's last row at or before (window, remainder), -1 before the first; by bisection."""
        low, high = self._first[:-1].copy(), self._first[1:].copy()
        while (open_ := np.flatnonzero(low < high)).size:
            middle = (low[open_] + high[open_]) // 2
            row = self._rows[middle]
            reached = self._window[row] < window
            reached |= (self._window[row] == window) & (self.log.remainder[row] <= remainder)
            low[open_[reached]] = middle[reached] + 1
            high[open_[~reached]] = middle[~reached]
        found = low > self._first[:-1]
        last = np.full(self.stage.n, -1, dtype=np.int64)
        last[found] = self._rows[low[found] - 1]
        return last


def _rows_of_disks(rows: Rows, n: int) -> tuple[Column, Column]:
    """Return (rows, first): the rows of disk i, in order, are rows[first[i] : first[i + 1]]."""
    count = len(rows)
    pairs = np.flatnonzero(rows["b"] >= 0)
    row = np.concatenate([np.arange(count), pairs])
    disk = np.concatenate([rows["a"], rows["b"][pairs]])
    order = np.lexsort((row, disk))
    first: NDArray[Any] = np.zeros(n + 1, dtype=np.int64)
    np.cumsum(np.bincount(disk, minlength=n), out=first[1:])
    return row[order], first
