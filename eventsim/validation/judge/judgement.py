"""The judgement of a motion: contacts, positions, energy and gaps beside those of the event-driven run; what is wrong first."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np

from eventsim.readers.contacts import ToldContacts
from eventsim.readers.samples import Samples
from eventsim.record.events import Floats, Kind
from eventsim.scene import Scene
from eventsim.scene.cells import Cells, Indices
from eventsim.scene.overlaps import period_of
from eventsim.scene.stage import Stage, stage_of
from eventsim.validation.follow import distances
from eventsim.validation.judge.beginning import (
    OTHER_PACE,
    begins_late,
    demand_same_clock,
    demand_same_pace,
    demand_same_velocities,
    placed,
    rounded,
    scene_at,
    within,
)
from eventsim.validation.judge.charge import Charge, Window, charged, in_our_form
from eventsim.validation.judge.displaced import displacements
from eventsim.validation.judge.faults import Fault, Witness
from eventsim.validation.judge.flights import Flights, Turn, energy_on_the_way, flights_of
from eventsim.validation.judge.gravity import wrong_gravity
from eventsim.validation.judge.jumps import jumps
from eventsim.validation.judge.overlaps import overlaps
from eventsim.validation.judge.previous import Previous
from eventsim.validation.judge.sizes import wrong_sizes
from eventsim.validation.judge.surroundings import Surroundings
from eventsim.validation.judge.told import Read, contacts_from
from eventsim.validation.truth import BELIEVED, Truth, truth_of

LOOKS = 600
"""Times at most at which positions are compared and gaps are looked for."""

ASTRAY = 0.1
"""In diameters: a disk that is further from its place has lost its way, and later contacts of it are not charged."""

STEPS_LATE, FLOWN = 2.0, 0.1
"""The usual tolerance of contact times: so many steps, and the time in which a typical disk flies so many diameters.

