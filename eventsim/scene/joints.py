"""Where walls end, and what is there: a post that sticks out between two of them, a corner, or another wall that goes on.

Around a point at which walls end these part the plane into sectors.  A disk can touch the point only in a sector of more than a
half turn, and there only beyond the ends of the two walls that bound it.  A sector of less than a half turn is a corner: who
meets one of its walls next to the point may meet the other one at once.  A bend below the last bits of the points is none.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from eventsim.formulas.walls.arc import Arc, on_arc
from eventsim.formulas.walls.boundary import Boundary
from eventsim.formulas.walls.container import Container
from eventsim.formulas.walls.face import Face
from eventsim.formulas.walls.point import END, LEFT_POST, RIGHT_POST, SEALED
from eventsim.formulas.walls.post import Post
from eventsim.formulas.walls.shape import Thin
from eventsim.scene.numbers import Point

BEND = 2.0**-50
"""A bend by which points are moved less than this part of their coordinates, 4 units in their last place, is none."""

ROUND_BEND = 2.0**-47
"""The same where an arc ends, whose tangent is known from three points."""

SEALING = 2.0**-48
"""An end closer than this part of the coordinates to another wall lies on it: 16 units in the last place."""


Beside = tuple[int, Point]
"""A side of a wall, and the direction of what makes a corner with it there."""


class Edge(NamedTuple):
    """An end of a wall, seen from its point: which shape, its second end or its first, the direction in which the wall lies.

    left: the side of the shape that is on the left of that direction.
    """

    shape: int
    second: bool
    x: float
    y: float
    left: int
    bend: float


class Joints(NamedTuple):
    """What a list of faces and arcs has at its ends.

    ends: for each shape the number `ends` of Face and Arc.
    beside: for each shape, from its ends along what makes a corner with it there; (0, 0) where nothing does, or on both sides.
    corners: for each shape, for its first end from the side +1 and -1 and its second end likewise, the shape that makes a
    corner with it there: 1 + its place, times its side; 0 where there is none.
    posts: what sticks out, in the order in which its points were given; None for a point where nothing does.
    """

    ends: list[float]
    beside: list[tuple[Point, Point]]
    corners: list[tuple[int, int, int, int]]
    posts: list[Post | None]


def joints_of(
    shapes: Sequence[Thin],
    points: Sequence[Point],
    containers: Sequence[Container],
    sides: Sequence[Boundary],
    rough: float,
) -> Joints:
    """The joints of faces and arcs, and the posts at some of their ends.

    containers, sides: what else closes an end.  rough: the largest coordinate as it was given.
    """
    edges, straight = _edges_at(shapes), _Straight(shapes)
    bits = [[0, 0] for _ in shapes]
    corners = [[0, 0, 0, 0] for _ in shapes]
    beside: list[tuple[list[Beside], list[Beside]]] = [([], []) for _ in shapes]
    posts: dict[Point, Post | None] = {}
    for (x, y), around in edges.items():
        size = max(abs(x), abs(y), rough)
        sealed = _is_sealed(x, y, size, straight, around, containers, sides)
        posts[x, y] = None
        around.sort(key=lambda edge: math.atan2(edge.y, edge.x))
        for k, edge in enumerate(around):
            follower = around[(k + 1) % len(around)]
            turn = _turn(edge, follower, k == len(around) - 1, size)
            if turn == 2 and not sealed:
                posts[x, y] = Post(x, y, edge.x, edge.y, follower.x, follower.y, max(abs(x), abs(y)))
                for one, side in ((edge, edge.left), (follower, -follower.left)):
                    bits[one.shape][one.second] |= LEFT_POST if side > 0 else RIGHT_POST
            elif turn == 0:
                beside[edge.shape][edge.second].append((edge.left, (follower.x, follower.y)))
                beside[follower.shape][follower.second].append((-follower.left, (edge.x, edge.y)))
                _corner(corners, edge, edge.left, follower, -follower.left)
                _corner(corners, follower, -follower.left, edge, edge.left)
        if sealed:
            for edge in around:
                bits[edge.shape][edge.second] |= SEALED
    return Joints(
        [float(first + END * second) for first, second in bits],
        [(_only(first), _only(second)) for first, second in beside],
        [(one[0], one[1], one[2], one[3]) for one in corners],
        [posts.get(point) for point in points],
    )


def _only(found: list[Beside]) -> Point:
    """The direction of what makes a corner at an end; none where there are corners on both sides."""
    return found[0][1] if len(found) == 1 else (0.0, 0.0)


def _corner(corners: list[list[int]], edge: Edge, side: int, other: Edge, other_side: int) -> None:
    corners[edge.shape][2 * edge.second + (side < 0)] = (1 + other.shape) * other_side


def _edges_at(shapes: Sequence[Thin]) -> dict[Point, list[Edge]]:
    """All ends by their points."""
    found: dict[Point, list[Edge]] = {}
    for k, shape in enumerate(shapes):
        for second in (False, True):
            x, y, ax, ay, left = shape.edge(second)
            bend = BEND if isinstance(shape, Face) else ROUND_BEND
            found.setdefault((x, y), []).append(Edge(k, second, ax, ay, left, bend))
    return found


def _turn(edge: Edge, follower: Edge, is_last: bool, size: float) -> int:
    """Counter-clockwise from one edge to the next: 0 less than a half turn, 1 a half turn, 2 more than that.

    is_last: the follower is the first one, behind the angle pi.
    """
    cross = edge.x * follower.y - edge.y * follower.x
    slack = max(edge.bend, follower.bend) * size
    length = math.hypot(edge.x, edge.y) + math.hypot(follower.x, follower.y)
    if abs(cross) > slack * length:
        return 0 if cross > 0.0 else 2
    if edge.x * follower.x + edge.y * follower.y < 0.0:
        return 1
    angle = math.atan2(follower.y, follower.x) - math.atan2(edge.y, edge.x)
    return 2 if (angle + 2.0 * math.pi if is_last else angle) > math.pi else 0


class _Straight:
    """All faces as arrays, to look for those that a point lies on."""

    def __init__(self, shapes: Sequence[Thin]) -> None:
        self.places = np.array([k for k, shape in enumerate(shapes) if isinstance(shape, Face)], np.int64)
        faces = np.array([shapes[k] for k in self.places], float).reshape(-1, len(Face._fields))
        columns = dict(zip(Face._fields, faces.T, strict=True))
        self.x, self.y, self.ex, self.ey, self.nx, self.ny, self.norm, self.along2, self.size = (
            columns[name] for name in ("x", "y", "ex", "ey", "nx", "ny", "norm", "along2", "size")
        )
        self.arcs = [(k, shape) for k, shape in enumerate(shapes) if isinstance(shape, Arc)]

    def hold(self, x: float, y: float, size: float, own: set[int]) -> bool:
        """Whether a point is on the inside of one of them, other than those in `own`."""
        along = self.ex * (x - self.x) + self.ey * (y - self.y)
        distance = np.abs(self.nx * (x - self.x) + self.ny * (y - self.y))
        near = distance <= SEALING * np.maximum(size, self.size) * self.norm
        if any(int(k) not in own for k in self.places[near & (along > 0.0) & (along < self.along2)]):
            return True
        return any(k not in own and _is_on(shape, x, y, size) for k, shape in self.arcs)


def _is_on(shape: Arc, x: float, y: float, size: float) -> bool:
    gap = math.hypot((x - shape.x) - shape.ux, (y - shape.y) - shape.uy) - shape.radius
    return abs(gap) <= SEALING * max(size, shape.radius) and on_arc(shape, x, y)


def _is_sealed(
    x: float,
    y: float,
    size: float,
    straight: _Straight,
    around: list[Edge],
    containers: Sequence[Container],
    sides: Sequence[Boundary],
) -> bool:
    """Whether a point at which walls end lies on another wall."""
    if any(abs((x, y)[one.axis] - one.position) <= SEALING * max(size, abs(one.position)) for one in sides):
        return True
    for one in containers:
        if abs(math.hypot(x - one.x, y - one.y) - one.radius) <= SEALING * max(
            size, one.radius, abs(one.x), abs(one.y)
        ):
            return True
    return straight.hold(x, y, size, {edge.shape for edge in around})
