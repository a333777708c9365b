"""The kernels driven by the rows of a log instead of a calendar: so a compact log becomes a full one.

Each contact is checked to be due at its time and resolved again; nothing is predicted, which makes it faster than the run.
Contacts of equal time, and velocities that were set, are left to `eventsim.replay.compact`.
"""

from __future__ import annotations

import math
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from eventsim.engines.fast import layout
from eventsim.engines.fast.advance import place, pulls, wrap
from eventsim.engines.fast.compiled import inline, kernel, link, part
from eventsim.engines.fast.layout import (
    NOBODY,
    RADIUS,
    REALS,
    VX,
    VY,
    WALL,
    WRAP_DOWN,
    WRAP_LEFT,
    WRAP_RIGHT,
    WRAP_UP,
    Arrays,
    T,
    X,
    Y,
)
from eventsim.engines.fast.loop import pointers, turn_over
from eventsim.engines.fast.memory import real
from eventsim.engines.fast.memory_order import along_a_curve
from eventsim.engines.fast.pairs import image, pair_is_due
from eventsim.engines.fast.plan import MANY_DISKS
from eventsim.engines.fast.resolve import resolve_pair, resolve_wall
from eventsim.engines.fast.rules import features_of, rules_of
from eventsim.engines.fast.shapes import WIDTH
from eventsim.engines.fast.single_disk_events import shape_time, wall_delay
from eventsim.engines.fast.state import FastState
from eventsim.formulas.crossing import crossing_delay
from eventsim.formulas.expansion import two_sum
from eventsim.formulas.real import NEVER
from eventsim.record.events import Floats, Kind, Rows
from eventsim.scene.stage import Stage

PAIR_ROW, WALL_ROW = int(Kind.PAIR), int(Kind.WALL)
NO_CODE = 0
"""No code of a wall: those are negative."""


class Entries(NamedTuple):
    """The columns of a compact log (R,)."""

    kind: NDArray[np.int8]
    a: NDArray[np.int32]
    b: NDArray[np.int32]
    wall: NDArray[np.int32]
    joint: NDArray[np.int64]
    epoch: NDArray[np.int64]
    remainder: Floats


class Timetable(NamedTuple):
    """Windows of the clock: where each ends and begins on its own clock; its epoch; where that begins on the scene's clock.

    The latter as a sum of two numbers.
    """

    end: Floats
    begin: Floats
    epoch: NDArray[np.int64]
    epoch_begin: Floats
    epoch_error: Floats


class Schedule(Protocol):
    """Windows of the clock, as far as they are known."""

    start: list[int]
    begin: list[float]
    end: list[float]


class Crowd(NamedTuple):
    """The number of disks, as kernels find it in a grid."""

    n: int


class Retracer:
    """The disks of a log on their way from row to row, in the records of the fast engine."""

    def __init__(self, stage: Stage, entries: Entries, rows: Rows) -> None:
        """rows (R,): where the full rows go."""
        self._memory = link()
        self._counts = np.zeros(13, np.int64)
        self._sums = np.zeros(6)
        order = along_a_curve(stage.x, stage.y) if stage.n >= MANY_DISKS else np.arange(stage.n)
        self.state = FastState(stage, order, self._counts)
        for name in ("x", "y", "vx", "vy"):
            getattr(self.state, name).set_all(getattr(stage, name))
        self.state.contact_time.set_all(-math.inf)
        self.state.words[:, layout.MET] = NOBODY
        self._rules = rules_of(stage)
        self._mass = None if stage.mass is None else np.ascontiguousarray(stage.mass[order])
        self._features = features_of(stage)
        self._entries = entries
        self._stage = stage
        self._rows = rows.view(np.uint8)

    def follow(self, first: int, last: int, window: int, windows: Schedule) -> tuple[int, int]:
        """Complete rows first, ..., last - 1, the clock being in `window`: (the first row that is not for kernels, its window).

        windows: those of these rows.
        """
        arrays = Arrays(
            disks=self.state.memory,
            slots=np.zeros(1, np.int32),  # as if there were cells: the image of a pair is the nearest one
            near=np.zeros(1, np.int32),
            several=self.state.several.reshape(-1),
            mass=self._mass,
            low=self.state.low.reshape(-1) if self.state.low_parts else None,
            low_places=self.state.low_of_places.reshape(-1) if self.state.low_places else None,
            features=self._features,
            levels=None,
            sides=None,  # as are those with points
            images=None,
            supports=None,  # scenes in which disks come to rest are left to `eventsim.replay.compact`
            rows=self._rows,
        )
        crowd = Crowd(self.state.n)
        places = self.state.place_of
        entries = Entries._make(column[:last] for column in self._entries)
        timetable = self._timetable(windows, window)
        row, ended = retrace(arrays, crowd, self._rules, self._sums, entries, timetable, places, first, 0)
        return int(row), window + int(ended)

    def _timetable(self, windows: Schedule, first: int) -> Timetable:
        epochs = np.array(windows.start[first:], dtype=np.int64)
        begin, error = two_sum(epochs * np.float64(self._stage.epoch_length), self._stage.start_time)
        return Timetable(np.array(windows.end[first:]), np.array(windows.begin[first:]), epochs, begin, error)


