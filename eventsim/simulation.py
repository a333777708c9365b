"""What a Python user calls: simulate a scene to its stop, or step through it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from inspect import signature
from os import PathLike
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import NDArray

from eventsim import patience
from eventsim.engines import Engine, engine_named
from eventsim.engines.base import Counters, Snapshot, Stop
from eventsim.engines.collapse import TAIL
from eventsim.engines.options import Options, names_of
from eventsim.errors import CheckpointError, CollapseError, EventsimError, SceneError
from eventsim.formulas.clock import clock_time
from eventsim.meant import NamesMeant
from eventsim.record.events import Rows, State, joined, unchangeable
from eventsim.record.files import read_log
from eventsim.record.provenance import Ending
from eventsim.run import EventLog, Run
from eventsim.runner.checkpoint import Checkpoint, interval, load_checkpoint, place_for
from eventsim.runner.checkpoint_writer import USUALLY
from eventsim.runner.keeping import Keeping
from eventsim.runner.loop import run_scene
from eventsim.runner.options import Interrupt, Notice, OnEvent, Progress, RunOptions, demand_place_of_log, stop_of
from eventsim.runner.outcome import diagnosed, provenance_of, state_of
from eventsim.runner.recording import MemorySink
from eventsim.scene import Scene
from eventsim.scene.numbers import SPEEDS, as_whole, is_velocity, number, point
from eventsim.scene.scene import difference
from eventsim.scene.stage import stage_of

if TYPE_CHECKING:
    from eventsim.measure import Measures

STEP_BUDGET, FIRST_BUDGET = 4096, 32
"""Steps of an engine between two looks at whether the next event has come; between the first two, where somebody waits only so
long: a step may take a hundredth of a second, where ties are told by rationals."""

MOST_WRAPS = 200_000
"""Wraps without an event after which `step` no longer waits for one."""


def simulate(
    scene: Scene,
    until: float | None = None,
    events: int | None = None,
    engine: str = "auto",
    log: bool | str | PathLike[str] = False,
    compact: bool = False,
    digest: bool = False,
    progress: Progress | None = None,
    on_event: OnEvent | None = None,
    measure: bool | float = False,
    profile: str | None = None,
    trust: bool | None = None,
    command: str | None = None,
    checkpoint: str | PathLike[str] | None = None,
    every: int | str | None = None,
    interrupt: Interrupt | None = None,
    notice: Notice | None = None,
    **options: Any,
) -> Run:
    """Simulate a scene until a time on its clock or for a number of events, whichever comes first.

    Simultaneous contacts are never cut apart, so a run that stops by `events` may have a few events more.
    Whatever breaks the run off (Ctrl-C raises KeyboardInterrupt), a log that has rows stays as NAME.part, which `load_log` reads.

    Args:
        scene: what there is.
        until: a time on the scene's clock; given here, it replaces what the scene says, as does `events`.
        events: how many events.
        engine: a name of `ENGINES`, or "auto".
        log: False (counters only), True (in memory) or a path (.csv, .jsonl, .npz, .parquet; streamed).
        compact: leave out of the log what replay computes.
        digest: compute the digest also where no log is kept.
        progress: called as progress(fraction, events, time) a few times a second.
        on_event: called as on_event(rows) with each block of new rows.
        measure: True, or the time at the beginning to leave out: `run.measures`, in constant memory and without a log.
        profile: "x" or "y", for profiles along it as well.
        trust: estimate until when positions hold, for `run.trust`; None: where that costs little, with the reference engine,
            and at the beginning of a log.
        command: what the log says that wrote it; None: nothing.
        checkpoint: a file that `resume` can go on from, replaced while the run goes on, and at the end.
        every: how often: after so many events (1000000) or so much time ("90s", "5min", "2h"); None: every minute.
        interrupt: ends the run between two events once another thread asks it to (`Interrupt().ask()`).
        notice: called as notice(sentence), once, where contacts come ever faster: `run.pace` tells afterwards.
        **options: the engine's own, such as check=True.

    Returns:
        A Run; its `stopped` tells why it ended.

    Raises:
        SceneError: where nothing says when to stop.
        EventsimError: for an engine or an option that does not exist, and for wishes that do not go together.
        LogError: for a log that cannot be written.
        CheckpointError: for a checkpoint that cannot be written.
    """
    chosen = engine_named(engine)
    given = _options(chosen, options, PARAMETERS, ELSEWHERE)
    stop = stop_of(a_scene(scene), until, events)
    wanted = RunOptions(
        log=log,
        compact=compact,
        digest=digest,
        progress=progress,
        on_event=on_event,
        command=command,
        interrupt=interrupt,
        notice=notice,
    )
    _demand_checkpoint(every, checkpoint)
    if profile is not None and measure is False:
        raise EventsimError(f"profile = {profile!r} is a part of what is measured: give measure=True, too")
    if checkpoint is not None:
        wanted.checkpoint, wanted.every = place_for(checkpoint), USUALLY if every is None else interval(every)
        if measure is not False:
            raise EventsimError("measures are not in a checkpoint: keep a log, and measure that")
    meter = line = None
    if measure is not False:
        from eventsim.measure import Meter  # only who measures pays for it

        discard = None if measure is True else number(measure, "measure")
        meter = Meter(scene, discard, profile=profile, engine=chosen.name)
        wanted.takers.append(meter.write)
    if trust or (trust is None and (chosen.name == "reference" or (chosen.name == "auto" and log is not False))):
        if not chosen.replays:
            raise EventsimError(f"trust is about the last bits of event-driven runs, and the engine {chosen.name} is none")
        from eventsim.measure.trust import UNASKED, TrustLine

        line = TrustLine(scene, None if trust or chosen.name == "reference" else UNASKED)
        wanted.takers.append(line.write)
    run = Run.of(run_scene(chosen, scene, stop, wanted, given))
    if meter is not None and run.time > scene.start_time:
        run._measures = meter.finish(run.time - scene.start_time, waits=run.stopped != "interrupted")
    if line is not None:
        run.trust = line.found()
    return run


PARAMETERS = tuple(name for name in signature(simulate).parameters if name not in ("scene", "command", "options"))
"""What can be given to `simulate` by name, for those who misspell it."""

ELSEWHERE = {
    "seed": "a seed belongs to who draws: load_scene(path, seed=1), gallery(name, seed=1)",
    "discard": "measure=TIME leaves out the beginning",
    **dict.fromkeys(("t", "time", "t_end", "t_max", "tmax", "duration"), "until=TIME says when to stop"),
}
"""What others call what `simulate` has by another name, or somebody else has."""

IN_STEPS = dict.fromkeys(("until", "events"), "it has no stop: advance_to(time) and step() go on as far as you ask")
"""The same of a `Simulation`."""


def _demand_checkpoint(every: object, checkpoint: object) -> None:
    """Raise EventsimError where it is said how often a checkpoint is written, and not where."""
    if every is not None and checkpoint is None:
        raise EventsimError(f"every = {every!r} says how often a checkpoint is written: give checkpoint=PATH, too")


def _options(engine: Engine, given: dict[str, Any], known: tuple[str, ...], elsewhere: dict[str, str]) -> Options:
    """The engine's options among keywords; EventsimError for others, with what may have been meant."""
    for name in given:
        if name in elsewhere and name not in names_of(engine.options):
            raise EventsimError(f"there is no option {name!r}: {elsewhere[name]}")
    return engine.options_from(given, known)


