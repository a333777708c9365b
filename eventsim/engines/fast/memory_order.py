"""The order of disks in memory: along a curve that fills the plane, so that neighbours in the domain are near in memory."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eventsim.record.events import Floats

LEVELS = 12
"""4**12 squares along the curve."""


def along_a_curve(x: Floats, y: Floats) -> NDArray[np.int64]:
    """The disks in the order of a Hilbert curve over the rectangle that holds them."""
    half = 1 << (LEVELS - 1)
    column, row = _squares(x, 2 * half), _squares(y, 2 * half)
    along = np.zeros(len(x), np.int64)
    while half:
        right, upper = (column & half) > 0, (row & half) > 0
        along += half * half * ((3 * right) ^ upper)
        flip = right & ~upper
        column[flip], row[flip] = ~column[flip], ~row[flip]
        column[~upper], row[~upper] = row[~upper], column[~upper]
        half //= 2
    return np.argsort(along, kind="stable")


def _squares(x: Floats, count: int) -> NDArray[np.int64]:
    low, extent = float(x.min()), float(np.ptp(x))
    if not extent > 0.0:
        return np.zeros(len(x), np.int64)
    return np.minimum((x - low) / extent * count, count - 1).astype(np.int64)
