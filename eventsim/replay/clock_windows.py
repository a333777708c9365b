"""The windows of the clock, worked out from a log."""

from __future__ import annotations

import bisect
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from functools import partial
from typing import TypeAlias

import numpy as np

from eventsim.engines import STEPPED
from eventsim.engines.turnover import Anchors, epochs_to_wrap, exponent_after, exponent_kicked
from eventsim.errors import LogError
from eventsim.formulas.clock import FIRST_WINDOW, end_of_epoch, next_window, remainder_since, window_length
from eventsim.record.events import Column, Kind, Rows
from eventsim.record.provenance import Provenance
from eventsim.replay.flight import Flights, follow, start_flights
from eventsim.replay.runs import Runs
from eventsim.scene.stage import Stage, stage_of

MOST_WINDOWS = 1_000_000
"""Windows behind the last row that are counted at once, if each has wraps."""

Changes: TypeAlias = Callable[["Windows", int, int], tuple[Column, Flights]]
"""Tells which disks are in some rows (from, to), whose windows are known, and how they fly after the last of these."""


class Windows:
    """The schedule of turnovers.

    Window w begins at epoch `start[w]`.  Its flights hold from the remainder `since[w]` on: 0, or of a window that the clock has
    jumped to because of a contact or a kick, that of its first row.  The next one begins where `end[w]` is on the clock of this
    one, and `begin[w + 1]` on its own.  `length[w]` is what it would last with rows in it.

    It follows from the number of rows in each window and, where there is none, from the flights; and goes on past the last row
    by the same rule, as far as somebody asks.
    """

    start: list[int]
    since: list[float]
    begin: list[float]
    end: list[float]
    length: list[float]

    def __init__(self, stage: Stage, runs: Runs, changes: Changes) -> None:
        """runs: of a full log."""
        self._stage = stage
        self._runs = runs
        self._changes = changes
        self._exponent = FIRST_WINDOW
        self.start, self.since, self.begin, self.end = [0], [0.0], [0.0], []
        self.length = [window_length(FIRST_WINDOW, stage.epoch_length)]
        self._flights: Flights | None = None
        self._seen = 0  # rows that are in these flights
        self._run = 0  # of rows of one epoch, the first that no window has had

    def _extend(self) -> bool:
        """Find the next window; False where the last one is open for ever."""
        stage, runs, start, epoch_length = self._stage, self._runs, self.start[-1], self._stage.epoch_length
        first, last = self._rows_of_window()
        count, following = last - first, self._run + (last > first)
        exponent = self._after_kicks(first, last)
        nominal = window_length(exponent, epoch_length)
        window = len(self.start) - 1

        def look() -> Anchors:
            return self._anchors(window, nominal, False, last)

        row = runs.first[following]
        jump = int(runs.epoch[following]) - start if following < len(runs) else None
        remainder = float(runs.remainder[following]) if jump is not None else 0.0
        now = np.inf if jump is None else jump * epoch_length + remainder
        kicked = jump is not None and jump > 0 and runs.begun_by_kick[following]
        if (
            count and runs.remainder[self._run] >= nominal
        ):  # the contact of an open window that the clock did not jump to
            end = end_of_epoch(float(runs.remainder[self._run]), epoch_length)
        elif count or (kicked and now < nominal):
            end = nominal
        else:
            epochs = epochs_to_wrap(stage, start, exponent, look())
            end = np.inf if epochs is None else epochs * epoch_length
        if kicked and jump is not None and now < end:
            after = exponent_kicked(stage, exponent, partial(self._kicked, window, now, row))
            self._append(now, jump, remainder, remainder, after)
        elif jump is not None and jump * epoch_length < end:
            if count or jump * epoch_length < nominal:
                raise LogError(f"the log does not fit its scene: no window of the clock begins at epoch {start + jump}")
            self._append(jump * epoch_length, jump, 0.0, remainder, exponent_after(stage, exponent, 0, look))
        elif end < np.inf:
            before = self.start[-1] - self.start[-2] if len(self.start) > 1 else 0
            if not count and jump is not None and jump > MOST_WINDOWS * max(int(end / epoch_length), before):
                raise LogError(
                    f"the log does not fit its scene: more than {MOST_WINDOWS} turns of the clock without a row"
                )
            self._append(end, int(end / epoch_length), 0.0, 0.0, exponent_after(stage, exponent, count, look))
        else:
            return False
        self._run = following
        return True

    def _rows_of_window(self) -> tuple[int, int]:
        """The rows (from, to) of the last window."""
        first = last = self._runs.first[self._run]
        if self._run < len(self._runs) and self._runs.epoch[self._run] == self.start[-1]:
            last = self._runs.first[self._run + 1]
        return first, last

    def _append(self, end: float, epochs: int, begin: float, since: float, exponent: int) -> None:
        self.end.append(end)
        self.start.append(self.start[-1] + epochs)
        self.begin.append(begin)
        self.since.append(since)
        self.length.append(window_length(exponent, self._stage.epoch_length))
        self._exponent = exponent

    def _after_kicks(self, first: int, last: int) -> int:
        """The exponent of the last window, whose rows are these, after its kicks."""
        exponent, window = self._exponent, len(self.start) - 1
        if exponent > self._stage.clock.idle_cap:
            begun = first + (self.since[-1] > 0.0)  # its first row was that of the kick, or no kick
            for kick in self._runs.kicks_in(begun, last):
                look = partial(self._kicked, window, kick.remainder, kick.row)
                exponent = exponent_kicked(self._stage, exponent, look)
        return exponent

    def _kicked(self, window: int, now: float, row: int) -> Anchors:
        kick = self._runs.kick(row)
        return self._anchors(window, now, True, row).kicked(kick.disk, *kick.velocity)

    def _anchors(self, window: int, limit: float, inclusive: bool, rows: int) -> Anchors:
        """How disks fly after the first `rows` rows, and all wraps in a window before a time, or up to it."""
        if self._flights is None:
            self._flights = start_flights(self._stage)
        if rows > self._seen:
            self._flights.put(*self._changes(self, self._seen, rows))
            self._seen = rows
        follow(self._flights, self._stage, self, window, limit, inclusive)
        return self._flights.anchors()

    def known(self, epochs: Column) -> Column:
        """Return the window of each row, all of which have been found, from its epoch."""
        first = np.flatnonzero(np.diff(epochs, prepend=-1))
        counts = np.diff(first, append=len(epochs))
        return np.repeat(
            np.array([bisect.bisect_left(self.start, epoch) for epoch in epochs[first].tolist()], np.int64), counts
        )

    def find_all(self) -> None:
        """Find the windows of all rows; LogError where none begins with the epoch of one."""
        for epoch in self._runs.epoch.tolist():
            self.window_at(epoch)

    def window_at(self, epoch: int) -> int:
        """Return the window that begins at an epoch; LogError where none does."""
        self._reach(epoch)
        window = bisect.bisect_left(self.start, epoch)
        if window == len(self.start) or self.start[window] != epoch:
            raise LogError(f"the log does not fit its scene: no window of the clock begins at epoch {epoch}")
        return window

    def place(self, time: float) -> tuple[int, float]:
        """Return (window, remainder) of a time on the scene's clock; the remainder is rounded once."""
        epochs = (Fraction(time) - Fraction(self._stage.start_time)) / Fraction(self._stage.epoch_length)
        self._reach(epochs, beyond=True)
        window = max(bisect.bisect_right(self.start, epochs) - 1, 0)
        if window and (epochs - self.start[window]) * Fraction(self._stage.epoch_length) < self.since[window]:
            window -= 1
        remainder = self._remainder(window, time)
        if window < len(self.end) and self.since[window + 1] == 0.0 and remainder >= self.end[window]:
            return window + 1, 0.0  # rounded up to the end of the window: the clock has turned over
        return window, remainder

    def _remainder(self, window: int, time: float) -> float:
        return remainder_since(self.start[window], self._stage.epoch_length, time, self._stage.start_time)

    def _reach(self, epochs: int | Fraction, beyond: bool = False) -> None:
        """Find all windows up to a time, or until the one that begins behind it; LogError for what would take for ever."""
        longest = max(self._exponent, self._stage.clock.idle_cap)
        if beyond and epochs - self.start[-1] > MOST_WINDOWS << longest and self._stage.periodic:
            raise LogError(
                f"the log does not reach so far: that is more than {MOST_WINDOWS} turns of the clock behind its rows"
            )
        while self.start[-1] < epochs or (beyond and self.start[-1] == epochs):
            if not self._extend():
                return