def resume(
    path: str | PathLike[str],
    until: float | None = None,
    events: int | None = None,
    engine: str | None = None,
    log: str | PathLike[str] | None = None,
    digest: bool = False,
    progress: Progress | None = None,
    on_event: OnEvent | None = None,
    checkpoint: str | PathLike[str] | None = None,
    every: int | str | None = None,
    scene: Scene | None = None,
    interrupt: Interrupt | None = None,
    notice: Notice | None = None,
) -> Run:
    """Go on with a run from its checkpoint `path`: the log it joins is that of an uninterrupted run, bit for bit.

    until, events: replace both parts of the stop that the run had; events count from its beginning.  engine: another one.
    log: where its log is now, if it was moved; rows behind the checkpoint are written anew.  digest: refused where there is no
    log.  progress, on_event, interrupt, notice: as in `simulate`, of what comes now.  checkpoint, every: where and how often
    the next checkpoints are written; left out, to `path`, as often as before.  scene: refuse the checkpoint where it is of
    another scene; a law of contacts of your own is taken from here.

    Returns a Run, whose counters and times include what was before.  Raises CheckpointError for a file that is no checkpoint,
    of another version or of another scene, or that is past the stop, LogError where its log is lost.
    """
    saved = load_checkpoint(path)
    provenance = saved.provenance
    if scene is not None and a_scene(scene) != provenance.scene:
        raise CheckpointError(f"{path}: the checkpoint is of another scene: {difference(provenance.scene, scene)}")
    if log is not None and saved.log is None:
        raise CheckpointError(f"{path}: the run kept no log, so none can be continued")
    if saved.log is not None and saved.log.mark.rows != saved.counters.events:
        raise CheckpointError(f"{path}: {saved.log.mark.rows} rows of a log do not fit {saved.counters.events} events")
    kept = until is None and events is None and saved.stop != Stop()  # who steps through a simulation has no stop
    stop = saved.stop if kept else stop_of(provenance.scene, until, events)
    if stop != saved.stop:
        _demand_ahead(stop, saved, path)
    wanted = RunOptions(
        log=False if saved.log is None else saved.log.path if log is None else log,
        compact=saved.log is not None and saved.log.compact,
        digest=digest,
        progress=progress,
        on_event=on_event,
        checkpoint=place_for(path if checkpoint is None else checkpoint),
        every=saved.every if every is None else interval(every),
        resumed=saved,
        interrupt=interrupt,
        notice=notice,
    )
    chosen = engine_named(provenance.engine if engine is None else engine)
    return Run.of(run_scene(chosen, provenance.scene if scene is None else scene, stop, wanted))


