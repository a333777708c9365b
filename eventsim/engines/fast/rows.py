"""Rows of the log, written into the buffer that Python drains: two cache lines each, in the order of `ROW`."""

from __future__ import annotations

import math

from eventsim.engines.fast.compiled import inline, put_line, real, store, word
from eventsim.engines.fast.layout import LABEL, WORDS
from eventsim.record.events import ROW, Kind

SIZE = ROW.itemsize
LINE = SIZE // 2
PAIR_KIND, WALL_KIND = int(Kind.PAIR), int(Kind.WALL)
NO_FLIGHT = (math.nan, math.nan, math.nan, math.nan)


@inline
def write_pair(m, number, slot, a, b, flight_a, flight_b, impulse, t, clock):
    """Write row `number` of the log, the contact of disks a and b, if rows are kept.

    flight_a, flight_b: place and velocity after it.  clock: the epoch, and as a sum of two numbers where it begins on the scene's
    clock.  The smaller label comes first; which disk has it is as good as random, so it is chosen without a branch.
    """
    if m.rows is None:
        return
    label_a, label_b = word(m.disks, a * WORDS + LABEL), word(m.disks, b * WORDS + LABEL)
    swapped = label_b < label_a
    first, second = _chosen(swapped, flight_b, flight_a), _chosen(swapped, flight_a, flight_b)
    labels = min(label_a, label_b), max(label_a, label_b)
    _write(m.rows, SIZE * slot, number, PAIR_KIND, labels, -1, first, second, impulse, t, clock)


@inline
def write_wall(m, number, slot, a, wall, flight, impulse, t, clock):
    """Write row `number` of the log, the contact of disk a with a wall, if rows are kept; see `write_pair`."""
    if m.rows is None:
        return
    labels = word(m.disks, a * WORDS + LABEL), -1
    _write(m.rows, SIZE * slot, number, WALL_KIND, labels, wall, flight, NO_FLIGHT, impulse, t, clock)


@inline
def write_spins(m, slot, a, b):
    """Write the spins of a pair, the smaller label first, or of a disk at a wall (b < 0), beside the row in a slot."""
    if b < 0:
        store(m.spin_rows, 2 * slot, real(m.spin, 2 * a))
        store(m.spin_rows, 2 * slot + 1, math.nan)
        return
    swapped = word(m.disks, b * WORDS + LABEL) < word(m.disks, a * WORDS + LABEL)
    store(m.spin_rows, 2 * slot + (1 if swapped else 0), real(m.spin, 2 * a))
    store(m.spin_rows, 2 * slot + (0 if swapped else 1), real(m.spin, 2 * b))


@inline
def _chosen(which, one, other):
    """One of two flights, number by number."""
    x, y = one[0] if which else other[0], one[1] if which else other[1]
    return x, y, one[2] if which else other[2], one[3] if which else other[3]


@inline
def _write(rows, at, number, kind, labels, wall, first, second, impulse, t, clock):
    epoch, begin, error = clock
    a, b = labels
    time = _sum_of_three(begin, t, error)
    put_line(rows, at, (number, time, _two(kind, a), _two(b, wall), *first))
    put_line(rows, at + LINE, (*second, impulse, -1, epoch, t))


@inline
def _two(low, high):
    """Two whole numbers of 32 bits as one of 64, as they lie in memory."""
    return (low & 0xFFFFFFFF) | (high << 32)


@inline
def _sum_of_three(a, b, small):
    """a + b + small, the error of the first sum carried along: as `eventsim.record.times.clock_times`."""
    total = a + b
    back = total - a
    return total + (small + ((a - (total - back)) + (b - back)))
