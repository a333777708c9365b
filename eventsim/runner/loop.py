"""The loop that takes a session to its stop: stints of the engine, and between them rows, checkpoints, progress, interrupts."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from time import perf_counter
from types import FrameType
from typing import Any, Protocol, runtime_checkable

import numpy as np

from eventsim.engines import Engine
from eventsim.engines.base import BrokenOffError, Session, Stop
from eventsim.engines.collapse import TAIL
from eventsim.errors import EventsimError
from eventsim.formulas.clock import MOST_EPOCHS, clock_time
from eventsim.record.digest import Digester
from eventsim.record.events import Rows, blank_rows
from eventsim.record.files import FileSink, continued_sink, open_log, open_sink
from eventsim.record.provenance import Ending, Provenance
from eventsim.runner.checkpoint import Checkpoint
from eventsim.runner.checkpoint_writer import CheckpointWriter
from eventsim.runner.interrupts import unmissed_interrupts
from eventsim.runner.options import OnEvent, Progress, RunOptions
from eventsim.runner.outcome import Outcome, diagnosed, provenance_of, state_of
from eventsim.runner.residuals import residuals_of
from eventsim.runner.writer import MemorySink, Sink, Writer
from eventsim.scene import Scene
from eventsim.scene.stage import Stage, stage_of

REPLAYED = ("auto", "reference", "fast")
"""Engines whose every bit follows from the scene and the order of its contacts."""

FIRST_BUDGET, LARGEST_BUDGET, LONGEST_STINT = 64, 1 << 20, 0.2
"""Steps of the first stint, and of any; seconds that a stint may take before progress and interrupts are looked at.

A stint may end early, where rows are to be passed on: that says nothing about how long its steps would have taken.
"""


def run_scene(engine: Engine, scene: Scene, stop: Stop, wanted: RunOptions | None = None, **options: Any) -> Outcome:
    """Run a scene to its stop with an engine; options are the engine's own.

    Raises EventsimError for options and wishes that the engine cannot fulfil.
    """
    wanted = RunOptions() if wanted is None else wanted
    stage = stage_of(scene)
    # Where contacts can pile up, the last rows say how.
    with unmissed_interrupts():
        session = engine.open(stage, keep_rows=wanted.rows or stage.law.loses_energy(), **options)
    return run_session(session, engine.name, scene, stop, wanted)


def run_session(session: Session, engine: str, scene: Scene, stop: Stop, wanted: RunOptions) -> Outcome:
    """Simulate to the stop and gather what was wanted; an interrupt keeps everything so far.

    Where something breaks the run off, a log that has rows stays as NAME.part, which can be read, and the last checkpoint.
    Raises EventsimError for wishes that do not go together, LogError and CheckpointError where files cannot be written.
    """
    stage = session.stage
    _demand_possible(engine, stop, stage, wanted)
    resumed = wanted.resumed
    if resumed is None:
        provenance = provenance_of(session, engine, scene, wanted.command)
    else:
        provenance = resumed.provenance
        session.restore(resumed.snapshot)
        session.counters.copy_from(resumed.counters)
    memory = MemorySink(provenance) if wanted.log is True else None
    file = _file_sink(wanted, provenance)
    sinks: list[Sink] = [sink for sink in (memory, file) if sink is not None]
    digester = Digester() if wanted.rows and (wanted.digest or wanted.log is not False) else None
    compiled_before = _compile_seconds(session)
    digests = [] if digester is None else [digester.update]
    writer = Writer([sink.write for sink in sinks] + digests + wanted.takers)
    try:
        if resumed is not None and file is not None and digester is not None:
            for rows in _rows_before(file, wanted):
                digester.update(rows)
        keeper = (
            None
            if wanted.checkpoint is None
            else CheckpointWriter(wanted.checkpoint, wanted.every, provenance, stop, file)
        )
        work = Work(session, stop, wanted.on_event, wanted.progress, writer, keeper)
        if resumed is not None:
            work.go_on(resumed)
        stopped = work.done()
        stopped, reason = diagnosed(session, stopped, work.last_rows)
        writer.finish()
        began = perf_counter()
        digest = None if digester is None else digester.hexdigest()
        for sink in sinks:
            sink.close(Ending(*session.clock, stopped, digest))
        written = work.written + perf_counter() - began
    except BaseException:
        writer.abandon()
        for sink in sinks:
            sink.leave() if session.counters.events else sink.abandon()
        raise
    compiled = _compile_seconds(session)
    return Outcome(
        scene=scene,
        engine=getattr(session, "at_work", engine),  # of `auto`, the one that came last
        state=state_of(session, stop, stopped),
        counters=session.counters,
        residuals=residuals_of(session),
        stopped=stopped,
        reason=reason,
        digest=digest,
        elapsed_s=work.elapsed - (compiled - compiled_before),
        compile_s=compiled,
        begun_by=getattr(session, "before", None),
        write_s=written,
        log_path=None if file is None else file.path,
        recorded=None if memory is None else memory.recorded(),
        trajectory=getattr(session, "trajectory", None),  # stepped engines have one
    )


def _demand_possible(engine: str, stop: Stop, stage: Stage, wanted: RunOptions) -> None:
    """Raise EventsimError for what this engine, or any, cannot do."""
    if wanted.compact and engine not in REPLAYED:
        raise EventsimError(
            "a compact log leaves out what replay computes, and replay computes as the reference and the fast engine do: "
            f"the log of the engine {engine} has to be a full one"
        )
    if stop.until is not None and stop.until - stage.start_time > MOST_EPOCHS * stage.epoch_length:
        latest = stage.start_time + MOST_EPOCHS * stage.epoch_length
        raise EventsimError(f"until = {stop.until!r}: the clock of this scene ends at {latest:g}")
    if wanted.checkpoint is None and wanted.resumed is None:
        return
    if engine not in REPLAYED:
        raise EventsimError(
            f"the engine {engine} has no checkpoints, since its future does not follow from the flights of the disks alone; "
            "auto, reference and fast have"
        )
    if wanted.log is True:
        raise EventsimError("a log in memory does not outlive its run: with a checkpoint the log needs a file")
    if wanted.digest and wanted.log is False:
        raise EventsimError(
            "a digest is of all rows, and a run that goes on has only its log to look back: give it a log file"
        )


def _file_sink(wanted: RunOptions, provenance: Provenance) -> FileSink | None:
    """The writer of the log file: a new one, or that of the run that goes on."""
    if isinstance(wanted.log, bool):
        return None
    path = Path(wanted.log)
    if wanted.resumed is None:
        return open_sink(path, provenance, compact=wanted.compact)
    assert wanted.resumed.log is not None, "only a run that kept a log goes on with one"
    return continued_sink(path, provenance, wanted.compact, wanted.resumed.log.mark)


def _rows_before(file: FileSink, wanted: RunOptions) -> Iterator[Rows]:
    """The full rows of the log that a run goes on with."""
    provenance, blocks = open_log(file.part)
    if not provenance.compact:
        return blocks
    assert wanted.expanded is not None, "who goes on with a compact log says how it is expanded"
    provenance = replace(provenance, kicks=file.sync().kicks)
    return iter([wanted.expanded(provenance, np.concatenate([blank_rows(0), *blocks]))])


def _compile_seconds(session: Session) -> float:
    """Seconds that a compiled engine has spent on compiling so far; 0 for others."""
    return float(getattr(session, "compile_s", 0.0))


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
    keeper: CheckpointWriter | None
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
