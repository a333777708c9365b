"""Rows of the log, written into the buffer that Python drains."""

from __future__ import annotations

import math

import numpy as np

from eventsim.engines.fast.compiled import inline
from eventsim.engines.fast.layout import LABEL, WORDS
from eventsim.engines.fast.memory import put, word
from eventsim.record.events import OFFSETS, ROW, Kind

SIZE = ROW.itemsize
EVENT, KIND, A, B, WALL, XA, YA, VXA, VYA = (
    OFFSETS[k] for k in ("event", "kind", "a", "b", "wall", "xa", "ya", "vxa", "vya")
)
XB, IMPULSE, JOINT, TIME, EPOCH, REMAINDER = (
    OFFSETS[k] for k in ("xb", "impulse", "joint", "time", "epoch", "remainder")
)
PAIR_KIND, WALL_KIND = int(Kind.PAIR), int(Kind.WALL)


@inline
def write_pair(m, number, slot, a, b, flight_a, flight_b, impulse, t, clock, rows):
    """Write row `number` of the log, the contact of disks a and b, if rows are kept.

    flight_a, flight_b: place and velocity after it.  clock: the epoch, and as a sum of two numbers where it begins on the scene's
    clock.  The smaller label comes first; which disk has it is as good as random, so it is no branch but a place in the row.
    """
    if rows is None:
        return
    at = SIZE * slot
    label_a, label_b = word(m.disks, a * WORDS + LABEL), word(m.disks, b * WORDS + LABEL)
    swapped = np.int64(label_b < label_a)
    put(rows, at + A + swapped * (B - A), np.int32(label_a))
    put(rows, at + B - swapped * (B - A), np.int32(label_b))
    _write_flight(rows, at + XA + swapped * (XB - XA), flight_a)
    _write_flight(rows, at + XB - swapped * (XB - XA), flight_b)
    put(rows, at + KIND, np.int8(PAIR_KIND))
    put(rows, at + WALL, np.int32(-1))
    _write_rest(rows, at, number, impulse, t, clock)


@inline
def write_wall(m, number, slot, a, wall, flight, impulse, t, clock, rows):
    """Write row `number` of the log, the contact of disk a with a wall, if rows are kept; see `write_pair`."""
    if rows is None:
        return
    at = SIZE * slot
    put(rows, at + A, np.int32(word(m.disks, a * WORDS + LABEL)))
    put(rows, at + B, np.int32(-1))
    _write_flight(rows, at + XA, flight)
    _write_flight(rows, at + XB, (math.nan, math.nan, math.nan, math.nan))
    put(rows, at + KIND, np.int8(WALL_KIND))
    put(rows, at + WALL, np.int32(wall))
    _write_rest(rows, at, number, impulse, t, clock)


@inline
def _write_flight(rows, at, flight):
    x, y, vx, vy = flight
    put(rows, at, x)
    put(rows, at + YA - XA, y)
    put(rows, at + VXA - XA, vx)
    put(rows, at + VYA - XA, vy)


@inline
def _write_rest(rows, at, number, impulse, t, clock):
    epoch, begin, error = clock
    put(rows, at + EVENT, np.int64(number))
    put(rows, at + IMPULSE, impulse)
    put(rows, at + JOINT, np.int64(-1))
    put(rows, at + TIME, _sum_of_three(begin, t, error))
    put(rows, at + EPOCH, np.int64(epoch))
    put(rows, at + REMAINDER, t)


@inline
def _sum_of_three(a, b, small):
    """a + b + small, the error of the first sum carried along: as `eventsim.record.times.clock_times`."""
    total = a + b
    back = total - a
    return total + (small + ((a - (total - back)) + (b - back)))
