"""The truth of a scene: the event-driven run, and until when it can be believed.

Float64 loses about 1.7 bits for each contact of a disk in a gas at packing fraction 0.3.  So the run is done twice, the second
time with all starting velocities changed in their last bit: where the two part, neither is the motion of the scene.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from eventsim.compiler import has_compiler
from eventsim.engines import ENGINES
from eventsim.errors import EventsimError
from eventsim.record.contacts import contacts_of
from eventsim.record.events import Floats, Kind, Rows
from eventsim.scene import Scene
from eventsim.scene.disks import typical_speed
from eventsim.scene.stage import Stage, stage_of
from eventsim.validation.follow import Followed, follow, position_errors

BELIEVED = 1e-3
"""In diameters: up to here the event-driven run and its neighbour have to agree for a time to be within the horizon."""

LAST_BIT = 2.0**-52

FEW = 20
"""Disks: with fewer, a run of the reference engine is over before the kernels of another kind of scene are compiled."""


@dataclass(frozen=True, slots=True)
class Truth:
    """A scene and its event-driven run through `times`.

    run: the run.  uncertainty: (T,) root mean square distance to the neighbouring run, in diameters.  speed: of a typical
    disk, root mean square over disks and times.
    """

    scene: Scene
    stage: Stage
    times: Floats
    run: Followed
    uncertainty: Floats
    speed: float

    @property
    def radius(self) -> float:
        """The median radius (1 where all disks are points)."""
        return float(np.median(self.stage.radius)) or 1.0

    @property
    def horizon(self) -> float:
        """The last of the times before the run and its neighbour part; the start where they part at once."""
        good = np.flatnonzero(self.uncertainty > BELIEVED)
        last = int(good[0]) if len(good) else len(self.uncertainty)
        return float(self.times[last - 1]) if last else self.scene.start_time

    @property
    def pair_contacts(self) -> int:
        """Contacts between disks."""
        return self.run.counters.pair_contacts

    @property
    def mean_free_time(self) -> float:
        """The mean time between two contacts, with disks or walls, of one disk."""
        sides = 2 * self.run.counters.pair_contacts + self.run.counters.wall_contacts
        duration = float(self.run.times[-1]) - self.scene.start_time
        return duration * self.stage.n / max(sides, 1)


def best_engine(n: int) -> str:
    """The event-driven engine to take for n disks: the fast one where its compiler is installed and worth its time."""
    return "fast" if n >= FEW and has_compiler() else "reference"


def truth_of(scene: Scene, times: Sequence[float], engine: str | None = None) -> Truth:
    """Run a scene event-driven through increasing times, and its neighbour.

    Raises EventsimError where the run stops before the first of the times.
    """
    stage = stage_of(scene)
    name = best_engine(stage.n) if engine is None else engine
    run = follow(ENGINES[name].open(stage, keep_rows=True), times)
    if not len(run.times):
        raise EventsimError(f"the event-driven run stopped ({run.stopped}) before {times[0]:g}: there is nothing to compare")
    neighbour = follow(ENGINES[name].open(neighbouring(stage), keep_rows=True), times)
    uncertainty = position_errors(stage, run, neighbour)
    moving = np.isfinite(stage.radius) & np.isfinite(scene.disks.mass)
    speed = typical_speed(run.velocity[:, moving, 0], run.velocity[:, moving, 1]) if np.any(moving) else 0.0
    start = typical_speed(stage.vx, stage.vy)
    return Truth(scene, stage, run.times, run, uncertainty, max(speed, start) or 1.0)


def time_after(rows: Rows, n: int, contacts: float, end: float) -> float:
    """The time when n disks have had so many contacts each, on average, of a log that begins with these rows.

    It lies midway between that contact and the next one, or `end`: a look at it is after the contact, and not just.
    """
    met = contacts_of(rows)
    sides = np.cumsum(np.where(met["kind"] == Kind.PAIR, 2, 1))
    last = min(int(np.searchsorted(sides, contacts * n * (1.0 - LAST_BIT))), len(met) - 1)
    time = float(met["time"][last])
    later = met["time"][last:][met["time"][last:] > time]
    following = float(later[0]) if len(later) else end
    return min(max(0.5 * (time + following), time), end)


def neighbouring(stage: Stage, bits: int = 1) -> Stage:
    """The stage with every component of a velocity changed by so many last bits, up or down in turn."""
    signs = np.where(np.arange(stage.n) % 2 == 0, 1.0 * bits, -1.0 * bits)
    vx, vy = stage.vx * (1.0 + signs * LAST_BIT), stage.vy * (1.0 - signs * LAST_BIT)
    return replace(stage, vx=vx, vy=vy)


def restarted(stage: Stage, position: Floats, velocity: Floats, time: float) -> Stage:
    """The stage of the same scene at a state (n, 2), (n, 2), on a clock that starts there."""
    return replace(
        stage,
        x=position[:, 0] - stage.corner[0],
        y=position[:, 1] - stage.corner[1],
        vx=velocity[:, 0].copy(),
        vy=velocity[:, 1].copy(),
        start_time=time,
    )
