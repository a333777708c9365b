"""The walls inside a domain: shapes at rest that reflect every disk, and their names."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, TypeAlias

from eventsim.errors import SceneError
from eventsim.scene.numbers import Point, number, point


@dataclass(frozen=True, slots=True)
class Segment:
    """A straight wall, hard on both sides; its ends are round posts of radius 0."""

    start: Point
    end: Point
    name: str | None = None
    kind: ClassVar[str] = "segment"

    def __post_init__(self) -> None:
        _set_points(self, "start", "end")


@dataclass(frozen=True, slots=True)
class Polygon:
    """A closed chain of segments through `points`; the last point is joined to the first."""

    points: tuple[Point, ...]
    name: str | None = None
    kind: ClassVar[str] = "polygon"

    def __post_init__(self) -> None:
        _set_chain(self)

    def edges(self) -> tuple[tuple[Point, Point], ...]:
        """The segments (start, end), one for each point."""
        return tuple(zip(self.points, self.points[1:] + self.points[:1], strict=True))


@dataclass(frozen=True, slots=True)
class Polyline:
    """An open chain of segments through `points`."""

    points: tuple[Point, ...]
    name: str | None = None
    kind: ClassVar[str] = "polyline"

    def __post_init__(self) -> None:
        _set_chain(self)

    def edges(self) -> tuple[tuple[Point, Point], ...]:
        """The segments (start, end), one fewer than points."""
        return tuple(zip(self.points[:-1], self.points[1:], strict=True))


@dataclass(frozen=True, slots=True)
class Arc:
    """A circular arc from `start` through a point to `end`, hard on both sides; ends like a segment's."""

    start: Point
    through: Point
    end: Point
    name: str | None = None
    kind: ClassVar[str] = "arc"

    def __post_init__(self) -> None:
        _set_points(self, "start", "through", "end")


@dataclass(frozen=True, slots=True)
class Circle:
    """A round container: the disks live inside. (A post is a disk with mass inf.)"""

    center: Point
    radius: float
    name: str | None = None
    kind: ClassVar[str] = "circle"

    def __post_init__(self) -> None:
        _set_points(self, "center")
        object.__setattr__(self, "radius", number(self.radius, "wall.radius"))


Wall: TypeAlias = Segment | Polygon | Polyline | Arc | Circle
Feature: TypeAlias = Segment | Arc | Circle
WALLS: dict[str, type[Wall]] = {kind.kind: kind for kind in (Segment, Polygon, Polyline, Arc, Circle)}


def wall_names(walls: Sequence[Wall]) -> tuple[str, ...]:
    """One name for each wall: its own, or wall0, wall1, ... by its place in the list."""
    return tuple(f"wall{i}" if wall.name is None else wall.name for i, wall in enumerate(walls))


def features(walls: Sequence[Wall]) -> tuple[Feature, ...]:
    """The walls in single pieces, each with its name: a chain gives its edges as NAME.0, NAME.1, ..."""
    pieces: list[Feature] = []
    for wall, name in zip(walls, wall_names(walls), strict=True):
        if isinstance(wall, Polygon | Polyline):
            pieces.extend(Segment(start, end, f"{name}.{i}") for i, (start, end) in enumerate(wall.edges()))
        else:
            pieces.append(replace(wall, name=name))
    return tuple(pieces)


def feature_names(walls: Sequence[Wall]) -> tuple[str, ...]:
    """The names that an event log uses, in order: those of the features."""
    return tuple(str(feature.name) for feature in features(walls))


def _set_points(wall: Wall, *keys: str) -> None:
    """Store the points of a new wall as pairs of floats."""
    for key in keys:
        object.__setattr__(wall, key, point(getattr(wall, key), f"wall.{key}"))


def _set_chain(wall: Polygon | Polyline) -> None:
    """Store the points of a new chain as a tuple of pairs of floats."""
    try:
        points = tuple(wall.points)
    except TypeError:
        raise SceneError(f"wall.points = {wall.points!r}: must be a list of points") from None
    object.__setattr__(wall, "points", tuple(point(p, f"wall.points[{i}]") for i, p in enumerate(points)))
