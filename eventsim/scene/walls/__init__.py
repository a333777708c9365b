"""The walls inside a domain, one file for each kind: what a scene file says of them (`wall` has all that a kind must know).

A new kind is a class of `Wall` and a place in `WALLS`; the shapes that it is made of are in `formulas/walls`.
"""

from __future__ import annotations

from collections.abc import Sequence

from eventsim.formulas.walls.shape import Shape
from eventsim.scene.walls.arc import Arc
from eventsim.scene.walls.circle import Circle
from eventsim.scene.walls.ellipse import Ellipse
from eventsim.scene.walls.segment import Polygon, Polyline, Segment
from eventsim.scene.walls.wall import Part, Wall

__all__ = [
    "SHAPES",
    "WALLS",
    "Arc",
    "Circle",
    "Ellipse",
    "Part",
    "Polygon",
    "Polyline",
    "Segment",
    "Wall",
    "feature_names",
    "parts_of",
    "wall_names",
]

WALLS: dict[str, type[Wall]] = {kind.kind: kind for kind in (Segment, Polygon, Polyline, Arc, Circle, Ellipse)}
"""The table of walls, by what a scene file calls them."""

SHAPES: tuple[type[Shape], ...] = tuple(dict.fromkeys(shape for kind in WALLS.values() for shape in kind.made_of))
"""The table of shapes that they are made of."""


def wall_names(walls: Sequence[Wall]) -> tuple[str, ...]:
    """One name for each wall: its own, or wall0, wall1, ... by its number in the list."""
    return tuple(f"wall{i}" if wall.name is None else wall.name for i, wall in enumerate(walls))


def parts_of(walls: Sequence[Wall]) -> tuple[Part, ...]:
    """The walls in single pieces, each with its name: a chain gives its edges as NAME.0, NAME.1, ..."""
    return tuple(part for wall, name in zip(walls, wall_names(walls), strict=True) for part in wall.parts(name))


def feature_names(walls: Sequence[Wall]) -> tuple[str, ...]:
    """The names that an event log uses, in order."""
    return tuple(str(part.name) for part in parts_of(walls))