class DoublingWindows(Windows):
    """The schedule of logs of version 0.1 and of stepped engines: a window without a row is followed by one twice as long."""

    def _reach(self, epochs: int | Fraction, beyond: bool = False) -> None:
        if epochs - self.start[-1] > MOST_WINDOWS << self._stage.clock.window_cap:
            raise LogError(f"the log does not reach so far: that is more than {MOST_WINDOWS} turns of the clock")
        super()._reach(epochs, beyond)

    def _extend(self) -> bool:
        first, last = self._rows_of_window()
        clock, length = self._stage.clock, window_length(self._exponent, self._stage.epoch_length)
        after = next_window(self._exponent, last - first, self._stage.n, clock.window_cap)
        self._append(length, 1 << self._exponent, 0.0, 0.0, after)
        self._run += last > first
        return True


def schedules_of(provenance: Provenance) -> list[type[Windows]]:
    """Return the kinds of schedules that a log may have, the likeliest first."""
    if provenance.engine in STEPPED:
        return [DoublingWindows]
    return [Windows, DoublingWindows]


def windows_of(provenance: Provenance, stage: Stage, runs: Runs, begin: Callable[[], Changes]) -> Windows:
    """Return the windows of a full log; LogError where its rows fit no schedule.

    begin: begins to read its rows, for each schedule anew.
    """
    misfits = []
    for kind in schedules_of(provenance):
        windows = kind(stage, runs, begin())
        try:
            windows.find_all()
            if provenance.ending is not None:
                windows.window_at(provenance.ending.epoch)
        except LogError as misfit:
            misfits.append(misfit)
        else:
            return windows
    raise misfits[0]


