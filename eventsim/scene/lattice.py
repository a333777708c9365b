"""Sites of square and hexagonal lattices that fill a region."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from eventsim.scene.cells import Indices
from eventsim.scene.disks import Floats
from eventsim.scene.gas import Region

# Sites are rounded: neighbours may be closer than a diameter by so many units in the last place of the largest
# length. That is well within what counts as touching.
ROUNDING_ULP = 4


@dataclass(frozen=True, slots=True)
class Shape:
    """Columns and rows of a lattice; where `short`, every second row has one site less."""

    columns: int
    rows: int
    short: bool


@dataclass(frozen=True, slots=True)
class Lattice:
    """A lattice for disks of one radius in a region.

    Attributes:
        hexagonal: each row shifted against the one before; else square.
        region: x0, y0, x1, y1.
        radius: of the disks, length.
        wraps: whether the region closes on itself along x and y; else whole disks are inside.
    """

    hexagonal: bool
    region: Region
    radius: float
    wraps: tuple[bool, bool]

    def shape(self, count: int) -> Shape | None:
        """The shape with at least `count` > 0 sites that keeps neighbours farthest apart; None if none fits."""
        width, height = self._size()
        # With many more columns than rows by the proportions of the region, neighbours would only come closer.
        most = min(count, int(8.0 * math.sqrt(count * width / height)) + 16)
        if self.radius > 0.0:
            most = min(most, int(min(width / (2.0 * self.radius), 1e9)) + 1)
        columns = np.arange(1, most + 1)
        best, distance = None, 0.0
        for short in (False, True) if self.hexagonal and not self.wraps[0] else (False,):
            rows = self._rows(columns, count, short)
            apart = self._distance(columns, rows, short)
            i = int(np.argmax(apart))
            if apart[i] > distance:
                best, distance = Shape(int(columns[i]), int(rows[i]), short), float(apart[i])
        slack = ROUNDING_ULP * np.spacing(max(width, height, *map(abs, self.region)))
        return best if distance >= 2.0 * self.radius - slack else None

    def capacity(self, most: int) -> int:
        """The largest number of sites that fits, if it is below `most`."""
        low, high = 0, most
        while low < high:
            middle = (low + high + 1) // 2
            low, high = (middle, high) if self.shape(middle) else (low, middle - 1)
        return low

    def sites(self, shape: Shape) -> Floats:
        """The sites (M, 2) of a shape, row by row."""
        (width, height), (x0, y0) = self._size(), self.region[:2]
        column, row = np.meshgrid(np.arange(shape.columns), np.arange(shape.rows))
        odd = row % 2
        if not self.hexagonal or shape.rows == 1:
            along = (column + 0.5) / shape.columns
        elif self.wraps[0]:
            along = (column + 0.25 + 0.5 * odd) / shape.columns
        elif shape.short:
            along = (column + 0.5 + 0.5 * odd) / shape.columns
        else:
            along = (column + 0.5 + 0.5 * odd) / (shape.columns + 0.5)
        if not self.hexagonal or self.wraps[1] or shape.rows == 1:
            y = y0 + height * ((row + 0.5) / shape.rows)
        else:
            margin = float(self._margin(np.array(self._pitch(shape)), np.array(shape.rows)))
            y = y0 + margin + (height - 2.0 * margin) * (row / (shape.rows - 1))
        there = (
            ~((odd == 1) & (column == shape.columns - 1))
            if shape.short
            else np.ones_like(odd, dtype=np.bool_)
        )
        return np.stack([(x0 + width * along)[there], y[there]], axis=1)

    def _size(self) -> tuple[float, float]:
        x0, y0, x1, y1 = self.region
        return x1 - x0, y1 - y0

    def _rows(self, columns: Indices, count: int, short: bool) -> Indices:
        """The fewest rows that give `count` sites."""
        if not short:
            rows = -(-count // columns)
            # Shifted rows close on themselves in pairs.
            return rows + rows % 2 if self.hexagonal and self.wraps[1] else rows
        pairs, rest = np.divmod(count, 2 * columns - 1)
        return 2 * pairs + np.where(rest == 0, 0, np.where(rest <= columns, 1, 2))

    def _distance(self, columns: Indices, rows: Indices, short: bool) -> Floats:
        """The distance of nearest neighbours for each number of columns."""
        width, height = self._size()
        if not self.hexagonal:
            return np.minimum(width / columns, height / rows)
        pitch = width / np.where(self.wraps[0] | short | (rows == 1), columns, columns + 0.5)
        inside = (height - 2.0 * self._margin(pitch, rows)) / np.maximum(rows - 1, 1)
        rise = height / rows if self.wraps[1] else inside
        nearest = np.minimum(pitch, np.hypot(0.5 * pitch, rise))
        nearest = np.where(rows > 2, np.minimum(nearest, 2.0 * rise), nearest)
        distance: Floats = np.where(rows == 1, np.minimum(pitch, height), nearest)
        return distance

    def _pitch(self, shape: Shape) -> float:
        """The distance of neighbours in a row of a hexagonal lattice."""
        whole = self.wraps[0] or shape.short or shape.rows == 1
        return self._size()[0] / (shape.columns if whole else shape.columns + 0.5)

    def _margin(self, pitch: Floats, rows: Indices) -> Floats:
        """How far the first row of a hexagonal lattice is from the edge: as far as is fair, at least a radius."""
        fair = np.minimum(0.5 * pitch, self._size()[1] / (2.0 * rows))
        margin: Floats = np.maximum(self.radius, fair)
        return margin