def _demand_ahead(stop: Stop, saved: Checkpoint, path: str | PathLike[str]) -> None:
    """Raise CheckpointError for a stop that the run has passed: a run does not go back, and its checkpoint would be lost."""
    provenance = saved.provenance
    time = clock_time(saved.snapshot.epoch, saved.snapshot.now, provenance.epoch_length, provenance.scene.start_time)
    earlier = "" if saved.log is None else "; the log has the states before (eventsim state LOG --at TIME)"
    if stop.until is not None and stop.until < time:
        raise CheckpointError(f"{path}: the run has come to t = {time!r}, past until = {stop.until!r}{earlier}")
    if stop.events is not None and stop.events < saved.counters.events:
        raise CheckpointError(
            f"{path}: the run has {saved.counters.events} events, past events = {stop.events}{earlier}"
        )


def a_scene(scene: object) -> Scene:
    """The scene that was given; SceneError for what is none."""
    if not isinstance(scene, Scene):
        raise SceneError(f"{scene!r} is not a scene: load_scene(path) and gallery(name) give one")
    return scene


@dataclass(frozen=True, slots=True)
class SavedSimulation:
    """A point that a simulation can go back to."""

    scene: Scene
    snapshot: Snapshot
    counters: Counters
    rows: int
    time: float | None
    ended: tuple[str, str] | None


