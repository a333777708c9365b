"""What kernels have counted, and what the counters of a run say: the one from the other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eventsim.engines.base import Counters
from eventsim.engines.fast.layout import (
    CROSSINGS,
    DEEPEST,
    EVENTS,
    OUTER_X,
    OUTER_Y,
    PAIRS,
    STALE,
    WALLS,
    WRAPS,
)
from eventsim.record.events import Floats


def take_from(counters: Counters, counts: NDArray[np.int64], sums: Floats) -> None:
    """Let the kernels go on from what the counters say."""
    counts[EVENTS] = counters.events
    counts[PAIRS], counts[WALLS] = counters.pair_contacts, counters.wall_contacts
    counts[WRAPS], counts[CROSSINGS] = counters.wraps, counters.crossings
    counts[STALE] = counters.stale
    sums[DEEPEST] = counters.deepest_overlap
    sums[OUTER_X], sums[OUTER_Y] = counters.outer_momentum


def tell(counters: Counters, counts: NDArray[np.int64], sums: Floats) -> None:
    """Let the counters say what the kernels have counted."""
    counters.events = int(counts[EVENTS])
    counters.pair_contacts, counters.wall_contacts = int(counts[PAIRS]), int(counts[WALLS])
    counters.wraps, counters.crossings = int(counts[WRAPS]), int(counts[CROSSINGS])
    counters.stale = int(counts[STALE])
    counters.deepest_overlap = float(sums[DEEPEST])
    counters.outer_momentum = [float(sums[OUTER_X]), float(sums[OUTER_Y])]