A step is that from sample to sample, or that of the contacts where they are told and are finer.
"""

SMALLEST = 1e-9
"""In radii: an overlap of paths below is rounding."""

FEWEST = 1e-3
"""Of a radius: positions that are rounded by more are said to be."""

SMOOTHED = 5
"""Samples."""

COARSE = 0.2
"""Of the typical speed: where the least turn that can be told from noise is larger, contacts cannot be told from positions."""


BLIND = (
    "the samples are too coarse, or too blurred, to tell contacts from positions: tell velocities, more digits, more times, "
    "or the contacts (--contacts)"
)


@dataclass(slots=True)
class Judgement:
    """What an engine's motion is worth.

    Attributes:
        name: of the scene.
        source: where the motion is from.
        truth: the event-driven run.
        samples: times and disks that were told, and whether contacts and velocities were.
        tolerance: how far apart the times of one contact may be.
        charge: which contacts were found, missed, doubled, false.
        looks: (L,) times at which positions were compared.
        errors: (L,) root mean square distance from the truth, in diameters.
        energy: (T,) relative change of the energy, at `times`; NaN where a velocity is not known; None without energy.
        differences: whether velocities were not told, so that those in the energy are differences of positions.
        lawful: the same change at the end of the event-driven run, where contacts take or give energy; None elsewhere.
        momentum: the largest change, over sum m |v|, where nothing outside gives any; None elsewhere.
        deepest: (depth in reaches, a, b, time) of the deepest overlap at the looks.
        blind: why its contacts cannot be told; None where they can.
        faults: all that were seen, in order of time.
        remarks: sentences on what could not be judged.
        elapsed: CPU seconds per time unit of a function that was stepped; None of a file.
    """

    name: str
    source: str
    truth: Truth
    times: Floats
    told: str
    tolerance: float
    charge: Charge
    looks: Floats
    errors: Floats
    energy: Floats | None
    lawful: float | None
    momentum: float | None
    deepest: tuple[float, int, int, float]
    blind: str | None = None
    faults: list[Fault] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)
    elapsed: float | None = None
    differences: bool = False

    @property
    def first_fault(self) -> Fault | None:
        """The first wrong event; None where none was seen."""
        return self.faults[0] if self.faults else None

    @property
    def compared(self) -> int:
        """The contacts that were compared with those of the event-driven run; without any, no wrong event says nothing."""
        return self.charge.ahead

    @property
    def lost(self) -> float:
        """From when on positions are further than ASTRAY diameters from the truth; inf: never."""
        over = np.flatnonzero(self.errors > ASTRAY)
        return float(self.looks[over[0]]) if len(over) else math.inf

    @property
    def believed(self) -> float:
        """Until when the event-driven run itself can be believed; inf: to the end."""
        good = np.all(self.truth.uncertainty <= BELIEVED)
        return math.inf if good else self.truth.horizon


def judge(
    scene: Scene,
    samples: Samples,
    contacts: ToldContacts | None = None,
    tolerance: float | None = None,
    until: float | None = None,
) -> Judgement:
    """Judge a motion.

    Args:
        scene: what was simulated.
        samples: positions at times, from the start of the scene on or from later.
        contacts: those that the engine tells; None: they are read from its paths.
        tolerance: how far apart the times of one contact may be; None: the usual one.
        until: the last time that counts; None: the end of the scene, or of the motion.

    Raises:
        EventsimError: where the samples are not of this scene.
    """
    samples, left = within(scene, samples, until)
    remarks = [] if left is None else [left]
    if samples.counted:
        remarks.append(f"its disks are counted from {samples.counted} on; here the first one is disk 0")
    late = begins_late(scene, samples)
    if late:
        first = float(samples.times[0])
        scene, contacts = scene_at(scene, first), None if contacts is None else contacts.since(first)
        remarks.append(f"the motion begins at t = {first:g}: it is judged from the state that the event-driven run has then")
    stage = stage_of(scene)
    samples = rounded(placed(scene, stage, samples), stage)
    if not late:
        demand_same_clock(scene, samples)
    times = samples.times
    looks = times[np.unique(np.linspace(0, len(times) - 1, min(LOOKS, len(times))).astype(int))]
    looks = looks[looks > scene.start_time]
    truth = truth_of(scene, looks.tolist())
    looks = truth.times
    mass = np.full(stage.n, stage.common_mass) if stage.mass is None else stage.mass
    place = samples.position - np.array(stage.corner)
    start = np.column_stack([stage.vx, stage.vy])
    flights = flights_of(stage, times, place, samples.velocity, start, samples.step, truth.speed)
    around = Surroundings(stage)
    if truth.run.stopped is not None:
        remarks.append(f"the event-driven run stopped at {looks[-1]:g} ({truth.run.stopped})")
    blind = flights.least > COARSE * truth.speed
    demand_same_pace(flights, start, truth, samples)
    if not late:
        demand_same_velocities(flights, start, truth, samples)
    if not blind and samples.step >= FEWEST * truth.radius:
        remarks.append(f"positions are rounded to {samples.step:g}: weak contacts are hidden, and times blurred")
    if samples.velocity is not None and not flights.told:
        remarks.append("the velocities that are told are not those with which positions move: they are not used")
    read = Read() if blind else contacts_from(flights, around, mass)
    met = read.met if contacts is None else in_our_form(contacts, stage)
    step = float(np.median(np.diff(times)))
    if tolerance is None:
        finest = step if contacts is None else min(step, contacts.step)
        tolerance = STEPS_LATE * finest + 2.0 * FLOWN * truth.radius / truth.speed
    seen = np.searchsorted(times, looks)
    apart = distances(stage, samples.position[seen], truth.run.position[: len(looks)]) / (2.0 * truth.radius)
    resolution = max(SMALLEST * truth.radius, 4.0 * samples.step, 4.0 * flights.blur)
    previous = Previous(flights, truth.run.rows, tolerance, stage.law.duration)
    witness = Witness(flights, around, mass, previous, max(tolerance, step), resolution)
    window = Window(tolerance, 0.0 if contacts is not None else step, _lost_from(truth, apart), float(looks[-1]))
    charge = Charge()
    if contacts is not None or not blind:
        charge = charged(truth, met, window, witness, 0.0 if contacts is not None else flights.least)
    if contacts is not None and not blind:
        by_paths = charged(truth, read.met, replace(window, step=step), witness, flights.least)
        known = set(by_paths.compared_at) - set(by_paths.untold_at)
        charge.untold_at = [time for time in charge.untold_at if time not in known]
        remarks += _where_they_disagree(charge, by_paths)
    weight, velocity = np.where(np.isfinite(mass), mass, 0.0), flights.velocity()
    energy = _energy(flights, velocity, weight)
    gravity = None if blind else wrong_gravity(flights, around, mass, truth.speed)
    sizes = wrong_sizes(read.met, around, resolution)
    drift = None if blind or gravity is not None else witness.drift(energy_on_the_way(flights, weight), float(energy[0]))
    at_start = [turn for turn in read.unexplained if turn.last == 0]
    unexplained = [turn for turn in read.unexplained if turn.last > 0]
    if at_start:
        remarks.append(_other_velocities(at_start))
    seen_here = [*map(witness.outcome, read.met), gravity, sizes, drift, *map(witness.turn, unexplained), *charge.faults]
    faults = [fault for fault in seen_here if fault is not None]
    groups = [group for group in read.groups if any(turn.last > 0 for turn in group)]
    faults += jumps(groups, flights, around, mass, faults)
    if sizes is None:
        faults += overlaps(flights, around, mass, resolution, faults, blind)
    for jump, (begin, end) in displacements(flights, resolution):
        faults = [jump, *(fault for fault in faults if not begin <= fault.time <= end)]
    return Judgement(
        name=scene.called,
        source=samples.source,
        truth=truth,
        times=times,
        told=_what_is_told(samples, flights, contacts),
        tolerance=tolerance,
        charge=charge,
        looks=looks,
        errors=np.sqrt(np.mean(apart**2, axis=1)),
        energy=_smooth(energy / energy[0] - 1.0, flights.told) if energy[0] > 0.0 and (flights.told or not blind) else None,
        lawful=_lawful(truth, weight),
        momentum=_momentum(velocity, stage, mass),
        deepest=_deepest(scene, samples, looks, seen),
        blind=_why_blind(samples, flights, truth) if blind and contacts is None else None,
        faults=sorted(faults, key=lambda fault: fault.time),
        remarks=remarks,
        differences=not flights.told,
    )


def _what_is_told(samples: Samples, flights: Flights, contacts: ToldContacts | None) -> str:
    """In words."""
    told = ["positions", *(["velocities"] if flights.told else []), *(["contacts"] if contacts is not None else [])]
    return f"{', '.join(told)} of {samples.n} disks at {len(samples.times)} times"


def _why_blind(samples: Samples, flights: Flights, truth: Truth) -> str:
    """Why contacts cannot be told from positions: where these are rounded by as much as disks move, that is why."""
    moved = truth.speed * float(np.median(np.diff(flights.times)))
    if samples.step <= OTHER_PACE * moved:
        return BLIND
    return (
        f"positions are rounded to {samples.step:g}, and disks move about {moved:.2g} from one time to the next: tell "
        "more digits, velocities, or the contacts (--contacts)"
    )


def _other_velocities(turns: list[Turn]) -> str:
    """A sentence on disks that begin with other velocities than the scene says: no event, but all that follows is off."""
    off = max(math.hypot(*turn.change) for turn in turns)
    return (
        f"{len(turns)} {'disk begins' if len(turns) == 1 else 'disks begin'} with velocities that differ from those of the scene "
        f"by up to {off:.3g}: a clock of another pace, or steps that add gravity before they move?"
    )


def _where_they_disagree(told: Charge, by_paths: Charge) -> list[str]:
    """A sentence where the contacts that are told show a wrong event first that the paths do not show, or the other way round."""
    here, there = (min(one.faults, key=lambda fault: fault.time, default=None) for one in (told, by_paths))
    if (here is None or any(here.disks == fault.disks for fault in by_paths.faults)) and (
        there is None or any(there.disks == fault.disks for fault in told.faults)
    ):
        return []
    first, other = ("no wrong event" if one is None else one.sentence for one in (here, there))
    return [f"Contacts and paths disagree. The contacts that are told say: {first}. The paths alone say: {other}."]


def _lost_from(truth: Truth, apart: Floats) -> Floats:
    """(n,) from when on a disk is astray, or rests; inf: never."""
    astray = apart > ASTRAY
    first = np.argmax(astray, axis=0)
    lost = np.where(astray.any(axis=0), truth.times[first], np.inf)
    rests = truth.run.rows[truth.run.rows["kind"] == Kind.REST]
    np.minimum.at(lost, rests["a"], rests["time"])
    over = truth.uncertainty > BELIEVED
    return np.minimum(lost, truth.times[int(np.argmax(over))] if over.any() else np.inf)


def _energy(flights: Flights, velocity: Floats, weight: Floats) -> Floats:
    """(T,) the energy; heights count from the start."""
    height = np.sum(weight * np.sum(flights.pull * flights.place, axis=-1), axis=1)
    kinetic = 0.5 * np.sum(weight * np.sum(velocity**2, axis=-1), axis=1)
    return np.asarray(kinetic - (height - height[0]))


def _lawful(truth: Truth, weight: Floats) -> float | None:
    """The change of the energy by the end of the event-driven run, of the kinetic energy at the start."""
    stage, run = truth.stage, truth.run
    pull = stage.gravity or (0.0, 0.0)
    if stage.law.keeps_energy() or any(length is not None and g for length, g in zip(stage.period, pull, strict=True)):
        return None
    start = float(np.sum(weight * (stage.vx**2 + stage.vy**2)))
    if not start > 0.0:
        return None
    fall = run.position[-1] - np.array(stage.corner) - np.column_stack([stage.x, stage.y])
    last = float(weight @ (np.sum(run.velocity[-1] ** 2, axis=-1) - 2.0 * fall @ np.array(pull)))
    return last / start - 1.0


def _smooth(energy: Floats, told: bool) -> Floats:
    """Medians of SMOOTHED samples: where velocities are differences, two disks that meet do not turn in the same one."""
    if told or len(energy) < SMOOTHED:
        return energy
    windows = np.lib.stride_tricks.sliding_window_view(energy, SMOOTHED)
    inner = np.array([np.median(known) if len(known := one[np.isfinite(one)]) else np.nan for one in windows])
    side = SMOOTHED // 2
    return np.concatenate([energy[:side], inner, np.full(side, inner[-1])])


def _momentum(velocity: Floats, stage: Stage, mass: Floats) -> float | None:
    """The largest change of the momentum over sum m |v|; None where walls, gravity or immovable disks give any."""
    if stage.surfaces or stage.gravity is not None or not np.all(np.isfinite(mass)):
        return None
    whole = np.sum(mass[:, None] * velocity, axis=1)
    scale = float(np.sum(mass * np.hypot(*velocity[0].T)))
    return float(np.nanmax(np.hypot(*(whole - whole[0]).T))) / scale if scale > 0.0 else None


def _deepest(scene: Scene, samples: Samples, looks: Floats, seen: Indices) -> tuple[float, int, int, float]:
    """(depth in reaches, a, b, time) of the deepest overlap of two disks at the looks."""
    disks, period, origin = scene.disks, period_of(scene.domain), np.array(scene.domain.origin)
    deepest = (0.0, -1, -1, math.nan)
    for time, sample in zip(looks.tolist(), seen.tolist(), strict=True):
        place = samples.position[sample] - origin
        for axis, length in enumerate(period):
            if math.isfinite(length):
                place[:, axis] %= length
        for found in Cells(place, disks.radius, disks.mass, period).pairs():
            if not len(found.depth):
                continue
            share = found.depth / (disks.radius[found.first] + disks.radius[found.second])
            worst = int(np.argmax(share))
            if share[worst] > deepest[0]:
                deepest = (float(share[worst]), int(found.first[worst]), int(found.second[worst]), time)
    return deepest
