"""Which side points are on, told without the package: by exact rationals for the first contact, by regions for the rest.

A wall here is a segment of two points, or a circle; nothing is shared with `eventsim` but the scene's numbers.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from typing import NamedTuple

Point = tuple[float, float]


class Hit(NamedTuple):
    """The first contact of a straight flight: when, with which segments, and whether it is exactly at the end of one."""

    time: Fraction
    walls: tuple[int, ...]
    exact: bool


def first_hit(start: Point, velocity: Point, segments: Sequence[tuple[Point, Point]]) -> Hit | None:
    """The first segment that a point flies into, in exact rationals; one that it begins on does not count."""
    x, y, u, w = map(Fraction, (*start, *velocity))
    best: Hit | None = None
    for k, (one, other) in enumerate(segments):
        ax, ay, bx, by = map(Fraction, (*one, *other))
        ex, ey = bx - ax, by - ay
        across = u * ey - w * ex
        if across == 0:
            continue
        time = ((ax - x) * ey - (ay - y) * ex) / across
        share = ((ax - x) * w - (ay - y) * u) / across
        if time <= 0 or not 0 <= share <= 1:
            continue
        at_end = share in (0, 1)
        if best is None or time < best.time:
            best = Hit(time, (k,), at_end)
        elif time == best.time:
            best = Hit(time, (*best.walls, k), best.exact or at_end)
    return best


def reflected(velocity: Point, segment: tuple[Point, Point], restitution: float) -> tuple[float, float]:
    """The velocity after contact with a segment, rounded once."""
    (ax, ay), (bx, by) = segment
    nx, ny = Fraction(ay) - Fraction(by), Fraction(bx) - Fraction(ax)
    u, w = map(Fraction, velocity)
    q = (1 + Fraction(restitution)) * (nx * u + ny * w) / (nx * nx + ny * ny)
    return float(u - q * nx), float(w - q * ny)


def is_inside(corners: Sequence[Point], x: float, y: float) -> bool:
    """Whether a place is inside a polygon; exact."""
    inside = False
    px, py = Fraction(x), Fraction(y)
    for (ax, ay), (bx, by) in zip(corners, (*corners[1:], corners[0]), strict=True):
        if (ay > y) != (by > y):
            fax, fay, fbx, fby = map(Fraction, (ax, ay, bx, by))
            if px < fax + (fbx - fax) * (py - fay) / (fby - fay):
                inside = not inside
    return inside


def margin(corners: Sequence[Point], x: float, y: float) -> float:
    """The distance of a place from the edges of a polygon."""
    return min(
        segment_distance(one, other, x, y) for one, other in zip(corners, (*corners[1:], corners[0]), strict=True)
    )


def segment_distance(one: Point, other: Point, x: float, y: float) -> float:
    """The distance of a place from a segment."""
    (ax, ay), (bx, by) = one, other
    ex, ey = bx - ax, by - ay
    share = min(1.0, max(0.0, ((x - ax) * ex + (y - ay) * ey) / (ex * ex + ey * ey)))
    return math.hypot(x - ax - share * ex, y - ay - share * ey)


def floor_height(points: Sequence[Point], x: float) -> float:
    """The height of a chain over x, which grows along it."""
    for (ax, ay), (bx, by) in pairwise(points):
        if ax <= x <= bx:
            return ay + (by - ay) * ((x - ax) / (bx - ax))
    raise ValueError(x)


def is_valley(points: Sequence[Point], x: float, y: float, near: float) -> bool:
    """Whether a place is at a point of a chain between two borders from which both ways lead up."""
    for k, (px, py) in enumerate(points):
        beside = [points[j][1] for j in (k - 1, k + 1) if 0 <= j < len(points)]
        if math.hypot(x - px, y - py) <= near and min(beside) > py:
            return True
    return False
