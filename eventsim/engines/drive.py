"""Drives a session to its stop: sinks, progress, interrupts, timing; the same for every engine."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from time import perf_counter
from types import FrameType
from typing import Protocol

import numpy as np

from eventsim import __version__
from eventsim.engines.base import OnEvent, Progress, Run, Session, Stop
from eventsim.engines.collapse import TAIL, diagnosis
from eventsim.engines.residuals import residuals_of
from eventsim.engines.writer import Writer
from eventsim.errors import EventsimError
from eventsim.formulas.clock import clock_time
from eventsim.record.digest import Digester
from eventsim.record.events import Rows, State, blank_rows
from eventsim.record.files import open_sink
from eventsim.record.log import EventLog, MemorySink
from eventsim.record.places import on_scene_axes
from eventsim.record.provenance import Ending, Provenance
from eventsim.scene import Scene

FIRST_BUDGET, LONGEST_STINT = 64, 0.2
"""Steps of the first stint; seconds that a stint may take before progress and interrupts are looked at."""

MOST_EPOCHS = 2.0**61
"""What the column `epoch` can count."""

REPLAYED = ("auto", "reference", "fast")
"""Engines whose every bit follows from the scene and the order of its contacts."""


class Sink(Protocol):
    """Where rows go."""

    def write(self, rows: Rows) -> None:
        """Take a block of rows."""

    def close(self, ending: Ending | None = None) -> None:
        """All rows have come; the run ended like this."""

    def abandon(self) -> None:
        """Leave nothing behind."""


@dataclass(slots=True)
class Wishes:
    """What a caller wants to have besides the state: a log (in memory: True, or a path), a digest, to be told.

    on_event is called between two stints of the engine, takers beside it, in the writer's thread.
    """

    log: bool | str | PathLike[str] = False
    compact: bool = False
    digest: bool = False
    progress: Progress | None = None
    on_event: OnEvent | None = None
    command: str | None = None
    takers: list[OnEvent] = field(default_factory=list)

    @property
    def rows(self) -> bool:
        """Whether anything wants the rows."""
        return self.log is not False or self.digest or self.on_event is not None or bool(self.takers)


def drive(session: Session, engine: str, scene: Scene, stop: Stop, wishes: Wishes) -> Run:
    """Simulate to the stop and gather what was wished for; an interrupt keeps everything so far.

    Raises EventsimError for a compact log of an engine whose floats replay cannot compute.
    """
    if wishes.compact and engine not in REPLAYED:
        raise EventsimError(
            "a compact log leaves out what replay computes, and replay computes as the reference and the fast engine do: "
            f"the log of the engine {engine} has to be a full one"
        )
    stage = session.stage
    if stop.until is not None and stop.until - stage.start_time > MOST_EPOCHS * stage.epoch_length:
        latest = stage.start_time + MOST_EPOCHS * stage.epoch_length
        raise EventsimError(f"until = {stop.until!r}: the clock of this scene ends at {latest:g}")
    provenance = provenance_of(session, engine, scene, wishes.command)
    memory = MemorySink(provenance) if wishes.log is True else None
    path = Path(wishes.log) if not isinstance(wishes.log, bool) else None
    sinks: list[Sink] = [] if memory is None else [memory]
    if path is not None:
        sinks.append(open_sink(path, provenance, compact=wishes.compact))
    digester = Digester() if wishes.rows and (wishes.digest or wishes.log is not False) else None
    compiled_before = _compile_seconds(session)
    digests = [] if digester is None else [digester.update]
    writer = Writer([sink.write for sink in sinks] + digests + wishes.takers)
    try:
        stopped, last_rows, elapsed = _simulate(session, stop, wishes, writer)
        stopped, reason = diagnosed(session, stopped, last_rows)
        writer.finish()
        began = perf_counter()
        digest = None if digester is None else digester.hexdigest()
        for sink in sinks:
            sink.close(Ending(*session.clock, stopped, digest))
        written = writer.waited_s + perf_counter() - began
    except BaseException:
        writer.abandon()
        for sink in sinks:
            sink.abandon()
        raise
    log = None if memory is None else memory.log()
    compiled = _compile_seconds(session)
    return Run(
        scene=scene,
        engine=getattr(session, "at_work", engine),  # of `auto`, the one that came last
        state=state_of(session, stop, stopped),
        counters=session.counters,
        residuals=residuals_of(session),
        stopped=stopped,
        reason=reason,
        digest=digest,
        elapsed_s=elapsed - (compiled - compiled_before),
        compile_s=compiled,
        write_s=written,
        log_path=path,
        trajectory=getattr(session, "trajectory", None),  # stepped engines have one
        _log=log,
    )


def diagnosed(session: Session, stopped: str, last_rows: Rows) -> tuple[str, str | None]:
    """Why a run stopped, and the sentence about it; a sequence that does not end is told from its last rows."""
    stage = session.stage
    if stopped != "collapse" or not stage.loses_energy:
        return stopped, session.reason
    time = clock_time(*session.clock, stage.epoch_length, stage.start_time)
    return diagnosis(last_rows, stage, session.clock, time) or (stopped, session.reason)


def _compile_seconds(session: Session) -> float:
    """Seconds that a compiled engine has spent on compiling so far; 0 for others."""
    return float(getattr(session, "compile_s", 0.0))


def provenance_of(session: Session, engine: str, scene: Scene, command: str | None = None) -> Provenance:
    """Where the rows of a session come from."""
    stage = session.stage
    return Provenance(
        scene=scene,
        engine=engine,
        version=__version__,
        epoch_length=stage.epoch_length,
        wall_names=stage.wall_names,
        command=command,
    )


def state_of(session: Session, stop: Stop | None = None, stopped: str | None = None) -> State:
    """The state where a session stands; its time is exactly the stop time where that was reached."""
    stage = session.stage
    motion = session.motion()
    epoch, remainder = session.clock
    time = clock_time(epoch, remainder, stage.epoch_length, stage.start_time)
    if stop is not None and stop.until is not None and stopped in ("until", "quiet"):
        time = max(stop.until, stage.start_time)
    position = np.column_stack(
        [
            on_scene_axes(motion.x, stage.corner[0], stage.period[0]),
            on_scene_axes(motion.y, stage.corner[1], stage.period[1]),
        ]
    )
    return State(time, position, np.column_stack([motion.vx, motion.vy]))


def _simulate(session: Session, stop: Stop, wishes: Wishes, writer: Writer) -> tuple[str, Rows, float]:
    """(why it stopped, the last rows, seconds simulating); in stints short enough to be interrupted."""
    budget = FIRST_BUDGET
    elapsed = 0.0
    last_rows = blank_rows(0)
    with _interruptible() as interrupted:
        while True:
            began = perf_counter()
            stopped = session.advance(stop, budget)
            stint = perf_counter() - began
            elapsed += stint
            if stint < 0.5 * LONGEST_STINT:
                budget *= 2
            elif stint > LONGEST_STINT:
                budget = max(budget // 2, 1)
            rows = session.take_rows()
            if len(rows):
                last_rows = rows[-TAIL:] if len(rows) >= TAIL else np.concatenate([last_rows, rows])[-TAIL:]
                writer.write(rows)
                if wishes.on_event is not None:
                    wishes.on_event(rows)
            if stopped is None and interrupted():
                stopped = "interrupted"
            if wishes.progress is not None:
                _tell(wishes.progress, session, stop)
            if stopped is not None:
                return stopped, last_rows, elapsed


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
def _interruptible() -> Iterator[Callable[[], bool]]:
    """Ctrl-C, or the signal to terminate, sets a flag instead of breaking into an event; a second one breaks in."""
    asked = False

    def ask(number: int, frame: FrameType | None) -> None:
        nonlocal asked
        if asked:
            raise KeyboardInterrupt
        asked = True

    if threading.current_thread() is not threading.main_thread():
        yield lambda: False
        return
    before = {number: signal.signal(number, ask) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield lambda: asked
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def memory_log(provenance: Provenance, blocks: list[Rows], ending: Ending | None) -> EventLog:
    """A log in memory from blocks of rows."""
    sink = MemorySink(provenance)
    for block in blocks:
        sink.write(block)
    sink.close(ending)
    return sink.log()
