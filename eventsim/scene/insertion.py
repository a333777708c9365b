"""Random sequential insertion: disks dropped at random, kept where they overlap nobody.

Source: B. Widom, Random sequential addition of hard spheres to a volume, J. Chem. Phys. 44, 3888 (1966),
doi:10.1063/1.1726548. In the plane it jams at a packing fraction of about 0.547.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from eventsim.patience import go_on
from eventsim.scene.cells import Cells, Indices
from eventsim.scene.disks import Floats
from eventsim.scene.numbers import Point

# Enough for a packing fraction of 0.5, where one drop in about 1300 still succeeds.
DROPS_PER_DISK = 200
LEAST_DROPS = 100_000
LEAST_BATCH = 1024
LARGEST_BATCH = 2**20


def insert_at_random(
    count: int,
    radius: float,
    mass: float,
    low: Point,
    high: Point,
    period: Point,
    free: Callable[[Floats], NDArray[np.bool_]],
    rng: np.random.Generator,
) -> Floats:
    """Centres (M, 2) of up to `count` equal disks; fewer when too many drops have failed.

    Drops are made one after the other, x before y, uniformly from `low` to `high`; they are taken in batches, but
    the result does not depend on the size of the batches.

    Args:
        count: how many disks.
        radius: of each, length.
        mass: of each; tracers (0) may overlap each other.
        low: least x and y of a centre, relative to the corner of the domain.
        high: largest x and y.
        period: of the domain along x and y; inf where there is none.
        free: which of the centres (K, 2) are in the domain, with nobody else and no wall in their way.
        rng: where the numbers are drawn from.
    """
    placed = np.empty((0, 2))
    lower, extent = np.array(low), np.array(high) - np.array(low)
    batch = min(max(LEAST_BATCH, count), LARGEST_BATCH)
    left = LEAST_DROPS + DROPS_PER_DISK * count
    while len(placed) < count and left > 0:
        left -= batch
        go_on("to place these disks at random")
        drops = lower + extent * rng.random((batch, 2))
        drops = drops[free(drops)]
        taken = np.zeros(len(drops), dtype=np.bool_)
        present = Cells(placed, np.full(len(placed), radius), np.full(len(placed), mass), period)
        for found in present.overlaps(drops, radius, mass):
            taken[found.first] = True
        drops = drops[~taken]
        fresh = Cells(drops, np.full(len(drops), radius), np.full(len(drops), mass), period)
        pairs = [(found.first, found.second) for found in fresh.pairs()]
        placed = np.concatenate([placed, drops[_first_come(len(drops), pairs)]])
    return placed[:count]


def insert_sizes(
    radii: Floats,
    mass: float,
    low: Floats,
    high: Floats,
    wraps: tuple[bool, bool],
    period: Point,
    free: Callable[[Floats, Floats], NDArray[np.bool_]],
    rng: np.random.Generator,
) -> Floats:
    """Centres (M, 2) of disks of these radii (N,), which descend: M < N when too many drops have failed.

    In each round every disk that has no place yet is dropped some times; its first free drop is kept unless it overlaps that of
    a larger one.

    Args:
        radii: of the disks, the largest first.
        mass: of each; tracers (0) may overlap each other.
        low, high: corners (2,) of the region, relative to the corner of the domain.
        wraps: along which axes the region is a whole period, so that disks may reach out of it.
        period: of the domain along x and y; inf where there is none.
        free: which of centres (K, 2) with radii (K,) are in the domain, with nobody else and no wall in their way.
        rng: where the numbers are drawn from.
    """
    count = len(radii)
    centres, waiting = np.full((count, 2), np.nan), np.arange(count)
    left = LEAST_DROPS + DROPS_PER_DISK * count
    while len(waiting) and left > 0:
        go_on("to place these disks at random")
        each = max(1, LEAST_BATCH // len(waiting))
        left -= each * len(waiting)
        who = np.repeat(waiting, each)
        margin = np.where(wraps, 0.0, radii[who, None])
        drops = low + margin + (high - low - 2.0 * margin) * rng.random((len(who), 2))
        good = free(drops, radii[who])
        placed = np.flatnonzero(np.isfinite(centres[:, 0]))
        present = Cells(centres[placed], radii[placed], np.full(len(placed), mass), period)
        for found in present.overlaps(drops, radii[who], mass):
            good[found.first] = False
        chosen = np.flatnonzero(good)
        chosen = chosen[np.unique(who[chosen], return_index=True)[1]]
        fresh = Cells(drops[chosen], radii[who[chosen]], np.full(len(chosen), mass), period)
        kept = chosen[_first_come(len(chosen), [(found.first, found.second) for found in fresh.pairs()])]
        centres[who[kept]] = drops[kept]
        waiting = np.flatnonzero(np.isnan(centres[:, 0]))
    whole: Floats = centres[np.isfinite(centres[:, 0])]
    return whole


def _first_come(count: int, pairs: list[tuple[Indices, Indices]]) -> NDArray[np.bool_]:
    """Which of `count` drops are kept if each is kept unless it overlaps one kept before it.

    In each round all those are kept that overlap no earlier undecided one: few rounds, no loop over drops.
    """
    kept = np.zeros(count, dtype=np.bool_)
    undecided = np.ones(count, dtype=np.bool_)
    none = np.empty(0, dtype=np.int64)
    first = np.concatenate([none, *(np.minimum(i, j) for i, j in pairs)])
    second = np.concatenate([none, *(np.maximum(i, j) for i, j in pairs)])
    while undecided.any():
        waiting = np.zeros(count, dtype=np.bool_)
        waiting[second] = True
        now = undecided & ~waiting
        kept |= now
        undecided &= ~now
        undecided[second[now[first]]] = False
        both = undecided[first] & undecided[second]
        first, second = first[both], second[both]
    return kept
