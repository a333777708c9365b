"""Which walls pull along themselves, as those do that grip or heat, and which way a wall goes where a disk meets it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from eventsim.formulas.walls.boundary import Boundary
from eventsim.formulas.walls.shape import Shape
from eventsim.record.events import Floats, Kind, Rows
from eventsim.scene.numbers import Point
from eventsim.scene.scene import Scene
from eventsim.scene.stage import Stage
from eventsim.scene.walls import parts_of


def walls_that_pull(stage: Stage) -> NDArray[np.bool_]:
    """Which walls (W,) pull along themselves, by their numbers in the log."""
    law, numbers = stage.law, range(len(stage.wall_names))
    return np.array([law.grips[1] or law.treatment(wall).temperature is not None for wall in numbers], dtype=bool)


class Pull:
    """The directions of walls that pull.

    A wall goes the way of its `velocity`: +x or +y along sides of the domain, from start to end, around what is closed
    counter-clockwise.  walls: (W,) which of them pull, by their numbers in the log.
    """

    def __init__(self, scene: Scene, stage: Stage) -> None:
        """Note the walls of a scene; places in rows are relative to the stage's corner."""
        self._radius = scene.disks.radius
        self.walls = walls_that_pull(stage)
        self._sides = np.zeros((len(self.walls), 2))
        self._shapes: dict[int, list[tuple[Shape, int]]] = {}
        for surface, turn in zip(stage.surfaces, stage.turns, strict=True):
            if isinstance(surface, Boundary):
                self._sides[surface.wall, 1 - surface.axis] = 1.0
            else:
                self._shapes.setdefault(surface.wall, []).append((surface.shape, turn))
        first = len(stage.boundaries)
        self._ways: dict[int, Point] = {
            first + k: (part.end[0] - part.start[0], part.end[1] - part.start[1])
            for k, part in enumerate(parts_of(scene.walls))
            if hasattr(part, "start") and hasattr(part, "end")
        }

    def directions(self, rows: Rows) -> Floats | None:
        """The unit vectors (R, 2) along the walls that pull, 0 in other rows; None where no wall pulls.

        Contacts that are resolved together go by a law of their own, along normals alone: 0.
        """
        if not self.walls.any():
            return None
        found = np.zeros((len(rows), 2))
        at = np.flatnonzero((rows["kind"] == Kind.WALL) & (rows["joint"] < 0))
        at = at[self.walls[rows["wall"][at]]]
        found[at] = self._sides[rows["wall"][at]]
        bent = at[np.isin(rows["wall"][at], list(self._shapes))]
        columns = (rows[name][bent].tolist() for name in ("wall", "a", "xa", "ya"))
        for row, wall, a, x, y in zip(bent.tolist(), *columns, strict=True):
            found[row] = self._direction(wall, float(self._radius[a]), x, y)
        return found

    def _direction(self, wall: int, radius: float, x: float, y: float) -> Point:
        """Along a shape, where a disk at (x, y) meets it; (0, 0) where a point hits an end: it turns round."""
        least, nearest = math.inf, None
        for shape, turn in self._shapes[wall]:
            away = shape.nearest(x, y)[2]
            if abs(away - radius) < least:
                least, nearest = abs(away - radius), (shape, turn)
        if nearest is None:
            return 0.0, 0.0
        shape, turn = nearest
        nx, ny = shape.normal(1, x, y)
        length = math.hypot(nx, ny)
        if not length > 0.0 or (turn == 0 and radius == 0.0):
            return 0.0, 0.0
        dx, dy = ny / length, -nx / length
        if turn == 0:  # around an end, on the whole the way of its wall
            wx, wy = self._ways.get(wall, (1.0, 0.0))
            turn = 1 if dx * wx + dy * wy >= 0.0 else -1
        return turn * dx, turn * dy