def stage_of_log(provenance: Provenance) -> Stage:
    """Return the stage of a log: that of its scene, with the epoch that its clock had, and its corner."""
    stage = stage_of(provenance.scene, provenance.corner)
    if stage.epoch_length == provenance.epoch_length:
        return stage
    return replace(stage, clock=stage.clock._replace(epoch_length=provenance.epoch_length))


def changes_in(stage: Stage, rows: Rows, windows: Column) -> tuple[Column, Flights]:
    """Return which disks are in some rows of a full log, and how they fly after the last of these; windows: of the rows."""
    pairs = np.flatnonzero(rows["b"] >= 0)
    row = np.concatenate([np.arange(len(rows)), pairs])
    disk = np.concatenate([rows["a"], rows["b"][pairs]]).astype(np.int64)
    order = np.lexsort((row, disk))
    last = order[np.flatnonzero(np.diff(disk[order], append=-1))]
    row, disk = row[last], disk[last]
    flights = start_flights(stage).take(disk)
    found, is_a = rows[row], rows["a"][row] == disk
    flights.window, flights.t = windows[row], found["remainder"].copy()
    for name in ("x", "y", "vx", "vy"):
        setattr(flights, name, np.where(is_a, found[name + "a"], found[name + "b"]))
    if flights.spin is not None:
        flights.spin = np.where(is_a, found["spin_a"], found["spin_b"])
    if stage.supports is not None and flights.gx is not None and flights.gy is not None:
        rests = found["kind"] == Kind.REST
        flights.gx[rests], flights.gy[rests] = stage.slopes[found["wall"][rests]].T
    return disk, flights
