"""Where a motion begins: with its scene, a step later, or far into it; and whether it is that of the scene at all."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from eventsim.errors import EventsimError
from eventsim.readers.samples import Samples
from eventsim.record.events import Floats, Rows
from eventsim.scene import Scene
from eventsim.scene.stage import Stage, stage_of
from eventsim.validation.follow import distances
from eventsim.validation.judge.flights import UNLIKE, Flights, Mask
from eventsim.validation.truth import Truth, truth_of

LATE = 1.5
"""Steps after the start of the scene up to which a motion begins with it: an engine tells places when its first step is done."""

SAME_START = 0.01
"""In diameters: how far positions at the start may be from those of the scene."""

MANY = 3
"""Disks that do not all turn in their first step so that one factor tells what is left of all their velocities."""

ROUNDS = 4
"""In which the factor of the unit and gravity in the first step are found together; what is left falls by their ratio."""

DECIMALS = (1.0, 0.1, 0.01, 1e-3, 1e-4, 1e-5, 1e-6)
"""To which positions are rounded in files."""

ROUNDING = 1e-6
"""Of the last decimal: how far from a multiple of it float64 may put a position."""

STAGGERING = 0.05
"""Of all samples: where more show so small a turn as rounding makes, positions are rounded; contacts make larger ones."""

CLEARLY = 2.0
"""A factor that is no accident of contacts in the first step, where nobody knows of them."""

OTHER_PACE = 0.1
"""Of the velocities at the start: by how much all may differ by one factor before they are told in another unit; of the typical
speed: by how much one of them may differ before the motion is another one."""


def within(scene: Scene, samples: Samples, until: float | None) -> tuple[Samples, str | None]:
    """The samples until a time, by default the end of the scene, and a sentence on what is left out.

    Nothing is simulated before this: times in another unit would ask for a run a thousand times as long.

    Raises:
        EventsimError: where less than two of them are left.
    """
    end = scene.until if until is None else until
    times, step = samples.times, float(np.median(np.diff(samples.times)))
    if end is None or times[-1] <= end + (LATE * step if until is None and step < end - scene.start_time else 0.0):
        return samples, None
    held = int(np.searchsorted(times, end, side="right"))
    if held < 2:
        limit = f"the scene, which ends at t = {end:g}" if until is None else f"what is asked for, until t = {end:g}"
        raise EventsimError(
            f"{samples.source}: of its {len(times)} times, from {times[0]:g} to {times[-1]:g}, {('none', 'only one')[held]} "
            f"is within {limit}: another unit of time, or times that do not count from the start of the scene?"
        )
    left = f"the motion goes on to t = {times[-1]:g}: it is judged until the scene ends, t = {end:g}"
    return samples.first(held), left if until is None else None


def begins_late(scene: Scene, samples: Samples) -> bool:
    """Whether the first samples are missing, and with them what an engine did then."""
    late = float(samples.times[0]) - scene.start_time
    return samples.n == len(scene.disks) and late > LATE * float(np.median(np.diff(samples.times)))


def scene_at(scene: Scene, first: float) -> Scene:
    """The scene as the event-driven run has it at a later time."""
    run = truth_of(scene, [first]).run
    if run.stopped is not None:
        raise EventsimError(f"the motion begins at t = {first:g}, and the event-driven run stopped before ({run.stopped})")
    disks = scene.disks.begun_at(run.position[0], run.velocity[0])
    return scene.begun_at(first, disks)


def placed(scene: Scene, stage: Stage, samples: Samples) -> Samples:
    """The samples on the scene's axes, from its start on; EventsimError where they are of another scene, or its disks spin."""
    if stage.law.rough is not None:
        raise EventsimError("the disks of this scene spin: places and velocities do not tell whether such contacts are right")
    if samples.n != stage.n:
        raise EventsimError(f"{samples.source}: has {samples.n} disks, and the scene {stage.n}")
    for name, told, own in (("radius", samples.radius, stage.radius), ("mass", samples.mass, scene.disks.mass)):
        if told is not None and not np.allclose(told, own, rtol=1e-5, atol=0.0):
            if samples.cell is not None and np.all(told == told[0]):
                continue  # what the gsd library gives where a file tells nothing
            disk = int(np.argmax(~np.isclose(told, own, rtol=1e-5, atol=0.0)))
            raise EventsimError(f"{samples.source}: disk {disk} has the {name} {told[disk]:g}, in the scene {own[disk]:g}")
    samples = samples.placed(scene.domain.origin if scene.domain.size is not None else (0.0, 0.0))
    begin, first = scene.start_time, float(samples.times[0])
    if first < begin - 1e-9 * abs(begin):
        raise EventsimError(f"{samples.source}: begins at {first:g}, before the scene does at {begin:g}")
    own = scene.disks.position
    diameter = 2.0 * (float(np.median(stage.radius)) or 1.0)
    if first <= begin + 1e-9 * abs(begin):
        away = distances(stage, samples.position[0], own)
        disk = int(np.argmax(away))
        if away[disk] > SAME_START * diameter:
            here, there = samples.position[0, disk].tolist(), own[disk].tolist()
            raise EventsimError(
                f"{samples.source}: disk {disk} begins at ({here[0]:.6g}, {here[1]:.6g}), in the scene, at t = {first:g}, at "
                f"({there[0]:.6g}, {there[1]:.6g}): another scene, "
                "another order of disks, other axes, or a motion that begins later than it says?"
            )
        return samples
    velocity = None
    if samples.velocity is not None:
        velocity = np.concatenate([scene.disks.velocity[None], samples.velocity])
    position = np.concatenate([own[None], samples.position])
    times = np.concatenate([[begin], samples.times])
    return Samples(samples.source, times, position, velocity, samples.radius, samples.mass, None, samples.step, samples.counted)


