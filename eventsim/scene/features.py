"""What disks can meet besides each other: boundaries of the domain, and walls broken up into primitive shapes."""

from __future__ import annotations

import math
from typing import NamedTuple, TypeAlias

from eventsim.formulas.walls.face import Face, face
from eventsim.formulas.walls.round import Arc, Container, Post, arc
from eventsim.scene import walls
from eventsim.scene.domain import BOUNDARY_NAMES, Channel, Open, Periodic
from eventsim.scene.scene import Scene

Shape: TypeAlias = Face | Post | Container | Arc
Point: TypeAlias = tuple[float, float]


class Boundary(NamedTuple):
    """A hard wall of the domain: across axis 0 (x) or 1 (y), at `position`, met from above (+1) or from below (-1)."""

    axis: int
    position: float
    side: float
    wall: int


class Feature(NamedTuple):
    """A primitive shape, the number of the wall that it belongs to, and whether disks also meet an image of it."""

    shape: Shape
    wall: int
    imaged: bool


def boundaries_of(scene: Scene) -> tuple[tuple[Boundary, ...], tuple[str, ...]]:
    """The hard walls of the domain, and their names."""
    domain = scene.domain
    if isinstance(domain, Open | Periodic):
        return (), ()
    width, height = domain.size
    if isinstance(domain, Channel):
        return (Boundary(1, 0.0, 1.0, 0), Boundary(1, height, -1.0, 1)), BOUNDARY_NAMES[2:]
    return (
        Boundary(0, 0.0, 1.0, 0),
        Boundary(0, width, -1.0, 1),
        Boundary(1, 0.0, 1.0, 2),
        Boundary(1, height, -1.0, 3),
    ), BOUNDARY_NAMES


def features_of(
    scene: Scene, corner: Point, period: tuple[float | None, float | None], first_wall: int
) -> tuple[Feature, ...]:
    """All shapes, in the order of the walls; a chain has one post for each of its points."""
    features: list[Feature] = []
    reach = float(scene.disks.radius.max())
    wall = first_wall
    for item in scene.walls:
        shifts = _shifts(item, corner, reach, period)
        for shift in shifts:
            shapes = _shapes(item, corner, shift)
            features.extend(Feature(shape, wall + offset, len(shifts) > 1) for shape, offset in shapes)
        wall += len(item.edges()) if isinstance(item, walls.Polygon | walls.Polyline) else 1
    return tuple(features)


def _shapes(item: walls.Wall, corner: Point, shift: Point) -> list[tuple[Shape, int]]:
    """The shapes of one wall relative to the corner and shifted, each with the number of its edge."""

    def place(p: Point) -> Point:
        return (p[0] - corner[0]) + shift[0], (p[1] - corner[1]) + shift[1]

    if isinstance(item, walls.Circle):
        return [(Container(*place(item.center), item.radius), 0)]
    if isinstance(item, walls.Arc):
        start, through, end = place(item.start), place(item.through), place(item.end)
        return [(arc(*start, *through, *end), 0), (Post(*start), 0), (Post(*end), 0)]
    if isinstance(item, walls.Segment):
        edges: tuple[tuple[Point, Point], ...] = ((item.start, item.end),)
        posts = [(item.start, 0), (item.end, 0)]
    else:
        edges = item.edges()
        posts = [(start, k) for k, (start, _) in enumerate(edges)]
        if isinstance(item, walls.Polyline):
            posts.append((item.points[-1], len(edges) - 1))
    shapes: list[tuple[Shape, int]] = [(face(*place(a), *place(b)), k) for k, (a, b) in enumerate(edges)]
    shapes.extend((Post(*place(p)), k) for p, k in posts)
    return shapes


def _span(item: walls.Wall, corner: Point) -> tuple[float, float, float, float]:
    """Bounds (x0, y0, x1, y1) of a wall relative to the corner; of an arc, of its whole circle."""
    if isinstance(item, walls.Circle):
        (cx, cy), r = item.center, item.radius
        points: list[Point] = [(cx - r, cy - r), (cx + r, cy + r)]
    elif isinstance(item, walls.Arc):
        whole = arc(*item.start, *item.through, *item.end)
        points = [
            (whole.x - whole.radius, whole.y - whole.radius),
            (whole.x + whole.radius, whole.y + whole.radius),
        ]
    elif isinstance(item, walls.Segment):
        points = [item.start, item.end]
    else:
        points = list(item.points)
    xs, ys = [p[0] - corner[0] for p in points], [p[1] - corner[1] for p in points]
    return min(xs), min(ys), max(xs), max(ys)


def _shifts(item: walls.Wall, corner: Point, reach: float, period: tuple[float | None, float | None]) -> list[Point]:
    """The translations by periods that bring a wall within reach of a centre in the domain; a container has none."""
    if isinstance(item, walls.Circle):
        return [(0.0, 0.0)]
    span = _span(item, corner)

    def along(low: float, high: float, length: float | None) -> list[float]:
        if length is None:
            return [0.0]
        first = math.ceil((-reach - high) / length)
        last = math.floor((length + reach - low) / length)
        return sorted((k * length for k in range(first, last + 1)), key=abs)

    return [(dx, dy) for dx in along(span[0], span[2], period[0]) for dy in along(span[1], span[3], period[1])]
