"""Rows of the log, written into the buffer that Python drains."""

from __future__ import annotations

import math

import numpy as np

from eventsim.engines.fast.compiled import inline
from eventsim.engines.fast.layout import LABEL, REALS, VX, VY, WORDS, X, Y
from eventsim.engines.fast.memory import put, real, word
from eventsim.record.events import ROW, Kind

_AT = {name: int(field[1]) for name, field in (ROW.fields or {}).items()}
SIZE = ROW.itemsize
EVENT, KIND, A, B, WALL, XA, YA, VXA, VYA = (
    _AT[k] for k in ("event", "kind", "a", "b", "wall", "xa", "ya", "vxa", "vya")
)
XB, YB, VXB, VYB, IMPULSE, JOINT, TIME, EPOCH, REMAINDER = (
    _AT[k] for k in ("xb", "yb", "vxb", "vyb", "impulse", "joint", "time", "epoch", "remainder")
)
PAIR_KIND, WALL_KIND = int(Kind.PAIR), int(Kind.WALL)


@inline
def write_row(m, number, slot, a, b, wall, impulse, t, clock, rows):
    """Write row `number` of the log, if rows are kept.

    clock: the epoch, and as a sum of two numbers where it begins on the scene's clock.
    """
    if rows is None:
        return
    if b >= 0 and word(m.disks, b * WORDS + LABEL) < word(m.disks, a * WORDS + LABEL):
        a, b = b, a
    at = SIZE * slot
    put(rows, at + EVENT, np.int64(number))
    put(rows, at + KIND, np.int8(PAIR_KIND if b >= 0 else WALL_KIND))
    put(rows, at + A, np.int32(word(m.disks, a * WORDS + LABEL)))
    put(rows, at + WALL, np.int32(wall))
    put(rows, at + XA, real(m.disks, a * REALS + X))
    put(rows, at + YA, real(m.disks, a * REALS + Y))
    put(rows, at + VXA, real(m.disks, a * REALS + VX))
    put(rows, at + VYA, real(m.disks, a * REALS + VY))
    if b >= 0:
        put(rows, at + B, np.int32(word(m.disks, b * WORDS + LABEL)))
        put(rows, at + XB, real(m.disks, b * REALS + X))
        put(rows, at + YB, real(m.disks, b * REALS + Y))
        put(rows, at + VXB, real(m.disks, b * REALS + VX))
        put(rows, at + VYB, real(m.disks, b * REALS + VY))
    else:
        put(rows, at + B, np.int32(-1))
        put(rows, at + XB, math.nan)
        put(rows, at + YB, math.nan)
        put(rows, at + VXB, math.nan)
        put(rows, at + VYB, math.nan)
    put(rows, at + IMPULSE, impulse)
    put(rows, at + JOINT, np.int64(-1))
    epoch, begin, error = clock
    put(rows, at + TIME, _sum_of_three(begin, t, error))
    put(rows, at + EPOCH, np.int64(epoch))
    put(rows, at + REMAINDER, t)


@inline
def _sum_of_three(a, b, small):
    """a + b + small, the error of the first sum carried along: as `eventsim.record.times.clock_times`."""
    total = a + b
    back = total - a
    return total + (small + ((a - (total - back)) + (b - back)))
