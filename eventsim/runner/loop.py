"""The loop that takes an engine to the stop: stints of the engine, and between them rows, checkpoints, progress, interrupts."""

from __future__ import annotations

from dataclasses import dataclass, field
from time import perf_counter

from eventsim.engines import Engine
from eventsim.engines.base import BrokenOffError, Session, Stop
from eventsim.engines.collapse import TAIL
from eventsim.engines.options import Options
from eventsim.errors import EventsimError
from eventsim.formulas.clock import MOST_EPOCHS, clock_time
from eventsim.record.events import Rows, blank_rows, joined, unchangeable
from eventsim.runner.checkpoint_writer import CheckpointWriter
from eventsim.runner.options import Interrupt, Notice, OnEvent, Progress, RunOptions
from eventsim.runner.outcome import Outcome, diagnosed, provenance_of, state_of
from eventsim.runner.pace import Pace
from eventsim.runner.recording import Recording
from eventsim.runner.residuals import residuals_of
from eventsim.scene import Scene
from eventsim.scene.stage import Stage, stage_of

FIRST_BUDGET, LARGEST_BUDGET, LONGEST_STINT = 64, 1 << 20, 0.2
"""Steps of the first stint, and of any; seconds that a stint may take before progress and interrupts are looked at.

A stint may end early, where rows are to be passed on: that says nothing about how long its steps would have taken.
"""


def run_scene(
    engine: Engine, scene: Scene, stop: Stop, wanted: RunOptions | None = None, options: Options | None = None
) -> Outcome:
    """Run a scene to its stop with an engine; options are the engine's own.

    Raises EventsimError for options and wishes that the engine cannot fulfil.
    """
    wanted = wanted or RunOptions()
    stage = stage_of(scene)
    # Where contacts can pile up, the last rows say how.
    session = engine.open(stage, wanted.rows or stage.law.loses_energy(), options)
    return run_session(session, engine, scene, stop, wanted)


def run_session(session: Session, engine: Engine, scene: Scene, stop: Stop, wanted: RunOptions) -> Outcome:
    """Run a session to the stop and gather what is wanted; an interrupt that is handed in keeps everything so far.

    Where something else breaks the run off, a log that has rows stays as NAME.part, which can be read, and the last checkpoint.
    Raises EventsimError for wishes that do not go together, LogError and CheckpointError where files cannot be written.
    """
    _demand_possible(engine, stop, session.stage, wanted)
    resumed, interrupt = wanted.resumed, wanted.interrupt or Interrupt()
    interrupt.session = session
    if resumed is None:
        provenance = provenance_of(session, engine.name, scene, wanted.command)
    else:
        provenance = resumed.provenance
        session.restore(resumed.snapshot)
        session.counters.copy_from(resumed.counters)
    recording = Recording(wanted, provenance)
    checkpoints = None
    try:
        if resumed is not None:
            recording.go_on(wanted)
        if wanted.checkpoint is not None:
            checkpoints = CheckpointWriter(wanted.checkpoint, wanted.every, provenance, stop, recording.file)
        pace = Pace(session, stop)
        loop = Loop(session, stop, recording, checkpoints, interrupt, pace, wanted.on_event, wanted.progress, wanted.notice)
        if resumed is not None:
            loop.elapsed, loop.last_rows, loop.saving = resumed.elapsed_s, resumed.last_rows, resumed.write_s
        stopped, reason = diagnosed(session, loop.run(), loop.last_rows)
        began = perf_counter()
        waited = recording.waited_s
        digest = recording.close(*session.clock, stopped)
        written = loop.saving + waited + perf_counter() - began
    except BaseException:
        recording.break_off(has_rows=session.counters.events > 0)
        raise
    finally:
        interrupt.session = None
        if checkpoints is not None:
            checkpoints.close()
    return Outcome(
        scene=scene,
        engine=session.at_work,  # of `auto`, the one that came last
        state=state_of(session, stop, stopped, scene),
        counters=session.counters,
        residuals=residuals_of(session),
        stopped=stopped,
        reason=reason,
        digest=digest,
        elapsed_s=loop.elapsed,
        compile_s=session.compile_s,
        begun_by=session.begun_by,
        write_s=written,
        log_path=None if recording.file is None else recording.file.path,
        recorded=None if recording.memory is None else recording.memory.recorded(),
        trajectory=session.trajectory,
        pace=pace.told,
    )


