"""Outlines: the walls and the domain of a scene as lines to draw."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np

from eventsim.record.events import Floats
from eventsim.scene import Scene
from eventsim.scene.walls import parts_of

Rectangle: TypeAlias = tuple[float, float, float, float]
"""x0, y0, x1, y1 on the scene's axes."""


def wall_lines(scene: Scene) -> list[Floats]:
    """Return every wall as a line of points (K, 2)."""
    return [part.outline() for part in parts_of(scene.walls)]


def boundary_lines(scene: Scene) -> tuple[list[Floats], list[Floats]]:
    """Return the boundaries of the domain, hard ones and periodic ones, as lines of points (2, 2)."""
    if scene.domain.size is None:
        return [], []
    (x0, y0), (width, height) = scene.domain.origin, scene.domain.size
    x1, y1 = x0 + width, y0 + height
    sides = (
        [np.array([(x, y0), (x, y1)]) for x in (x0, x1)],
        [np.array([(x0, y), (x1, y)]) for y in (y0, y1)],
    )
    hard: list[Floats] = []
    open_: list[Floats] = []
    for lines, periodic in zip(sides, scene.domain.periodic, strict=True):
        (open_ if periodic else hard).extend(lines)
    return hard, open_
