"""The chart: speed against accuracy on several scenes, all engines, and where each of them is the right choice."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from eventsim.engines import ENGINES, ONE_LOG, STEPPED
from eventsim.engines.base import Session, Stop
from eventsim.errors import EventsimError
from eventsim.record.events import Floats
from eventsim.runner.loop import run_scene
from eventsim.runner.options import RunOptions
from eventsim.scene import Scene
from eventsim.scene.disks import typical_speed
from eventsim.scene.gallery import gallery
from eventsim.scene.stage import Stage, stage_of
from eventsim.validation.compare import UNREACHED, Comparison, Tell, compare, truth_to_compare
from eventsim.validation.competitors import COMPETITORS, Competitor
from eventsim.validation.follow import follow, position_errors
from eventsim.validation.pile import pile
from eventsim.validation.precision import Curves, Task
from eventsim.validation.seeds import curves_over_seeds
from eventsim.validation.timing import timing_of, warm_up
from eventsim.validation.truth import best_engine, time_after, truth_of

CONTACTS = 3.0
"""Mean free times after which trajectories are compared, where the task does not say."""

SEEDS = (101, 102)
"""Further seeds of the gas whose positions are compared: its errors are medians, with bars."""

CHAOS_CONTACTS = 48
CHAOS_STEPS = (0.1, 0.01)
"""The panel on chaos: contacts per disk, and steps (in radii) of `stepped-located`."""

LOSSES_UNTIL = 0.3
"""The panels on losses: how long the gas of 300 disks is followed; some 900 contacts are compared one by one."""

SIZES = (30, 100, 300, 1000, 3000)
RATE_CONTACTS, RATE_STEP = 4.0, 0.05
"""The panel on rates: numbers of disks; mean free times that are simulated; the step (in radii) of stepped engines."""


@dataclass(frozen=True, slots=True)
class Chaos:
    """Errors against contacts per disk, per engine; slope: bits lost for each contact of a disk; horizon: where float64 ends."""

    contacts: Floats
    errors: dict[str, Floats]
    slope: float
    horizon: float


@dataclass(slots=True)
class Chart:
    """All that the figure shows.

    losses: contacts and energy of the gas against the step.  rates: contacts per second against the number of disks, per engine.
    interrupted: what was not reached by then is missing.
    """

    tasks: list[Curves] = field(default_factory=list)
    losses: Comparison | None = None
    chaos: Chaos | None = None
    rates: dict[str, list[tuple[int, float]]] = field(default_factory=dict)
    interrupted: bool = False

    @property
    def left_out(self) -> list[str]:
        """Who could not take part, a sentence each, once; and that not all was reached."""
        sentences = dict.fromkeys(f"{c.task.name}: {text}" for c in self.tasks for text in c.left_out)
        return [*sentences, *([UNREACHED] if self.interrupted else [])]


def default_tasks() -> list[Task]:
    """The scenes of the usual chart: not a home game."""
    galperin = gallery("galperin")
    assert galperin.until is not None
    dense = gallery("periodic-fluid", n=100, packing_fraction=0.88)
    return [
        replace(
            task_of(gallery("gas", n=100), "gas", "100 disks, packing 0.3, after 3 contacts a disk"),
            others=tuple(gallery("gas", n=100, seed=seed) for seed in SEEDS),
        ),
        Task("break", gallery("break"), "trajectory", 0.5, "15 touching disks and a cue, 0.5 s"),
        Task("galperin", galperin, "trajectory", galperin.until, "mass ratio 100, after all 31 contacts"),
        task_of(gallery("gas", n=100), "gas, long", "100 disks, packing 0.3, 100 contacts a disk", "pressure", 100.0),
        task_of(dense, "dense", "100 disks, packing 0.88, 100 contacts a disk", "pressure", 100.0),
        Task("pile", pile(), "unrest", 20.0, "20 disks that fall, e = 1/2, until they rest"),
    ]


def task_of(
    scene: Scene, name: str, words: str = "", measure: str = "trajectory", contacts: float = CONTACTS
) -> Task:
    """The task on a scene after so many contacts a disk, or at its end."""
    truth = truth_to_compare(scene, None).truth
    until = scene.start_time + contacts * truth.mean_free_time
    if measure == "trajectory":
        until = time_after(truth.run.rows, truth.stage.n, contacts, float(truth.times[-1]))
    return Task(name, scene, measure, until, words)


def chart_of(
    tasks: Sequence[Task],
    patience_s: float,
    further: bool = True,
    tell: Tell = lambda _: None,
    keeps: bool = False,
) -> Chart:
    """Measure all tasks; further: also losses, chaos and rates, on the gas.

    Interrupted, it raises KeyboardInterrupt; where it `keeps` what it has reached, it gives that if there is any.
    """
    competitors = list(COMPETITORS.values())
    chart = Chart()
    try:
        for task in tasks:
            chart.tasks.append(curves_over_seeds(task, competitors, patience_s, tell, keeps))
            if chart.tasks[-1].interrupted:
                raise KeyboardInterrupt
        if further:
            gas = gallery("gas")
            chart.losses = compare(gas, competitors, until=LOSSES_UNTIL, patience_s=patience_s, tell=tell, keeps=keeps)
            if chart.losses.interrupted:
                raise KeyboardInterrupt
            tell("chaos")
            chart.chaos = chaos()
            chart.rates = rates(patience_s, tell)
    except KeyboardInterrupt:
        if not (keeps and chart.tasks):
            raise
        chart.interrupted = True
    return chart


def chaos(n: int = 100) -> Chaos:
    """Errors of the event-driven run and of located steps in a gas, contact by contact."""
    scene = gallery("gas", n=n)
    free = truth_to_compare(scene, scene.until).truth.mean_free_time
    contacts = np.arange(1.0, CHAOS_CONTACTS + 1.0)
    truth = truth_of(scene, (contacts * free).tolist())
    errors = {"event-driven": truth.uncertainty}
    competitor = COMPETITORS["stepped-located"]
    for step in CHAOS_STEPS:
        dt = step * truth.radius / truth.speed
        run = follow(STEPPED[competitor.engine].open(truth.stage, options=competitor.at(dt)), truth.times.tolist())
        errors[f"{competitor.label}, {step:g} radii a step"] = position_errors(truth.stage, run, truth.run)
    growing = (truth.uncertainty > 1e-13) & (truth.uncertainty < 1e-3)
    slope = float(np.polyfit(contacts[growing], np.log2(truth.uncertainty[growing]), 1)[0]) if growing.sum() > 2 else math.nan
    return Chaos(contacts, errors, slope, (truth.horizon - scene.start_time) / free)


def rates(patience_s: float, tell: Tell = lambda _: None) -> dict[str, list[tuple[int, float]]]:
    """Contacts of a gas that are simulated per second, by engine and number of disks."""
    found: dict[str, list[tuple[int, float]]] = {}
    for n in SIZES:
        scene = gallery("gas", n=n)
        stage = stage_of(scene)
        probe = run_scene(ENGINES[best_engine(n)], scene, Stop(events=4 * n), RunOptions(log=True))
        free = probe.time * n / (2 * probe.counters.pair_contacts + probe.counters.wall_contacts)
        until = RATE_CONTACTS * free
        truth = follow(ENGINES[best_engine(n)].open(stage, keep_rows=True), [until])
        contacts = truth.counters.pair_contacts + truth.counters.wall_contacts
        speed = typical_speed(stage.vx, stage.vy)
        dt = RATE_STEP * float(stage.radius[0]) / speed
        for label, opened in _contestants(dt):
            if label in found and found[label][-1][0] < SIZES[max(SIZES.index(n) - 1, 0)]:
                continue  # it had no patience left
            tell(f"rate of {label} with {n} disks")
            try:
                warm_up(partial(opened, stage), [until])
            except EventsimError:
                continue
            run = follow(opened(stage), [until], patience_s)
            if run.stopped is None:
                timing = timing_of(partial(opened, stage), [until])
                found.setdefault(label, []).append((n, contacts / max(timing.median, 1e-9)))
    return found


def _contestants(dt: float) -> list[tuple[str, Callable[[Stage], Session]]]:
    """Who takes part in the panel on rates: (label, how to open it on a stage)."""

    def event_driven(name: str) -> Callable[[Stage], Session]:
        return lambda stage: ENGINES[name].open(stage, keep_rows=True)

    def stepped(competitor: Competitor) -> Callable[[Stage], Session]:
        return lambda stage: STEPPED[competitor.engine].open(stage, options=competitor.at(dt))

    named = [(name, event_driven(name)) for name in ONE_LOG]
    return named + [(label, stepped(COMPETITORS[label])) for label in ("stepped", "frames", "pymunk")]
