"""A passage: a log of any length read once from its beginning to its end, with the states at ascending times on the way."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import closing
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from eventsim.errors import LogError
from eventsim.record.events import Column, Floats, Rows, State, blank_rows
from eventsim.replay.clock_windows import Changes, Windows, changes_in
from eventsim.replay.flight import Flights, start_flights
from eventsim.replay.log import AnyLog
from eventsim.replay.motion import Motion, pull_of
from eventsim.replay.runs import Runs


class Moment(NamedTuple):
    """The state at a time, and what gravity does to each disk (n, 2) after it."""

    state: State
    pull: Floats


class Passage(Motion):
    """The motion that a full log tells, in memory that its length does not change; bit for bit that of `Replay`."""

    def __init__(self, log: AnyLog) -> None:
        """Read the log once, for its clock."""
        super().__init__(log, Runs(log.blocks()), self._begin)

    def states(self, times: Iterable[float]) -> Iterator[State]:
        """Yield the states at ascending times on the scene's clock; see `Replay.state_at`."""
        return (moment.state for moment in self.moments(times))

    def moments(self, times: Iterable[float]) -> Iterator[Moment]:
        """Yield the moments at ascending times, read in one go.  Raises LogError for a time that the log does not cover."""
        wanted = [float(time) for time in times]
        for time in wanted:
            self._demand_told(time)
        if any(later < time for time, later in pairwise(wanted)):
            raise LogError("the states of a passage are asked for in the order of time")
        places = [self.windows.place(time) for time in wanted]
        clock = np.array(wanted)
        flights = start_flights(self.stage)
        waiting: list[Block] = []
        done = 0
        with closing(self.log.blocks()) as blocks:
            for rows in blocks:
                block = Block(self.windows.known(rows["epoch"]), rows)
                for number, place in block.exact_places(clock[done:]):
                    places[done + number] = place
                while done < len(wanted) and not block.touches(wanted[done], places[done]):
                    waiting = self._taken_over(flights, waiting, places[done])
                    yield self._moment(flights, places[done], wanted[done])
                    done += 1
                if done == len(wanted):
                    return
                waiting = [*self._taken_over(flights, waiting, places[done]), block]
        for place, time in zip(places[done:], wanted[done:], strict=True):
            waiting = self._taken_over(flights, waiting, place)
            yield self._moment(flights, place, time)

    def final(self) -> State:
        """Return the state where the run stopped; of a log that still grows, the state after its last row."""
        flights, place = start_flights(self.stage), self._end()
        with closing(self.log.blocks()) as blocks:
            for rows in blocks:
                self._taken_over(flights, [Block(self.windows.known(rows["epoch"]), rows)], place)
        return self._flown(flights, *place, self._clock(*place))

    def _moment(self, flights: Flights, place: tuple[int, float], time: float) -> Moment:
        copied = flights.take(np.arange(self.stage.n))
        pull = pull_of(copied, self.stage.n)
        return Moment(self._flown(copied, *place, time), pull)

    def _taken_over(self, flights: Flights, blocks: list[Block], place: tuple[int, float]) -> list[Block]:
        """Let flights be those after all rows up to a place; the rows behind it."""
        left = []
        for block in blocks:
            due = block.is_due(place)
            if due.any():
                flights.put(*changes_in(self.stage, block.rows[due], block.windows[due]))
            if not due.all():
                left.append(Block(block.windows[~due], block.rows[~due]))
        return left

    def _begin(self) -> Changes:
        reader = Reader(self.log)

        def changes(windows: Windows, first: int, end: int) -> tuple[Column, Flights]:
            disks: list[Column] = []
            flights = start_flights(self.stage)
            for rows in reader.rows(first, end):
                changed, flown = changes_in(self.stage, rows, windows.known(rows["epoch"]))
                flights.put(changed, flown)
                disks.append(changed)
            every = np.unique(np.concatenate([np.empty(0, np.int64), *disks]))
            return every, flights.take(every)

        return changes


class Block(NamedTuple):
    """Rows, and the windows of the clock that they are in."""

    windows: Column
    rows: Rows

    def is_due(self, place: tuple[int, float]) -> Column:
        """Which rows (n,) are not later than a place."""
        window, remainder = place
        due: Column = (self.windows < window) | ((self.windows == window) & (self.rows["remainder"] <= remainder))
        return due

    def touches(self, time: float, place: tuple[int, float]) -> bool:
        """Whether a row of the block is not later.  If none is, none behind the block is: times step back by last bits only."""
        return bool(self.is_due(place).any() or (self.rows["time"] <= time).any())

    def exact_places(self, times: Floats) -> Iterator[tuple[int, tuple[int, float]]]:
        """Yield the number of each of the ascending times that is the time of a row, and the exact place of that row."""
        time = self.rows["time"]
        low, high = np.searchsorted(times, time, side="left"), np.searchsorted(times, time, side="right")
        for row in np.flatnonzero(low < high).tolist():
            for number in range(low[row], high[row]):
                yield number, (int(self.windows[row]), float(self.rows["remainder"][row]))


class Reader:
    """Rows of a log, taken in order."""

    def __init__(self, log: AnyLog) -> None:
        self._blocks = log.blocks()
        self._block = blank_rows(0)
        self._begins = 0

    def rows(self, first: int, end: int) -> Iterator[Rows]:
        """Yield the rows from `first` to before `end`; none before those that were taken last."""
        while True:
            block = self._block[max(first - self._begins, 0) : max(end - self._begins, 0)]
            if len(block):
                yield block
            if end <= self._begins + len(self._block):
                return
            self._begins += len(self._block)
            self._block = next(self._blocks)
