"""The cells: a grid that tells which disks can meet before they cross into another cell.

Cells only decide which pairs are looked at; they change no bit of any flight.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple, TypeAlias

from eventsim.scene.stage import Stage

Cell: TypeAlias = tuple[int, int]

MARGIN = 1.0 + 2.0**-20
"""Cells are wider than the longest reach by this, so that a disk enters a neighbouring cell well before the contact."""

ENOUGH_DISKS = 24
"""Below it, looking at all pairs is faster than keeping cells."""


class Grid(NamedTuple):
    """Cells of `side` (x, y); columns and rows, None where the plane is open."""

    side: tuple[float, float]
    columns: int | None
    rows: int | None


def plan(stage: Stage, side: float | None = None) -> Grid | None:
    """The grid that a scene profits from, or None: all pairs.  A side that is asked for is kept to if it is wide enough."""
    if side is None and stage.n < ENOUGH_DISKS:
        return None
    radii = sorted(stage.radius.tolist())[-2:]
    least = max(sum(radii), 2.0 * radii[-1]) * MARGIN
    extent = stage.size if stage.size is not None else (float(stage.x.max()), float(stage.y.max()))
    if side is None:
        spacing = math.sqrt(extent[0]) * math.sqrt(extent[1]) / math.sqrt(stage.n)
        side = max(least, spacing)
    if not (side >= least and side > 0.0):
        return None
    if stage.size is None:
        return Grid((side, side), None, None)
    columns, rows = (int(min(length / side, 2.0**20)) for length in stage.size)
    enough = [count >= 3 or length is None for count, length in zip((columns, rows), stage.period, strict=True)]
    if not all(enough) or max(columns, rows) < 3:
        return None
    columns, rows = max(columns, 1), max(rows, 1)
    return Grid((stage.size[0] / columns, stage.size[1] / rows), columns, rows)


class Cells:
    """Which disks are in which cell."""

    def __init__(self, stage: Stage, grid: Grid) -> None:
        self.side = grid.side
        self._shape = (grid.columns, grid.rows)
        self._periodic = tuple(length is not None for length in stage.period)
        self._members: dict[Cell, list[int]] = {}
        self._around: dict[Cell, list[tuple[list[int], tuple[int, int]]]] = {}
        self._ahead: dict[tuple[Cell, int, int], list[tuple[list[int], tuple[int, int]]]] = {}
        self.cell_of: list[Cell] = [(0, 0)] * stage.n

    def place(self, i: int, x: float, y: float) -> None:
        """Put disk i into the cell of its centre; it must not be in another one."""
        cell = self._clip(int(x // self.side[0]), 0), self._clip(int(y // self.side[1]), 1)
        self.cell_of[i] = cell
        self._in(cell).append(i)

    def clear(self) -> None:
        """Take out all disks."""
        for members in self._members.values():
            members.clear()

    def move(self, i: int, axis: int, step: int) -> None:
        """Move disk i to the next cell along an axis; over a periodic boundary to the other side."""
        column, row = self.cell_of[i]
        self._in((column, row)).remove(i)
        if axis == 0:
            column = self._next(column, step, 0)
        else:
            row = self._next(row, step, 1)
        self.cell_of[i] = (column, row)
        self._in((column, row)).append(i)

    def near(self, i: int) -> list[tuple[list[int], tuple[int, int]]]:
        """The members of the cells around disk i, its own included, each with the image (kx, ky) that is meant."""
        cell = self.cell_of[i]
        around = self._around.get(cell)
        if around is None:
            around = self._around[cell] = list(self._neighbours(cell, (-1, 0, 1), (-1, 0, 1)))
        return around

    def ahead(self, i: int, axis: int, step: int) -> list[tuple[list[int], tuple[int, int]]]:
        """As near, but only the three cells on the side towards which disk i has just moved."""
        key = self.cell_of[i], axis, step
        ahead = self._ahead.get(key)
        if ahead is None:
            offsets = ((step,), (-1, 0, 1)) if axis == 0 else ((-1, 0, 1), (step,))
            ahead = self._ahead[key] = list(self._neighbours(key[0], *offsets))
        return ahead

    def edges(self, i: int, axis: int) -> tuple[float | None, float | None]:
        """The coordinates at which disk i leaves its cell downwards and upwards; None at the end of the grid."""
        k = self.cell_of[i][axis]
        count = self._shape[axis]
        low = None if k == 0 and count is not None else k * self.side[axis]
        high = None if count is not None and k == count - 1 else (k + 1) * self.side[axis]
        return low, high

    def _in(self, cell: Cell) -> list[int]:
        return self._members.setdefault(cell, [])

    def _clip(self, k: int, axis: int) -> int:
        count = self._shape[axis]
        return k if count is None else min(max(k, 0), count - 1)

    def _next(self, k: int, step: int, axis: int) -> int:
        count = self._shape[axis]
        return (k + step) % count if count is not None and self._periodic[axis] else k + step

    def _neighbours(
        self, cell: Cell, offsets_x: tuple[int, ...], offsets_y: tuple[int, ...]
    ) -> Iterator[tuple[list[int], tuple[int, int]]]:
        for dx in offsets_x:
            for dy in offsets_y:
                column, kx = self._fold(cell[0] + dx, 0)
                row, ky = self._fold(cell[1] + dy, 1)
                if column is not None and row is not None:
                    yield self._in((column, row)), (kx, ky)

    def _fold(self, k: int, axis: int) -> tuple[int | None, int]:
        """The cell number inside the domain and the image it is seen in; None beyond a hard boundary."""
        count = self._shape[axis]
        if count is None or 0 <= k < count:
            return k, 0
        if not self._periodic[axis]:
            return None, 0
        return k % count, k // count
