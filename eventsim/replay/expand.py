"""From a compact log to the full one, row by row or, where there are many, with compiled kernels."""

from __future__ import annotations

from itertools import islice
from typing import TYPE_CHECKING

import numpy as np

from eventsim.compiler import has_compiler
from eventsim.record.events import ROW, Column, Rows
from eventsim.record.provenance import Provenance
from eventsim.record.times import clock_times
from eventsim.replay.compact import BLOCK, Expansion, Numbers
from eventsim.replay.disk_flight import DiskFlight
from eventsim.scene.stage import Stage

if TYPE_CHECKING:
    from eventsim.engines.fast.state import FastState

COMPUTED = ("xa", "ya", "vxa", "vya", "xb", "yb", "vxb", "vyb", "impulse")
MANY_ROWS = 50_000
"""From so many on, loading compiled kernels takes less time than they save."""


def expand_rows(provenance: Provenance, compact: Rows) -> Rows:
    """Return the full rows of a compact log, in O(rows) time.

    Raises LogError where the rows do not follow from the scene.
    """
    expansion = Expansion(provenance, compact)
    if len(compact) >= MANY_ROWS and expansion.stage.supports is None and has_compiler():
        return _expanded_by_kernels(expansion, compact)
    rows = compact.copy()
    numbers = expansion.numbers()
    for first in range(0, len(rows), BLOCK):
        block = rows[first : first + BLOCK]
        _fill(block, list(islice(numbers, len(block))), expansion.stage)
    return rows


def _fill(rows: Rows, numbers: list[Numbers], stage: Stage) -> None:
    """Enter into compact rows what they left out."""
    for name, values in zip(COMPUTED, zip(*numbers, strict=True), strict=True):
        rows[name] = values
    rows["time"] = clock_times(rows["epoch"], rows["remainder"], stage.epoch_length, stage.start_time)


def _expanded_by_kernels(expansion: Expansion, compact: Rows) -> Rows:
    """The same with the kernels of the fast engine; what they leave out is done here, row by row."""
    from eventsim.engines.fast.retrace import Entries, Retracer  # who has many rows pays for the compiler

    rows = np.empty(len(compact), ROW)
    windows = expansion.windows
    kind, a, b, wall, joint, remainder = (
        np.ascontiguousarray(compact[name]) for name in ("kind", "a", "b", "wall", "joint", "remainder")
    )
    entries = Entries(kind, a, b, wall, joint, windows.index_of(compact["epoch"]), remainder)
    lengths, epochs = np.array(windows.length), np.array(windows.start, dtype=np.int64)
    retracer = Retracer(expansion.stage, entries, lengths, epochs, rows)
    row = window = 0
    while True:
        row, window = retracer.follow(row, window)
        if row == len(rows):
            return rows
        end = row + _cluster_size(joint, row)
        disks = sorted({int(i) for i in (*a[row:end], *b[row:end]) if i >= 0})
        for i in disks:
            _lend(retracer.state, i, expansion.disks[i], window)
        rows[row:end] = compact[row:end]
        _fill(rows[row:end], list(expansion.numbers(row, end)), expansion.stage)
        for i in disks:
            _take_back(retracer.state, i, expansion.disks[i])
        row = end


def _lend(s: FastState, i: int, flight: DiskFlight, window: int) -> None:
    """Let a flight be that of disk i of the kernels."""
    flight.window, flight.t = window, s.t[i]
    flight.anchor(s.t[i], (s.x[i], s.y[i]), (s.vx[i], s.vy[i]))
    flight.wraps = [s.wraps_x[i], s.wraps_y[i]]
    flight.met, flight.contact_time = s.met[i], s.contact_time[i]
    if s.low_parts:
        flight.low = s.low_vx[i], s.low_vy[i]
    if s.low_places:
        flight.low_place = s.low_x[i], s.low_y[i]


def _take_back(s: FastState, i: int, flight: DiskFlight) -> None:
    """Let disk i of the kernels fly on as a flight does."""
    s.t[i], s.x[i], s.y[i], s.vx[i], s.vy[i] = flight.t, flight.x, flight.y, flight.vx, flight.vy
    s.wraps_x[i], s.wraps_y[i] = flight.wraps
    s.met[i], s.contact_time[i] = flight.met, flight.contact_time
    if s.low_parts:
        s.low_vx[i], s.low_vy[i] = flight.low
    if s.low_places:
        s.low_x[i], s.low_y[i] = flight.low_place or (0.0, 0.0)


def _cluster_size(joint: Column, row: int) -> int:
    """How many rows from `row` on belong to one cluster."""
    if joint[row] < 0:
        return 1
    count = 1
    while row + count < len(joint) and joint[row + count] == joint[row]:
        count += 1
    return count
