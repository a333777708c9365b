"""An ellipse."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from eventsim.formulas.walls import ellipse as numbers
from eventsim.formulas.walls.shape import Shape
from eventsim.scene.disks import Floats
from eventsim.scene.numbers import Point, is_length
from eventsim.scene.walls.arc import FULL_TURN_POINTS
from eventsim.scene.walls.wall import Bounds, Part

FLATTEST = 1e-6
"""Below this ratio of the semi-axes the tips, of curvature radius b^2 / a, have no digits left."""


@dataclass(frozen=True, slots=True)
class Ellipse(Part):
    """An ellipse, hard on both sides, for points that fly straight.

    semi_axes: (a, b), of which a lies along `direction`, a vector of any length.
    """

    center: Point
    semi_axes: Point
    direction: Point = (1.0, 0.0)
    name: str | None = None
    kind: ClassVar[str] = "ellipse"
    made_of: ClassVar[tuple[type[Shape], ...]] = (numbers.Ellipse,)
    for_points: ClassVar[bool] = True
    scatters: ClassVar[bool] = False
    sides: ClassVar[tuple[str, str]] = ("inside", "outside")

    def parts(self, name: str) -> tuple[Ellipse, ...]:
        """The ellipse itself, with its name."""
        return (replace(self, name=name),)

    def pieces(self, moved: Callable[[Point], Point]) -> list[tuple[Shape, int]]:
        """One ellipse, of part 0, where `moved` brings its centre."""
        return [(self._shape(moved(self.center)), 0)]

    def _shape(self, center: Point) -> numbers.Ellipse:
        (ex, ey), (a, b) = self.direction, self.semi_axes
        size = max(map(abs, center)) + max(a, b)
        return numbers.Ellipse(*center, ex, ey, math.hypot(ex, ey), a, b, size)

    def shape_problems(self) -> Iterator[str]:
        """Its semi-axes are lengths, its direction is one."""
        if not all(map(is_length, self.semi_axes)):
            yield f".semi_axes = {list(self.semi_axes)}: must be two lengths above 0"
        elif min(self.semi_axes) < FLATTEST * max(self.semi_axes):
            yield f".semi_axes = {list(self.semi_axes)}: the smaller must be at least {FLATTEST} of the larger"
        if not is_length(math.hypot(*self.direction)):
            yield f".direction = {list(self.direction)}: must be a vector along the first axis, such as [1, 0]"

    def curvature_radius(self) -> float:
        """The larger semi-axis."""
        return max(self.semi_axes)

    def bounds(self) -> Bounds:
        """The rectangle around it."""
        (x, y), (a, b), (ex, ey) = self.center, self.semi_axes, self.direction
        norm = math.hypot(ex, ey)
        wide, high = math.hypot(a * ex, b * ey) / norm, math.hypot(a * ey, b * ex) / norm
        return (x - wide, y - high), (x + wide, y + high)

    def span(self, axis: int) -> tuple[Fraction, Fraction]:
        """Where the circle around it begins and ends along an axis, exactly."""
        middle, reach = Fraction(self.center[axis]), Fraction(max(self.semi_axes))
        return middle - reach, middle + reach

    def depth(self, position: Floats, radius: Floats | float) -> Floats:
        """How deep disks at `position` (M, 2) of a `radius` reach into it, (M,)."""
        shape = self._shape(self.center)
        found = [shape.nearest(x, y)[2] for x, y in position.tolist()]
        return np.asarray(radius - np.minimum(found, min(self.semi_axes)))

    def contains(self, position: Floats) -> NDArray[np.bool_]:
        """Which places `position` (M, 2) lie inside."""
        (a, b), (ex, ey) = self.semi_axes, self.direction
        x, y = (position[:, axis] - self.center[axis] for axis in (0, 1))
        norm = math.hypot(ex, ey)
        u, w = (x * ex + y * ey) / (norm * a), (y * ex - x * ey) / (norm * b)
        inside: NDArray[np.bool_] = u * u + w * w < 1.0
        return inside

    def length(self) -> float:
        """Its perimeter, by the arithmetic-geometric mean."""
        a, b = self.semi_axes
        mean, other, weight = max(a, b), min(a, b), 0.5
        total = mean * mean
        squares = 0.5 * (mean - other) * (mean + other)
        while mean - other > 1e-15 * mean:
            mean, other, difference = 0.5 * (mean + other), math.sqrt(mean * other), 0.5 * (mean - other)
            weight *= 2.0
            squares += weight * difference * difference
        return 2.0 * math.pi * (total - squares) / mean

    def outline(self) -> Floats:
        """A line of points around it."""
        (a, b), (ex, ey) = self.semi_axes, self.direction
        angle, norm = np.linspace(0.0, 2.0 * math.pi, FULL_TURN_POINTS + 1), math.hypot(ex, ey)
        u, w = a * np.cos(angle) / norm, b * np.sin(angle) / norm
        return np.column_stack([self.center[0] + u * ex - w * ey, self.center[1] + u * ey + w * ex])
