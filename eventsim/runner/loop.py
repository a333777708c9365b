"""A run at work: an engine's stints, and between them rows passed on, checkpoints, progress and interrupts."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from time import perf_counter
from types import FrameType
from typing import Protocol, runtime_checkable

import numpy as np

from eventsim.engines.base import BrokenOffError, OnEvent, Progress, Session, Stop
from eventsim.engines.collapse import TAIL
from eventsim.formulas.clock import clock_time
from eventsim.record.events import Rows, blank_rows
from eventsim.record.provenance import Ending
from eventsim.runner.checkpoint import Checkpoint
from eventsim.runner.checkpoint_writer import Keeper
from eventsim.runner.writer import Writer

FIRST_BUDGET, LARGEST_BUDGET, LONGEST_STINT = 64, 1 << 20, 0.2
"""Steps of the first stint, and of any; seconds that a stint may take before progress and interrupts are looked at.

A stint may end early, where rows are to be passed on: that says nothing about how long its steps would have taken.
"""


class Sink(Protocol):
    """Where rows go."""

    def write(self, rows: Rows) -> None:
        """Take a block of rows."""

    def close(self, ending: Ending | None = None) -> None:
        """All rows have come; the run ended like this."""

    def leave(self) -> None:
        """The run broke off: what has been written stays, as far as it can be read."""

    def abandon(self) -> None:
        """Leave nothing behind."""


@runtime_checkable
class Provisional(Protocol):
    """A session that holds rows back, because it may begin again."""

    def break_off(self) -> None:
        """End here; all rows can be taken."""


@dataclass(slots=True)
class Work:
    """A run in stints short enough to be interrupted, and what is done between them.

    elapsed: seconds simulating.  last_rows: the last of all, for a diagnosis.
    """

    session: Session
    stop: Stop
    on_event: OnEvent | None
    progress: Progress | None
    writer: Writer
    keeper: Keeper | None
    elapsed: float = 0.0
    last_rows: Rows = field(default_factory=lambda: blank_rows(0))
    _kept: float = 0.0

    @property
    def written(self) -> float:
        """Seconds spent on waiting for rows to be written, and on checkpoints."""
        return self.writer.waited_s + self._kept

    def go_on(self, resumed: Checkpoint) -> None:
        """Go on where an earlier run was stopped."""
        self.elapsed, self._kept, self.last_rows = resumed.elapsed_s, resumed.write_s, resumed.last_rows

    def done(self) -> str:
        """Simulate to the end; why it stopped."""
        session, keeper = self.session, self.keeper
        budget = FIRST_BUDGET
        with _interruptible(session) as interrupted:
            self._keep()
            while True:
                aim = self.stop if keeper is None else keeper.next_stop(self.stop, session.counters.events)
                began = perf_counter()
                try:
                    stopped = session.advance(aim, budget)
                except BrokenOffError:
                    stopped = "interrupted"
                stint = perf_counter() - began
                self.elapsed += stint
                if stint < 0.5 * LONGEST_STINT:
                    budget = min(2 * budget, LARGEST_BUDGET)
                elif stint > LONGEST_STINT:
                    budget = max(budget // 2, 1)
                self._pass_on(session.take_rows())
                if stopped == "events" and aim != self.stop and not self._has_all_events():
                    stopped = None
                if stopped is None and interrupted():
                    stopped = "interrupted"
                    if isinstance(session, Provisional):
                        session.break_off()
                        self._pass_on(session.take_rows())
                self._keep(stopped)
                if self.progress is not None:
                    _tell(self.progress, session, self.stop)
                if stopped is not None:
                    return stopped

    def _has_all_events(self) -> bool:
        return self.stop.events is not None and self.session.counters.events >= self.stop.events

    def _pass_on(self, rows: Rows) -> None:
        if len(rows):
            self.last_rows = rows[-TAIL:] if len(rows) >= TAIL else np.concatenate([self.last_rows, rows])[-TAIL:]
            self.writer.write(rows)
            if self.on_event is not None:
                self.on_event(rows)

    def _keep(self, stopped: str | None = None) -> None:
        """Write a checkpoint where one is due, behind all rows so far."""
        if self.keeper is not None and self.keeper.is_due(self.session.counters.events, stopped):
            self.writer.settle()
            began = perf_counter()
            self.keeper.keep(self.session, self.last_rows, self.elapsed, self.written)
            self._kept += perf_counter() - began


def _tell(progress: Progress, session: Session, stop: Stop) -> None:
    stage = session.stage
    time = clock_time(*session.clock, stage.epoch_length, stage.start_time)
    events = session.counters.events
    shares = []
    if stop.until is not None and stop.until > stage.start_time:
        shares.append((time - stage.start_time) / (stop.until - stage.start_time))
    if stop.events:
        shares.append(events / stop.events)
    progress(max(shares, default=None), events, time)


@contextmanager
def _interruptible(session: Session) -> Iterator[Callable[[], bool]]:
    """Ctrl-C, or the signal to terminate, sets a flag instead of breaking into an event; a second one breaks in.

    Where the session says that it only prepares itself (loads a compiler, compiles), which takes long, the first one breaks in.
    """
    asked = False

    def ask(number: int, frame: FrameType | None) -> None:
        nonlocal asked
        if asked:
            raise KeyboardInterrupt
        asked = True
        if getattr(session, "prepares", False):
            raise BrokenOffError

    if threading.current_thread() is not threading.main_thread():
        yield lambda: False
        return
    before = {number: signal.signal(number, ask) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield lambda: asked
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
