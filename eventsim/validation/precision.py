"""Work and precision: the error of every engine against the time that it takes, over its parameter.

What is called an error depends on what the scene can be asked for:

    trajectory   root mean square distance of the disks from the truth at one time, in diameters
    pressure     relative error of the virial over a long run, from the event-driven one
    unrest       how far a pile is from rest when it should be: see `pile`
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from eventsim.compiler import has_compiler
from eventsim.engines import ENGINES, ONE_LOG, STEPPED
from eventsim.engines.base import Counters, Session
from eventsim.engines.certified import CertifiedOptions
from eventsim.engines.reference.loop import ReferenceSession
from eventsim.engines.reference.predict import Predictor
from eventsim.engines.stepped.session import SteppedSession
from eventsim.errors import EventsimError
from eventsim.formulas.contact import pair_delay
from eventsim.formulas.laws import TimeOfContact
from eventsim.scene import Scene
from eventsim.scene.stage import Stage, stage_of
from eventsim.validation.averages import kinetic_energy, virial_pressure
from eventsim.validation.competitors import Competitor, able
from eventsim.validation.follow import Followed, follow, position_errors
from eventsim.validation.pile import unrest
from eventsim.validation.timing import timing_of, warm_up
from eventsim.validation.truth import Truth, best_engine, neighbouring, truth_of

STEPS = (2.0, 1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002)
"""Steps in the time in which a typical disk flies its radius."""

BITS = (64, 96, 128, 192, 256, 512, 1024)
DURATIONS = (0.3, 0.1, 0.03, 0.01, 0.003, 0.001, 0.0003)
"""Precisions of balls; contact durations, in sqrt(d / g), of event-driven runs of a pile."""

NEIGHBOURS = 5
"""Runs that tell how much of a pressure is chance."""

BOTTOM = 1e-16
"""In diameters: an error that is shown where a run agrees with the truth to the last bit."""

Tell = Callable[[str], None]
ErrorOf = Callable[[Followed, Session], float]


@dataclass(slots=True)
class Point:
    """One engine with one parameter on one scene: error against work.

    parameter: `dt` (time), `bits`, or `contact_duration` (time).  elapsed: CPU seconds per simulated time, a median; least,
    most: of the runs that were timed.  error_least, error_most: over the seeds, whose median the error is.  events, steps,
    pair_tests, calendar: how often what was done; calendar: contacts, crossings, wraps and stale predictions taken from it.
    """

    scene: str
    measure: str
    label: str
    parameter: str
    value: float
    error: float
    elapsed: float
    least: float = math.nan
    most: float = math.nan
    error_least: float = math.nan
    error_most: float = math.nan
    events: int = 0
    steps: int = 0
    pair_tests: int = 0
    calendar: int = 0


@dataclass(frozen=True, slots=True)
class Task:
    """A scene, what is asked of it, until when, a few words for its panel; others: the scene with other seeds."""

    name: str
    scene: Scene
    measure: str
    until: float
    words: str = ""
    others: tuple[Scene, ...] = ()


@dataclass(slots=True)
class Curves:
    """All points of one task.

    floor: the error below which nothing can be told.  left_out: who could not take part, and why.  interrupted: engines that were
    not reached, or not to their end, are missing.
    """

    task: Task
    points: list[Point] = field(default_factory=list)
    floor: float = 0.0
    left_out: list[str] = field(default_factory=list)
    interrupted: bool = False

    def of(self, label: str) -> list[Point]:
        """The points of one engine, from its coarsest parameter to its finest."""
        return [point for point in self.points if point.label == label]

    @property
    def labels(self) -> list[str]:
        """The engines that took part."""
        return list(dict.fromkeys(point.label for point in self.points))


@dataclass(frozen=True, slots=True)
class _Runner:
    """One engine with one parameter: how to open it, and the error of what it did."""

    label: str
    parameter: str
    value: float
    open: Callable[[], Session]
    error: ErrorOf


def curves(
    task: Task,
    competitors: Sequence[Competitor],
    patience_s: float,
    tell: Tell = lambda _: None,
    timed: bool = True,
    keeps: bool = False,
) -> Curves:
    """Run every engine over its parameter.

    Interrupted, it raises KeyboardInterrupt; where it `keeps` what it has reached, it gives the engines that were timed to their
    end, if there are two of them.

    Args:
        task: the scene, and what is asked of it.
        competitors: the stepped engines.
        patience_s: a run that would take longer is left out, CPU seconds.
        tell: is told what is done.
        timed: whether runs are timed again.
        keeps: whether an interrupt leaves what was reached.
    """
    tell(f"{task.name}: event-driven run")
    result = Curves(task)
    stage = stage_of(task.scene)
    ready, result.left_out = able(competitors, stage)
    if task.measure == "unrest":
        runners = [[_rest(task, duration) for duration in DURATIONS]]
        speed = float(np.hypot(*(stage.gravity or (1.0, 0.0)))) ** 0.5
        error: ErrorOf = _unrest_error(stage)
    else:
        truth = truth_of(task.scene, [task.until])
        speed = truth.speed
        if task.measure == "pressure":
            error = _pressure_error(truth)
            result.floor = _chance(truth, error)
            runners = _event_driven(stage, lambda run, _: result.floor, result)
        else:
            best = _proven(stage, task.until, patience_s, result) or truth.run
            error = _trajectory_error(stage, best)
            if best is truth.run:
                runners = _event_driven(stage, lambda run, _: float(truth.uncertainty[-1]), result)
            else:
                runners = _event_driven(stage, error, result)
                runners.append([_plain(stage, error)])
                runners.append([_balls(stage, bits) for bits in BITS])
    radius = float(np.median(stage.radius)) or 1.0
    for competitor in ready:
        runners.append([_step_of(stage, competitor, step * radius / speed, error) for step in STEPS])
    duration = task.until - task.scene.start_time
    whole = 0
    try:
        for engine in runners:
            _run_list(result, engine, task.until, duration, patience_s, tell)
            if timed:
                _time(result, engine, task.until, duration)
            whole = len(result.points)
    except KeyboardInterrupt:
        del result.points[whole:]
        if not keeps or len(result.labels) < 2:
            raise
        result.interrupted = True
    return result


def _run_list(
    result: Curves, runners: Sequence[_Runner], until: float, duration: float, patience_s: float, tell: Tell
) -> None:
    """Run one engine from its cheapest parameter on, as long as there is patience."""
    taken, before, why = 0.0, 0.0, ""
    stopped: list[_Runner] = []
    for place, runner in enumerate(runners):
        growth = max(before / runner.value, runner.value / before) if before else 1.0
        if runner.parameter == "dt" and taken * growth > patience_s:
            _give_up(result, runners[place:], f"it would take more than {patience_s:g} s")
            return
        tell(f"{result.task.name}: {runner.label}, {runner.parameter} = {runner.value:.3g}")
        if not place and runner.label != "certified":  # its library is loaded since the proof
            warm_up(runner.open, [until])
        session = runner.open()
        if isinstance(session, SteppedSession) and result.task.measure != "pressure":
            session.only_step()  # where its contacts are not asked for, telling them shall not use up its patience
        run = follow(session, [until], patience_s)
        taken, before = run.elapsed_s, runner.value
        if run.stopped == "patience":
            _give_up(result, runners[place:], f"it was stopped after {patience_s:g} s")
            return
        if run.stopped is None:
            result.points.append(_point(result.task, runner, run, session, duration))
        else:
            stopped.append(runner)
            why = why or session.reason or run.stopped
    if stopped:
        _give_up(result, stopped, f"it stopped ({why})")


def _give_up(result: Curves, runners: Sequence[_Runner], why: str) -> None:
    """Tell that an engine does not take part with some of its parameters."""
    values = ", ".join(f"{runner.value:.4g}" for runner in runners)
    result.left_out.append(f"{runners[0].label} with {runners[0].parameter} = {values} is left out: {why}")


def _point(task: Task, runner: _Runner, run: Followed, session: Session, duration: float) -> Point:
    counters: Counters = run.counters
    return Point(
        scene=task.name,
        measure=task.measure,
        label=runner.label,
        parameter=runner.parameter,
        value=runner.value,
        error=max(runner.error(run, session), BOTTOM),
        elapsed=run.elapsed_s / duration,
        events=counters.events,
        steps=counters.steps,
        pair_tests=counters.pair_tests,
        calendar=0 if counters.steps else counters.events + counters.crossings + counters.wraps + counters.stale,
    )


def _time(result: Curves, runners: Sequence[_Runner], until: float, duration: float) -> None:
    """Time the runs again from new: stepped engines only step then."""
    points = {(point.label, point.value): point for point in result.points}
    for runner in runners:
        point = points.get((runner.label, runner.value))
        if point is not None:
            known = [] if runner.parameter == "dt" else [point.elapsed * duration]
            timing = timing_of(runner.open, [until], known).per(duration)
            point.elapsed, point.least, point.most = timing[:3]


def _event_driven(stage: Stage, error: ErrorOf, result: Curves) -> list[list[_Runner]]:
    """The event-driven engines, each with its own 53 bits, however small the scene; who cannot take part is noted."""
    runners = []
    for name in ONE_LOG:
        if name == "fast" and not has_compiler():
            result.left_out.append("fast is left out: nothing is compiled here, as numba is missing or told not to")
            continue
        opened = partial(ENGINES[name].open, stage)
        try:
            opened()
        except EventsimError as refused:
            result.left_out.append(f"{name} is left out: {refused}")
        else:
            runners.append([_Runner(name, "bits", 53.0, opened, error)])
    return runners


def _plain(stage: Stage, error: ErrorOf) -> _Runner:
    """The reference engine without careful contact times."""
    return _Runner("plain", "bits", 53.0, lambda: PlainSession(stage), error)


def _step_of(stage: Stage, competitor: Competitor, dt: float, error: ErrorOf) -> _Runner:
    engine = STEPPED[competitor.engine]
    return _Runner(competitor.label, "dt", dt, lambda: engine.open(stage, options=competitor.at(dt)), error)


def _rest(task: Task, duration: float) -> _Runner:
    """An event-driven run of a pile with another contact duration."""
    stage = stage_of(task.scene)
    stage = replace(stage, law=TimeOfContact(stage.law.pair, stage.law.wall, duration))
    name = best_engine(stage.n)
    engine = ENGINES[name]
    return _Runner(name, "contact_duration", duration, lambda: engine.open(stage), _unrest_error(stage))


def _balls(stage: Stage, bits: int) -> _Runner:
    """The certified engine with so many bits and no more; its error is the radius of its balls."""
    diameter = 2.0 * float(stage.radius.mean()) or 1.0

    def error(run: Followed, session: Session) -> float:
        radii = session.radii()[:, :2]  # type: ignore[attr-defined]
        return float(np.sqrt(np.mean(np.sum(radii**2, axis=1)))) / diameter

    engine = ENGINES["certified"]
    return _Runner("certified", "bits", float(bits), lambda: engine.open(stage, options=CertifiedOptions(bits, bits)), error)


def _proven(stage: Stage, until: float, patience_s: float, result: Curves) -> Followed | None:
    """The certified run to a time; None where it is not installed, does not know the scene, or takes too long."""
    try:
        session = ENGINES["certified"].open(stage, keep_rows=False)
    except EventsimError as error:
        result.left_out.append(f"certified is left out: {error}")
        return None
    run = follow(session, [until], patience_s)
    if run.stopped is not None:
        result.left_out.append(f"certified is left out: it was stopped ({session.reason or run.stopped})")
        return None
    return run


def _unrest_error(stage: Stage) -> ErrorOf:
    return lambda run, _: unrest(stage, run.position[-1], run.velocity[-1])


def _trajectory_error(stage: Stage, best: Followed) -> ErrorOf:
    return lambda run, _: float(position_errors(stage, run, best)[-1])


def _pressure_error(truth: Truth) -> ErrorOf:
    stage = truth.stage
    duration = float(truth.times[-1]) - truth.scene.start_time
    energy = kinetic_energy(stage, np.column_stack([stage.vx, stage.vy]))
    exact = virial_pressure(stage, truth.run.rows, energy, duration)
    return lambda run, _: abs(virial_pressure(stage, run.rows, energy, duration) / exact - 1.0)


def _chance(truth: Truth, error: ErrorOf) -> float:
    """What the pressures of event-driven runs that start some last bits away differ by: chance; root mean square."""
    engine = ENGINES[best_engine(truth.stage.n)]
    errors = []
    for bits in range(1, NEIGHBOURS + 1):
        session = engine.open(neighbouring(truth.stage, bits), keep_rows=True)
        errors.append(error(follow(session, truth.times.tolist()), session))
    return float(np.sqrt(np.mean(np.square(errors))))


class PlainPredictor(Predictor):
    """Predicts contacts of disks by `pair_delay`, whose c and D cancel near contact and at a graze."""

    straight_delay = staticmethod(pair_delay)


class PlainSession(ReferenceSession):
    """The reference engine in the middle of a run, without careful contact times of pairs."""

    name = "plain"
    predictor = PlainPredictor