def rounded(samples: Samples, stage: Stage) -> Samples:
    """The samples with the last digit that their positions have, where one sees that they are rounded to few decimals.

    Disks may move in whole hundredths by themselves: rounding shows where free flights stagger.
    """
    dt = np.diff(samples.times)[:, None, None]
    if len(dt) < MANY:
        return samples
    mass = np.full(stage.n, stage.common_mass) if stage.mass is None else stage.mass
    moves = np.isfinite(mass)
    told = samples.position[1:, moves]
    for step in DECIMALS:
        if np.all(np.abs(told / step - np.round(told / step)) < ROUNDING):
            mean = stage.nearest(np.diff(told, axis=0)) / dt[1:]
            pull = np.array(stage.gravity or (0.0, 0.0))
            bends = np.abs(np.diff(mean, axis=0) - 0.5 * pull * (dt[2:] + dt[1:-1])) * dt[2:]
            by_digits = (bends > 0.5 * step) & (bends < 2.5 * step)  # x2 - 2 x1 + x0 of places that are off by half of it
            staggers = bends.size > 0 and float(np.mean(by_digits)) > STAGGERING
            return replace(samples, step=max(samples.step, step)) if staggers else samples
    return samples


def demand_same_clock(scene: Scene, samples: Samples) -> None:
    """Raise EventsimError where the first step alone tells another unit of time: a run through all times would not end.

    Of scenes that say when they end `within` has kept what is in them.  Who meets something in the first step only a run would
    tell: all disks have to fly by one and the same factor.
    """
    if scene.until is not None and samples.times[-1] <= scene.until:
        return
    stage = stage_of(scene)
    start = np.column_stack([stage.vx, stage.vy])
    moves = np.any(start != 0.0, axis=1)
    if moves.sum() < MANY:
        return
    dt = float(samples.times[1] - samples.times[0])
    pull = np.where(np.isfinite(scene.disks.mass)[:, None], np.array(stage.gravity or (0.0, 0.0)), 0.0)
    share, off = _pace(stage.nearest(samples.position[1] - samples.position[0]) / dt, start, pull, dt, moves)
    if not 1.0 / CLEARLY < share < CLEARLY and float(off.max()) < UNLIKE:
        raise _of_another_pace(samples.source, share)


def demand_same_velocities(flights: Flights, start: Floats, truth: Truth, samples: Samples) -> None:
    """Raise EventsimError where a disk flies off, straight from its place, with another velocity than it should.

    start: (n, 2) velocities.
    """
    times, place, pull = flights.times, flights.place, flights.pull
    if len(times) < 3:
        return
    dt, later = np.diff(times[:3]).tolist()
    begun = (place[1] - place[0]) / dt - 0.5 * pull * dt
    then = (place[2] - place[1]) / later - pull * (dt + 0.5 * later)
    least = max(OTHER_PACE * truth.speed, flights.least, 4.0 * samples.step / dt)  # two ends, two components
    off = np.hypot(*(begun - start).T)
    wrong = (off > least) & (np.hypot(*(then - begun).T) < 0.5 * least) & _free(truth.run.rows, len(start), float(times[2]))
    if not wrong.any():
        return
    disk, count = int(np.argmax(wrong)), int(wrong.sum())
    more = f" ({count} disks differ)" if count > 1 else ""
    (vx, vy), (ux, uy) = begun[disk].tolist(), start[disk].tolist()
    raise EventsimError(
        f"{samples.source}: disk {disk} begins with velocity ({vx:.4g}, {vy:.4g}), in the scene, at t = {times[0]:g}, with "
        f"({ux:.4g}, {uy:.4g}){more}: another scene, another order of disks, or another sign of an axis?"
    )


def _free(rows: Rows, n: int, until: float) -> Mask:
    """(n,) which disks meet nothing until a time."""
    free = np.ones(n, dtype=bool)
    early = rows[rows["time"] <= until]
    free[early["a"]] = False
    free[early["b"][early["b"] >= 0]] = False
    return free


def demand_same_pace(flights: Flights, start: Floats, truth: Truth, samples: Samples) -> None:
    """Raise EventsimError where disks begin with one and the same multiple of the velocities that they should have.

    start: (n, 2) velocities.  truth: the event-driven run, which tells who flies free until the first samples.
    """
    dt = float(flights.times[1] - flights.times[0])
    if samples.step > OTHER_PACE * truth.speed * dt:
        return  # what they move is less than what they are rounded by
    size = np.sum(start * start, axis=1)
    moves = size > 0.0
    free = moves & _free(truth.run.rows, len(start), float(flights.times[1]))
    if free.any():
        moves = free
    elif moves.sum() < MANY:
        return
    share, off = _pace((flights.place[1] - flights.place[0]) / dt, start, flights.pull, dt, moves)
    if abs(share - 1.0) > OTHER_PACE and float(np.median(off)) < UNLIKE:
        raise _of_another_pace(samples.source, share)


def _pace(mean: Floats, start: Floats, pull: Floats, dt: float, moves: Mask) -> tuple[float, Floats]:
    """(factor, what is left) of the mean velocities of a first step over those at the start, of disks that move."""
    size = np.sum(start * start, axis=1)[moves]
    share, begun = 0.0, mean
    for _ in range(ROUNDS):  # gravity counts by the square of the factor
        begun = mean - 0.5 * share**2 * pull * dt
        share = float(np.median(np.sum(begun * start, axis=1)[moves] / size))
    return share, np.hypot(*(begun - share * start)[moves].T) / np.sqrt(size)


def _of_another_pace(source: str, share: float) -> EventsimError:
    return EventsimError(
        f"{source}: its disks begin with {share:.4g} times the velocities of the scene: another unit of time, another scene?"
    )
