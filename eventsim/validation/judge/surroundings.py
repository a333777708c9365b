"""Surroundings: how far disks of a judged engine are from each other and from walls."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from eventsim.engines.stepped.ground import BOUNDARY, ground_of, nearest
from eventsim.record.events import Floats
from eventsim.scene.stage import Stage

Vector = tuple[float, float]

DISTANCE = getattr(nearest, "py_func", nearest)
"""As plain Python: compiling it takes longer than all questions that are asked here."""


class Surroundings:
    """What disks of a stage can meet; places are relative to its corner, wrapped or not."""

    def __init__(self, stage: Stage) -> None:
        self.stage = stage
        self._ground = ground_of(stage)
        self._period = np.array([math.inf if length is None else length for length in stage.period])

    @property
    def surfaces(self) -> range:
        """The numbers of sides and shapes."""
        return range(len(self._ground.kind))

    def wall_of(self, surface: int) -> int:
        """The number, in a log, of the wall that a surface belongs to."""
        return int(self._ground.wall[surface])

    def is_side(self, surface: int) -> bool:
        """Whether a surface is a side of the domain."""
        return bool(self._ground.kind[surface] == BOUNDARY)

    def apart(self, one: Floats, other: Floats) -> Floats:
        """The vectors (..., 2) from `one` to the nearest images of `other`."""
        return self.stage.nearest(other - one)

    def gap(self, a: int, b: int, place_a: Floats, place_b: Floats) -> float:
        """The least gap of two disks on straight ways through places (K, 2) at the same times: negative where they overlap."""
        d = self.apart(place_a, place_b)
        least = float(np.hypot(d[:, 0], d[:, 1]).min())
        for begin, end in pairwise(d):
            way = end - begin
            length2 = float(way @ way)
            if length2 > 0.0:
                share = min(max(-float(begin @ way) / length2, 0.0), 1.0)
                near = begin + share * way
                least = min(least, math.hypot(*near))
        return least - float(self.stage.radius[a] + self.stage.radius[b])

    def to_wall(self, surface: int, place: Floats) -> tuple[Vector, float]:
        """(unit normal towards a place (2,), distance) of a surface; a side of the domain counts beyond it as negative."""
        x, y = (float(v) if math.isinf(length) else float(v % length) for v, length in zip(place, self._period, strict=True))
        nx, ny, distance = DISTANCE(int(self._ground.kind[surface]), self._ground.numbers[surface], x, y)
        return (float(nx), float(ny)), float(distance)

    def beyond(self, surface: int, places: Floats) -> bool:
        """Whether a centre that goes through places (K, 2) gets to the other side of a surface."""
        if self.is_side(surface):
            return any(self.to_wall(surface, place)[1] < 0.0 for place in places)
        before: Vector | None = None
        for begin, end in pairwise(places):
            for place in (begin, end):
                normal, distance = self.to_wall(surface, place)
                if not math.isfinite(distance):
                    before = None
                    continue
                if before is not None and normal[0] * before[0] + normal[1] * before[1] < -0.9:
                    return True
                before = normal
        return False
