"""Flights: where the paths of sampled disks are free, and where they turn.

A free path is a straight line, or a parabola, through consecutive samples.  Where it is none, the disk has met something: a
turn, with the flight before it and the flight after it.  Velocities are differences of positions where none are told.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from eventsim.record.events import Floats
from eventsim.scene.stage import Stage

Mask: TypeAlias = NDArray[np.bool_]

LEAST_TURN = 1e-3
"""Of the typical speed: a smaller change of velocity is no turn."""

ABOVE_NOISE = 8.0
"""A turn is so many times larger than the change that half of all disks show at a sample, which is noise or drift."""

SHORTEST = 8
"""Samples of a flight whose halves are compared."""

BLURRED_BY = 6.0**0.5
"""Steps of noise of positions in the difference of two mean velocities: x2 - 2 x1 + x0."""

WILD = 4.0
"""Of the typical speed: from the first step on in which disks are faster (root mean square) nothing is told of noise."""

SPLIT = 0.1
"""Of the way that a change of velocity makes from one sample to the next: two flights that miss each other by more have no
common point, so that there is a third between them."""

FEW = 5
"""Samples over which the impulses of one contact may be spread, as steps of an engine do."""

FALLEN = 0.02
"""Of the change of velocity of a turn: gravity that gives less on its way cannot bring the same two together twice."""

UNLIKE = 0.02
"""Of the typical speed: told velocities that differ more from the motion of the positions (the median) are not used."""


@dataclass(frozen=True, slots=True)
class Turn:
    """A disk flies free until sample `first` and from sample `last` on.

    time: where the two flights cross, to within `slack`.  before: the velocity with which it comes there.  change: what it was
    given, gravity apart.  place: where it is then, as samples have it.  ends: whether the samples end before the flight after it
    is known.  split: whether the two flights do not cross, so that there were several contacts between the samples.  fallen: what
    gravity gave on the way, as a share of the change.
    """

    disk: int
    first: int
    last: int
    time: float
    before: Floats
    change: Floats
    place: Floats
    slack: float = 0.0
    ends: bool = False
    split: bool = False
    fallen: float = 0.0

    @property
    def is_short(self) -> bool:
        """Whether it is over so soon that what it was given can be that of one contact, be it in several steps."""
        short = self.last - self.first <= FEW and self.fallen <= FALLEN
        return self.is_sharp or (short and not self.ends and not self.split)

    @property
    def is_sharp(self) -> bool:
        """Whether it is over within one step, at one time, and the flight after it is known."""
        return self.last - self.first <= 1 and not self.ends and not self.split


@dataclass(frozen=True, slots=True)
class Flights:
    """Paths of n disks through T samples.

    Attributes:
        times: (T,) on the scene's clock.
        place: (T, n, 2) relative to the stage's corner, not wrapped.
        before, after: (T, n, 2) velocities of the flights that end and that begin at a sample.
        turned: whether a disk turns there, (T, n); or on the way to the next sample, (T - 1, n), where velocities are told.
        least: the smallest change of velocity that is seen as a turn.
        usual: the change that half of all disks show from one sample to the next by positions: noise, or drift.
        told: whether velocities are those that were told.
        pull: (n, 2) gravity on each disk.
    """

    times: Floats
    place: Floats
    before: Floats
    after: Floats
    turned: Mask
    least: float
    usual: float
    told: bool
    pull: Floats

    @property
    def blur(self) -> float:
        """About the noise of positions, length."""
        return self.usual * float(np.median(np.diff(self.times))) / BLURRED_BY

    def turns(self) -> Iterator[Turn]:
        """All turns, disk by disk."""
        for disk in range(self.place.shape[1]):
            marks = np.flatnonzero(np.diff(np.concatenate([[False], self.turned[:, disk], [False]]).astype(np.int8)))
            for begin, end in marks.reshape(-1, 2).tolist():
                yield self._turn(disk, begin, end if self.told else end - 1)

    def velocity(self) -> Floats:
        """(T, n, 2) velocities at the samples; a turn is where its flights cross, and NaN where that is not known."""
        speeds = self.before.copy()
        for turn in () if self.told else self.turns():
            span = slice(turn.first, turn.last + 1)
            lag = (self.times[span] - turn.time)[:, None]
            come = turn.before + np.where(lag < 0.0, 0.0, turn.change)
            speeds[span, turn.disk] = come + self.pull[turn.disk] * lag if turn.is_sharp else np.nan
        speeds[0] = self.before[0]
        return speeds

    def _turn(self, disk: int, first: int, last: int) -> Turn:
        lag = float(self.times[last] - self.times[first])
        before, after, pull = self.before[first, disk], self.after[last, disk], self.pull[disk]
        change = after - before - pull * lag
        back = self.place[last, disk] - after * lag + 0.5 * pull * lag * lag
        size = float(change @ change)
        apart = self.place[first, disk] - back
        since = float(apart @ change) / size if size > 0.0 and lag > 0.0 else 0.0
        kept = min(max(since, 0.0), lag)
        slack = (SPLIT + self.least / math.sqrt(size)) * lag if size > 0.0 else lag
        split = math.hypot(*(apart - kept * change)) > slack * math.sqrt(size)
        time = float(self.times[first]) + kept
        ends = not self.told and last >= len(self.times) - 2
        place = self.place[first, disk] + before * kept + 0.5 * pull * kept * kept
        fallen = math.hypot(*pull) * lag / math.sqrt(size) if size > 0.0 else 0.0
        return Turn(disk, first, last, time, before + pull * kept, change, place, slack, ends, split, fallen)


def flights_of(
    stage: Stage, times: Floats, place: Floats, velocity: Floats | None, start: Floats, step: float, speed: float
) -> Flights:
    """The flights through samples; the first is the start of the scene.

    Args:
        stage: the scene.
        times: (T,) on its clock.
        place: (T, n, 2) relative to its corner.
        velocity: (T, n, 2), or None.
        start: (n, 2) velocities at the start.
        step: about the last digit of positions, length.
        speed: of a typical disk of the event-driven run: what goes wrong late in the samples is no scale for what was before.
    """
    mass = np.full(stage.n, stage.common_mass) if stage.mass is None else stage.mass
    pull = np.where(np.isfinite(mass)[:, None], np.array(stage.gravity or (0.0, 0.0)), 0.0)
    dt = np.diff(times)[:, None, None]
    way = stage.nearest(np.diff(place, axis=0))
    place = np.concatenate([place[:1], place[:1] + np.cumsum(way, axis=0)])
    mean = way / dt
    calm = _calm(mean[:, np.isfinite(mass)], speed)
    told = False
    if velocity is not None:
        unlike = np.abs(mean - 0.5 * (velocity[1:] + velocity[:-1]))[:calm]
        told = float(np.median(unlike)) < UNLIKE * speed + step / float(np.median(dt))
    if told:
        assert velocity is not None
        before = after = velocity
        changes = np.diff(velocity, axis=0) - pull * dt
    else:
        before = np.concatenate([start[None], mean + 0.5 * pull * dt])
        after = np.concatenate([mean - 0.5 * pull * dt, before[-1:]])
        changes = after - before
    size = np.hypot(changes[..., 0], changes[..., 1])
    moving = size[:calm, np.isfinite(mass)]
    usual = float(np.median(moving)) if moving.size else 0.0
    blurred = 0.0 if told else 4.0 * step / float(dt.min())
    least = max(LEAST_TURN * speed, ABOVE_NOISE * usual, blurred)
    bends = (np.diff(mean, axis=0) - 0.5 * pull * (dt[1:] + dt[:-1]))[:calm]
    noise = float(np.median(np.hypot(bends[..., 0], bends[..., 1]))) if len(bends) else 0.0
    noise = max(noise, BLURRED_BY * step / float(np.median(dt)) / 12.0**0.5)
    return Flights(times, place, before, after, size > least, least, noise, told, pull)


def _calm(mean: Floats, speed: float) -> int:
    """The number of steps, of mean velocities (T - 1, n, 2), before disks fly apart; at least two."""
    if not mean.size:
        return len(mean)
    wild = np.flatnonzero(np.mean(np.sum(mean * mean, axis=-1), axis=1) > (WILD * speed) ** 2)
    return max(int(wild[0]), 2) if len(wild) else len(mean)


class Gained(NamedTuple):
    """What free flights have been given until each sample, (T,): energy, and its standard error.

    largest: the size of what one flight alone was given: a contact that samples hide is no drift.
    """

    energy: Floats
    error: Floats
    largest: Floats


class Flight(NamedTuple):
    """A free flight, and what its second half tells against the first, by positions alone.

    disk: whose.  begun, lasts: when it begins, and how long it is, time.  middle, end: samples.  velocity: the mean of those of
    both halves.  acceleration: what makes the one of the other.
    """

    disk: int
    begun: float
    lasts: float
    middle: int
    end: int
    velocity: Floats
    acceleration: Floats


def free_flights(flights: Flights) -> Iterator[Flight]:
    """All flights of at least SHORTEST samples, disk by disk."""
    count, n = flights.place.shape[:2]
    ends: dict[int, list[tuple[int, int]]] = {disk: [] for disk in range(n)}
    for turn in flights.turns():
        ends[turn.disk].append((turn.first, turn.last))
    for disk in range(n):
        begin = 0
        for first, last in [*ends[disk], (count, count)]:
            if first - 1 - begin >= SHORTEST:
                yield _flight(flights, disk, begin, first - 1)
            begin = last + 1


def _flight(flights: Flights, disk: int, begin: int, end: int) -> Flight:
    middle = (begin + end) // 2
    at = [begin, middle, end]
    (t0, t1, t2), (x0, x1, x2) = flights.times[at].tolist(), flights.place[at, disk]
    one, other = (x1 - x0) / (t1 - t0), (x2 - x1) / (t2 - t1)
    return Flight(disk, t0, t2 - t0, middle, end, 0.5 * (one + other), 2.0 * (other - one) / (t2 - t0))


def energy_on_the_way(flights: Flights, mass: Floats) -> Gained:
    """What free flights gain beside what gravity gives; mass: (n,), 0 where it is infinite.

    Flights of less than SHORTEST samples are left out.
    """
    count = len(flights.times)
    energy, variance, largest = np.zeros(count), np.zeros(count), np.zeros(count)
    blur = flights.blur
    for flight in free_flights(flights):
        m, end = float(mass[flight.disk]), flight.end
        if not m > 0.0:
            continue
        push = (flight.acceleration - flights.pull[flight.disk]) * flight.lasts
        given = m * float(flight.velocity @ push)
        energy[end] += given
        largest[end] = max(largest[end], abs(given))
        variance[end] += (m * math.hypot(*flight.velocity) * 8.0 * blur / flight.lasts) ** 2
    return Gained(np.cumsum(energy), np.sqrt(np.cumsum(variance)), np.maximum.accumulate(largest))
