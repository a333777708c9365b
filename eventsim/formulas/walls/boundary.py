"""The surfaces that disks meet: normals of walls, places on them, their numbers."""

from __future__ import annotations

from eventsim.formulas.expansion import two_sum
from eventsim.formulas.low_place import Low
from eventsim.formulas.real import Real
from eventsim.formulas.walls.delays import at_origin
from eventsim.formulas.walls.face import Face, face_normal
from eventsim.formulas.walls.round import round_normal
from eventsim.scene.stage import Stage


class Surfaces:
    """The walls of a stage by their places: the boundaries of the domain first, then the wall shapes.

    radius: of every disk, in the engine's numbers.
    """

    def __init__(self, stage: Stage, radius: list[Real]) -> None:
        self._boundaries = stage.boundaries
        self._features = stage.features
        self._radius = radius

    def normal(self, place: int, side: int, x: Real, y: Real, low: Low = None) -> tuple[Real, Real]:
        """The normal, of any length, towards a disk at (x, y); low: the low parts of that."""
        if place < len(self._boundaries):
            boundary = self._boundaries[place]
            return (boundary.side, 0.0) if boundary.axis == 0 else (0.0, boundary.side)
        shape = self._features[place - len(self._boundaries)].shape
        if isinstance(shape, Face):
            return face_normal(shape, side)
        if low is not None:
            return round_normal(at_origin(shape), side, (x - shape.x) + low[0], (y - shape.y) + low[1])
        return round_normal(shape, side, x, y)

    def exactly_on(self, place: int, i: int, x: Real, y: Real) -> tuple[Real, Real]:
        """The place of disk i, set exactly onto a boundary of the domain that it meets."""
        if place >= len(self._boundaries):
            return x, y
        boundary = self._boundaries[place]
        target = boundary.position + boundary.side * self._radius[i]
        return (target, y) if boundary.axis == 0 else (x, target)

    def left_on(self, place: int, i: int) -> tuple[int, float] | None:
        """(axis, what rounding left of that coordinate) of disk i on a boundary of the domain; None for other walls."""
        if place >= len(self._boundaries):
            return None
        boundary = self._boundaries[place]
        return boundary.axis, two_sum(boundary.position, boundary.side * self._radius[i])[1]

    def number(self, place: int) -> int:
        """The number that the log knows a wall by."""
        boundaries = self._boundaries
        return boundaries[place].wall if place < len(boundaries) else self._features[place - len(boundaries)].wall
