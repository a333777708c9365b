"""Which wall shapes a disk can meet before it leaves its cell: a list for each cell, where there are many shapes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from eventsim.engines.fast.columns import Integers
from eventsim.formulas.walls.arc import Arc
from eventsim.formulas.walls.face import Face
from eventsim.formulas.walls.post import Post
from eventsim.formulas.walls.shape import Shape
from eventsim.record.events import Floats
from eventsim.scene.stage import Stage

if TYPE_CHECKING:
    from eventsim.engines.fast.plan import Sizes

MANY_SHAPES = 24
"""From here on lists are kept: to look at fewer takes less time than to cross from cell to cell."""

ROOM = 2.0**-16
"""How much further than a disk reaches a shape is listed, as a part of the width of cells: more than it strays from its cell."""


def shapes_in_cells(stage: Stage, sizes: Sizes) -> Integers:
    """Where the list of each cell begins, row by row, and where the last one ends; behind that the lists.

    The outer cells have what is beyond them as well, since they reach to infinity on the open plane.
    """
    cells = [_cells_near(feature.shape, stage, sizes) for feature in stage.features]
    number = np.repeat(np.arange(len(cells)), [len(found) for found in cells])
    cell = np.concatenate(cells)
    order = np.argsort(cell, kind="stable")  # each list in the order of the shapes
    count = sizes.columns * sizes.rows
    begins = np.searchsorted(cell[order], np.arange(count + 1)) + (count + 1)
    return np.concatenate([begins, number[order]]).astype(np.int32)


def _cells_near(shape: Shape, stage: Stage, sizes: Sizes) -> NDArray[np.int64]:
    """The cells from which a disk can reach a shape."""
    reach = float(stage.radius.max()) + ROOM * max(sizes.side)
    low, high = _bounds(shape)
    first_x, last_x = _span(low[0] - reach, high[0] + reach, sizes.low[0], sizes.side[0], sizes.columns)
    first_y, last_y = _span(low[1] - reach, high[1] + reach, sizes.low[1], sizes.side[1], sizes.rows)
    columns, rows = np.arange(first_x, last_x + 1), np.arange(first_y, last_y + 1)
    cells = (columns + sizes.columns * rows[:, None]).ravel()
    if len(columns) < 3 or len(rows) < 3:
        return cells
    x = np.asarray(sizes.low[0] + sizes.side[0] * (columns + 0.5), np.float64)
    y = np.asarray(sizes.low[1] + sizes.side[1] * (rows + 0.5), np.float64)
    distance = _distances(shape, x, y[:, None])
    near = np.broadcast_to(distance <= reach + 0.5 * float(np.hypot(*sizes.side)), (len(rows), len(columns))).copy()
    near[[edge in (0, sizes.rows - 1) for edge in rows]] = True
    near[:, [edge in (0, sizes.columns - 1) for edge in columns]] = True
    return cells[near.ravel()]


def _bounds(shape: Shape) -> tuple[tuple[float, float], tuple[float, float]]:
    """The lower left and upper right corner of a rectangle that holds a shape."""
    if isinstance(shape, Post):
        return (shape.x, shape.y), (shape.x, shape.y)
    if isinstance(shape, Face):
        return (min(shape.x, shape.x1), min(shape.y, shape.y1)), (max(shape.x, shape.x1), max(shape.y, shape.y1))
    if isinstance(shape, Arc):
        x, y, r = shape.x + shape.ux, shape.y + shape.uy, shape.radius
        return (x - r, y - r), (x + r, y + r)
    return (-np.inf, -np.inf), (np.inf, np.inf)


def _distances(shape: Shape, x: Floats, y: Floats) -> Floats:
    """At most the distances of points from a shape."""
    if isinstance(shape, Face):
        share = ((x - shape.x) * shape.ex + (y - shape.y) * shape.ey) / shape.along2
        share = np.clip(share, 0.0, 1.0)
        return np.hypot(x - (shape.x + share * shape.ex), y - (shape.y + share * shape.ey))
    if isinstance(shape, Arc):
        return np.abs(np.hypot(x - (shape.x + shape.ux), y - (shape.y + shape.uy)) - shape.radius)
    return np.zeros(np.broadcast(x, y).shape)


def _span(low: float, high: float, begin: float, side: float, count: int) -> tuple[int, int]:
    """The first and the last column or row, counted from 0, that a length touches."""
    ends = np.clip(np.floor((np.array([low, high]) - begin) / side), 0, count - 1)
    return int(ends[0]), int(ends[1])
