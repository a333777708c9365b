"""What measures know of walls: where they are, how long they are, and what their two sides are called."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from eventsim.measure import sums
from eventsim.measure.ensemble import Ensemble
from eventsim.record.events import Floats
from eventsim.scene.scene import Scene
from eventsim.scene.stage import Stage
from eventsim.scene.walls import Arc, Circle, Part, Segment, parts_of


class Sides(NamedTuple):
    """Length of a wall, and the names of its left or inner and its right or outer side; empty where it has but one."""

    length: float
    names: tuple[str, str]


def described_walls(scene: Scene, stage: Stage, ensemble: Ensemble) -> Floats:
    """Return the walls (W, WALL_COLUMNS) as sums know them, relative to the stage's corner, in the order of their names."""
    walls = np.zeros((len(stage.wall_names), sums.WALL_COLUMNS))
    for boundary in stage.boundaries:
        assert stage.size is not None
        mine = walls[boundary.wall]
        mine[sums.LEVER], mine[sums.INSET] = 0.5 * stage.size[boundary.axis], 1.0
    for mine, wall in zip(walls[len(stage.boundaries) :], parts_of(scene.walls), strict=True):
        if ensemble.circle is not None and isinstance(wall, Circle):
            mine[sums.LEVER], mine[sums.INSET] = wall.radius, 1.0
        if isinstance(wall, Segment):
            (x0, y0), (x1, y1) = wall.start, wall.end
            middle, out = (0.5 * (x0 + x1), 0.5 * (y0 + y1)), (y0 - y1, x1 - x0)
        elif isinstance(wall, Arc):
            (x, y), mine[sums.BEND], start, turn = wall.sweep()
            out = mine[sums.BEND] * math.cos(start + 0.5 * turn), mine[sums.BEND] * math.sin(start + 0.5 * turn)
            middle, mine[sums.HALF] = (x + out[0], y + out[1]), math.cos(0.5 * turn)
        else:
            continue  # disks meet but one side, or its sides are not told apart
        mine[sums.WALL_X], mine[sums.WALL_Y] = middle[0] - stage.corner[0], middle[1] - stage.corner[1]
        mine[sums.OUT_X], mine[sums.OUT_Y] = out
        mine[sums.FACE] = sums.END if _wraps_onto_itself(stage, wall) else sums.BOTH
    across = np.array(stage.gravity or (0.0, 0.0)) - stage.slopes
    walls[:, sums.PRESS] = np.hypot(across[:, 0], across[:, 1])
    walls[:, sums.SLOPE_X : sums.SLOPE_Y + 1] = stage.slopes
    return walls


def _wraps_onto_itself(stage: Stage, wall: Part) -> bool:
    """Whether a wall is longer than a period: then no image of a disk is the nearest one to all of it."""
    return any(
        period is not None and high - low > period for period, low, high in zip(stage.period, *wall.bounds(), strict=True)
    )


def sides_of(scene: Scene, stage: Stage) -> tuple[Sides, ...]:
    """Return length and sides of each wall, in the order of their names."""
    found = []
    for boundary in stage.boundaries:
        assert stage.size is not None
        found.append(Sides(stage.size[1 - boundary.axis], ("", "")))
    return (*found, *(Sides(part.length(), part.sides) for part in parts_of(scene.walls)))
