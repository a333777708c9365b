"""Which disks of a scene reach into each other, into walls or out of the domain, and how deep."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from eventsim.scene.cells import Cells, Indices
from eventsim.scene.corner import corner_of
from eventsim.scene.disks import Disks, Floats
from eventsim.scene.domain import BOUNDARY_NAMES, Domain, Open
from eventsim.scene.numbers import Point
from eventsim.scene.walls.wall import Part, shifts

# Decimal input and lattices are rounded: an overlap up to so many units in the last place of the largest
# coordinate or reach counts as touching.
TOUCHING_ULP = 16
# More overlaps than this are not counted: somebody put a whole gas in one place.
ENOUGH = 100_000
EVERYWHERE = (-math.inf, -math.inf), (math.inf, math.inf)


@dataclass(frozen=True, slots=True)
class Found:
    """M overlaps, ordered by disk; `other` is a disk, a piece of a wall or a side of the domain.

    Attributes:
        disk, other: indices (M,).
        depth: length (M,), positive.
        rounding: depth (M,) up to which an overlap counts as touching.
    """

    disk: Indices
    other: Indices
    depth: Floats
    rounding: Floats

    def touching(self) -> Found:
        """Those that count as touching."""
        return self._where(self.depth <= self.rounding)

    def broken(self) -> Found:
        """Those that are deeper than rounding explains."""
        return self._where(self.depth > self.rounding)

    def __len__(self) -> int:
        return len(self.disk)

    def _where(self, mask: np.ndarray[tuple[int], np.dtype[np.bool_]]) -> Found:
        return Found(self.disk[mask], self.other[mask], self.depth[mask], self.rounding[mask])


def period_of(domain: Domain) -> Point:
    """The period of a domain along x and y; inf where there is none."""
    along_x, along_y = domain.period
    return math.inf if along_x is None else along_x, math.inf if along_y is None else along_y


def pair_overlaps(disks: Disks, domain: Domain, parts: Sequence[Part]) -> Found:
    """Pairs of disks that overlap, disk < other; all positions inside the domain.

    Near O(N), also where radii differ widely; the search ends when ENOUGH have been found.
    """
    corner = corner_of(disks, domain, parts)
    position = disks.position - np.array(corner)
    scale = coordinate_scale(disks, corner)
    chunks: list[Found] = []
    count = 0
    for found in Cells(position, disks.radius, disks.mass, period_of(domain)).pairs():
        low, high = np.minimum(found.first, found.second), np.maximum(found.first, found.second)
        reach = disks.radius[low] + disks.radius[high]
        rounding = touching_depth(np.maximum(np.maximum(scale[low], scale[high]), reach))
        chunks.append(Found(low, high, found.depth, rounding))
        count += len(low)
        if count >= ENOUGH:
            break
    return _gather(chunks)


def feature_overlaps(disks: Disks, domain: Domain, parts: Sequence[Part]) -> Found:
    """Disks that lie across a wall or reach out of a container; `other` counts the pieces."""
    corner = corner_of(disks, domain, parts)
    scale = coordinate_scale(disks, corner)
    chunks: list[Found] = []
    for index, near, deep in wall_overlaps(
        parts, disks.position, disks.radius, domain.origin, period_of(domain)
    ):
        size = parts[index].scale(corner)
        rounding = touching_depth(np.maximum(scale[near], size))
        chunks.append(Found(near, np.full(len(near), index), deep, rounding))
    return _gather(chunks)


def boundary_overlaps(disks: Disks, domain: Domain) -> Found:
    """Disks that reach out of the hard sides of the domain; `other` counts BOUNDARY_NAMES."""
    if isinstance(domain, Open):
        return _gather([])
    rounding = touching_depth(np.maximum(coordinate_scale(disks, domain.origin), max(domain.size)))
    chunks: list[Found] = []
    for side in range(len(BOUNDARY_NAMES)):
        axis, upper = divmod(side, 2)
        if domain.periodic[axis]:
            continue
        place = disks.position[:, axis] - domain.origin[axis]
        deep = disks.radius - (domain.size[axis] - place if upper else place)
        out = np.flatnonzero(deep > 0.0)
        chunks.append(Found(out, np.full(len(out), side), deep[out], rounding[out]))
    return _gather(chunks)


def touching_depth(scale: Floats) -> Floats:
    """The depth up to which an overlap counts as touching, where the largest length is `scale`."""
    depth: Floats = TOUCHING_ULP * np.spacing(scale)
    return depth


def coordinate_scale(disks: Disks, corner: Point) -> Floats:
    """The largest length that the place of each disk is rounded to, (N,).

    That is its coordinate as given, its coordinate from the corner, or its radius.
    """
    given = np.abs(disks.position).max(axis=1)
    relative = np.abs(disks.position - np.array(corner)).max(axis=1)
    scale: Floats = np.maximum(np.maximum(given, relative), disks.radius)
    return scale


def wall_overlaps(
    parts: Sequence[Part], position: Floats, radius: Floats, origin: Point, period: Point
) -> Iterator[tuple[int, Indices, Floats]]:
    """For each piece of a wall, and image of it, that disks reach into: its index, the disks (M,), their depths (M,).

    Walls have images along a direction of finite `period`; those that hold disks have none. Near O(N) where the pieces
    are small.
    """
    if not len(radius):
        return
    groups = [_by_x(members, position) for members in _octaves(radius)]
    largest = float(radius.max())
    for index, part in enumerate(parts):
        low, high = box = part.bounds()
        moves = shifts(box, origin, period, largest)
        if part.holds:  # a disk anywhere outside of it is across it
            (low, high), moves = EVERYWHERE, [(0.0, 0.0)]
        for (members, x), shift in product(groups, moves):
            reach = radius[members].max()
            first = np.searchsorted(x, low[0] + shift[0] - reach, side="left")
            last = np.searchsorted(x, high[0] + shift[0] + reach, side="right")
            near = members[first:last]
            y = position[near, 1] - shift[1]
            near = near[(y >= low[1] - reach) & (y <= high[1] + reach)]
            depth = part.depth(position[near] - shift, radius[near])
            deep = depth > 0.0
            if deep.any():
                yield index, near[deep], depth[deep]


def _octaves(radius: Floats) -> list[Indices]:
    """Indices of the disks, grouped by the octave of their radius."""
    octave = np.frexp(radius)[1]
    return [np.flatnonzero(octave == level) for level in np.unique(octave)]


def _by_x(members: Indices, position: Floats) -> tuple[Indices, Floats]:
    """The members sorted by x, and their x."""
    order = members[np.argsort(position[members, 0])]
    return order, position[order, 0]


def _gather(chunks: list[Found]) -> Found:
    """Overlaps ordered by disk and other; of a pair that overlaps in several images the deepest."""
    none = np.empty(0, dtype=np.int64)
    disk = np.concatenate([none, *(chunk.disk for chunk in chunks)])
    other = np.concatenate([none, *(chunk.other for chunk in chunks)])
    depth = np.concatenate([np.empty(0), *(chunk.depth for chunk in chunks)])
    rounding = np.concatenate([np.empty(0), *(chunk.rounding for chunk in chunks)])
    order = np.lexsort((-depth, other, disk))
    disk, other = disk[order], other[order]
    first = np.ones(len(disk), dtype=np.bool_)
    first[1:] = (disk[1:] != disk[:-1]) | (other[1:] != other[:-1])
    return Found(disk[first], other[first], depth[order][first], rounding[order][first])
