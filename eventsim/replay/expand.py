"""From a compact log to the full one, row by row or, where there are many, with compiled kernels."""

from __future__ import annotations

from itertools import islice
from typing import TYPE_CHECKING

import numpy as np

from eventsim.compiler import has_compiler
from eventsim.errors import LogError
from eventsim.record.events import ROW, Column, Rows
from eventsim.record.provenance import Provenance
from eventsim.record.times import clock_times
from eventsim.replay.clock_windows import Windows, schedules_of
from eventsim.replay.compact import BLOCK, Expansion, Numbers
from eventsim.replay.disk_flight import DiskFlight
from eventsim.replay.flight import Flights, start_flights
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
    misfits = []
    for schedule in schedules_of(provenance):
        try:
            return _expanded(Expansion(provenance, compact, schedule), compact)
        except LogError as misfit:
            misfits.append(misfit)
    raise misfits[0]


def _expanded(expansion: Expansion, compact: Rows) -> Rows:
    plain = expansion.stage.supports is None and not expansion.stage.points
    if plain and len(compact) >= MANY_ROWS and has_compiler():
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
    columns = [np.ascontiguousarray(compact[name]) for name in Entries._fields]
    joint, a, b = compact["joint"], compact["a"], compact["b"]
    retracer = Retracer(expansion.stage, Entries(*columns), rows)
    row = window = known = 0

    def changes(_: Windows, first: int, last: int) -> tuple[Column, Flights]:
        return np.arange(expansion.stage.n), _flights(retracer.state, expansion.stage, window)

    windows.flights_from(changes)
    while row < len(rows):
        windows.resolved = row
        known = windows.reach(row)
        row, window = retracer.follow(row, known, window, windows)
        if row < known:
            end = row + _cluster_size(joint, row)
            disks = sorted({int(i) for i in (*a[row:end], *b[row:end]) if i >= 0})
            for i in disks:
                _lend(retracer.state, i, expansion.disks[i], window)
            rows[row:end] = compact[row:end]
            _fill(rows[row:end], list(expansion.numbers(row, end)), expansion.stage)
            for i in disks:
                _take_back(retracer.state, i, expansion.disks[i])
            row = end
    return rows


def _flights(s: FastState, stage: Stage, window: int) -> Flights:
    """The flights of the kernels' disks, whose clock is in a window."""
    flights = start_flights(stage)
    flights.window[:] = window
    flights.t, flights.x, flights.y, flights.vx, flights.vy = (each.every() for each in (s.t, s.x, s.y, s.vx, s.vy))
    return flights


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