@kernel
def retrace(arrays, crowd, rules, sums, entries, timetable, place_of, row, window):
    """Complete rows from `row` on as long as they are contacts by themselves: (the first other row, its window)."""
    m = pointers(arrays)
    clock = timetable.epoch[window], timetable.epoch_begin[window], timetable.epoch_error[window]
    while row < len(entries.a):
        while timetable.epoch[window] < entries.epoch[row]:
            end = timetable.end[window]
            for i in range(crowd.n):
                _fly(m, rules, i, end, False)
            turn_over(arrays, crowd, rules, end, end - timetable.begin[window + 1])
            window += 1
            clock = timetable.epoch[window], timetable.epoch_begin[window], timetable.epoch_error[window]
        t, i = entries.remainder[row], place_of[entries.a[row]]
        if entries.joint[row] >= 0 or t < real(m.disks, i * REALS + T):
            break
        if entries.kind[row] == PAIR_ROW:
            j = place_of[entries.b[row]]
            if t < real(m.disks, j * REALS + T):
                break
            _fly(m, rules, i, t, True)
            _fly(m, rules, j, t, True)
            if not _pair_meets(m, rules, i, j, t):
                break
            resolve_pair(m, rules, sums, i, j, t, clock, row, row)
        elif entries.kind[row] == WALL_ROW:
            _fly(m, rules, i, t, True)
            code = _wall_met(m, rules, i, entries.wall[row], t, rules.features)
            if code == NO_CODE:
                break
            resolve_wall(m, rules, sums, i, code, t, clock, row, row)
        else:
            break
        row += 1
    return row, window


@inline
def _fly(m, rules, i, limit, inclusive):
    """Follow disk i through all wraps before a time, or up to it."""
    if rules.length_x is None and rules.length_y is None:
        return
    due, code = _next_wrap(m, rules, i)
    while due < limit or (inclusive and due == limit):
        wrap(m, rules, i, code, due)
        due, code = _next_wrap(m, rules, i)


@inline
def _next_wrap(m, rules, i):
    """(time, code) of the next wrap; of equal ones the one that `eventsim.replay.disk_flight` takes."""
    f = i * REALS
    t = real(m.disks, f + T)
    gx, gy = pulls(m, rules, i)
    x, u, y, w = real(m.disks, f + X), real(m.disks, f + VX), real(m.disks, f + Y), real(m.disks, f + VY)
    first, code = _next_across(NEVER, NO_CODE, t, x, u, gx, rules.length_x, WRAP_LEFT, WRAP_RIGHT)
    return _next_across(first, code, t, y, w, gy, rules.length_y, WRAP_DOWN, WRAP_UP)


@inline
def _next_across(first, code, t, x, v, g, length, down, up):
    if length is None:
        return first, code
    due = t + crossing_delay(x, v, g, 0.0, 1.0)
    if due < first:
        first, code = due, down
    due = t + crossing_delay(x, v, g, length, -1.0)
    if due < first:
        first, code = due, up
    return first, code


@inline
def _pair_meets(m, rules, i, j, t):
    """Whether two disks meet at a time in the image that is nearest then."""
    if rules.length_x is None and rules.length_y is None:
        return pair_is_due(m, rules, i, j, 0, 0) == t
    xi, yi = place(m, rules, i, t)
    xj, yj = place(m, rules, j, t)
    return pair_is_due(m, rules, i, j, image(xi - xj, rules.length_x), image(yi - yj, rules.length_y)) == t


@part
def _wall_met(m, rules, i, wall, t, features):
    """The code of the contact that disk i has with a wall at a time; NO_CODE where there is none, or several."""
    f = i * REALS
    begin, r = real(m.disks, f + T), real(m.disks, f + RADIUS)
    gx, gy = pulls(m, rules, i)
    x, u, y, w = real(m.disks, f + X), real(m.disks, f + VX), real(m.disks, f + Y), real(m.disks, f + VY)
    if wall < rules.first_feature:
        code = _wall_across(m, begin, x, u, gx, r, rules.width, wall, t, 2 * i, rules.wall_x)
        if code != NO_CODE:
            return code
        return _wall_across(m, begin, y, w, gy, r, rules.height, wall, t, 2 * i + 1, rules.wall_y)
    return _shape_met(m, rules, i, wall, t, features)


@inline
def _wall_across(m, begin, x, v, g, r, length, wall, t, at, first):
    if first is None:
        return NO_CODE
    if wall == first and begin + wall_delay(x, v, g, 0.0, 1.0, r, at, m.low_places) == t:
        return WALL - 2 * wall
    if wall == first + 1 and begin + wall_delay(x, v, g, length, -1.0, r, at, m.low_places) == t:
        return WALL - 2 * wall - 1
    return NO_CODE


@inline
def _shape_met(m, rules, i, wall, t, features):
    code = NO_CODE
    if features is None:
        return code
    for k in range(features):
        if real(m.features, WIDTH * k + 1) == wall:
            time, side, _ = shape_time(m, rules, i, k, m.supports)
            if time == t:
                if code != NO_CODE:
                    return NO_CODE
                code = WALL - 2 * (rules.first_feature + k) - (1 if side < 0 else 0)
    return code
