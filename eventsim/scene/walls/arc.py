"""An arc of a circle through three points."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from eventsim.formulas.walls import arc as numbers
from eventsim.formulas.walls.post import Post
from eventsim.formulas.walls.shape import Shape
from eventsim.scene.disks import Floats
from eventsim.scene.numbers import SHORTEST, Point, is_length, is_place
from eventsim.scene.walls.wall import Bounds, Part, distances

FULL_TURN_POINTS = 240
"""Points on a whole circle: on a picture 1000 pixels wide the chords are off by less than a tenth of a pixel."""


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
        """An arc, and posts at its ends, all of part 0, where `moved` brings its points."""
        start, through, end = moved(self.start), moved(self.through), moved(self.end)
        return [(numbers.arc(*start, *through, *end), 0), (Post(*start), 0), (Post(*end), 0)]

    def shape_problems(self) -> Iterator[str]:
        """Its points determine a circle that floats can hold."""
        center, radius = circle_through(self.start, self.through, self.end)
        chords = math.dist(self.start, self.through), math.dist(self.through, self.end)
        if not (is_place(center) and is_length(radius) and min(chords) >= SHORTEST):
            yield (
                f": start {self.start}, through {self.through} and end {self.end} do not determine a circle:"
                " they must be three points that are not on a line (use a segment)"
            )

    def curvature_radius(self) -> float:
        """The radius of its circle."""
        return circle_through(self.start, self.through, self.end)[1]

    def bounds(self) -> Bounds:
        """The rectangle of its whole circle."""
        (x, y), r = circle_through(self.start, self.through, self.end)
        return (x - r, y - r), (x + r, y + r)

    def depth(self, position: Floats, radius: Floats | float) -> Floats:
        """How deep disks at `position` (M, 2) of a `radius` reach into it, (M,)."""
        center, size = circle_through(self.start, self.through, self.end)
        from_center = distances(position, center)
        with np.errstate(invalid="ignore", divide="ignore"):
            scale = np.where(from_center > 0.0, size / from_center, 0.0)
        # The nearest point of the whole circle is on the arc if it is on the same side of the chord as `through`.
        foot_x = center[0] + (position[:, 0] - center[0]) * scale - self.start[0]
        foot_y = center[1] + (position[:, 1] - center[1]) * scale - self.start[1]
        chord_x, chord_y = self.end[0] - self.start[0], self.end[1] - self.start[1]
        through_x, through_y = self.through[0] - self.start[0], self.through[1] - self.start[1]
        turn = chord_x * through_y - chord_y * through_x
        # only the sign of turn, whose product with another area may be no float
        on_arc = (chord_x * foot_y - chord_y * foot_x) * np.sign(turn) >= 0.0
        ends = np.minimum(distances(position, self.start), distances(position, self.end))
        return radius - np.where((from_center == 0.0) | on_arc, np.abs(from_center - size), ends)

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
    """Centre and radius of the circle through three points; the radius is inf where they lie on a line."""
    ax, ay = through[0] - start[0], through[1] - start[1]
    bx, by = end[0] - start[0], end[1] - start[1]
    # In units of the largest of them, products neither overflow nor vanish.
    unit = max(abs(ax), abs(ay), abs(bx), abs(by)) or 1.0
    ax, ay, bx, by = ax / unit, ay / unit, bx / unit, by / unit
    twice_area = 2.0 * (ax * by - ay * bx)
    if twice_area == 0.0:
        return start, math.inf
    a2, b2 = ax * ax + ay * ay, bx * bx + by * by
    cx, cy = unit * ((by * a2 - ay * b2) / twice_area), unit * ((ax * b2 - bx * a2) / twice_area)
    return (start[0] + cx, start[1] + cy), math.hypot(cx, cy)


def circle_points(center: Point, radius: float, begin: float, turn: float) -> Floats:
    """Points (K, 2) on a circle, from an angle on through a turn."""
    count = max(math.ceil(FULL_TURN_POINTS * abs(turn) / (2.0 * math.pi)), 2) + 1
    angle = begin + np.linspace(0.0, turn, count)
    return np.column_stack([center[0] + radius * np.cos(angle), center[1] + radius * np.sin(angle)])
