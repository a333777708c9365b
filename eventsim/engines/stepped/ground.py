"""What a stepped engine sees of a stage: its walls and periods as arrays, and how deep a disk is in a wall."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from eventsim.engines.stepped.compiled import part
from eventsim.formulas.walls.face import Face
from eventsim.formulas.walls.round import Arc, Container, Post
from eventsim.record.events import Floats
from eventsim.scene.features import Feature
from eventsim.scene.stage import Stage

BOUNDARY, FACE, POST, CONTAINER, ARC = range(5)


class Ground(NamedTuple):
    """Walls and periods.

    kind: (W,) which shape.  numbers: (W, 8) its numbers.  wall: (W,) its number in the log.  length_x, length_y: periods,
    inf where there is none.  gx, gy: gravity.
    """

    kind: NDArray[np.int64]
    numbers: Floats
    wall: NDArray[np.int64]
    length_x: float
    length_y: float
    gx: float
    gy: float


def ground_of(stage: Stage) -> Ground:
    """The walls and periods of a stage."""
    kinds: list[int] = []
    numbers: list[tuple[float, ...]] = []
    names: list[int] = []
    for axis, position, side, wall in stage.boundaries:
        kinds.append(BOUNDARY)
        numbers.append((float(axis), position, side))
        names.append(wall)
    for feature in stage.features:
        kind, values = _numbers(feature)
        kinds.append(kind)
        numbers.append(values)
        names.append(feature.wall)
    table = np.zeros((len(kinds), 8))
    for k, values in enumerate(numbers):
        table[k, : len(values)] = values
    gravity = stage.gravity or (0.0, 0.0)
    length_x, length_y = (math.inf if length is None else length for length in stage.period)
    return Ground(np.array(kinds, np.int64), table, np.array(names, np.int64), length_x, length_y, *gravity)


def _numbers(feature: Feature) -> tuple[int, tuple[float, ...]]:
    shape = feature.shape
    if isinstance(shape, Face):
        return FACE, (shape.x, shape.y, shape.ex, shape.ey, shape.nx / shape.norm, shape.ny / shape.norm, shape.along2)
    if isinstance(shape, Post):
        return POST, tuple(shape)
    if isinstance(shape, Container):
        return CONTAINER, tuple(shape)
    assert isinstance(shape, Arc)
    return ARC, tuple(shape)


@part
def nearest(kind: int, w: Any, x: float, y: float) -> tuple[float, float, float]:
    """(nx, ny, distance): the unit normal that points from a wall to a centre and the distance; inf: beside the wall."""
    if kind == BOUNDARY:
        if w[0] == 0.0:
            return w[2], 0.0, w[2] * (x - w[1])
        return 0.0, w[2], w[2] * (y - w[1])
    dx, dy = x - w[0], y - w[1]
    if kind == FACE:
        along = w[2] * dx + w[3] * dy
        if along < 0.0 or along > w[6]:
            return 0.0, 0.0, math.inf
        distance = w[4] * dx + w[5] * dy
        side = 1.0 if distance >= 0.0 else -1.0
        return side * w[4], side * w[5], side * distance
    distance = math.sqrt(dx * dx + dy * dy)
    if not distance > 0.0:
        return 0.0, 0.0, math.inf
    ux, uy = dx / distance, dy / distance
    if kind == POST:
        return ux, uy, distance
    if kind == CONTAINER:
        return -ux, -uy, w[2] - distance
    fx, fy = w[0] + ux * w[2] - w[3], w[1] + uy * w[2] - w[4]
    if w[7] * (w[5] * fy - w[6] * fx) < 0.0:
        return 0.0, 0.0, math.inf
    if distance >= w[2]:
        return ux, uy, distance - w[2]
    return -ux, -uy, w[2] - distance
