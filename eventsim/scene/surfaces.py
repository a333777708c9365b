"""What disks can meet besides each other: boundaries of the domain, and walls broken up into shapes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from eventsim.formulas.walls.boundary import Boundary
from eventsim.formulas.walls.shape import Shape
from eventsim.scene.domain import BOUNDARY_NAMES, Channel, Domain, Open, Periodic
from eventsim.scene.numbers import Point
from eventsim.scene.walls import Wall
from eventsim.scene.walls.wall import Bounds, shifts


class Feature(NamedTuple):
    """A shape, the number of the wall that it belongs to, and whether disks also meet an image of it."""

    shape: Shape
    wall: int
    imaged: bool


def boundaries_of(domain: Domain) -> tuple[tuple[Boundary, ...], tuple[str, ...]]:
    """The hard walls of the domain, and their names."""
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
    walls: Sequence[Wall], reach: float, corner: Point, period: tuple[float | None, float | None], first_wall: int
) -> tuple[Feature, ...]:
    """All shapes, in the order of the walls.

    reach: the largest radius of a disk.  corner: of the domain.  first_wall: the number of the first wall.
    """
    features: list[Feature] = []
    number = first_wall
    along_x, along_y = (math.inf if length is None else length for length in period)
    for wall in walls:
        moves = [(0.0, 0.0)] if wall.holds else shifts(_bounds(wall), corner, (along_x, along_y), reach)
        for move_x, move_y in moves:

            def moved(p: Point, move: Point = (move_x, move_y)) -> Point:
                return (p[0] - corner[0]) + move[0], (p[1] - corner[1]) + move[1]

            features += [Feature(shape, number + part, len(moves) > 1) for shape, part in wall.pieces(moved)]
        number += len(wall.parts(""))
    return tuple(features)


def _bounds(wall: Wall) -> Bounds:
    """The rectangle that a wall lies in."""
    found = [part.bounds() for part in wall.parts("")]
    x0, y0 = (min(low[axis] for low, _ in found) for axis in (0, 1))
    x1, y1 = (max(high[axis] for _, high in found) for axis in (0, 1))
    return (x0, y0), (x1, y1)
