"""Sizes: how wide the cells are, how many slots they have, how long a day of the calendar is."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from eventsim.engines.reference.cells import MARGIN
from eventsim.record.events import Floats
from eventsim.scene.stage import Stage

FEWEST_COLUMNS = 5
"""Along a period: disks in neighbouring cells are then nearer than half a period, so their image is the nearest one."""

WIDEST = 1.41
"""In reaches: four centres of equal disks at most fit into a square cell that is narrower than sqrt 2 reaches."""

DILUTE, VERY_DILUTE = 1.6, 2.4
"""Mean distance of disks, in reaches, from which on wide cells, and cells with room for several disks, pay."""

MANY_DISKS = 50_000
"""From here on the records outgrow the caches: memory is prefetched, and days are shorter."""

LOOK_AHEAD = 32
"""Days at which the prefetch begins."""

SHARE, SHARE_OF_MANY = 1.4, 0.7
"""The length of a day, in mean times between two scheduled events (the two disks of a contact have one each)."""

LEAST_DAYS = 64


class Sizes(NamedTuple):
    """A grid of cells: its corner, how many columns and rows, how wide, how many slots each."""

    low: tuple[float, float]
    columns: int
    rows: int
    side: tuple[float, float]
    depth: int


def cell_sizes(stage: Stage, x: Floats, y: Floats, depth: int) -> Sizes | None:
    """The cells for disks at (x, y); None where a period is too short for cells: everyone looks at everyone.

    In an open domain the grid covers twice the extent of the disks and is made anew when one leaves it.
    """
    least = 2.0 * float(stage.radius.max()) * MARGIN
    if stage.size is None:
        low, size = _around(x, y)
    else:
        low, size = (0.0, 0.0), stage.size
    spacing = math.sqrt(size[0]) * math.sqrt(size[1]) / math.sqrt(stage.n)
    if not spacing > 0.0:
        spacing = least or 1.0
    wide = max(least, 1e-6 * max(size))
    if spacing < DILUTE * least:
        side, most = wide, False
    elif spacing < VERY_DILUTE * least and np.ptp(stage.radius) == 0.0:
        side, most = WIDEST * least, True
    else:
        side, depth, most = max(wide, spacing), max(depth, 8), False
    columns, rows = (_number(length, side, wide, most) for length in size)
    for count, length in zip((columns, rows), stage.period, strict=True):
        if length is not None and count < FEWEST_COLUMNS:
            return None
    return Sizes(low, columns, rows, (size[0] / columns, size[1] / rows), depth)


def _around(x: Floats, y: Floats) -> tuple[tuple[float, float], tuple[float, float]]:
    """Corner and size of a rectangle around all centres, with as much room again on each side as they fill."""
    low = float(x.min()), float(y.min())
    size = [float(np.ptp(x)), float(np.ptp(y))]
    room = max(*size) or 1.0
    return (low[0] - room, low[1] - room), (size[0] + 2.0 * room, size[1] + 2.0 * room)


def _number(length: float, side: float, least: float, most: bool) -> int:
    """How many cells along a length: as wide as `side` at most, or at least; never narrower than `least`."""
    count = math.ceil(length / side) if most else int(length / side)
    return max(1, min(count, int(length / least) if least > 0.0 else count))


def days_of(n: int) -> int:
    """The number of days in the calendar, a power of two."""
    return 1 << max(LEAST_DAYS, (8 if n >= MANY_DISKS else 4) * n).bit_length() - 1


def shortest_day(end: float) -> float:
    """Days of a window that ends at `end` are so long at least that their numbers stay exact."""
    return max(math.ldexp(end, -40), 1e-300)


def day_length(due: Floats, now: float, end: float, n: int) -> float:
    """A day that has less than one event: from how soon the next events of the disks are."""
    ahead = due[np.isfinite(due)] - now
    least = shortest_day(end)
    if not len(ahead):
        return max(end, least)
    k = max(1, len(ahead) // 8)
    share = np.partition(ahead, k - 1)[k - 1] / k
    return float(max((SHARE_OF_MANY if n >= MANY_DISKS else SHARE) * share, least))
