"""Marks: dots of a figure, held one by one while they are few; of many only which places of a fine grid have one."""

from __future__ import annotations

import numpy as np

from eventsim.record.events import Column, Floats

MOST_MARKS = 200_000
"""Marks that are held one by one."""

COLUMNS, ROWS = 4096, 2048
"""Of the grid: finer than the pixels of a figure."""


class Marks:
    """Dots in a rectangle.  count: how many there are."""

    def __init__(self, x: tuple[float, float], y: tuple[float, float], rows: int = ROWS) -> None:
        """x, y: from, to.  rows: of the grid."""
        self._low, self._size = (x[0], y[0]), (x[1] - x[0], y[1] - y[0])
        self._shape = (COLUMNS, min(rows, ROWS))
        self._single: list[tuple[Column, Column]] = []
        self._grid: Column | None = None
        self.count = 0

    def add(self, x: Column, y: Column) -> None:
        """Add dots (n,)."""
        self.count += len(x)
        if self._grid is None:
            self._single.append((x, y))
            if self.count <= MOST_MARKS:
                return
            self._grid = np.zeros(self._shape, np.bool_)
            for pair in self._single:
                self._enter(self._grid, pair)
            self._single = []
            return
        self._enter(self._grid, (x, y))

    def drawn(self) -> tuple[Floats, Floats]:
        """Return the places of the dots, or of the cells of the grid that hold some."""
        if self._grid is None:
            x, y = zip((np.empty(0), np.empty(0)), *self._single, strict=True)
            return np.concatenate(x), np.concatenate(y)
        cells = np.nonzero(self._grid)
        along, across = (
            low + size * (cell + 0.5) / number
            for low, size, cell, number in zip(self._low, self._size, cells, self._shape, strict=True)
        )
        return along, across

    def _enter(self, grid: Column, dots: tuple[Column, Column]) -> None:
        cells = []
        for values, low, size, number in zip(dots, self._low, self._size, self._shape, strict=True):
            share = (values - low) / (size or 1.0)
            cells.append(np.clip((share * number).astype(np.int64), 0, number - 1))
        grid[tuple(cells)] = True
