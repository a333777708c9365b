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

MASSIVE, TRACER, IMMOVABLE = KINDS = 0, 1, 2
# A cell is a little wider than the largest diameter in it, so that a rounded cell index misses no overlap.
CELL_MARGIN = 1.001
# Cell indices are clipped to this range; clipping brings far cells together, it never separates near ones.
LAST_CELL = 2**30
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
        group = len(KINDS) * octave + kind
        for label in np.unique(group):
            self.grids.append(self._grid(np.flatnonzero(group == label), int(label % len(KINDS))))

    def pairs(self) -> Iterator[Overlaps]:
        """All overlapping pairs among the disks, in chunks.

        A pair that overlaps through several periodic images comes once for each.
        """
        for i, small in enumerate(self.grids):
            for large in self.grids[i:]:
                yield from self._search(large, small.members, self.position, self.radius, small.kind)

    def overlaps(self, position: Floats, radius: float | Floats, mass: float) -> Iterator[Overlaps]:
        """Overlaps of other disks at `position` (M, 2) with these, in chunks; `first` counts those.  radius: of all, or (M,)."""
        radii = np.full(len(position), radius)
        everyone = np.arange(len(position))
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
        column, row = (_cell(position[:, axis], corner[axis], width) for axis in (0, 1))
        keys = row * ROW_STRIDE + column
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
        itself = queries is grid.members
        span = int(min(reach / grid.width, LAST_CELL)) + 1
        images = [(0.0,) if np.isinf(length) else (0.0, -length, length) for length in self.period]
        for shift in product(*images):
            near = queries
            for axis in (0, 1):
                if shift[axis]:
                    moved = position[near, axis] + shift[axis]
                    near = near[(moved > -reach) & (moved < self.period[axis] + reach)]
            column, row = (_cell(position[near, k] + shift[k], grid.corner[k], grid.width, 2) for k in (0, 1))
            if not itself:
                # In the order of the cells, neighbours in turn: the search below then runs through the cache.
                order = np.argsort(row * ROW_STRIDE + column)
                near, column, row = near[order], column[order], row[order]
            left, right = np.clip(column - span, 0, LAST_CELL), np.clip(column + span, 0, LAST_CELL)
            # Within one grid each pair is found from the disk that comes first.
            half = itself and shift == (0.0, 0.0)
            for up in range(0 if half else -span, span + 1):
                base = (row + up) * ROW_STRIDE
                stop = np.searchsorted(grid.keys, base + right, side="right")
                start = np.searchsorted(grid.keys, base + left, side="left")
                if half and up == 0:
                    start = np.arange(1, len(near) + 1)
                for query, slot in _expand(start, stop):
                    first, second = near[query], grid.members[slot]
                    with np.errstate(over="ignore"):
                        x = position[first, 0] - self.position[second, 0] + shift[0]
                        y = position[first, 1] - self.position[second, 1] + shift[1]
                        depth = radius[first] + self.radius[second] - np.hypot(x, y)
                    deep = depth > 0.0 if half or not itself else (depth > 0.0) & (first < second)
                    yield Overlaps(first[deep], second[deep], depth[deep])


def _kinds(mass: Floats) -> Indices:
    """Whether each disk is massive, a tracer (0) or immovable (inf)."""
    return np.where(mass == 0.0, TRACER, np.where(np.isinf(mass), IMMOVABLE, MASSIVE))


def _cell(coordinate: Floats, corner: float, width: float, beyond: int = 0) -> Indices:
    """The index of the cell that holds a coordinate, up to `beyond` cells outside of the grid."""
    with np.errstate(over="ignore"):
        return np.clip(np.floor((coordinate - corner) / width), -beyond, LAST_CELL + beyond).astype(np.int64)


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
