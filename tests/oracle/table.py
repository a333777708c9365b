"""A scene as the oracle sees it: its numbers without rounding, its walls in primitive shapes.

This is all that the oracle takes from `eventsim`: the numbers of a Scene.  Places are those of the scene file.

* `Line`: a straight wall, a side of the domain among them (which has no ends, and is met from one side).
* `Ring`: a container, met from inside.
* `Bow`: an arc, hard on both sides.
* `Oval`: an ellipse, hard on both sides, for points alone.
* `Tip`: a point where lines or bows end; disks with a radius meet it like a disk of radius 0 that stands still.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from decimal import Decimal
from typing import Any, TypeAlias

import eventsim as es
from tests.oracle.digits import ONE, ZERO, exact, root

Vector: TypeAlias = tuple[Decimal, Decimal]

TOUCHING = Decimal(16) * Decimal(2) ** -52
"""A gap at the start of at most 16 units in the last place, of the largest coordinate or reach, is touching: what
scenes promise.
"""


@dataclass(frozen=True, eq=False)
class Line:
    """From `start` along `along` (not of unit length); the normal is `along` turned left.

    length2: along.along, None without ends.  sides: those that disks meet it from, +1 where the normal points.
    """

    name: str
    start: Vector
    end: Vector
    along: Vector
    normal: Vector
    norm: Decimal
    length2: Decimal | None
    sides: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Ring:
    """A container: a circle that is met from inside."""

    name: str
    centre: Vector
    radius: Decimal


@dataclass(frozen=True, eq=False)
class Bow:
    """The part of a circle beyond its chord, which goes from `start` along `chord`; `bulge`: the sign of chord x
    (point - start) there.
    """

    name: str
    centre: Vector
    radius: Decimal
    start: Vector
    end: Vector
    chord: Vector
    bulge: int


@dataclass(frozen=True, eq=False)
class Oval:
    """An ellipse; axis: the unit direction of its first semi-axis."""

    name: str
    centre: Vector
    axis: Vector
    semi_axes: Vector

    def scaled(self, p: Vector) -> Vector:
        """A vector in the frame in which the ellipse is a circle of radius 1."""
        (ex, ey), (a, b) = self.axis, self.semi_axes
        return (p[0] * ex + p[1] * ey) / a, (p[1] * ex - p[0] * ey) / b

    def gradient(self, p: Vector) -> Vector:
        """How the distance from the middle of that circle grows, for a point p of it: across the ellipse, outwards."""
        (ex, ey), (a, b) = self.axis, self.semi_axes
        x, y = p[0] / a, p[1] / b
        return x * ex - y * ey, x * ey + y * ex


@dataclass(frozen=True, eq=False)
class Tip:
    """An end of walls; names: of all walls that end there; arms: the unit directions in which they leave."""

    names: frozenset[str]
    place: Vector
    walls: tuple[int, ...]
    arms: tuple[Vector, ...]


Shape: TypeAlias = Line | Ring | Bow | Oval | Tip


@dataclass(frozen=True, eq=False)
class Table:
    """Everything that does not change while time passes.

    radius, mass: of every disk; mass None: infinite.  period: along x and y, None where there is none.  bonds: for
    each shape, the shapes that continue it: the ends of a line or bow, and what ends at a tip.  supports: for each
    line, its index or that of the first line that it is in line with and joined to (bends below the last bits of the
    points are none).  sealed: ends that lie on another wall but for the last bits, so that no point passes between.
    """

    radius: list[Decimal]
    mass: list[Decimal | None]
    start: list[tuple[Vector, Vector]]
    gravity: Vector | None
    pair_restitution: Decimal
    wall_restitution: Decimal
    contact_duration: Decimal | None
    period: tuple[Decimal | None, Decimal | None]
    shapes: list[Shape]
    bonds: list[frozenset[int]]
    supports: dict[int, tuple[int, ...]]
    sealed: frozenset[Vector]
    corner: Vector
    largest: float
    size: tuple[float, float] | None
    start_time: Decimal = ZERO
    pull: list[Vector] = field(default_factory=list)


def table_of(scene: Any) -> Table:
    """The table of a Scene, in the digits of the present round."""
    shapes: list[Shape] = []
    domain = scene.domain
    period: tuple[Decimal | None, Decimal | None] = (None, None)
    size: tuple[float, float] | None = None
    corner = (ZERO, ZERO)
    if not isinstance(domain, es.Open):
        origin, size = domain.origin, domain.size
        corner = (exact(origin[0]), exact(origin[1]))
        width, height = map(exact, size)
        if isinstance(domain, es.Box):
            shapes += _sides(corner, width, height, "left", "right")
        if not isinstance(domain, es.Periodic):
            shapes += _sides(corner, width, height, "bottom", "top")
        period = (None if isinstance(domain, es.Box) else width, height if isinstance(domain, es.Periodic) else None)
    for number, wall in enumerate(scene.walls):
        shapes += _pieces(wall, f"wall{number}" if wall.name is None else wall.name)
    shapes += _tips(shapes)
    gravity = None if scene.gravity is None else (exact(scene.gravity[0]), exact(scene.gravity[1]))
    disks = scene.disks
    mass = [None if math.isinf(m) else exact(m) for m in disks.mass.tolist()]
    law = scene.restitution
    largest = float(abs(disks.position).max()) + float(disks.radius.max())
    for wall in shapes:
        largest = max(largest, *(float(abs(c)) for c in _extent(wall)))
    still = (ZERO, ZERO)
    return Table(
        radius=[exact(r) for r in disks.radius.tolist()],
        mass=mass,
        start=[
            ((exact(x), exact(y)), (exact(u), exact(w)))
            for (x, y), (u, w) in zip(disks.position.tolist(), disks.velocity.tolist(), strict=True)
        ],
        gravity=gravity,
        pair_restitution=ONE if law is None else exact(law.pair),
        wall_restitution=ONE if law is None else exact(law.wall),
        contact_duration=None if scene.contact_duration is None else exact(scene.contact_duration),
        period=period,
        shapes=shapes,
        bonds=_bonds(shapes),
        supports=_supports(shapes),
        sealed=frozenset(one.place for one in shapes if isinstance(one, Tip) and _is_sealed(one, shapes)),
        corner=corner,
        largest=largest,
        size=size,
        start_time=exact(scene.start_time),
        pull=[still if gravity is None or m is None else gravity for m in mass],
    )


def _sides(corner: Vector, width: Decimal, height: Decimal, low: str, high: str) -> list[Shape]:
    """Two opposite sides of the domain; their normals point inside."""
    x, y = corner
    if low == "left":
        return [
            Line(low, corner, corner, (ZERO, -ONE), (ONE, ZERO), ONE, None, (1,)),
            Line(high, (x + width, y), (x + width, y), (ZERO, ONE), (-ONE, ZERO), ONE, None, (1,)),
        ]
    return [
        Line(low, corner, corner, (ONE, ZERO), (ZERO, ONE), ONE, None, (1,)),
        Line(high, (x, y + height), (x, y + height), (-ONE, ZERO), (ZERO, -ONE), ONE, None, (1,)),
    ]


def _pieces(wall: Any, name: str) -> list[Shape]:
    """The lines, rings and bows of one wall of a scene."""
    if isinstance(wall, es.Circle):
        return [Ring(name, _point(wall.center), exact(wall.radius))]
    if isinstance(wall, es.Arc):
        return [bow(name, _point(wall.start), _point(wall.through), _point(wall.end))]
    if isinstance(wall, es.Segment):
        return [line(name, _point(wall.start), _point(wall.end))]
    if wall.kind == "ellipse":
        x, y = _point(wall.direction)
        length = root(x * x + y * y)
        return [Oval(name, _point(wall.center), (x / length, y / length), _point(wall.semi_axes))]
    if not isinstance(wall, es.Polygon | es.Polyline):
        raise NotImplementedError(f"the oracle knows no wall of kind {wall.kind}")
    points = [_point(p) for p in wall.points]
    ends = points[1:] + (points[:1] if isinstance(wall, es.Polygon) else [])
    return [line(f"{name}.{k}", a, b) for k, (a, b) in enumerate(zip(points, ends, strict=False))]


def _point(p: tuple[float, float]) -> Vector:
    return exact(p[0]), exact(p[1])


def line(name: str, start: Vector, end: Vector) -> Line:
    """The straight wall between two points."""
    along = end[0] - start[0], end[1] - start[1]
    normal = -along[1], along[0]
    length2 = along[0] * along[0] + along[1] * along[1]
    return Line(name, start, end, along, normal, root(length2), length2, (1, -1))


def bow(name: str, start: Vector, through: Vector, end: Vector) -> Bow:
    """The arc through three points: the centre has equal distances from them."""
    ax, ay = through[0] - start[0], through[1] - start[1]
    bx, by = end[0] - start[0], end[1] - start[1]
    cross = ax * by - ay * bx
    a2, b2 = ax * ax + ay * ay, bx * bx + by * by
    cx, cy = (by * a2 - ay * b2) / (2 * cross), (ax * b2 - bx * a2) / (2 * cross)
    bulge = 1 if bx * ay - by * ax > 0 else -1
    return Bow(name, (start[0] + cx, start[1] + cy), root(cx * cx + cy * cy), start, end, (bx, by), bulge)


def ends_of(shape: Shape) -> list[tuple[Vector, Vector]]:
    """Where a wall ends, and the unit directions in which it leaves from there."""
    if isinstance(shape, Line) and shape.length2 is not None:
        (ex, ey), n = shape.along, shape.norm
        return [(shape.start, (ex / n, ey / n)), (shape.end, (-ex / n, -ey / n))]
    if isinstance(shape, Bow):
        ex, ey = shape.chord
        found = []
        for px, py in (shape.start, shape.end):
            tx, ty = -(py - shape.centre[1]) / shape.radius, (px - shape.centre[0]) / shape.radius
            if shape.bulge * (ex * ty - ey * tx) < 0:
                tx, ty = -tx, -ty
            found.append(((px, py), (tx, ty)))
        return found
    return []


def _tips(shapes: list[Shape]) -> list[Shape]:
    """The ends of all walls, each place once."""
    places: dict[Vector, list[tuple[int, Vector]]] = {}
    for k, shape in enumerate(shapes):
        for place, arm in ends_of(shape):
            places.setdefault(place, []).append((k, arm))
    return [
        Tip(
            frozenset(_name(shapes[k]) for k, _ in met),
            place,
            tuple(k for k, _ in met),
            tuple(arm for _, arm in met),
        )
        for place, met in places.items()
    ]


def _name(shape: Shape) -> str:
    assert not isinstance(shape, Tip)
    return shape.name


def names_of(shape: Shape) -> frozenset[str]:
    """The names that a log may give to a contact with a shape."""
    return shape.names if isinstance(shape, Tip) else frozenset((shape.name,))


def _bonds(shapes: list[Shape]) -> list[frozenset[int]]:
    bonds: list[set[int]] = [set() for _ in shapes]
    for k, shape in enumerate(shapes):
        if isinstance(shape, Tip):
            together = {k, *shape.walls}
            for one in together:
                bonds[one] |= together
    return [frozenset(bond) for bond in bonds]


def _supports(shapes: list[Shape]) -> dict[int, tuple[int, ...]]:
    """For each line the lines in line with it, itself among them, that reach it without a hole."""
    lines = {k: shape for k, shape in enumerate(shapes) if isinstance(shape, Line)}
    found: dict[int, tuple[int, ...]] = {}
    for k, one in lines.items():
        if one.length2 is None:
            found[k] = (k,)
            continue
        pieces = []
        for j, other in lines.items():
            if other.length2 is not None and all(in_line(one, end) for end, _ in ends_of(other)):
                low, high = sorted(along(one, end) for end, _ in ends_of(other))
                pieces.append((low, high, j))
        group, grown, slack = {k}, True, TOUCHING * one.length2
        low, high = ZERO, one.length2
        while grown:
            grown = False
            for a, b, j in pieces:
                if j not in group and a <= high + slack and b >= low - slack:
                    group.add(j)
                    low, high, grown = min(low, a), max(high, b), True
        found[k] = tuple(sorted(group))
    return found


def _is_sealed(tip: Tip, shapes: list[Shape]) -> bool:
    """Whether an end of walls lies on another wall."""
    x, y = tip.place
    for k, other in enumerate(shapes):
        if k in tip.walls:
            continue
        if isinstance(other, Line):
            if in_line(other, tip.place) and (other.length2 is None or 0 < along(other, tip.place) < other.length2):
                return True
        elif isinstance(other, Ring | Bow):
            dx, dy = x - other.centre[0], y - other.centre[1]
            size = max(abs(x), abs(y), other.radius)
            near = abs(root(dx * dx + dy * dy) - other.radius) <= TOUCHING * size
            if near and (isinstance(other, Ring) or _is_beyond(other, tip.place)):
                return True
    return False


def _is_beyond(one: Bow, p: Vector) -> bool:
    """Whether a point is on the side of the chord where the bow is."""
    fx, fy = p[0] - one.start[0], p[1] - one.start[1]
    return one.bulge * (one.chord[0] * fy - one.chord[1] * fx) > 0


def along(one: Line, p: Vector) -> Decimal:
    """How far along a line the foot of a point is, times the line's length."""
    return one.along[0] * (p[0] - one.start[0]) + one.along[1] * (p[1] - one.start[1])


def across(one: Line, p: Vector) -> Decimal:
    """How far to the left of a line a point is, times the line's norm."""
    return one.normal[0] * (p[0] - one.start[0]) + one.normal[1] * (p[1] - one.start[1])


def in_line(one: Line, p: Vector) -> bool:
    """Whether a point is on a line but for the last bits."""
    scale = abs(p[0]) + abs(p[1]) + abs(one.start[0]) + abs(one.start[1])
    return abs(across(one, p)) <= TOUCHING * one.norm * scale


def _extent(shape: Shape) -> list[Decimal]:
    if isinstance(shape, Tip):
        return list(shape.place)
    if isinstance(shape, Line):
        return [*shape.start, *shape.end]
    if isinstance(shape, Bow):
        return [*shape.start, *shape.end]
    far = max(shape.semi_axes) if isinstance(shape, Oval) else shape.radius
    return [c + s * far for c in shape.centre for s in (1, -1)]