class Simulation(NamesMeant):
    """A scene that is simulated step by step.

    log: True (in memory) or a path (.csv, .jsonl, .npz, .parquet), to which rows are streamed.  measure: the time at the
    beginning that `measures` leave out; True: they find out.  checkpoint: a file that `resume` can go on from, replaced `every`
    so many events or so much time, and at the end.  Files are complete once `close()` was called, or the end of `with` is
    reached.  options: the engine's own.  Raises LogError and CheckpointError for files that cannot be written.

    >>> import eventsim as es
    >>> sim = es.Simulation(es.gallery("two-disks"), engine="reference")
    >>> rows = sim.step()
    >>> sim.advance_to(sim.time + 1.0); sim.set_velocity(0, (1.0, 0.0))  # doctest: +ELLIPSIS
    array(...)
    >>> sim.log[-1].kind
    'kick'
    """

    def __init__(
        self,
        scene: Scene,
        engine: str = "auto",
        log: bool | str | PathLike[str] = True,
        measure: bool | float = False,
        checkpoint: str | PathLike[str] | None = None,
        every: int | str | None = None,
        **options: Any,
    ) -> None:
        chosen = engine_named(engine)
        own = tuple(signature(Simulation).parameters)[1:-1]
        self.scene = scene
        self.engine = chosen.name
        self._options = options
        self._discard = None if isinstance(measure, bool) else measure
        self._keeping: Keeping | None = None
        self._closed = False
        self._session = chosen.open(stage_of(a_scene(scene)), options=_options(chosen, options, own, IN_STEPS))
        self._provenance = provenance_of(self._session, self.engine, scene)
        self._memory = MemorySink(self._provenance)  # stays empty beside a file
        self._read: EventLog | None = None  # the log as it was read last
        self._measured: tuple[EventLog, Measures] | None = None
        self._time: float | None = None
        self._broken_off = False
        self._ended: tuple[str, str] | None = None  # why it cannot go on: a word, a sentence
        demand_place_of_log(log)
        _demand_checkpoint(every, checkpoint)
        if log is False:
            raise EventsimError("a simulation that is stepped through keeps its log: log=True, or a path")
        if checkpoint is not None and isinstance(log, bool):
            raise EventsimError("a log in memory does not outlive its run: with a checkpoint the log needs a file")
        if not isinstance(log, bool):
            self._keeping = Keeping(self._provenance, log, checkpoint, USUALLY if every is None else interval(every))

    def __repr__(self) -> str:
        return f"Simulation({self.scene.called}: {self.counters.events:,} events to t = {self.time!r})"

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *raised: object) -> None:
        self.close()

    def close(self) -> None:
        """Complete the files of the log and of the checkpoint; there is no going on after it.  Without files it does nothing."""
        if self._keeping is not None and not self._closed:
            self._closed = True
            self._keeping.close(self._session, self._ending.reason)

    def __copy__(self) -> Simulation:
        """A simulation that stands where this one does and goes on by itself.  Raises EventsimError where files are written."""
        if self._keeping is not None:
            raise EventsimError("a simulation that writes files has no copy: two would write the same")
        other = Simulation(self.scene, self.engine, **self._options)
        other._memory.write(self._memory.recorded().rows)
        other.restore(self.snapshot())
        return other

    def __deepcopy__(self, memo: dict[int, Any]) -> Simulation:
        return self.__copy__()

    @property
    def time(self) -> float:
        """Where the scene's clock stands."""
        if self._time is not None:
            return self._time
        stage = self._session.stage
        return clock_time(*self._session.clock, stage.epoch_length, stage.start_time)

    @property
    def state(self) -> State:
        """Where all disks are now; looking changes nothing."""
        state = state_of(self._session, scene=self.scene)
        return state if self._time is None else replace(state, time=self._time)

    @property
    def log(self) -> EventLog:
        """All that happened so far, at the cost of what came since the last look; a file is read as a whole where it has grown.

        Who only wants the new rows has them from `step` and `advance_to`.
        """
        ending = self._ending if self._keeping is None or self._closed else None  # a file that grows has none
        if self._read is None or self._read.provenance.ending != ending:
            self._read = self._log_so_far()
        return self._read

    def _log_so_far(self) -> EventLog:
        if self._keeping is not None and self._keeping.log is not None:
            file = self._keeping.log
            if not self._closed:
                file.sync()
            path = file.path if self._closed else file.part
            log = EventLog(*read_log(path, verify=self._closed))
            log.path = path
            return log
        self._memory.close(self._ending)
        return EventLog(*self._memory.recorded())

    @property
    def measures(self) -> Measures:
        """What is measured in all that happened so far, from the whole log, whose length it costs where rows or time have passed.

        Raises EventsimError where there is nothing to measure.
        """
        from eventsim.measure import measure  # only who measures pays for it

        log = self.log
        if self._measured is not None and self._measured[0] is log and log.provenance.ending is not None:
            return self._measured[1]
        if log.provenance.ending is None:  # a file that grows
            ended = replace(log.provenance, ending=self._ending)
            log = EventLog(ended, log.rows)
        measures = measure(log, self._discard)
        self._measured = log, measures
        return measures

    @property
    def counters(self) -> Counters:
        """How often what happened."""
        return self._session.counters

    def step(self) -> Rows:
        """Go to the next event; its row, or the rows of all contacts at that instant.

        Empty where no event is ahead: the clock stands at the last one then, or, where disks wrap around the domain, as far on as
        it took to find that out.  Who wants to go on from here asks `advance_to(time)`.
        Raises CollapseError where the simulation cannot go on (contacts follow one another without end, digits have run out, no
        law tells what a contact does), and again whenever it is asked to; EventsimError after MOST_WRAPS wraps without an event,
        where nobody knows whether one is ahead.
        """
        return self._advance(Stop(events=self._session.counters.events + 1))

    def advance_to(self, time: float, events: int | None = None) -> Rows:
        """Let time pass to `time` on the scene's clock; the rows of what happened.

        events: stop after so many even where that is earlier; `time` of the simulation tells which came first.
        It also stops earlier where nobody waits any more (`eventsim.patience`).
        Raises CollapseError as step; EventsimError for a time that has passed.
        """
        time = number(time, "time")
        if not math.isfinite(time) or time < self.time:
            raise EventsimError(f"cannot advance to {time!r}: it must be a finite time, not before {self.time!r}")
        return self._advance(Stop(time, None if events is None else self._session.counters.events + events))

    def set_velocity(self, disk: int | np.integer[Any], velocity: Sequence[float] | NDArray[Any]) -> None:
        """Give a disk another velocity, now: a kick, logged, so that the log still replays.

        Raises EventsimError for a disk that does not exist or a velocity that no disk of a scene may have; CollapseError where
        the simulation cannot go on.
        """
        self._demand_going()
        vx, vy = point(velocity, f"velocity of disk {disk}")
        place = as_whole(disk)
        if place is None or not 0 <= place < len(self.scene.disks):
            raise EventsimError(f"disk {disk} does not exist; there are {len(self.scene.disks)}, counted from 0")
        if not is_velocity(vx, vy):
            raise EventsimError(f"velocity ({vx!r}, {vy!r}) of disk {disk}: {SPEEDS}")
        self._session.kick(place, vx, vy)
        self._keep()

    def snapshot(self) -> SavedSimulation:
        """A point to come back to."""
        self._demand_whole()
        rows = len(self._memory.recorded().rows)
        return SavedSimulation(
            self.scene, self._session.snapshot(), self._session.counters.copy(), rows, self._time, self._ended
        )

    def restore(self, saved: SavedSimulation) -> None:
        """Go back to a snapshot; what happened since is forgotten.

        Raises EventsimError for a snapshot of another scene, and where what happened since is in a file.
        """
        if self._keeping is not None and saved.counters.events != self.counters.events:
            raise EventsimError("what is in a log file cannot be taken back: keep the log in memory to restore snapshots")
        if saved.scene != self.scene:
            raise EventsimError("restore() takes what snapshot() of a simulation of the same scene gave")
        self._broken_off = False
        self._session.restore(saved.snapshot)
        self._session.counters.copy_from(saved.counters)
        self._session.take_rows()
        if self._keeping is None:
            self._memory.forget(saved.rows)
            self._read = None
        self._time, self._ended = saved.time, saved.ended

    def _advance(self, stop: Stop) -> Rows:
        begun, came = self.time, []
        stopped, wraps = None, self.counters.wraps
        budget = FIRST_BUDGET if patience.is_bounded() else STEP_BUDGET
        while stopped is None:
            stopped = self._advanced(stop, budget)
            budget = min(2 * budget, STEP_BUDGET)
            came.append(self._keep())
            if stopped is None and patience.is_over():
                stopped = "patience"
            if stopped is None and stop.until is None and self.counters.wraps - wraps > MOST_WRAPS:
                self._time = None
                raise EventsimError(
                    f"no event in {MOST_WRAPS} wraps around the domain, up to t = {self.time:g}, and none may be ahead; "
                    "advance_to(time) lets time pass"
                )
        self._time = None
        if stopped in ("collapse", "digits", "law"):
            stopped, reason = diagnosed(self._session, stopped, self._last_rows())
            self._ended = stopped, f"stopped by {stopped}: {reason}"
            self._demand_going()
        if stop.until is not None and stopped in ("until", "quiet"):
            self._time = float(stop.until)
        if self.time < begun:  # a quiet end is that of the last flight, which has been passed already
            while self._session.advance(Stop(until=begun), STEP_BUDGET) is None:
                pass
            self._time = begun
        return unchangeable(joined(came))

    def _advanced(self, stop: Stop, budget: int) -> str | None:
        """A stint of the engine, which Ctrl-C may break off."""
        self._demand_going()
        self._broken_off = True
        stopped = self._session.advance(stop, budget)
        self._broken_off = False
        return stopped

    def _demand_whole(self) -> None:
        """Raise EventsimError after half an event, which is nothing to go on from, and after the end."""
        if self._closed:
            raise EventsimError("the simulation is closed: its files are complete; resume() goes on from a checkpoint")
        if self._broken_off:
            raise EventsimError("the simulation was broken off in the middle of an event: restore() a snapshot, or begin anew")

    def _demand_going(self) -> None:
        """Raise EventsimError also where the run cannot go on: what it stopped at would be passed over."""
        self._demand_whole()
        if self._ended is not None:
            raise CollapseError(self._ended[1])

    @property
    def _ending(self) -> Ending:
        """Where it stands, as the end of a log."""
        return Ending(*self._session.clock, "until" if self._ended is None else self._ended[0])

    def _keep(self) -> Rows:
        """Have the new rows kept; they are returned."""
        rows = unchangeable(self._session.take_rows())
        if len(rows):
            self._read = None
        if self._keeping is not None:
            self._keeping.write(rows, self._session)
        elif len(rows):
            self._memory.write(rows)
        return rows

    def _last_rows(self) -> Rows:
        """Those that a diagnosis looks at."""
        return self._memory.recorded().rows[-TAIL:] if self._keeping is None else self._keeping.last_rows
