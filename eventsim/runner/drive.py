"""Drives a session to its stop: sinks, progress, interrupts, timing; the same for every engine."""

from __future__ import annotations

from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from time import perf_counter

import numpy as np

from eventsim import __version__
from eventsim.engines.base import OnEvent, Progress, Run, Session, Stop
from eventsim.engines.collapse import diagnosis
from eventsim.errors import EventsimError
from eventsim.formulas.clock import MOST_EPOCHS, clock_time
from eventsim.record.digest import Digester
from eventsim.record.events import Rows, State
from eventsim.record.files import FileSink, continued_sink, open_sink
from eventsim.record.places import on_scene_axes
from eventsim.record.provenance import Ending, Provenance
from eventsim.replay.log import EventLog, MemorySink, rows_so_far
from eventsim.runner.checkpoint import Checkpoint, Every
from eventsim.runner.checkpoint_writer import USUALLY, Keeper
from eventsim.runner.loop import Sink, Work
from eventsim.runner.residuals import residuals_of
from eventsim.runner.writer import Writer
from eventsim.scene import Scene
from eventsim.scene.stage import Stage

REPLAYED = ("auto", "reference", "fast")
"""Engines whose every bit follows from the scene and the order of its contacts."""


@dataclass(slots=True)
class Wishes:
    """What a caller wants to have besides the state: a log (in memory: True, or a path), a digest, to be told, checkpoints.

    on_event is called between two stints of the engine, takers beside it, in the writer's thread.  checkpoint: the file that is
    replaced again and again, `every` so often.  resumed: the checkpoint that the run goes on from.
    """

    log: bool | str | PathLike[str] = False
    compact: bool = False
    digest: bool = False
    progress: Progress | None = None
    on_event: OnEvent | None = None
    command: str | None = None
    takers: list[OnEvent] = field(default_factory=list)
    checkpoint: Path | None = None
    every: Every = USUALLY
    resumed: Checkpoint | None = None

    @property
    def rows(self) -> bool:
        """Whether anything wants the rows."""
        return self.log is not False or self.digest or self.on_event is not None or bool(self.takers)


def drive(session: Session, engine: str, scene: Scene, stop: Stop, wishes: Wishes) -> Run:
    """Simulate to the stop and gather what was wished for; an interrupt keeps everything so far.

    Where something breaks the run off, a log that has rows stays as NAME.part, which can be read, and the last checkpoint.
    Raises EventsimError for wishes that do not go together, LogError and CheckpointError where files cannot be written.
    """
    stage = session.stage
    _demand_possible(engine, stop, stage, wishes)
    resumed = wishes.resumed
    if resumed is None:
        provenance = provenance_of(session, engine, scene, wishes.command)
    else:
        provenance = resumed.provenance
        session.restore(resumed.snapshot)
        session.counters.copy_from(resumed.counters)
    memory = MemorySink(provenance) if wishes.log is True else None
    file = _file_sink(wishes, provenance)
    sinks: list[Sink] = [sink for sink in (memory, file) if sink is not None]
    digester = Digester() if wishes.rows and (wishes.digest or wishes.log is not False) else None
    compiled_before = _compile_seconds(session)
    digests = [] if digester is None else [digester.update]
    writer = Writer([sink.write for sink in sinks] + digests + wishes.takers)
    try:
        if resumed is not None and file is not None and digester is not None:
            for rows in rows_so_far(file):
                digester.update(rows)
        keeper = None if wishes.checkpoint is None else Keeper(wishes.checkpoint, wishes.every, provenance, stop, file)
        work = Work(session, stop, wishes.on_event, wishes.progress, writer, keeper)
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
    return Run(
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
        trajectory=getattr(session, "trajectory", None),  # stepped engines have one
        _log=None if memory is None else memory.log(),
    )


def _demand_possible(engine: str, stop: Stop, stage: Stage, wishes: Wishes) -> None:
    """Raise EventsimError for what this engine, or any, cannot do."""
    if wishes.compact and engine not in REPLAYED:
        raise EventsimError(
            "a compact log leaves out what replay computes, and replay computes as the reference and the fast engine do: "
            f"the log of the engine {engine} has to be a full one"
        )
    if stop.until is not None and stop.until - stage.start_time > MOST_EPOCHS * stage.epoch_length:
        latest = stage.start_time + MOST_EPOCHS * stage.epoch_length
        raise EventsimError(f"until = {stop.until!r}: the clock of this scene ends at {latest:g}")
    if wishes.checkpoint is None and wishes.resumed is None:
        return
    if engine not in REPLAYED:
        raise EventsimError(
            f"the engine {engine} has no checkpoints, since its future does not follow from the flights of the disks alone; "
            "auto, reference and fast have"
        )
    if wishes.log is True:
        raise EventsimError("a log in memory does not outlive its run: with a checkpoint the log needs a file")
    if wishes.digest and wishes.log is False:
        raise EventsimError(
            "a digest is of all rows, and a run that goes on has only its log to look back: give it a log file"
        )


def _file_sink(wishes: Wishes, provenance: Provenance) -> FileSink | None:
    """The writer of the log file: a new one, or that of the run that goes on."""
    if isinstance(wishes.log, bool):
        return None
    path = Path(wishes.log)
    if wishes.resumed is None:
        return open_sink(path, provenance, compact=wishes.compact)
    assert wishes.resumed.log is not None, "only a run that kept a log goes on with one"
    return continued_sink(path, provenance, wishes.compact, wishes.resumed.log.mark)


def diagnosed(session: Session, stopped: str, last_rows: Rows) -> tuple[str, str | None]:
    """Why a run stopped, and the sentence about it; a sequence that does not end is told from its last rows."""
    stage = session.stage
    if stopped != "collapse" or not stage.loses_energy or getattr(session, "refused", False):
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


def memory_log(provenance: Provenance, blocks: list[Rows], ending: Ending | None) -> EventLog:
    """A log in memory from blocks of rows."""
    sink = MemorySink(provenance)
    for block in blocks:
        sink.write(block)
    sink.close(ending)
    return sink.log()
