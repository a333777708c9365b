"""Validate: the event-driven run of a scene against stepped engines over a list of steps."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import NamedTuple

import numpy as np

from eventsim.engines import ENGINES, STEPPED
from eventsim.engines.base import Stop
from eventsim.errors import EventsimError
from eventsim.record.events import Kind, Rows
from eventsim.runner.outcome import state_of
from eventsim.scene import Scene
from eventsim.scene.stage import stage_of
from eventsim.validation.averages import collision_rate, kinetic_energy, virial_pressure
from eventsim.validation.competitors import Competitor, able
from eventsim.validation.contacts import RESTARTS, Census, census, longest_stuck
from eventsim.validation.follow import Followed, advanced, follow, position_errors
from eventsim.validation.timing import Timing, timing_of, warm_up
from eventsim.validation.truth import Truth, best_engine, time_after, truth_of

USUAL_STEPS = (2.0, 1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01)
"""Steps in the time in which a typical disk flies its radius."""

CHECKS = (1.0, 2.0, 4.0, 8.0)
"""Contacts a disk after which trajectories are compared."""

FITTED = 1
"""The check whose errors give the order of convergence: two contacts a disk."""

PATIENCE_S = 5.0
"""Seconds that one run may take; finer steps of the same engine are left out then."""

TRUTH_SHARE = 10.0
"""How much longer the event-driven run may take, which all others are compared with; it ends there."""

COMPARED_ROWS = 2000
"""Rows of the log that the reference engine has to confirm."""

EDGE = 1e-9
"""Share of the run at its end whose contacts are left out of ratio, rate and pressure: engines with steps find them after it."""

UNREACHED = "what was not reached is left out: it was interrupted"
"""What an interrupt leaves to say."""

Tell = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class Line:
    """One engine with one step: everything that was measured.

    step: dt in the time in which a typical disk flies its radius.  ratio: pair contacts, of those of the event-driven run.
    census: contact by contact, from exact states.  errors: at the checks, in diameters.  energy: relative change (None where
    it is not conserved).  rate, pressure: relative to the event-driven run's.  timing: CPU seconds per simulated time.
    """

    label: str
    dt: float
    step: float
    pair_contacts: int
    wall_contacts: int
    ratio: float
    census: Census
    errors: tuple[float, ...]
    energy: float | None
    momentum: float
    overlap: float
    stuck: float
    rate: float
    pressure: float
    timing: Timing
    steps: int
    pair_tests: int

    @property
    def elapsed(self) -> float:
        """CPU seconds per simulated time, the median."""
        return self.timing.median


@dataclass(frozen=True, slots=True, repr=False)
class Comparison:
    """A scene, its event-driven run, and the lines of all engines; left_out: a sentence on each that could not take part.

    checks: times after which each disk has had 1, 2, 4, 8 contacts, on average (of a shorter run less, in these proportions).
    settings: what each engine was told, in words.  orders: measured, of convergence.  agrees: whether the event-driven engines
    write the same log.  interrupted: what was not reached by then is missing.  verdict: what it comes to in sentences, as
    `es.validate` adds.
    """

    name: str
    truth: Truth
    engine: str
    checks: tuple[float, ...]
    exact: Line
    lines: list[Line]
    left_out: list[str]
    settings: dict[str, str] = field(default_factory=dict)
    orders: dict[str, float] = field(default_factory=dict)
    agrees: bool = True
    interrupted: bool = False
    verdict: tuple[str, ...] = ()

    def __str__(self) -> str:
        return "\n".join(self.verdict) or repr(self)

    def __repr__(self) -> str:
        first = f": {self.verdict[0]}" if self.verdict else ""
        return f"Comparison({self.name}: {len(self.lines)} runs of other engines against {self.engine}{first})"


def compare(
    scene: Scene,
    competitors: Sequence[Competitor],
    steps: Sequence[float] | None = None,
    until: float | None = None,
    patience_s: float = PATIENCE_S,
    tell: Tell = lambda _: None,
    keeps: bool = False,
) -> Comparison:
    """Run a scene with every engine and step; steps are times, left out: USUAL_STEPS.

    Interrupted, it raises KeyboardInterrupt; where it `keeps` what it has reached, it gives that if there is any.

    Raises EventsimError where the scene has no contact to compare, and where none of the engines can simulate it.
    """
    ready, left_out = able(competitors, stage_of(scene))
    if competitors and not ready:
        raise EventsimError(f"there is nothing to compare with: {'; '.join(left_out)}")
    tell("event-driven run")
    truth, checks, engine, whole = truth_to_compare(scene, until, TRUTH_SHARE * patience_s)
    if not whole:
        spent, end = f"{TRUTH_SHARE * patience_s:g} s", f"t = {truth.times[-1]:g}"
        left_out.append(f"what comes after {end} is left out: the event-driven run took {spent} until there")
    flight = truth.radius / truth.speed
    sizes = sorted({step * flight for step in USUAL_STEPS} if steps is None else set(steps), reverse=True)
    times = truth.times.tolist()
    duration = times[-1] - scene.start_time
    timing = timing_of(lambda: ENGINES[engine].open(truth.stage, keep_rows=True), times[-1:], [truth.run.elapsed_s])
    exact = _line(truth, "event-driven", math.nan, truth.run, Census(), checks, timing.per(duration))
    lines: list[Line] = []
    interrupted = False
    try:
        for competitor in ready:
            taken = 0.0
            for place, dt in enumerate(sizes):
                if place and taken * sizes[place - 1] / dt > patience_s:
                    left_out.append(_given_up(competitor, sizes[place:], f"it would take more than {patience_s:g} s"))
                    break
                tell(f"{competitor.label}, dt = {dt:.3g}")
                opened = partial(STEPPED[competitor.engine].open, truth.stage, options=competitor.at(dt))
                if not place:
                    warm_up(opened, times)
                run = follow(opened(), times, patience_s)
                taken = run.elapsed_s
                if run.stopped is not None:
                    late = run.stopped == "patience"
                    reason = f"it was stopped after {patience_s:g} s" if late else f"it stopped ({run.stopped})"
                    left_out.append(_given_up(competitor, sizes[place:], reason))
                    break
                found = census(truth, STEPPED[competitor.engine], competitor.at(dt), dt)
                timing = timing_of(opened, times[-1:])  # stops on the way are ours
                lines.append(_line(truth, competitor.label, dt, run, found, checks, timing.per(duration)))
    except KeyboardInterrupt:
        if not (keeps and lines):
            raise
        interrupted = True
        left_out.append(UNREACHED)
    orders = {
        competitor.label: fitted_order(
            [line.dt for line in lines if line.label == competitor.label],
            [line.errors[min(FITTED, len(checks) - 1)] for line in lines if line.label == competitor.label],
        )
        for competitor in ready
    }
    settings = {competitor.label: competitor.settings for competitor in ready}
    name = scene.called
    agrees = interrupted or engines_agree(truth)
    return Comparison(name, truth, engine, checks, exact, lines, left_out, settings, orders, agrees, interrupted)


def _given_up(competitor: Competitor, steps: Sequence[float], why: str) -> str:
    """A sentence on the steps with which an engine does not take part."""
    return f"{competitor.label} with dt = {', '.join(f'{step:.3g}' for step in steps)} is left out: {why}"


def engines_agree(truth: Truth) -> bool:
    """Whether the reference engine writes the same log, bit for bit, as the run of the truth begins with."""
    session = ENGINES["reference"].open(truth.stage, keep_rows=True)
    count = min(len(truth.run.rows), COMPARED_ROWS)
    while session.advance(Stop(float(truth.times[-1]), count), COMPARED_ROWS) is None:
        pass
    rows = session.take_rows()[:count]
    return rows.tobytes() == truth.run.rows[:count].tobytes()


class Compared(NamedTuple):
    """What others are compared with: the event-driven run, the times of the checks, the engine that did it.

    whole: it came to the stop that was asked for, or to its own end.
    """

    truth: Truth
    checks: tuple[float, ...]
    engine: str
    whole: bool


def truth_to_compare(scene: Scene, until: float | None, patience_s: float = math.inf) -> Compared:
    """The event-driven run, as far as it comes in so many CPU seconds.

    Raises EventsimError where it has no stop, or meets nothing.
    """
    engine = best_engine(len(scene.disks))
    events = scene.events if until is None and scene.until is None else None
    stop = Stop(scene.until if until is None else until, events)
    if stop.until is None and stop.events is None:
        raise EventsimError("nothing says when to stop: give --until, or a key until or events in the scene")
    # with rows, as all runs here: one kind of kernel to compile
    session = ENGINES[engine].open(stage_of(scene), keep_rows=True)
    stopped, rows = advanced(session, stop, patience_s, int(CHECKS[-1] * len(scene.disks)) + 2)
    begin, end = scene.start_time, state_of(session, stop, stopped).time
    contacts = 2 * session.counters.pair_contacts + session.counters.wall_contacts
    if not contacts or not end > begin:
        raise EventsimError(f"nothing meets before {end:g}: there is nothing to compare")
    share = min(contacts / len(scene.disks) / CHECKS[-1], 1.0)
    checks = tuple(time_after(rows, len(scene.disks), share * check, end) for check in CHECKS)
    restarts = np.linspace(begin, end, RESTARTS + 2)[1:-1]
    times = sorted({*checks, *restarts.tolist(), end})
    return Compared(truth_of(scene, times, engine), checks, engine, stopped is not None)


def _line(
    truth: Truth, label: str, dt: float, run: Followed, found: Census, checks: Sequence[float], timing: Timing
) -> Line:
    stage, exact = truth.stage, truth.run
    duration = float(truth.times[-1]) - truth.scene.start_time
    energy = kinetic_energy(stage, np.column_stack([stage.vx, stage.vy]))
    errors = position_errors(stage, run, exact)
    places = np.searchsorted(truth.times, np.array(checks))

    last = float(truth.times[-1]) - EDGE * duration
    whole = not (exact.rows["time"] < last).any()

    def before_end(rows: Rows) -> Rows:
        return rows if whole else rows[rows["time"] < last]

    def relative(gauge: Callable[[Rows], float]) -> float:
        base = gauge(before_end(exact.rows))
        return gauge(before_end(run.rows)) / base - 1.0 if base else math.nan

    def pairs(one: Followed) -> int:
        left_out = len(one.rows[one.rows["kind"] == Kind.PAIR]) - len(before_end(one.rows[one.rows["kind"] == Kind.PAIR]))
        return one.counters.pair_contacts - left_out

    return Line(
        label=label,
        dt=dt,
        step=dt * truth.speed / truth.radius,
        pair_contacts=run.counters.pair_contacts,
        wall_contacts=run.counters.wall_contacts,
        ratio=pairs(run) / pairs(exact) if pairs(exact) else math.nan,
        census=found,
        errors=tuple(float(errors[place]) if place < len(errors) else math.nan for place in places),
        energy=run.residuals.energy,
        momentum=run.residuals.momentum,
        overlap=run.residuals.max_overlap,
        stuck=longest_stuck(run.rows, dt) if math.isfinite(dt) else 0.0,
        rate=relative(lambda rows: collision_rate(stage, rows, duration)),
        pressure=relative(lambda rows: virial_pressure(stage, rows, energy, duration)),
        timing=timing,
        steps=run.counters.steps,
        pair_tests=run.counters.pair_tests,
    )


SATURATED = 0.3
"""In diameters: errors above are those of a run that has lost its way, and say nothing about the step."""

ROUNDING = 1e-11
"""In diameters: errors below are rounding."""


def fitted_order(steps: Sequence[float], errors: Sequence[float]) -> float:
    """The slope of a log-log fit, from at least two points that are neither saturated nor rounding; nan without."""
    points = [
        (math.log(step), math.log(error))
        for step, error in zip(steps, errors, strict=True)
        if math.isfinite(error) and ROUNDING < error < SATURATED
    ]
    if len(points) < 2:
        return math.nan
    x, y = np.array(points).T
    return float(np.polyfit(x, y, 1)[0])
