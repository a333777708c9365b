"""Straight walls: a segment, and chains of segments."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from eventsim.formulas.walls.face import Face, face
from eventsim.formulas.walls.post import Post
from eventsim.formulas.walls.shape import Shape
from eventsim.scene.disks import Floats
from eventsim.scene.numbers import Point
from eventsim.scene.walls.wall import Bounds, Part, Wall, distances, length_problems


@dataclass(frozen=True, slots=True)
class Segment(Part):
    """A straight wall, hard on both sides; its ends are round posts of radius 0."""

    start: Point
    end: Point
    name: str | None = None
    kind: ClassVar[str] = "segment"
    made_of: ClassVar[tuple[type[Shape], ...]] = (Face, Post)
    scatters: ClassVar[bool] = False
    sides: ClassVar[tuple[str, str]] = ("left", "right")

    def parts(self, name: str) -> tuple[Segment, ...]:
        """The segment itself, with its name."""
        return (replace(self, name=name),)

    def pieces(self, moved: Callable[[Point], Point]) -> list[tuple[Shape, int]]:
        """A face, and posts at its ends, all of part 0, where `moved` brings its points."""
        start, end = moved(self.start), moved(self.end)
        return [(face(*start, *end), 0), (Post(*start), 0), (Post(*end), 0)]

    def shape_problems(self) -> Iterator[str]:
        """It needs a length."""
        if self.start == self.end:
            yield f": start and end are the same point {self.start}: a segment needs a length"
        else:
            yield from length_problems("", self.start, self.end)

    def own_image_problems(self, period: Sequence[float]) -> Iterator[str]:
        """It lies on its image by `period` where it is parallel to the way there, exactly, and longer."""
        way = [Fraction(b) - Fraction(a) for a, b in zip(self.start, self.end, strict=True)]
        if any(d != 0 and math.isinf(length) for d, length in zip(way, period, strict=True)):
            return
        x, y = (0 if d == 0 else d / Fraction(length) for d, length in zip(way, period, strict=True))
        whole = math.gcd(x.numerator * y.denominator, y.numerator * x.denominator)
        longer = Fraction(whole, x.denominator * y.denominator)
        if longer > 1:
            piece = f"from {list(self.start)} to {list(self.end)}"
            yield f": {piece} it is {float(longer):.6g} times as long as the way to its own image, and lies on it"

    def bounds(self) -> Bounds:
        """The rectangle of its ends."""
        (x0, y0), (x1, y1) = self.start, self.end
        return (min(x0, x1), min(y0, y1)), (max(x0, x1), max(y0, y1))

    def depth(self, position: Floats, radius: Floats | float) -> Floats:
        """How deep disks at `position` (M, 2) of a `radius` reach into it, (M,)."""
        dx, dy = self.end[0] - self.start[0], self.end[1] - self.start[1]
        length = math.hypot(dx, dy)
        tx, ty = dx / length, dy / length
        px, py = position[:, 0] - self.start[0], position[:, 1] - self.start[1]
        along = tx * px + ty * py
        beside = np.abs(tx * py - ty * px)
        ends = np.minimum(distances(position, self.start), distances(position, self.end))
        return radius - np.where((along >= 0.0) & (along <= length), beside, ends)

    def length(self) -> float:
        """The distance of its ends."""
        return math.dist(self.start, self.end)

    def outline(self) -> Floats:
        """The line from start to end."""
        return np.array([self.start, self.end])


@dataclass(frozen=True, slots=True)
class _Chain(Wall):
    """Segments through `points`, with one post at each of them."""

    points: tuple[Point, ...]
    name: str | None = None
    made_of: ClassVar[tuple[type[Shape], ...]] = (Face, Post)
    scatters: ClassVar[bool] = False
    least: ClassVar[int]
    """Points that it needs."""

    @abstractmethod
    def edges(self) -> tuple[tuple[Point, Point], ...]:
        """The segments (start, end)."""

    def parts(self, name: str) -> tuple[Segment, ...]:
        """The edges, which a chain called `name` numbers: NAME.0, NAME.1, ..."""
        return tuple(Segment(start, end, f"{name}.{i}") for i, (start, end) in enumerate(self.edges()))

    def pieces(self, moved: Callable[[Point], Point]) -> list[tuple[Shape, int]]:
        """The faces, then a post at each point, where `moved` brings the points."""
        edges = self.edges()
        shapes: list[tuple[Shape, int]] = [(face(*moved(a), *moved(b)), k) for k, (a, b) in enumerate(edges)]
        shapes += [(Post(*moved(p)), min(k, len(edges) - 1)) for k, p in enumerate(self.points)]
        return shapes

    def shape_problems(self) -> Iterator[str]:
        """It needs enough points, and its edges a length."""
        if len(self.points) < self.least:
            yield f".points has {len(self.points)} point(s): a {self.kind} needs at least {self.least}"
            return
        for k, (start, end) in enumerate(self.edges()):
            if start == end:
                hint = " (a polygon closes by itself)" if k == len(self.points) - 1 else ""
                yield f".points[{k}] and the next point are the same, {start}: an edge needs a length{hint}"
            else:
                yield from length_problems(f".points[{k}]", start, end)


@dataclass(frozen=True, slots=True)
class Polygon(_Chain):
    """A closed chain of segments through `points`; the last point is joined to the first."""

    kind: ClassVar[str] = "polygon"
    least: ClassVar[int] = 3

    def edges(self) -> tuple[tuple[Point, Point], ...]:
        """The segments (start, end), one for each point."""
        return tuple(zip(self.points, self.points[1:] + self.points[:1], strict=True))

    def contains(self, position: Floats) -> NDArray[np.bool_]:
        """Which places `position` (M, 2) lie inside: a ray to the right crosses an odd number of edges."""
        inside = np.zeros(len(position), dtype=np.bool_)
        x, y = position.T
        for (x0, y0), (x1, y1) in self.edges():
            between = (y0 <= y) != (y1 <= y)
            if y0 != y1:
                inside ^= between & (x < x0 + (y - y0) * ((x1 - x0) / (y1 - y0)))
        return inside


@dataclass(frozen=True, slots=True)
class Polyline(_Chain):
    """An open chain of segments through `points`."""

    kind: ClassVar[str] = "polyline"
    least: ClassVar[int] = 2

    def edges(self) -> tuple[tuple[Point, Point], ...]:
        """The segments (start, end), one fewer than points."""
        return tuple(zip(self.points[:-1], self.points[1:], strict=True))
