"""How deep disks reach into walls: vectorised distances, to place and check disks (not for contacts)."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import product

import numpy as np

from eventsim.scene.cells import Indices
from eventsim.scene.disks import Floats
from eventsim.scene.numbers import Point
from eventsim.scene.walls import Arc, Circle, Feature


def circle_through(start: Point, through: Point, end: Point) -> tuple[Point, float]:
    """Centre and radius of the circle through three points; the radius is inf where they lie on a line."""
    ax, ay = through[0] - start[0], through[1] - start[1]
    bx, by = end[0] - start[0], end[1] - start[1]
    # In units of the largest of them, products neither overflow nor vanish.
    unit = max(abs(ax), abs(ay), abs(bx), abs(by)) or 1.0
    ax, ay, bx, by = ax / unit, ay / unit, bx / unit, by / unit
    twice_area = 2.0 * (ax * by - ay * bx)
    if twice_area == 0.0:
        return start, math.inf
    a2, b2 = ax * ax + ay * ay, bx * bx + by * by
    cx, cy = unit * ((by * a2 - ay * b2) / twice_area), unit * ((ax * b2 - bx * a2) / twice_area)
    return (start[0] + cx, start[1] + cy), math.hypot(cx, cy)


def wall_depth(feature: Feature, position: Floats, radius: Floats | float) -> Floats:
    """How deep disks at `position` (M, 2) reach into a wall, (M,): radius minus distance.

    For a container it is how far they reach out of it.
    """
    if isinstance(feature, Circle):
        return _distance(position, feature.center) + radius - feature.radius
    if isinstance(feature, Arc):
        return radius - _arc_distance(feature, position)
    return radius - _segment_distance(feature.start, feature.end, position)


def wall_overlaps(
    features: Sequence[Feature], position: Floats, radius: Floats, origin: Point, period: Point
) -> Iterator[tuple[int, Indices, Floats]]:
    """For each feature, and image of it, that disks reach into: its index, the disks (M,), their depths (M,).

    Walls have images along a direction of finite `period`; containers have none. Near O(N) where the features
    are small.
    """
    if not len(radius):
        return
    groups = [_by_x(members, position) for members in _octaves(radius)]
    largest = float(radius.max())
    for index, feature in enumerate(features):
        low, high = bounds(feature)
        if isinstance(feature, Circle):
            shifts = [(0.0, 0.0)]
        else:
            along_x, along_y = (_images(low[k], high[k], origin[k], period[k], largest) for k in (0, 1))
            shifts = list(product(along_x, along_y))
        for (members, x), shift in product(groups, shifts):
            reach = radius[members].max()
            first = np.searchsorted(x, low[0] + shift[0] - reach, side="left")
            last = np.searchsorted(x, high[0] + shift[0] + reach, side="right")
            near = members[first:last]
            y = position[near, 1] - shift[1]
            near = near[(y >= low[1] - reach) & (y <= high[1] + reach)]
            depth = wall_depth(feature, position[near] - shift, radius[near])
            deep = depth > 0.0
            if deep.any():
                yield index, near[deep], depth[deep]


def _images(low: float, high: float, origin: float, period: float, reach: float) -> list[float]:
    """The translations that bring a wall from `low` to `high` within reach of the domain, along one axis."""
    if math.isinf(period):
        return [0.0]
    first = math.ceil((origin - reach - high) / period)
    last = math.floor((origin + period + reach - low) / period)
    return [k * period for k in range(first, last + 1)]


def _octaves(radius: Floats) -> list[Indices]:
    """Indices of the disks, grouped by the octave of their radius."""
    octave = np.frexp(radius)[1]
    return [np.flatnonzero(octave == level) for level in np.unique(octave)]


def _by_x(members: Indices, position: Floats) -> tuple[Indices, Floats]:
    """The members sorted by x, and their x."""
    order = members[np.argsort(position[members, 0])]
    return order, position[order, 0]


def bounds(feature: Feature) -> tuple[Point, Point]:
    """A rectangle (lower-left, upper-right) outside of which no disk centre can touch, but for its radius."""
    if isinstance(feature, Circle):
        # A disk anywhere outside the container is across it.
        return (-math.inf, -math.inf), (math.inf, math.inf)
    if isinstance(feature, Arc):
        (x, y), r = circle_through(feature.start, feature.through, feature.end)
        return (x - r, y - r), (x + r, y + r)
    (x0, y0), (x1, y1) = feature.start, feature.end
    return (min(x0, x1), min(y0, y1)), (max(x0, x1), max(y0, y1))


def _distance(position: Floats, center: Point) -> Floats:
    """Distances (M,) of positions (M, 2) from a point."""
    distance: Floats = np.hypot(position[:, 0] - center[0], position[:, 1] - center[1])
    return distance


def _segment_distance(start: Point, end: Point, position: Floats) -> Floats:
    """Distances (M,) of positions (M, 2) from a segment of positive length."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    length = math.hypot(dx, dy)
    tx, ty = dx / length, dy / length
    px, py = position[:, 0] - start[0], position[:, 1] - start[1]
    along = tx * px + ty * py
    beside = np.abs(tx * py - ty * px)
    ends = np.minimum(_distance(position, start), _distance(position, end))
    return np.where((along >= 0.0) & (along <= length), beside, ends)


def _arc_distance(arc: Arc, position: Floats) -> Floats:
    """Distances (M,) of positions (M, 2) from an arc that is not a straight line."""
    center, radius = circle_through(arc.start, arc.through, arc.end)
    from_center = _distance(position, center)
    with np.errstate(invalid="ignore", divide="ignore"):
        scale = np.where(from_center > 0.0, radius / from_center, 0.0)
    # The nearest point of the whole circle is on the arc if it is on the same side of the chord as `through`.
    foot_x = center[0] + (position[:, 0] - center[0]) * scale - arc.start[0]
    foot_y = center[1] + (position[:, 1] - center[1]) * scale - arc.start[1]
    chord_x, chord_y = arc.end[0] - arc.start[0], arc.end[1] - arc.start[1]
    through_x, through_y = arc.through[0] - arc.start[0], arc.through[1] - arc.start[1]
    turn = chord_x * through_y - chord_y * through_x
    # only the sign of turn, whose product with another area may be no float
    on_arc = (chord_x * foot_y - chord_y * foot_x) * np.sign(turn) >= 0.0
    ends = np.minimum(_distance(position, arc.start), _distance(position, arc.end))
    return np.where((from_center == 0.0) | on_arc, np.abs(from_center - radius), ends)
