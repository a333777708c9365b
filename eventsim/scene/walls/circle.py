"""A round container."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from eventsim.formulas.walls.container import Container
from eventsim.formulas.walls.shape import Shape
from eventsim.scene.disks import Floats
from eventsim.scene.numbers import Point
from eventsim.scene.walls.arc import circle_points
from eventsim.scene.walls.wall import Bounds, Part, distances


@dataclass(frozen=True, slots=True)
class Circle(Part):
    """A round container: the disks live inside. (A post is a disk with mass inf.)"""

    center: Point
    radius: float
    name: str | None = None
    kind: ClassVar[str] = "circle"
    made_of: ClassVar[tuple[type[Shape], ...]] = (Container,)
    holds: ClassVar[bool] = True
    scatters: ClassVar[bool] = False

    def parts(self, name: str) -> tuple[Circle, ...]:
        """The circle itself, with its name."""
        return (replace(self, name=name),)

    def pieces(self, moved: Callable[[Point], Point]) -> list[tuple[Shape, int]]:
        """One container, of part 0, where `moved` brings its centre."""
        return [(Container(*moved(self.center), self.radius), 0)]

    def shape_problems(self) -> Iterator[str]:
        """None: a centre and a radius are a circle."""
        return iter(())

    def period_problems(self, axis: int, origin: float, length: float) -> Iterator[str]:
        """Disks cannot be in a container and its image: along an `axis` it keeps within a period, a `length` from `origin` on."""
        low = self.center[axis] - self.radius - origin
        if low < 0.0 or low + 2.0 * self.radius > length:
            yield f".radius = {self.radius}: the circle must not reach beyond the period in {'xy'[axis]}"

    def curvature_radius(self) -> float:
        """The radius of the circle."""
        return self.radius

    def bounds(self) -> Bounds:
        """The square around it."""
        (x, y), r = self.center, self.radius
        return (x - r, y - r), (x + r, y + r)

    def span(self, axis: int) -> tuple[Fraction, Fraction]:
        """Where the circle begins and ends along an axis, exactly."""
        middle, radius = Fraction(self.center[axis]), Fraction(self.radius)
        return middle - radius, middle + radius

    def depth(self, position: Floats, radius: Floats | float) -> Floats:
        """How far disks at `position` (M, 2) of a `radius` reach out of it, (M,)."""
        return distances(position, self.center) + radius - self.radius

    def contains(self, position: Floats) -> NDArray[np.bool_]:
        """Which places `position` (M, 2) lie inside."""
        return distances(position, self.center) < self.radius

    def length(self) -> float:
        """The length of the circle."""
        return 2.0 * math.pi * self.radius

    def outline(self) -> Floats:
        """A line of points around it."""
        return circle_points(self.center, self.radius, 0.0, 2.0 * math.pi)