def _demand_possible(engine: Engine, stop: Stop, stage: Stage, wanted: RunOptions) -> None:
    """Raise EventsimError for what this engine, or any, cannot do."""
    if wanted.compact and isinstance(wanted.log, bool):
        raise EventsimError("compact is a form of log files: give the log a path, or leave compact out")
    if wanted.compact and not engine.replays:
        raise EventsimError(
            "a compact log leaves out what the reference and the fast engine compute: "
            f"the log of the engine {engine.name} has to be a full one"
        )
    if stage.goes_on_as_fast and stop.until is not None and stop.until - stage.start_time > MOST_EPOCHS * stage.epoch_length:
        latest = stage.start_time + MOST_EPOCHS * stage.epoch_length
        raise EventsimError(f"until = {stop.until!r}: the clock of this scene ends at {latest:g}")
    if wanted.checkpoint is None and wanted.resumed is None:
        return
    if not engine.replays:
        raise EventsimError(
            f"the engine {engine.name} has no checkpoints, since its future does not follow from the flights of the disks alone; "
            "auto, reference and fast have"
        )
    if wanted.log is True:
        raise EventsimError("a log in memory does not outlive its run: with a checkpoint the log needs a file")
    if wanted.digest and wanted.log is False:
        raise EventsimError(
            "a digest is of all rows, and a run that goes on has only its log to look back: give it a log file"
        )


@dataclass(slots=True)
class Loop:
    """A run in stints short enough to be interrupted, and what is done between them.

    elapsed: seconds simulating, without those of compiling.  saving: seconds spent on checkpoints.  last_rows: the last of all,
    for a diagnosis.
    """

    session: Session
    stop: Stop
    recording: Recording
    checkpoints: CheckpointWriter | None
    interrupt: Interrupt
    pace: Pace
    on_event: OnEvent | None = None
    progress: Progress | None = None
    notice: Notice | None = None
    elapsed: float = 0.0
    saving: float = 0.0
    last_rows: Rows = field(default_factory=lambda: blank_rows(0))

    def run(self) -> str:
        """Simulate to the end; why it stopped."""
        session, budget = self.session, FIRST_BUDGET
        self._save()
        while True:
            aim = self._next_stop()
            began, compiled = perf_counter(), session.compile_s
            try:
                stopped = session.advance(aim, budget)
            except BrokenOffError:
                stopped = "interrupted"
            stint = perf_counter() - began
            # What is compiled outside a stint, as for a checkpoint before the first one, takes nothing from it.
            self.elapsed += max(stint - (session.compile_s - compiled), 0.0)
            if stint < 0.5 * LONGEST_STINT:
                budget = min(2 * budget, LARGEST_BUDGET)
            elif stint > LONGEST_STINT:
                budget = max(budget // 2, 1)
            self._pass_on(session.take_rows())
            if stopped == "events" and aim != self.stop and not self._has_all_events():
                stopped = None
            if stopped is None and self.interrupt.asked:
                stopped = "interrupted"
                session.break_off()
                self._pass_on(session.take_rows())
            self._save(stopped)
            if self.progress is not None:
                _tell(self.progress, session, self.stop)
            if (told := self.pace.look()) is not None and self.notice is not None:
                self.notice(told)
            if stopped is not None:
                return stopped

    def _next_stop(self) -> Stop:
        """The stop, or where the next checkpoint is due before it."""
        if self.checkpoints is None:
            return self.stop
        return self.checkpoints.next_stop(self.stop, self.session.counters.events)

    def _has_all_events(self) -> bool:
        return self.stop.events is not None and self.session.counters.events >= self.stop.events

    def _pass_on(self, rows: Rows) -> None:
        if len(rows):
            self.last_rows = rows[-TAIL:] if len(rows) >= TAIL else joined([self.last_rows, rows])[-TAIL:]
            self.recording.write(rows)
            if self.on_event is not None:
                self.on_event(unchangeable(rows))

    def _save(self, stopped: str | None = None) -> None:
        """Write a checkpoint where one is due, behind all rows so far."""
        if self.checkpoints is not None and self.checkpoints.is_due(self.session.counters.events, stopped):
            self.recording.settle()
            began = perf_counter()
            written = self.recording.waited_s + self.saving
            digest = self.recording.digest_so_far
            self.checkpoints.save(self.session, self.last_rows, self.elapsed, written, digest)
            self.saving += perf_counter() - began


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
