"""What measures know of walls: where they are, how long they are, and what their two sides are called."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from eventsim.measure import sums
from eventsim.measure.ensemble import Ensemble
from eventsim.record.events import Floats
from eventsim.scene.scene import Scene
from eventsim.scene.stage import Stage
from eventsim.scene.walls import Arc, Circle, Segment, parts_of


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
        mine[sums.WALL_X + boundary.axis] = boundary.position
        mine[sums.NORMAL_X + boundary.axis] = boundary.side
        mine[sums.LEVER], mine[sums.INSET] = 0.5 * stage.size[boundary.axis], 1.0
    for mine, wall in zip(walls[len(stage.boundaries) :], parts_of(scene.walls), strict=True):
        if isinstance(wall, Circle):
            place = wall.center
            mine[sums.BEND] = wall.radius
            if ensemble.circle is not None:
                mine[sums.LEVER], mine[sums.INSET] = wall.radius, 1.0
        elif isinstance(wall, Arc):
            place, mine[sums.BEND], *_ = wall.sweep()
        elif not isinstance(wall, Segment):
            continue  # of another kind: its sides are not told apart
        else:
            place = wall.start
            mine[sums.NORMAL_X], mine[sums.NORMAL_Y] = wall.start[1] - wall.end[1], wall.end[0] - wall.start[0]
        mine[sums.WALL_X], mine[sums.WALL_Y] = place[0] - stage.corner[0], place[1] - stage.corner[1]
    across = np.array(stage.gravity or (0.0, 0.0)) - stage.slopes
    walls[:, sums.PRESS] = np.hypot(across[:, 0], across[:, 1])
    walls[:, sums.SLOPE_X : sums.SLOPE_Y + 1] = stage.slopes
    return walls


def sides_of(scene: Scene, stage: Stage) -> tuple[Sides, ...]:
    """Return length and sides of each wall, in the order of their names."""
    found = []
    for boundary in stage.boundaries:
        assert stage.size is not None
        found.append(Sides(stage.size[1 - boundary.axis], ("", "")))
    return (*found, *(Sides(part.length(), part.sides) for part in parts_of(scene.walls)))
