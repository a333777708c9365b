"""What disks can meet besides each other: boundaries of the domain, shapes of walls; and which of these support disks."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from eventsim.formulas.doubt import NO_SPEED, TOUCHING, rounding_of
from eventsim.formulas.rest import Support
from eventsim.formulas.walls.arc import Arc
from eventsim.formulas.walls.boundary import Boundary
from eventsim.formulas.walls.container import Container
from eventsim.formulas.walls.face import Face, face, is_in_line, slope
from eventsim.formulas.walls.point import POINT, end_of
from eventsim.formulas.walls.post import Post
from eventsim.formulas.walls.shape import Shape, Thin
from eventsim.scene.disks import Floats
from eventsim.scene.domain import Channel, Domain, Open, Periodic, hard_sides
from eventsim.scene.joints import joints_of
from eventsim.scene.numbers import Point
from eventsim.scene.walls import Wall
from eventsim.scene.walls.wall import shifts


class Feature(NamedTuple):
    """A shape, the number of the wall that it belongs to, and whether disks also meet an image of it.

    part, image: the number of the shape of which this is an image, and which.  corners: what makes corners with it at its ends
    (`joints.Joints`), by number among the features.
    """

    shape: Shape
    wall: int
    imaged: bool
    part: int = 0
    image: tuple[int, int] = (0, 0)
    corners: tuple[int, int, int, int] = (0, 0, 0, 0)


def boundaries_of(domain: Domain) -> tuple[tuple[Boundary, ...], tuple[str, ...]]:
    """The hard walls of the domain, and their names."""
    if isinstance(domain, Open | Periodic):
        return (), ()
    width, height = domain.size
    if isinstance(domain, Channel):
        return (Boundary(1, 0.0, 1.0, 0), Boundary(1, height, -1.0, 1)), hard_sides(domain)
    return (
        Boundary(0, 0.0, 1.0, 0),
        Boundary(0, width, -1.0, 1),
        Boundary(1, 0.0, 1.0, 2),
        Boundary(1, height, -1.0, 3),
    ), hard_sides(domain)


def features_of(
    walls: Sequence[Wall],
    reach: float,
    corner: Point,
    period: tuple[float | None, float | None],
    boundaries: Sequence[Boundary],
) -> tuple[Feature, ...]:
    """All shapes, in the order of the walls; a point at which walls end has a post where it sticks out between them.

    reach: the largest radius of a disk.  corner: of the domain.  boundaries: of the domain, whose walls come first.
    """
    found: list[Feature] = []
    number, part = len(boundaries), 0
    along_x, along_y = (math.inf if length is None else length for length in period)
    rough = 0.0
    for wall in walls:
        moves = _moves(wall, reach, corner, (along_x, along_y))
        pieces: list[tuple[Shape, int]] = []
        for move_x, move_y in moves:

            def moved(p: Point, move: Point = (move_x, move_y)) -> Point:
                return (p[0] - corner[0]) + move[0], (p[1] - corner[1]) + move[1]

            pieces = wall.pieces(moved)
            image = round(move_x / along_x), round(move_y / along_y)
            found += [
                Feature(shape, number + owner, len(moves) > 1, part + k, image)
                for k, (shape, owner) in enumerate(pieces)
            ]
        part += len(pieces)
        number += len(wall.parts(""))
        rough = max(rough, *(piece.scale() for piece in wall.parts("") if not piece.curvature_radius()), 0.0)
    return _joined(found, boundaries, rough)


def count_with_images(walls: Sequence[Wall], reach: float, corner: Point, period: tuple[float | None, float | None]) -> int:
    """How many walls, edges counted, disks can meet: each as often as there are images of it; as `features_of`."""
    lengths = (math.inf if period[0] is None else period[0], math.inf if period[1] is None else period[1])
    return sum(len(wall.parts("")) * len(_moves(wall, reach, corner, lengths)) for wall in walls)


def _moves(wall: Wall, reach: float, corner: Point, period: Point) -> list[Point]:
    """The translations by periods (inf: none) that bring a wall within reach of disks."""
    return [(0.0, 0.0)] if wall.holds else shifts(wall.rectangle(), corner, period, reach)


def with_one_size(features: Sequence[Feature], radii: Floats) -> tuple[Feature, ...]:
    """The same features; those that share ends have one size where one of the radii is that of a point to some of them alone.

    Else the wall on one side of an end would leave a disk there to the post, or to the other wall, and these to that one.
    """
    joined = [k for k, one in enumerate(features) if isinstance(one.shape, Thin | Post)]
    every = [features[k].shape.size for k in joined]  # type: ignore[attr-defined]
    if not every or not _parts(radii, min(every), max(every)):
        return tuple(features)
    group = list(range(len(features)))

    def first_of(k: int) -> int:
        while group[k] != k:
            k = group[k]
        return k

    at: dict[Point, int] = {}
    for k in joined:
        for end in _ends(features[k].shape):
            one, other = first_of(at.setdefault(end, k)), first_of(k)
            group[max(one, other)] = min(one, other)
    sizes: dict[int, tuple[float, float]] = {}
    for k, size in zip(joined, every, strict=True):
        low, high = sizes.get(first_of(k), (size, size))
        sizes[first_of(k)] = min(low, size), max(high, size)
    mixed = {k for k, (low, high) in sizes.items() if _parts(radii, low, high)}
    found = list(features)
    for k in joined:
        if first_of(k) in mixed:
            shape = features[k].shape._replace(size=sizes[first_of(k)][1])  # type: ignore[attr-defined]
            found[k] = features[k]._replace(shape=shape)
    return tuple(found)


def _parts(radii: Floats, low: float, high: float) -> bool:
    """Whether a disk of one of these radii is a point to a wall of size `high`, and none to one of size `low`."""
    return bool(np.any((radii > POINT * low) & (radii <= POINT * high)))


def _ends(shape: Shape) -> tuple[Point, ...]:
    return ((shape.x, shape.y), (shape.x1, shape.y1)) if isinstance(shape, Thin) else ((shape.x, shape.y),)


def turn_of(surface: Boundary | Feature) -> int:
    """How the direction of a wall follows from its normal: see `Stage.turns`."""
    if isinstance(surface, Boundary):
        return -1 if surface.axis == 0 else 1
    shape = surface.shape
    if isinstance(shape, Face):
        return 1
    if isinstance(shape, Arc):
        return 1 if shape.sign > 0.0 else -1
    return 0 if isinstance(shape, Post) else -1


def moved_on(features: Sequence[Feature], step: tuple[int, int]) -> tuple[int, ...]:
    """For each feature the number of the one whose place it takes once a disk has wrapped by (kx, ky); -1: there is none."""
    number = {(one.part, one.image): k for k, one in enumerate(features)}
    return tuple(number.get((one.part, (one.image[0] + step[0], one.image[1] + step[1])), -1) for one in features)


def _joined(found: list[Feature], boundaries: Sequence[Boundary], rough: float) -> tuple[Feature, ...]:
    """The same features, with what is at their ends; posts only where they can be met, and once."""
    thin = [(k, one.shape) for k, one in enumerate(found) if isinstance(one.shape, Thin)]
    posts = [(k, one.shape) for k, one in enumerate(found) if isinstance(one.shape, Post)]
    containers = [one.shape for one in found if isinstance(one.shape, Container)]
    joints = joints_of(
        [shape for _, shape in thin], [(post.x, post.y) for _, post in posts], containers, boundaries, rough
    )
    shapes: dict[int, Shape | None] = {k: one.shape for k, one in enumerate(found)}
    taken: set[Post | None] = {None}
    for (k, _), post in zip(posts, joints.posts, strict=True):
        shapes[k] = None if post in taken else post
        taken.add(post)
    for (k, shape), ends, beside in zip(thin, joints.ends, joints.beside, strict=True):
        shapes[k] = shape.with_ends(ends, *beside)
    number = {k: n for n, k in enumerate(k for k, shape in shapes.items() if shape is not None)}
    corners = {
        k: tuple((number[thin[abs(code) - 1][0]] + 1) * (1 if code > 0 else -1) if code else 0 for code in codes)
        for (k, _), codes in zip(thin, joints.corners, strict=True)
    }
    none = 0, 0, 0, 0
    return tuple(
        found[k]._replace(shape=shape, corners=corners.get(k, none))  # type: ignore[arg-type]
        for k, shape in shapes.items()
        if shape is not None
    )


def supports_of(
    borders: Sequence[tuple[int, float]],
    faces: Sequence[Face | None],
    gravity: tuple[float, float],
    shares: Sequence[float],
) -> tuple[Support | None, ...]:
    """The supports that walls of the domain (axis, position) and shapes give; None for a shape that is no face, or gives none.

    shares: what comes back of low bounces on each shape.  Where they differ, bounces on walls in line are no one series.
    """
    straight = [one for one in faces if one is not None]
    kinds = {share: k for k, share in enumerate(dict.fromkeys(shares))}
    inside: list[Support | None] = []
    for one, share in zip(faces, shares, strict=True):
        support = None if one is None else face_support(one, straight, gravity)
        inside.append(support and support._replace(line=support.line + kinds[share] * len(straight)))
    return (*(border_support(*border, gravity, -1 - k) for k, border in enumerate(borders)), *inside)


def border_support(axis: int, position: float, gravity: tuple[float, float], line: int) -> Support:
    """The support that a wall of the domain across an axis gives; its normal points up the axis, as side +1 says."""
    piece = face(position, 1.0, position, 0.0) if axis == 0 else face(0.0, position, 1.0, position)
    return Support(piece, *slope(piece, *gravity), -math.inf, math.inf, line)


def face_support(one: Face, faces: Sequence[Face], gravity: tuple[float, float]) -> Support:
    """The support that one of the faces of a scene gives; O(n log n) for n of them."""
    pieces, line = [], -1
    for k, other in enumerate(faces):
        ends = (other.x, other.y), (other.x + other.ex, other.y + other.ey)
        if all(is_in_line(one, *end) for end in ends):
            line = k if line < 0 else line
            pieces.append(sorted(one.ex * (x - one.x) + one.ey * (y - one.y) for x, y in ends))
    slack = TOUCHING * one.along2
    low, high = 0.0, one.along2
    for begin, end in sorted(pieces):
        if begin <= high + slack and end >= low - slack:
            high = max(high, end)
    for begin, end in sorted(pieces, key=lambda piece: -piece[1]):
        if begin <= high + slack and end >= low - slack:
            low = min(low, begin)
    first_sealed, second_sealed = (end_of(one.ends, second, 1)[1] for second in (False, True))
    low = -math.inf if first_sealed and low == 0.0 else low  # nothing slides over an end on another wall
    high = math.inf if second_sealed and high == one.along2 else high
    return Support(one, *slope(one, *gravity), low, high, line)


def any_lies(support: Support, flights: tuple[Floats, ...], radius: Floats, gravity: tuple[float, float]) -> bool:
    """Whether one of the disks lies on a support: pressed onto it, and without a velocity across it.

    flights: x, y, vx, vy, (n,) each.
    """
    shape, (x, y, vx, vy) = support.face, flights
    distance, fall = shape.nx * (x - shape.x) + shape.ny * (y - shape.y), shape.nx * gravity[0] + shape.ny * gravity[1]
    along = shape.ex * (x - shape.x) + shape.ey * (y - shape.y)
    gap, rate = np.abs(distance) - radius * shape.norm, shape.nx * vx + shape.ny * vy
    scale = shape.norm * (np.abs(x) + np.abs(y) + abs(shape.x) + abs(shape.y) + radius)
    touches = (np.abs(gap) <= TOUCHING * scale) & (support.low <= along) & (along <= support.high)
    rounded = NO_SPEED * rounding_of(shape.nx * vx, shape.ny * vy) if shape.nx != 0.0 and shape.ny != 0.0 else 0.0
    still = (rate * rate <= 8.0 * abs(fall) * np.abs(gap)) | (np.abs(rate) <= rounded)
    pressed = (np.sign(distance) * fall < 0.0) | (radius * shape.norm <= TOUCHING * scale)  # places tell no side of points
    return bool(np.any(touches & still & pressed & (fall != 0.0)))
