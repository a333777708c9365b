"""What a stepped engine sees of a stage: its walls and periods as arrays, and how deep a disk is in a wall."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from eventsim.engines.stepped.compiled import part
from eventsim.formulas.walls.arc import Arc, arc_nearest
from eventsim.formulas.walls.container import Container, container_nearest
from eventsim.formulas.walls.ellipse import Ellipse, ellipse_nearest
from eventsim.formulas.walls.face import Face, face_nearest
from eventsim.formulas.walls.post import Post, post_nearest
from eventsim.record.events import Floats
from eventsim.scene.stage import Stage

KINDS = (Face, Post, Container, Arc, Ellipse)
"""The shapes that `nearest` knows."""

FACE, POST, CONTAINER, ARC, ELLIPSE, BOUNDARY = range(6)
"""Kinds of walls: the shapes by their places in KINDS, and a side of the domain."""

WIDTH = 17
"""Numbers of the shape that has most."""


class Ground(NamedTuple):
    """Walls and periods.

    kind: (W,) which shape.  numbers: (W, WIDTH) its numbers.  wall: (W,) its number in the log.  length_x, length_y: periods,
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
    walls: list[tuple[int, tuple[float, ...]]] = [
        (BOUNDARY, (float(axis), position, side)) for axis, position, side, _ in stage.boundaries
    ]
    walls += [(KINDS.index(type(feature.shape)), tuple(feature.shape)) for feature in stage.features]
    table = np.zeros((len(walls), WIDTH))
    for row, (_, numbers) in zip(table, walls, strict=True):
        row[: len(numbers)] = numbers
    kinds = np.array([kind for kind, _ in walls], np.int64)
    names = np.array([surface.wall for surface in stage.surfaces], np.int64)
    gravity = stage.gravity or (0.0, 0.0)
    length_x, length_y = (math.inf if length is None else length for length in stage.period)
    return Ground(kinds, table, names, length_x, length_y, *gravity)


@part
def nearest(kind: int, w: Any, x: float, y: float) -> tuple[float, float, float]:
    """(nx, ny, distance): the unit normal that points from a wall to a centre and the distance; inf: beside the wall."""
    if kind == BOUNDARY:
        if w[0] == 0.0:
            return w[2], 0.0, w[2] * (x - w[1])
        return 0.0, w[2], w[2] * (y - w[1])
    if kind == FACE:
        return face_nearest(
            Face(w[0], w[1], w[2], w[3], w[4], w[5], w[6], w[7], w[8], w[9], w[10], w[11], 0.0, 0.0, 0.0, 0.0, 0.0), x, y
        )
    if kind == POST:
        return post_nearest(Post(w[0], w[1]), x, y)
    if kind == CONTAINER:
        return container_nearest(Container(w[0], w[1], w[2]), x, y)
    if kind == ELLIPSE:
        return ellipse_nearest(Ellipse(w[0], w[1], w[2], w[3], w[4], w[5], w[6], w[7]), x, y)
    return arc_nearest(
        Arc(w[0], w[1], w[2], w[3], w[4], w[5], w[6], w[7], w[8], w[9], w[10], w[11], 0.0, 0.0, 0.0, 0.0, 0.0), x, y
    )
