"""What a stepped engine has found: rows of its log, and how often what."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from eventsim.engines.base import Counters
from eventsim.engines.stepped.compiled import part
from eventsim.engines.stepped.disks import Moving
from eventsim.record.events import ROW, Floats, Rows

EVENTS, PAIRS, WALLS, TESTS, ROW_COUNT = range(5)
DEEPEST, OUTER_X, OUTER_Y, MOVED = range(4)

BUFFER = 4096
"""Rows that fit at least between two calls."""


class Found(NamedTuple):
    """rows: room for rows, none where none are kept.  counts: EVENTS, PAIRS, ... sums: DEEPEST, OUTER_X, OUTER_Y, MOVED
    (how far the fastest disk may have flown since the list of neighbours was made)."""

    rows: Rows
    counts: NDArray[np.int64]
    sums: Floats


def nothing_found(room: int) -> Found:
    """An empty record with room for so many rows."""
    return Found(np.zeros(room, ROW), np.zeros(5, np.int64), np.zeros(4))


def tell_counters(found: Found, counters: Counters) -> None:
    """Let counters say what was found."""
    counts, sums = found.counts, found.sums
    counters.events = int(counts[EVENTS])
    counters.pair_contacts, counters.wall_contacts = int(counts[PAIRS]), int(counts[WALLS])
    counters.pair_tests = int(counts[TESTS])
    counters.deepest_overlap = float(sums[DEEPEST])
    counters.outer_momentum = [float(sums[OUTER_X]), float(sums[OUTER_Y])]


def take_counters(found: Found, counters: Counters) -> None:
    """Count on from where counters are: somebody may have set them back."""
    found.counts[EVENTS] = counters.events
    found.counts[PAIRS], found.counts[WALLS] = counters.pair_contacts, counters.wall_contacts
    found.counts[TESTS] = counters.pair_tests
    found.sums[DEEPEST] = counters.deepest_overlap
    found.sums[OUTER_X], found.sums[OUTER_Y] = counters.outer_momentum


@part
def note_pair(found: Found, m: Moving, i: int, j: int, time: float, impulse: float) -> None:
    """A pair contact, its disks as they are now; `time` counts from the beginning."""
    found.counts[EVENTS] += 1
    found.counts[PAIRS] += 1
    if len(found.rows) == 0:
        return
    a, b = min(i, j), max(i, j)
    row = _new_row(found, m, a, time, impulse)
    row["kind"], row["b"], row["wall"] = 0, b, -1
    row["xb"], row["yb"], row["vxb"], row["vyb"] = m.x[b], m.y[b], m.vx[b], m.vy[b]


@part
def note_wall(found: Found, m: Moving, i: int, wall: int, time: float, impulse: float) -> None:
    """A wall contact, its disk as it is now; `time` counts from the beginning."""
    found.counts[EVENTS] += 1
    found.counts[WALLS] += 1
    if len(found.rows) == 0:
        return
    row = _new_row(found, m, i, time, impulse)
    row["kind"], row["b"], row["wall"] = 1, -1, wall
    row["xb"], row["yb"], row["vxb"], row["vyb"] = math.nan, math.nan, math.nan, math.nan


@part
def _new_row(found: Found, m: Moving, a: int, time: float, impulse: float) -> Any:
    row = found.rows[found.counts[ROW_COUNT]]
    found.counts[ROW_COUNT] += 1
    row["event"] = found.counts[EVENTS] - 1
    row["remainder"], row["impulse"], row["joint"], row["a"] = time, impulse, -1, a
    row["xa"], row["ya"], row["vxa"], row["vya"] = m.x[a], m.y[a], m.vx[a], m.vy[a]
    return row


@part
def meet(mass_a: float, mass_b: float) -> bool:
    """Whether two disks meet: two immovable ones, or two tracers, do not."""
    return not ((math.isinf(mass_a) and math.isinf(mass_b)) or (mass_a == 0.0 and mass_b == 0.0))
