"""Overlaps: disks that go on into each other, or into a wall, as no engine lets them that turns those who touch.

An engine that advances in steps sees an overlap when a step is done, and turns those who approach.  At most it lets them come as
far into each other as they approach in one of its steps, which is one of the samples or a part of it.  So, whatever chaos does,
two disks never fly deeper than the largest way that they make relative to each other from one sample to the next, from the sample
before they touch on.  (At the first sample of an overlap this is so by itself: they were apart before.)  Others may push them
further in the same way: twice that is granted, and besides the rounding of positions, and a graze.

Where one of the two is turned all the while, it is held by a spring that gives way, or sinks in a pile whose overlaps are not
pushed apart: then they may be deeper by a tenth of the reach.  So they may where samples do not tell who turns.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from eventsim.record.contacts import Key
from eventsim.record.events import Floats, Kind
from eventsim.scene.cells import Indices
from eventsim.validation.judge.faults import GRAZE, Fault
from eventsim.validation.judge.flights import Flights, Mask
from eventsim.validation.judge.outcome import named
from eventsim.validation.judge.surroundings import Surroundings
from eventsim.validation.judge.told import NEAR

GRANTED = 2.0
"""Ways from one sample to the next."""

ROUNDED = 1e-9
"""Of the largest coordinate: an overlap below is rounding."""


class Overlap(NamedTuple):
    """Two that overlap at some samples of T.

    key: who.  path: (T, 2) of one relative to the other.  samples, depths: when, and how deep.  reach: length.
    """

    key: Key
    path: Floats
    samples: Indices
    depths: Floats
    reach: float


def overlaps(
    flights: Flights, around: Surroundings, mass: Floats, resolution: float, known: Sequence[Fault], blind: bool = False
) -> Iterator[Fault]:
    """Faults of overlaps that are too deep, at the first sample at which they are.

    Args:
        flights: the paths.
        around: their disks and walls.
        mass: (n,), inf for immovable disks.
        resolution: a smaller overlap cannot be told, length.
        known: faults that name the contact itself; overlaps that they explain are left out.
        blind: whether turns cannot be told.
    """
    least = max(resolution, ROUNDED * float(np.abs(flights.place[0]).max(initial=0.0)))
    for overlap in (*_pairs(flights, around, mass), *_walls(flights, around, mass)):
        if overlap.depths.max(initial=0.0) > GRAZE * overlap.reach + least:
            yield from _too_deep(overlap, flights, around, least, known, blind)


def _pairs(flights: Flights, around: Surroundings, mass: Floats) -> Iterator[Overlap]:
    """Disks that overlap; O(T n^2), of one difference each."""
    stage, place = around.stage, flights.place
    period, radius = stage.period[0], stage.radius
    massive = np.isfinite(mass) & (mass > 0.0)
    for a in range(stage.n - 1):
        x = place[:, a + 1 :, 0] - place[:, a, None, 0]
        if period is not None:
            x -= period * np.round(x / period)
        meet = massive[a + 1 :] | massive[a] | (np.isfinite(mass[a + 1 :]) != np.isfinite(mass[a]))
        reach = np.where(meet, radius[a + 1 :] + radius[a], 0.0)
        sample, other = np.nonzero(np.abs(x) < reach)
        depth = reach[other] - np.hypot(*around.apart(place[sample, a], place[sample, other + a + 1]).T)
        for b in np.unique(other[depth > 0.0]).tolist():
            these = (other == b) & (depth > 0.0)
            path = place[:, a + 1 + b] - place[:, a]
            yield Overlap((int(Kind.PAIR), a, a + 1 + b), path, sample[these], depth[these], float(reach[b]))


def _walls(flights: Flights, around: Surroundings, mass: Floats) -> Iterator[Overlap]:
    """Disks that overlap a side of the domain or a wall."""
    for a in np.flatnonzero(np.isfinite(mass)).tolist():
        radius, path = float(around.stage.radius[a]), flights.place[:, a]
        flown = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])
        for surface in around.surfaces:
            samples, depths, k = [], [], 0
            while k < len(path):
                gap = around.to_wall(surface, path[k])[1] - radius
                if gap < 0.0:
                    samples.append(k)
                    depths.append(-gap)
                k += 1
                if 0.0 < gap < math.inf:  # it has to fly to get there
                    k = max(k, int(np.searchsorted(flown, flown[k - 1] + gap)) - 1)
            key = (int(Kind.WALL), a, around.wall_of(surface))
            yield Overlap(key, path, np.array(samples, np.int64), np.array(depths), radius)


def _too_deep(
    overlap: Overlap, flights: Flights, around: Surroundings, least: float, known: Sequence[Fault], blind: bool
) -> Iterator[Fault]:
    """The faults of two, one for each time from their touch to their parting."""
    key, path, samples, depths, reach = overlap
    disks = key[1:] if key[0] == Kind.PAIR else key[1:2]
    times, shallow = flights.times, GRAZE * reach + least
    ways = np.hypot(*around.stage.nearest(np.diff(path, axis=0)).T)
    turned = np.ones(len(ways), dtype=bool) if blind else _turned(flights, disks)
    for run in np.split(np.arange(len(samples)), np.flatnonzero(np.diff(samples) > 1) + 1):
        depth, first, last = depths[run], int(samples[run[0]]), int(samples[run[-1]])
        if depth.max() <= shallow:
            continue
        way = np.maximum.accumulate(ways[np.maximum(np.arange(first, last + 1) - 1, 0)])
        deeper = np.where(turned[first:last], 0.0, np.maximum(np.diff(depth), 0.0))
        free = np.concatenate([[0.0], np.cumsum(deeper)])
        over = np.minimum(free, depth) > GRANTED * way + shallow
        over |= depth > GRANTED * way + shallow + NEAR * reach
        if not over.any() or _is_known(disks, float(times[max(first - 1, 0)]), float(times[last]), known):
            continue
        at, worst = int(np.argmax(over)), int(np.argmax(depth))
        time, deepest = float(times[first + at]), float(times[first + worst])
        here, step, most = (_share(float(length), reach) for length in (depth[at], way[at], depth[worst]))
        whole = "" if not reach > 0.0 else " of the reach" if key[0] == Kind.PAIR else " of the radius"
        said = (
            f"overlap: {named(key, around.stage)} at t = {time:.6g}: by {here}{whole}, where one step brings at most {step}; "
            f"by {most} at t = {deepest:.6g}"
        )
        yield Fault(time, "overlap", said, disks)


def _turned(flights: Flights, disks: Sequence[int]) -> Mask:
    """(T - 1,) whether one of them turns on the way from a sample to the next."""
    turned = np.asarray(flights.turned[:, list(disks)].any(axis=1))
    return turned if flights.told else np.asarray(turned[1:] | turned[:-1])


def _share(length: float, reach: float) -> str:
    """A length in reaches; of points as it is."""
    return f"{length / reach:.2%}" if reach > 0.0 else f"{length:.3g}"


def _is_known(disks: Sequence[int], begin: float, end: float, known: Sequence[Fault]) -> bool:
    """Whether a fault of these disks was seen while they overlap."""
    return any(begin <= fault.time <= end and set(disks) <= set(fault.disks) for fault in known)
