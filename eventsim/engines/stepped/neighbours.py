"""Neighbours: the pairs that can touch before the list is made anew (Verlet's list, filled through cells).

Source: L. Verlet, Physical Review 159, 98 (1967), doi:10.1103/PhysRev.159.98.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from eventsim.engines.stepped.compiled import kernel
from eventsim.engines.stepped.disks import Moving, fastest
from eventsim.engines.stepped.found import MOVED, Found
from eventsim.engines.stepped.ground import Ground
from eventsim.formulas.image import nearest_image

SKIN = 0.35
"""In mean diameters: how much farther than their reach listed disks may be; more makes longer lists, less makes more of them."""

FEW = 24
"""Disks up to which all pairs are looked at when a list is made."""

MOST_CELLS = 4
"""Cells per disk at most, so that an open plane does not cost more than its disks."""


class Neighbours:
    """The list: pairs (capacity, 2), of which the first `count` are valid while no disk has moved more than skin / 2."""

    def __init__(self, n: int) -> None:
        self.pairs: NDArray[np.int64] = np.empty((max(8 * n, 64), 2), np.int64)
        self.count = 0
        self.skin = 0.0
        self.built = 0

    def renew(self, m: Moving, ground: Ground, found: Found, dt: float) -> bool:
        """Make the list anew if the next step could bring together a pair that is not on it; whether it was made."""
        flight = float(fastest(m)) * dt + math.hypot(ground.gx, ground.gy) * dt * dt
        if self.built and 2.0 * (found.sums[MOVED] + flight) <= self.skin:
            return False
        found.sums[MOVED] = 0.0
        self.skin = max(SKIN * 2.0 * float(m.radius.mean()), 2.2 * flight)
        while True:
            self.count = self._fill(m, ground)
            if self.count <= len(self.pairs):
                break
            self.pairs = np.empty((self.count + self.count // 4, 2), np.int64)
        self.built += 1
        return True

    def _fill(self, m: Moving, ground: Ground) -> int:
        n = len(m.x)
        width = 2.0 * float(m.radius.max()) + self.skin
        low_x, low_y, size_x, size_y = _extent(m, ground)
        columns, rows = (int(min(max(size / width, 1.0), 1e6)) if width > 0.0 else 1 for size in (size_x, size_y))
        while columns * rows > MOST_CELLS * n + 16:
            columns, rows = (columns + 1) // 2, (rows + 1) // 2
        narrow = (ground.length_x < math.inf and columns < 3) or (ground.length_y < math.inf and rows < 3)
        if n <= FEW or narrow:
            return int(fill_all(m, ground, self.skin, self.pairs))
        cells = np.empty(columns * rows, np.int64)
        following = np.empty(n, np.int64)
        sides = (size_x / columns, size_y / rows)
        return int(
            fill_from_cells(m, ground, self.skin, self.pairs, cells, following, columns, rows, low_x, low_y, *sides)
        )


def _extent(m: Moving, ground: Ground) -> tuple[float, float, float, float]:
    """(x, y, width, height) of a rectangle that holds all centres; along a period, the period."""
    low_x, low_y = float(m.x.min()), float(m.y.min())
    size_x, size_y = float(m.x.max()) - low_x, float(m.y.max()) - low_y
    if ground.length_x < math.inf:
        low_x, size_x = 0.0, ground.length_x
    if ground.length_y < math.inf:
        low_y, size_y = 0.0, ground.length_y
    return low_x, low_y, size_x or 1.0, size_y or 1.0


@kernel
def fill_all(m: Moving, ground: Ground, skin: float, pairs: NDArray[np.int64]) -> int:
    """Look at all pairs; their number, also where there is no room for all."""
    count = 0
    for i in range(len(m.x)):
        for j in range(i + 1, len(m.x)):
            dx = nearest_image(m.x[i] - m.x[j], ground.length_x)
            dy = nearest_image(m.y[i] - m.y[j], ground.length_y)
            reach = m.radius[i] + m.radius[j] + skin
            if dx * dx + dy * dy < reach * reach:
                if count < len(pairs):
                    pairs[count, 0], pairs[count, 1] = i, j
                count += 1
    return count


@kernel
def fill_from_cells(
    m: Moving,
    ground: Ground,
    skin: float,
    pairs: NDArray[np.int64],
    cells: NDArray[np.int64],
    following: NDArray[np.int64],
    columns: int,
    rows: int,
    low_x: float,
    low_y: float,
    side_x: float,
    side_y: float,
) -> int:
    """Look at pairs in the same or neighbouring cells; each is listed once, the smaller number first."""
    cells[:] = -1
    count = 0
    around_x, around_y = ground.length_x < math.inf, ground.length_y < math.inf
    for i in range(len(m.x)):
        column = min(max(int((m.x[i] - low_x) / side_x), 0), columns - 1)
        row = min(max(int((m.y[i] - low_y) / side_y), 0), rows - 1)
        for up in range(-1, 2):
            other_row = row + up
            if around_y:
                other_row = (other_row + rows) % rows
            if other_row < 0 or other_row >= rows:
                continue
            for right in range(-1, 2):
                other_column = column + right
                if around_x:
                    other_column = (other_column + columns) % columns
                if other_column < 0 or other_column >= columns:
                    continue
                j = cells[other_column + columns * other_row]
                while j >= 0:
                    dx = nearest_image(m.x[i] - m.x[j], ground.length_x)
                    dy = nearest_image(m.y[i] - m.y[j], ground.length_y)
                    reach = m.radius[i] + m.radius[j] + skin
                    if dx * dx + dy * dy < reach * reach:
                        if count < len(pairs):
                            pairs[count, 0], pairs[count, 1] = min(i, j), max(i, j)
                        count += 1
                    j = following[j]
        cell = column + columns * row
        following[i] = cells[cell]
        cells[cell] = i
    return count
