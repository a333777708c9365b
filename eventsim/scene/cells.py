"""Which disks of a scene overlap which, found through cells: near O(N) also where radii differ widely."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from eventsim.scene.disks import Floats
from eventsim.scene.numbers import Point

Indices: TypeAlias = NDArray[np.int64]

MASSIVE, TRACER, IMMOVABLE = 0, 1, 2
# A cell is a little wider than the largest diameter in it, so that a rounded cell index misses no overlap.
CELL_MARGIN = 1.001
# Cell indices are clipped to this range; clipping brings far cells together, it never separates near ones.
LAST_CELL = 2.0**30
ROW_STRIDE = 2**31
# Candidate pairs looked at in one go: bounds the memory, about 100 bytes each.
CANDIDATES_AT_ONCE = 2**21


@dataclass(frozen=True, slots=True)
class Overlaps:
    """Overlapping pairs: `first` and `second` are disk indices (M,), `depth` is reach minus distance (M,)."""

    first: Indices
    second: Indices
    depth: Floats


@dataclass(frozen=True, slots=True)
class _Grid:
    """Disks of one kind and of nearly one size, sorted by the key of their cell."""

    members: Indices
    keys: Indices
    corner: Point
    width: float
    radius: float
    kind: int


class Cells:
    """Disks sorted into cells, one grid for each octave of the radius and each kind of mass.

    Two disks that do not meet (both tracers, or both immovable) are never reported.
    """

    def __init__(self, position: Floats, radius: Floats, mass: Floats, period: Point) -> None:
        """Sort disks; positions (N, 2) finite, along a direction of finite `period` within [0, period)."""
        self.position = position
        self.radius = radius
        self.period = period
        self.grids: list[_Grid] = []
        if not len(radius):
            return
        kind = _kinds(mass)
        octave = np.frexp(radius)[1].astype(np.int64)
        octave[radius == 0.0] = octave.min() - 1
        groups = np.unique(np.stack([octave, kind], axis=1), axis=0)
        for level, k in groups:
            self.grids.append(self._grid(np.flatnonzero((octave == level) & (kind == k)), int(k)))

    def pairs(self) -> Iterator[Overlaps]:
        """All overlapping pairs among the disks, in chunks.

        A pair that overlaps through several periodic images comes once for each.
        """
        for i, small in enumerate(self.grids):
            for large in self.grids[i:]:
                for found in self._search(large, small.members, self.position, self.radius, small.kind):
                    if small is large:
                        once = found.first < found.second
                        found = Overlaps(found.first[once], found.second[once], found.depth[once])
                    yield found

    def overlaps(self, position: Floats, radius: float, mass: float) -> Iterator[Overlaps]:
        """Overlaps of other, equal disks at `position` (M, 2) with these, in chunks; `first` counts those."""
        everyone = np.arange(len(position))
        radii = np.full(len(position), radius)
        kind = int(_kinds(np.array([mass]))[0])
        for grid in self.grids:
            yield from self._search(grid, everyone, position, radii, kind)

    def _grid(self, members: Indices, kind: int) -> _Grid:
        """The grid of these disks."""
        position = self.position[members]
        largest = float(self.radius[members].max())
        low = position.min(axis=0)
        with np.errstate(over="ignore"):
            extent = float((position.max(axis=0) - low).max())
        # Points have no diameter: about one of them to a cell.
        width = 2.0 * largest or extent / np.sqrt(len(members)) or 1.0
        corner = (float(low[0]), float(low[1]))
        width = min(CELL_MARGIN * width, np.finfo(np.float64).max)
        column, row = _cell(position[:, 0], corner[0], width), _cell(position[:, 1], corner[1], width)
        keys = row.astype(np.int64) * ROW_STRIDE + column.astype(np.int64)
        order = np.argsort(keys, kind="stable")
        return _Grid(members[order], keys[order], corner, width, largest, kind)

    def _search(
        self, grid: _Grid, queries: Indices, position: Floats, radius: Floats, kind: int
    ) -> Iterator[Overlaps]:
        """Overlaps of the disks `queries` (indices into position and radius) with those of a grid."""
        if not len(queries) or (kind == grid.kind and kind != MASSIVE):
            return
        reach = float(radius[queries].max()) + grid.radius
        if reach == 0.0:
            return
        span = np.floor(min(reach / grid.width, LAST_CELL)) + 1.0
        images = [(0.0,) if np.isinf(length) else (0.0, -length, length) for length in self.period]
        for shift in product(*images):
            near = queries
            for axis in (0, 1):
                if shift[axis]:
                    moved = position[near, axis] + shift[axis]
                    near = near[(moved > -reach) & (moved < self.period[axis] + reach)]
            column = _cell(position[near, 0] + shift[0], grid.corner[0], grid.width, LAST_CELL + 2)
            row = _cell(position[near, 1] + shift[1], grid.corner[1], grid.width, LAST_CELL + 2)
            left = np.clip(column - span, 0.0, LAST_CELL).astype(np.int64)
            right = np.clip(column + span, 0.0, LAST_CELL).astype(np.int64)
            for up in range(-int(span), int(span) + 1):
                base = (row.astype(np.int64) + up) * ROW_STRIDE
                start = np.searchsorted(grid.keys, base + left, side="left")
                stop = np.searchsorted(grid.keys, base + right, side="right")
                for query, slot in _expand(start, stop):
                    first, second = near[query], grid.members[slot]
                    apart = position[first] - self.position[second]
                    with np.errstate(over="ignore"):
                        distance = np.hypot(apart[:, 0] + shift[0], apart[:, 1] + shift[1])
                    depth = radius[first] + self.radius[second] - distance
                    deep = depth > 0.0
                    yield Overlaps(first[deep], second[deep], depth[deep])


def _kinds(mass: Floats) -> Indices:
    """Whether each disk is massive, a tracer (0) or immovable (inf)."""
    return np.where(mass == 0.0, TRACER, np.where(np.isinf(mass), IMMOVABLE, MASSIVE))


def _cell(coordinate: Floats, corner: float, width: float, last: float = LAST_CELL) -> Floats:
    """The index of the cell that holds a coordinate, as a whole float."""
    with np.errstate(over="ignore"):
        return np.clip(np.floor((coordinate - corner) / width), LAST_CELL - last, last)


def _expand(start: Indices, stop: Indices) -> Iterator[tuple[Indices, Indices]]:
    """Every (k, s) with start[k] <= s < stop[k], in chunks of bounded size."""
    count = stop - start
    total = np.cumsum(count)
    done = 0
    while done < len(count):
        before = total[done - 1] if done else 0
        end = max(done + 1, int(np.searchsorted(total, before + CANDIDATES_AT_ONCE, side="right")))
        part = count[done:end]
        query = np.repeat(np.arange(done, end), part)
        offset = np.repeat(start[done:end] - (total[done:end] - part - before), part)
        yield query, offset + np.arange(len(query))
        done = end
