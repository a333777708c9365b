"""Replay: the state of all disks at any time, from a log alone."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from eventsim.errors import LogError
from eventsim.record.events import Column, Floats, Kind, Rows, State
from eventsim.replay.any_log import LogInMemory
from eventsim.replay.clock_windows import Windows, changes_in
from eventsim.replay.flight import Flights, start_flights
from eventsim.replay.motion import Motion, pull_of
from eventsim.replay.runs import Runs
from eventsim.scene.numbers import as_number


def one_time(value: object) -> float:
    """A time as a float; raises LogError where the value is not one number."""
    try:
        return as_number(value)
    except (TypeError, OverflowError) as error:
        raise LogError(f"time = {value!r}: {error}; ask for one state after another") from None


class Replay(Motion):
    """The motion that a log tells, bit for bit that of the engine which wrote it.

    A compact log is expanded first. Between rows a disk is in free flight; its last row is found by bisection.
    """

    def __init__(self, log: LogInMemory) -> None:
        """Index the rows of each disk: O(rows log rows) time, 16 bytes per row and disk in it."""
        self.full = log.expand()
        super().__init__(self.full, Runs([self.full.rows]), lambda: self._changes)
        self._window = self.windows.known(self.full.rows["epoch"])
        self._rows, self._first = _rows_of_disks(self.full.rows, self.stage.n)

    def _changes(self, windows: Windows, first: int, last: int) -> tuple[Column, Flights]:
        rows = self.full.rows[first:last]
        return changes_in(self.stage, rows, windows.known(rows["epoch"]))

    def state_at(self, time: float) -> State:
        """Return the state at a time on the scene's clock; at the time of an event, the state after it.

        The time of an event is the one in the log's column `time`: the exact clock behind it decides, not its rounding.
        O(log rows) per disk. Raises LogError for a time that the log does not cover.
        """
        time = one_time(time)
        return self._state(self._place_of(time), time)

    def acceleration_at(self, time: float) -> Floats:
        """Return what gravity does to each disk (n, 2) after a time on the scene's clock: less where it rests on a wall.

        Zeros without gravity. Raises LogError as `state_at`.
        """
        return pull_of(self._anchors(*self._place_of(time)), self.stage.n)

    def _place_of(self, time: float) -> tuple[int, float]:
        """Return (window, remainder) of a time on the scene's clock."""
        self._demand_told(time)
        row = int(np.searchsorted(self.full.rows["time"], time, side="right")) - 1
        if row >= 0 and self.full.rows["time"][row] == time:
            return int(self._window[row]), float(self.full.rows["remainder"][row])
        return self.windows.place(time)

    def final(self) -> State:
        """Return the state where the run stopped; of a log that still grows, the state after its last row."""
        return self._at(self._end())

    def state_after(self, event: int) -> State:
        """Return the state at the exact time of a row, after the last row of that time."""
        row = self.full.rows[event]
        return self._at((int(self._window[event]), float(row["remainder"])))

    def _at(self, place: tuple[int, float]) -> State:
        return self._state(place, self._clock(*place))

    def _state(self, place: tuple[int, float], time: float) -> State:
        return self._flown(self._anchors(*place), *place, time)

    def _anchors(self, window: int, remainder: float) -> Flights:
        """Return the flight of each disk that was valid at (window, remainder)."""
        flights = start_flights(self.stage)
        row = self._last_rows(window, remainder)
        disks = np.flatnonzero(row >= 0)
        chosen = row[disks]
        rows = self.full.rows[chosen]
        is_a = rows["a"] == disks
        flights.window[disks] = self._window[chosen]
        flights.t[disks] = rows["remainder"]
        if self.stage.supports is not None and flights.gx is not None and flights.gy is not None:
            rests = rows["kind"] == Kind.REST
            flights.gx[disks[rests]], flights.gy[disks[rests]] = self.stage.slopes[rows["wall"][rests]].T
        for target, name in ((flights.x, "x"), (flights.y, "y"), (flights.vx, "vx"), (flights.vy, "vy")):
            target[disks] = np.where(is_a, rows[name + "a"], rows[name + "b"])
        if flights.spin is not None:
            flights.spin[disks] = np.where(is_a, rows["spin_a"], rows["spin_b"])
        return flights

    def _last_rows(self, window: int, remainder: float) -> NDArray[np.int64]:
        """Return each disk's last row at or before (window, remainder), -1 before the first; by bisection."""
        low, high = self._first[:-1].copy(), self._first[1:].copy()
        while (open_ := np.flatnonzero(low < high)).size:
            middle = (low[open_] + high[open_]) // 2
            row = self._rows[middle]
            reached = self._window[row] < window
            reached |= (self._window[row] == window) & (self.full.rows["remainder"][row] <= remainder)
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
