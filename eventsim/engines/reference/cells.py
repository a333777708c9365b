"""The cells: a grid that tells which disks can meet before they cross into another cell.

Cells only decide which pairs are looked at; they change no bit of any flight.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import product
from typing import NamedTuple, TypeAlias

import numpy as np

from eventsim.scene.stage import Stage

Cell: TypeAlias = tuple[int, int]
Group: TypeAlias = tuple[list[int], tuple[int, int]]
"""Disks that may be met, and the image (kx, ky) they are seen in."""

MARGIN = 1.0 + 2.0**-20
"""Cells are wider than the longest reach by this, so that a disk enters a neighbouring cell well before the contact."""

ENOUGH_DISKS = 24
"""Below it, looking at all pairs is faster than keeping cells."""


LARGEST = 2.0**12
"""Columns or rows that are enough for any scene of this engine."""

GIANT, FEW = 4.0, 32
"""A disk of more than 4 times the median radius is kept out of the cells, if it is one of at most n / 32."""


class Grid(NamedTuple):
    """Columns and rows of cells of `side` (x, y), the first one at `low`; giants: disks tried against all others.

    On the open plane the outer cells reach to infinity, so that disks which fly apart come to an end of their crossings.
    """

    side: tuple[float, float]
    columns: int
    rows: int
    low: tuple[float, float] = (0.0, 0.0)
    giants: tuple[int, ...] = ()


def plan(stage: Stage, side: float | None = None) -> Grid | None:
    """The grid that a scene profits from, or None: all pairs.  A side that is asked for is kept to if it is wide enough."""
    if side is None and stage.n < ENOUGH_DISKS:
        return None
    giants = _giants(stage)
    least = sum(sorted(np.delete(stage.radius, giants).tolist())[-2:]) * MARGIN
    low, extent = _extent(stage)
    if side is None:
        spacing = math.sqrt(extent[0]) * math.sqrt(extent[1]) / math.sqrt(stage.n)
        side = max(least, spacing)
    if not (side >= least and side > 0.0):
        return None
    columns, rows = (int(min(length / side, LARGEST)) for length in extent)
    enough = [count >= 3 or length is None for count, length in zip((columns, rows), stage.period, strict=True)]
    if not all(enough) or max(columns, rows) < 3:
        return None
    columns, rows = max(columns, 1), max(rows, 1)
    width, height = extent[0] / columns or side, extent[1] / rows or side  # disks in a row on the plane take up no area
    return Grid((width, height), columns, rows, low, giants)


def _extent(stage: Stage) -> tuple[tuple[float, float], tuple[float, float]]:
    """(lower corner, size) of what the cells cover: the domain; on the open plane three times what the disks take up."""
    if stage.size is not None:
        return (0.0, 0.0), stage.size
    width, height = float(np.ptp(stage.x)), float(np.ptp(stage.y))
    return (float(stage.x.min()) - width, float(stage.y.min()) - height), (3.0 * width, 3.0 * height)


def _giants(stage: Stage) -> tuple[int, ...]:
    """The disks that would make every cell as large as they are."""
    giants = np.flatnonzero(stage.radius > GIANT * np.median(stage.radius))
    return tuple(giants.tolist()) if len(giants) * FEW <= stage.n else ()


def images_of(stage: Stage) -> list[tuple[int, int]]:
    """The images (kx, ky) in which a disk of the domain can be met from inside it."""
    along_x, along_y = ((0,) if length is None else (-1, 0, 1) for length in stage.period)
    return list(product(along_x, along_y))


class Cells:
    """Which disks are in which cell; the giants are in none, they are near to everybody."""

    def __init__(self, stage: Stage, grid: Grid) -> None:
        self.side = grid.side
        self._low = grid.low
        self._shape = (grid.columns, grid.rows)
        self._periodic = tuple(length is not None for length in stage.period)
        self._members: dict[Cell, list[int]] = {}
        self._around: dict[Cell, list[Group]] = {}
        self._ahead: dict[tuple[Cell, int, int], list[Group]] = {}
        self.cell_of: list[Cell | None] = [(0, 0)] * stage.n
        for giant in grid.giants:
            self.cell_of[giant] = None
        images = images_of(stage)
        giants, everyone = list(grid.giants), list(range(stage.n))
        self._giants: list[Group] = [(giants, image) for image in images] if giants else []
        self._everyone: list[Group] = [(everyone, image) for image in images]

    def place(self, i: int, x: float, y: float) -> None:
        """Put disk i into the cell of its centre; it must not be in another one."""
        if self.cell_of[i] is None:
            return
        cell = self._clip(x, 0), self._clip(y, 1)
        self.cell_of[i] = cell
        self._in(cell).append(i)

    def clear(self) -> None:
        """Take out all disks."""
        for members in self._members.values():
            members.clear()

    def move(self, i: int, axis: int, step: int) -> None:
        """Move disk i to the next cell along an axis; over a periodic boundary to the other side."""
        cell = self.cell_of[i]
        if cell is None:
            return
        column, row = cell
        self._in(cell).remove(i)
        if axis == 0:
            column = self._next(column, step, 0)
        else:
            row = self._next(row, step, 1)
        self.cell_of[i] = (column, row)
        self._in((column, row)).append(i)

    def near(self, i: int) -> list[Group]:
        """The members of the cells around disk i, its own included, each with the image (kx, ky) that is meant."""
        cell = self.cell_of[i]
        if cell is None:
            return self._everyone
        around = self._around.get(cell)
        if around is None:
            around = self._around[cell] = [*self._neighbours(cell, (-1, 0, 1), (-1, 0, 1)), *self._giants]
        return around

    def ahead(self, i: int, axis: int, step: int) -> list[Group]:
        """As near, but only the three cells on the side towards which disk i has just moved."""
        cell = self.cell_of[i]
        assert cell is not None
        key = cell, axis, step
        ahead = self._ahead.get(key)
        if ahead is None:
            offsets = ((step,), (-1, 0, 1)) if axis == 0 else ((-1, 0, 1), (step,))
            ahead = self._ahead[key] = list(self._neighbours(cell, *offsets))
        return ahead

    def edges(self, i: int, axis: int) -> tuple[float | None, float | None]:
        """The coordinates at which disk i leaves its cell downwards and upwards; None at the end of the grid, and for a giant."""
        cell = self.cell_of[i]
        if cell is None:
            return None, None
        k = cell[axis]
        count = self._shape[axis]
        low = None if k == 0 else self._low[axis] + k * self.side[axis]
        high = None if k == count - 1 else self._low[axis] + (k + 1) * self.side[axis]
        return low, high

    def _in(self, cell: Cell) -> list[int]:
        return self._members.setdefault(cell, [])

    def _clip(self, x: float, axis: int) -> int:
        """The column or row of a coordinate; beyond the grid the outermost."""
        count, k = self._shape[axis], (x - self._low[axis]) / self.side[axis]
        return int(min(max(k, 0.0), count - 1.0))

    def _next(self, k: int, step: int, axis: int) -> int:
        return (k + step) % self._shape[axis] if self._periodic[axis] else k + step

    def _neighbours(self, cell: Cell, offsets_x: tuple[int, ...], offsets_y: tuple[int, ...]) -> Iterator[Group]:
        for dx in offsets_x:
            for dy in offsets_y:
                column, kx = self._fold(cell[0] + dx, 0)
                row, ky = self._fold(cell[1] + dy, 1)
                if column is not None and row is not None:
                    yield self._in((column, row)), (kx, ky)

    def _fold(self, k: int, axis: int) -> tuple[int | None, int]:
        """The cell number inside the domain and the image it is seen in; None beyond a hard boundary."""
        count = self._shape[axis]
        if 0 <= k < count:
            return k, 0
        if not self._periodic[axis]:
            return None, 0
        return k % count, k // count
