"""An arc of a circle through three points."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import ClassVar

import numpy as np

from eventsim.errors import SceneError
from eventsim.formulas.walls import arc as numbers
from eventsim.formulas.walls.post import Post
from eventsim.formulas.walls.shape import Shape
from eventsim.scene.disks import Floats
from eventsim.scene.numbers import SHORTEST, Point, is_length, is_place
from eventsim.scene.walls.wall import Bounds, Part, distances

FULL_TURN_POINTS = 240
"""Points on a whole circle: on a picture 1000 pixels wide the chords are off by less than a tenth of a pixel."""

FLATTEST = 2.0**-48
"""A bulge below this part of the coordinates, 16 units in their last place, is rounding: the arc might bend the other way."""


@dataclass(frozen=True, slots=True)
class Arc(Part):
    """A circular arc from `start` through a point to `end`, hard on both sides; ends like a segment's."""

    start: Point
    through: Point
    end: Point
    name: str | None = None
    kind: ClassVar[str] = "arc"
    made_of: ClassVar[tuple[type[Shape], ...]] = (numbers.Arc, Post)
    sides: ClassVar[tuple[str, str]] = ("inside", "outside")

    def parts(self, name: str) -> tuple[Arc, ...]:
        """The arc itself, with its name."""
        return (replace(self, name=name),)

    def pieces(self, moved: Callable[[Point], Point]) -> list[tuple[Shape, int]]:
        """An arc, and posts at its ends, all of part 0, where `moved` brings its points.

        Raises SceneError where rounding takes its bulge there.
        """
        start, through, end = moved(self.start), moved(self.through), moved(self.end)
        size = max(abs(c) for point in (start, through, end) for c in point)
        if bulge(start, through, end) < FLATTEST * size:
            raise SceneError(
                f"{self.name or 'an arc'}: its points are on a line, but for the last digits, where they are counted from the "
                f"corner of the domain: up to {size:g} away (leave less room between walls and disks)"
            )
        return [(numbers.arc(*start, *through, *end), 0), (Post(*start), 0), (Post(*end), 0)]

    def shape_problems(self) -> Iterator[str]:
        """Its points determine a circle that floats can hold, and their digits its bulge."""
        center, radius = circle_through(self.start, self.through, self.end)
        chords = math.dist(self.start, self.through), math.dist(self.through, self.end)
        points = f"start {self.start}, through {self.through} and end {self.end}"
        if not (is_place(center) and is_length(radius) and min(chords) >= SHORTEST):
            yield (
                f": {points} do not determine a circle: they must be three points that are not on a line (use a segment)"
            )
        elif bulge(self.start, self.through, self.end) < FLATTEST * self.scale():
            yield f": {points} are on a line, but for the last digits: the bulge of an arc must be above these (use a segment)"

    def bounds(self) -> Bounds:
        """The rectangle of its whole circle; of an arc of less than a half, that of its ends, wider by its bulge."""
        shape = numbers.arc(*self.start, *self.through, *self.end)
        if numbers.is_minor(shape):
            half, r = 0.5 * math.hypot(shape.ex, shape.ey), shape.radius
            wide = half * (half / (r + math.sqrt(max((r - half) * (r + half), 0.0))))
            (x0, x1), (y0, y1) = (sorted((self.start[k], self.end[k])) for k in (0, 1))
            return (x0 - wide, y0 - wide), (x1 + wide, y1 + wide)
        (x, y), r = circle_through(self.start, self.through, self.end)
        return (x - r, y - r), (x + r, y + r)

    def depth(self, position: Floats, radius: Floats | float) -> Floats:
        """How deep disks at `position` (M, 2) of a `radius` reach into it, (M,)."""
        shape = numbers.arc(*self.start, *self.through, *self.end)
        px, py = position[:, 0] - shape.x, position[:, 1] - shape.y
        from_center = np.hypot(px - shape.ux, py - shape.uy)
        excess = (px * px + py * py) - 2.0 * (px * shape.ux + py * shape.uy)  # nothing cancels where the arc is nearly flat
        gap = np.abs(excess) / (from_center + shape.radius)
        first, second = (way(shape, position[:, 0], position[:, 1]) >= 0.0 for way in (numbers.from_start, numbers.from_end))
        on_arc = first & second if numbers.is_minor(shape) else first | second
        ends = np.minimum(distances(position, self.start), distances(position, self.end))
        return radius - np.where((from_center == 0.0) | on_arc, gap, ends)

    def outline(self) -> Floats:
        """A line of points along it."""
        return circle_points(*self.sweep())

    def length(self) -> float:
        """The length of the arc."""
        _, radius, _, turn = self.sweep()
        return radius * abs(turn)

    def sweep(self) -> tuple[Point, float, float, float]:
        """(centre, radius, angle of the start, turn); turn > 0: counter-clockwise."""
        center, radius = circle_through(self.start, self.through, self.end)
        begin, middle, end = (
            math.atan2(p[1] - center[1], p[0] - center[0]) for p in (self.start, self.through, self.end)
        )
        turn = (end - begin) % (2.0 * math.pi)
        if (middle - begin) % (2.0 * math.pi) > turn:  # `through` is passed on the way round the other side
            turn -= 2.0 * math.pi
        return center, radius, begin, turn


def circle_through(start: Point, through: Point, end: Point) -> tuple[Point, float]:
    """Centre and radius of the circle through three points, rounded once; the radius is inf where they lie on a line."""
    x0, y0 = Fraction(start[0]), Fraction(start[1])
    ax, ay, bx, by = Fraction(through[0]) - x0, Fraction(through[1]) - y0, Fraction(end[0]) - x0, Fraction(end[1]) - y0
    twice_area = 2 * (ax * by - ay * bx)
    if twice_area == 0:
        return start, math.inf
    a2, b2 = ax * ax + ay * ay, bx * bx + by * by
    try:
        cx, cy = float((by * a2 - ay * b2) / twice_area), float((ax * b2 - bx * a2) / twice_area)
        return (float(x0 + Fraction(cx)), float(y0 + Fraction(cy))), math.hypot(cx, cy)
    except OverflowError:  # as good as on a line
        return start, math.inf


def bulge(start: Point, through: Point, end: Point) -> float:
    """The distance of `through` from the line through start and end, or of that which is farther from the others."""
    x0, y0 = Fraction(start[0]), Fraction(start[1])
    ax, ay, bx, by = Fraction(through[0]) - x0, Fraction(through[1]) - y0, Fraction(end[0]) - x0, Fraction(end[1]) - y0
    longest = max(math.dist(start, end), math.dist(start, through), math.dist(through, end))
    return float(abs(ax * by - ay * bx)) / longest if longest > 0.0 else 0.0


def circle_points(center: Point, radius: float, begin: float, turn: float) -> Floats:
    """Points (K, 2) on a circle, from an angle on through a turn."""
    count = max(math.ceil(FULL_TURN_POINTS * abs(turn) / (2.0 * math.pi)), 2) + 1
    angle = begin + np.linspace(0.0, turn, count)
    return np.column_stack([center[0] + radius * np.cos(angle), center[1] + radius * np.sin(angle)])
