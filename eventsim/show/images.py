"""Images: what of disks and walls is to be drawn again on the other side of a periodic domain."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from eventsim.record.events import Floats
from eventsim.scene import Scene


def disks_with_images(position: Floats, radius: Floats, scene: Scene) -> tuple[Floats, NDArray[np.int64]]:
    """Return the places (M, 2) where disks are seen, and which disk (M,) each is: those across a boundary repeated."""
    disk = np.arange(len(position))
    for axis, period in enumerate(scene.domain.period):
        if period is None:
            continue
        corner = scene.domain.origin[axis]
        below = position[:, axis] - radius[disk] < corner
        above = position[:, axis] + radius[disk] > corner + period
        step = np.zeros(2)
        step[axis] = period
        position = np.concatenate([position, position[below] + step, position[above] - step])
        disk = np.concatenate([disk, disk[below], disk[above]])
    return position, disk


def lines_with_images(lines: Sequence[Floats], scene: Scene) -> list[Floats]:
    """Return lines of points (K, 2) and those of their images that reach into a periodic domain."""
    seen = [np.asarray(line) for line in lines]
    for axis, period in enumerate(scene.domain.period):
        if period is None:
            continue
        step = np.zeros(2)
        step[axis] = period
        low, high = scene.domain.origin[axis], scene.domain.origin[axis] + period
        shifted = [line + k * step for line, k in product(seen, (-1, 1))]
        seen += [line for line in shifted if line[:, axis].max() > low and line[:, axis].min() < high]
    return seen


def wrapped_pieces(
    ends: Floats,
    disk: NDArray[np.int64],
    period: tuple[float | None, float | None],
    corner: tuple[float, float],
) -> tuple[Floats, NDArray[np.int64]]:
    """Return pieces (P, 2, 2), and the disk (P,) of each, repeated in every image of the domain that they pass through."""
    for axis, length in enumerate(period):
        if length is None:
            continue
        cell = np.floor((ends[:, :, axis] - corner[axis]) / length).astype(np.int64)
        low, high = cell.min(axis=1), cell.max(axis=1)
        count = high - low + 1
        which = np.repeat(np.arange(len(ends)), count)
        place = np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)
        ends, disk = ends[which].copy(), disk[which]
        ends[:, :, axis] -= ((low[which] + place) * length)[:, None]
    return ends, disk
