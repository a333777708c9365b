"""A track: one engine's run of a scene, simulated piece by piece, that can go back to any time."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from time import perf_counter
from typing import Any

from eventsim.errors import CollapseError, EventsimError
from eventsim.patience import patience
from eventsim.record.events import Rows, State, joined
from eventsim.replay.log import EventLog
from eventsim.scene import Scene
from eventsim.simulation import SavedSimulation, Simulation

FIRST_PIECE, LONGEST_PIECE = 256, 1 << 16
"""Events of a piece, at first and at most."""

PIECE_SECONDS = 0.02
"""What a piece should take: short enough for twenty worlds to share two cores, long enough to be worth a thread."""

LONGEST_SECONDS = 0.1
"""What a piece may take that has few events and much else to do, as disks that fly around a torus."""

MARK_SECONDS, REWIND_SECONDS = 0.5, 10.0
"""Seconds of work between two points to go back to, at most; seconds that going back may take."""

MARK_EVENTS, MARK_EVENTS_PER_DISK = 4096, 16
"""Events between two points that a track can go back to; going back simulates at most so many again."""

MOST_MARKS = 64
"""When there are more, every other one is forgotten: their distance grows with the run."""


@dataclass(frozen=True, slots=True)
class Mark:
    """A point to go back to: its time since the start, the rows until then."""

    time: float
    count: int
    saved: SavedSimulation


class Track:
    """A run of a scene. Times count from the start of the run; all events until `horizon` are known.

    returns: whether it can go back. options: the engine's own.
    """

    def __init__(self, scene: Scene, engine: str = "auto", *, returns: bool = True, **options: Any) -> None:
        self.simulation = Simulation(scene, engine, **options)
        self.scene = scene
        self.horizon = 0.0
        self.ended: str | None = None
        self._epoch_length = self.simulation.log.provenance.epoch_length
        self._blocks: list[Rows] = []
        self._ends: list[int] = []
        self._piece = FIRST_PIECE
        self._worked = 0.0
        self._spacing = max(MARK_EVENTS, MARK_EVENTS_PER_DISK * len(scene.disks))
        self._marks = [Mark(0.0, 0, self.simulation.snapshot())] if returns else []

    @property
    def count(self) -> int:
        """The rows so far."""
        return self._ends[-1] if self._ends else 0

    def advance(self, goal: float, most: int = LONGEST_PIECE) -> None:
        """Simulate a piece on the way to a time: at most so many events, and some hundredths of a second."""
        simulation = self.simulation
        target = max(self.scene.start_time + goal, simulation.time)
        began = perf_counter()
        events = max(min(self._piece, most), 1)
        try:
            with patience(LONGEST_SECONDS):
                rows = simulation.advance_to(target, events)
        except CollapseError as error:
            rows = simulation.log.rows[self.count :].copy()
            self.ended = str(error)
        self._append(rows)
        if self.ended is None:  # what is before the clock is known, also where nothing but wraps came
            reached = goal if simulation.time >= target else simulation.time - self.scene.start_time
            self.horizon = max(self.horizon, reached)
        took = perf_counter() - began
        self._worked += took
        if took > 2.0 * PIECE_SECONDS:
            self._piece = max(self._piece // 2, 1)
        elif took < PIECE_SECONDS and len(rows) >= events:
            self._piece = min(2 * self._piece, LONGEST_PIECE)
        self._mark()

    def rewind(self, time: float) -> State:
        """Go back (or on) to a time; return the state there. What happened later is forgotten, and comes again alike."""
        while len(self._marks) > 1 and self._marks[-1].time > time:
            self._marks.pop()
        mark = self._marks[-1]
        self.simulation.restore(mark.saved)
        self._blocks, self._ends = (
            ([mark_rows], [mark.count]) if len(mark_rows := self.rows(0, mark.count)) else ([], [])
        )
        self.horizon, self.ended = mark.time, None
        began = perf_counter()
        while self.horizon < time and self.ended is None:
            self.advance(time)
            if perf_counter() - began > REWIND_SECONDS:
                raise EventsimError(f"time = {time:g} takes too long to compute again: act at an earlier one")
        return self.simulation.state

    def kick(self, disk: int, velocity: tuple[float, float]) -> None:
        """Give a disk another velocity, now; raise EventsimError for a disk that does not exist."""
        self.simulation.set_velocity(disk, velocity)
        self._append(self.simulation.log.rows[self.count :].copy())
        # The next mark must not lie before the kick: a simulation that goes back forgets what was done to it.
        self._marks.append(Mark(self.horizon, self.count, self.simulation.snapshot()))

    def rows(self, first: int, end: int) -> Rows:
        """Return the rows from `first` to before `end`."""
        parts = []
        place = bisect_right(self._ends, first)
        while first < end:
            begin = self._ends[place - 1] if place else 0
            parts.append(self._blocks[place][first - begin : end - begin])
            first = self._ends[place]
            place += 1
        return joined(parts)

    def log(self) -> EventLog:
        """Return all that happened so far."""
        return self.simulation.log

    def time_of(self, row: int) -> float:
        """Return the time of a row, counted from the start of the run."""
        last = self.rows(row, row + 1)[0]
        return float(last["epoch"] * self._epoch_length + last["remainder"])

    def _append(self, rows: Rows) -> None:
        if len(rows):
            self._blocks.append(rows)
            self._ends.append(self.count + len(rows))
            self.horizon = max(self.horizon, self.time_of(self.count - 1))

    def _cut(self, count: int) -> None:
        """Forget all rows but the first `count`."""
        while self._ends and self._ends[-1] > count:
            self._ends.pop()
            block = self._blocks.pop()
            keep = count - self.count
            if keep > 0:
                self._blocks.append(block[:keep])
                self._ends.append(count)

    def _mark(self) -> None:
        near = self.count - self._marks[-1].count < self._spacing if self._marks else True
        if not self._marks or self.ended is not None or (near and self._worked < MARK_SECONDS):
            return
        self._worked = 0.0
        self._marks.append(Mark(self.horizon, self.count, self.simulation.snapshot()))
        if len(self._marks) > MOST_MARKS:
            del self._marks[1::2]
