"""Who is near whom in a periodic domain: pairs within a distance, and neighbours in Voronoi's sense.

Both are scipy's, which freud brings along: its tree finds pairs, and its triangulation (Delaunay's) has an edge where two Voronoi
cells share a side.  The triangulation knows no periods, so it is made of the places and as many of their images as matter.
"""

from __future__ import annotations

import math
from itertools import product
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from eventsim.record.events import Floats

Indices: TypeAlias = NDArray[np.int64]

MARGIN = 4.0
"""How wide the rim of images is at first, in mean distances between neighbours; it doubles until it is wide enough."""

TILE = 80.0
"""Side of a tile whose points are triangulated together, in the same unit."""


def wrapped(place: Floats, size: Floats) -> Floats:
    """Places (n, 2) in a domain that begins at 0: at least 0 and below its size, however they are rounded."""
    inside: Floats = place - size * np.floor(place / size)
    return np.where(inside < size, inside, 0.0)


def pairs_within(place: Floats, size: Floats, far: float) -> Indices:
    """All pairs (m, 2) nearer than `far`, which is less than half of each side; each once, the smaller number first.

    place: (n, 2), at least 0 and below the size (2,) of the domain.
    """
    from scipy.spatial import cKDTree

    found: Indices = cKDTree(place, boxsize=size).query_pairs(far, output_type="ndarray")
    return found


def voronoi_neighbours(place: Floats, size: Floats) -> tuple[Indices, Indices, Floats]:
    """Neighbours in Voronoi's sense: (one, other, from one to the other (m, 2)), each pair in both directions.

    The domain is looked at tile by tile: a triangulation of many points is slower than several ones of few, which caches hold.

    place: (n, 2), at least 0 and below the size (2,) of the domain, n >= 3.
    """
    spacing = math.sqrt(float(size.prod()) / len(place))
    tiles = np.maximum(size // (TILE * spacing), 1.0)
    margin = MARGIN * spacing
    while True:
        points, own = _with_images(place, size, margin)
        found = [
            _neighbours_in(points, len(place), size * corner / tiles, size * (np.array(corner) + 1.0) / tiles, margin)
            for corner in product(*(range(int(count)) for count in tiles))
        ]
        edges = [edge for edge in found if edge is not None]
        if len(edges) == len(found):
            break
        margin *= 2.0
    one, other = np.concatenate(edges, axis=1)
    return one, own[other], points[other] - points[one]


def _neighbours_in(points: Floats, n: int, low: Floats, high: Floats, margin: float) -> Indices | None:
    """Edges (2, m) from those of the first n points that lie in a tile; None where the margin around it is too narrow."""
    x, y = points.T
    (left, bottom), (right, top) = low.tolist(), high.tolist()
    inside = (x[:n] >= left) & (x[:n] < right) & (y[:n] >= bottom) & (y[:n] < top)
    around = (x > left - margin) & (x < right + margin) & (y > bottom - margin) & (y < top + margin)
    around[:n] &= ~inside
    local = np.concatenate([np.flatnonzero(inside), np.flatnonzero(around)])
    mine = int(inside.sum())
    corners = _triangles(points[local])
    corners = corners[(corners < mine).any(axis=1)]
    if not _is_settled(points[local[corners]], low, high, margin):
        return None
    # triangles turn counter-clockwise, so an edge of two triangles comes once in each direction
    one, other = corners.T.ravel(), np.roll(corners, -1, axis=1).T.ravel()
    kept = one < mine
    return np.stack([local[one[kept]], local[other[kept]]])


def _with_images(place: Floats, size: Floats, margin: float) -> tuple[Floats, Indices]:
    """The places, behind them their images within a margin around the domain, and whose each is."""
    points, own = [place], [np.arange(len(place))]
    reach = [range(-k, k + 1) for k in (math.ceil(margin / length) for length in size.tolist())]
    for image in product(*reach):
        if any(image):
            moved = place + size * np.array(image)
            near = np.flatnonzero(((moved > -margin) & (moved < size + margin)).all(axis=1))
            points.append(moved[near])
            own.append(near)
    return np.asfortranarray(np.concatenate(points)), np.concatenate(own)


def _triangles(points: Floats) -> Indices:
    """Delaunay's triangles (m, 3), each counter-clockwise."""
    from scipy.spatial import Delaunay

    found: Any = Delaunay(points)
    corners: Indices = found.simplices.astype(np.int64)
    return corners


def _is_settled(corners: Floats, low: Floats, high: Floats, margin: float) -> bool:
    """Whether no point beyond a margin around a tile lies in a circle through the corners of one of these triangles (m, 3, 2)."""
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        twice = 2.0 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
        a2, b2 = (a * a).sum(axis=1), (b * b).sum(axis=1)
        middle = np.column_stack([b[:, 1] * a2 - a[:, 1] * b2, a[:, 0] * b2 - b[:, 0] * a2]) / twice[:, None]
        radius = np.hypot(middle[:, 0], middle[:, 1])[:, None]
        middle = middle + corners[:, 0]
        return bool(((middle - radius > low - margin) & (middle + radius < high + margin)).all())
