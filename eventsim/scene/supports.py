"""Which walls can support a disk under gravity, and how far: the straight ones."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from eventsim.formulas.rest import Support
from eventsim.formulas.walls.face import TOUCHING, Face, face, is_in_line, slope

Floats: TypeAlias = NDArray[np.float64]


def supports_of(
    borders: Sequence[tuple[int, float]], faces: Sequence[Face | None], gravity: tuple[float, float]
) -> tuple[Support | None, ...]:
    """The supports that walls of the domain (axis, position) and shapes give; None for a shape that is no face, or gives none."""
    straight = [one for one in faces if one is not None]
    inside = [None if one is None else face_support(one, straight, gravity) for one in faces]
    return (*(border_support(*border, gravity) for border in borders), *inside)


def border_support(axis: int, position: float, gravity: tuple[float, float]) -> Support:
    """The support that a wall of the domain across an axis gives; its normal points up the axis, as side +1 says."""
    line = face(position, 1.0, position, 0.0) if axis == 0 else face(0.0, position, 1.0, position)
    return Support(line, *slope(line, *gravity), -math.inf, math.inf)


def face_support(one: Face, faces: Sequence[Face], gravity: tuple[float, float]) -> Support:
    """The support that one of the faces of a scene gives; O(n log n) for n of them."""
    pieces = []
    for other in faces:
        ends = (other.x, other.y), (other.x + other.ex, other.y + other.ey)
        if all(is_in_line(one, *end) for end in ends):
            pieces.append(sorted(one.ex * (x - one.x) + one.ey * (y - one.y) for x, y in ends))
    slack = TOUCHING * one.along2
    low, high = 0.0, one.along2
    for begin, end in sorted(pieces):
        if begin <= high + slack and end >= low - slack:
            high = max(high, end)
    for begin, end in sorted(pieces, key=lambda piece: -piece[1]):
        if begin <= high + slack and end >= low - slack:
            low = min(low, begin)
    return Support(one, *slope(one, *gravity), low, high)


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
    still = rate * rate <= 8.0 * abs(fall) * np.abs(gap)
    return bool(np.any(touches & still & (np.sign(distance) * fall < 0.0)))
