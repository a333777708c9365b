"""Outlines: the walls and the domain of a scene as lines to draw, and the rectangle that a picture shows."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np

from eventsim.record.events import Floats
from eventsim.scene import Scene
from eventsim.scene.walls import parts_of

Rectangle: TypeAlias = tuple[float, float, float, float]
"""x0, y0, x1, y1 on the scene's axes."""

MARGIN = 0.02
"""Share of the larger side that is left free around hard boundaries and open scenes."""

FAR = 1.0
"""An open scene's picture grows by at most this share of its size on each side to follow disks that fly away."""


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


def shown_rectangle(scene: Scene, contacts: Floats, visited: Floats) -> Rectangle:
    """Return what a picture shows: the domain; where it is open, walls, contacts (C, 2) and the visited places (K, 2)."""
    if scene.domain.size is not None:
        (x0, y0), (width, height) = scene.domain.origin, scene.domain.size
        margin = MARGIN * max(width, height)
        free = [0.0 if periodic else margin for periodic in scene.domain.periodic]
        return x0 - free[0], y0 - free[1], x0 + width + free[0], y0 + height + free[1]
    reach = float(scene.disks.radius.max())
    points = [
        *wall_lines(scene),
        *(near + side * reach for near in (scene.disks.position, contacts) for side in (-1, 1)),
    ]
    places = np.concatenate(points)
    low, high = places.min(axis=0), places.max(axis=0)
    extent = float((high - low).max()) or 1.0
    if len(visited):
        low = np.maximum(np.minimum(low, visited.min(axis=0) - reach), low - FAR * extent)
        high = np.minimum(np.maximum(high, visited.max(axis=0) + reach), high + FAR * extent)
    margin = MARGIN * float((high - low).max() or 1.0)
    return float(low[0] - margin), float(low[1] - margin), float(high[0] + margin), float(high[1] + margin)
