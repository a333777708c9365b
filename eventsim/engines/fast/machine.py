"""The memory of a run and the kernels that work in it: cells, calendar, rows."""

from __future__ import annotations

import math
import sys
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eventsim.engines.base import Counters, Motion
from eventsim.engines.fast import layout
from eventsim.engines.fast.compiled import lanes_work
from eventsim.engines.fast.layout import Arrays, Grid
from eventsim.engines.fast.loop import fill, predict_some, run, schedule, turn_over
from eventsim.engines.fast.plan import Grids, Sizes, day_length, in_memory, shortest_day
from eventsim.engines.fast.rules import features_of, images_of, pairs_of, rules_of, shares_of, supports_of
from eventsim.engines.fast.state import FastState
from eventsim.formulas.clock import window_length
from eventsim.formulas.doubt import latest_tie, screen_in
from eventsim.formulas.expansion import two_sum
from eventsim.record.events import ROW, SPIN_ROW, Floats, Rows, row_of
from eventsim.scene.stage import Stage

ROOM = 1 << 13
"""Rows in a buffer, a megabyte: fewer would keep Python busy, more would stand in the way of what the caches hold."""

MOST = 16
"""Buffers that are kept for another time: those that wait for the writer, and a few more."""


class Buffers:
    """A pool of buffers.  New memory would cost a tenth of a run's time: the system hands it out page by page, each wiped."""

    def __init__(self) -> None:
        self._pool: list[Rows] = []

    def blank(self) -> Rows:
        """A buffer (ROOM,) whose rows nobody holds, neither the caller nor whoever took rows of it."""
        for buffer, looks in zip(self._pool, _looks(self._pool), strict=True):
            if looks == UNSEEN:
                return buffer
        buffer = _new()
        if len(self._pool) < MOST:
            self._pool.append(buffer)
        return buffer


def _new() -> Rows:
    """A buffer (ROOM,) that begins with a cache line; views of it refer to it, not to the memory below, so they are counted."""
    memory = np.empty((ROOM + 1) * ROW.itemsize, np.uint8)
    start = -memory.ctypes.data % ROW.itemsize
    return np.frombuffer(memory.data[start : start + ROOM * ROW.itemsize], ROW)


def _looks(pool: list[Rows]) -> list[int]:
    """How many references there are to each buffer, views of its rows included, and those that counting takes."""
    return [sys.getrefcount(buffer) for buffer in pool]


UNSEEN = _looks([np.empty(0, ROW)])[0]
"""The count of a buffer that only the pool has: counted, since it depends on the Python that counts."""


def with_spins(rows: Rows, spins: Floats) -> Rows:
    """Rows (n,) of kernels with their spins (n, 2), as rows of a scene with spin."""
    whole = np.empty(len(rows), SPIN_ROW)
    memory = whole.view(np.uint8).reshape(len(rows), -1)
    memory[:, : ROW.itemsize] = rows.view(np.uint8).reshape(len(rows), -1)
    memory[:, ROW.itemsize :] = spins.view(np.uint8)
    return whole


COUNTED = {
    "events": layout.EVENTS,
    "pair_contacts": layout.PAIRS,
    "wall_contacts": layout.WALLS,
    "wraps": layout.WRAPS,
    "crossings": layout.CROSSINGS,
    "stale": layout.STALE,
}
"""Counters of a run that kernels keep, and where."""

FOREVER = 1 << 60
SOON = 0.25
"""Rows for each disk before which cells that are full again get more slots, and are not chosen anew."""
FEW_STEPS = 256
TOO_FEW_DAYS, TOO_MANY_DAYS = 0.5, 6.0
"""Days that an event may take, on the average of so many steps; outside, the length of a day is chosen anew."""


class Machine:
    """The memory of one run; stage, keep_rows, lanes, sizes: see `FastSession`.  Empty until `predict_afresh`."""

    def __init__(
        self, stage: Stage, keep_rows: bool, lanes: bool | None, sizes: Sizes | tuple[Sizes, ...] | str | None
    ) -> None:
        self.stage = stage
        self.counts = np.zeros(13, np.int64)
        self.sums = np.zeros(6)
        self.keep_rows = keep_rows
        beside = stage.gravity is None or stage.supports is None  # all fly straight beside each other
        plain = stage.mass is None or not np.any(np.isinf(stage.mass) | (stage.mass == 0.0))
        wanted = lanes_work() if lanes is None else lanes
        self._lanes = 8 if wanted and beside and plain else None
        order = in_memory(stage)
        self.state = FastState(stage, order, self.counts)
        self.rules = rules_of(stage)
        self._screened: int | None = None  # the exponent of the window that the rules' screen is for
        self._features = features_of(stage)
        self._supports = supports_of(stage)
        self._images = images_of(stage)
        self._shares = shares_of(stage)
        self._pairs = pairs_of(stage)
        self._species = None if stage.species is None else np.ascontiguousarray(stage.species[order], np.int32)
        self._mass = None if stage.mass is None else np.ascontiguousarray(stage.mass[order])
        self._buffers = Buffers()
        self._buffer = self._buffers.blank() if keep_rows else np.empty(0, ROW)
        self._spins = np.empty(2 * ROOM) if keep_rows and stage.spin is not None else None
        self.counts[layout.ROOM] = ROOM if keep_rows else 2 * FOREVER
        self._blocks: list[Rows] = []
        self.grids = Grids(stage, sizes)
        self._days = self._steps = 0
        self._remade = 0, 0, 0.0
        self.grid: Grid
        self.arrays: Any

    def run(self, limit: float, target: int, budget: int) -> int:
        """Let kernels handle events before `limit` until `target` rows in all, for `budget` steps; the status."""
        counts = self.counts
        day, steps = int(counts[layout.DAY]), int(counts[layout.STEPS])
        status: int = run(self.arrays, self.grid, self.rules, counts, self.sums, limit, target, budget)
        self.state.now = float(self.sums[layout.NOW])
        self._days += int(counts[layout.DAY]) - day
        self._steps += int(counts[layout.STEPS]) - steps
        if self._steps > max(self.state.n, FEW_STEPS):
            if not TOO_FEW_DAYS < self._days / self._steps < TOO_MANY_DAYS:
                self.schedule()
            self._days = self._steps = 0
        return status

    def take_counters(self, counters: Counters) -> None:
        """Let the kernels go on from what counters say."""
        counts, sums = self.counts, self.sums
        for name, place in COUNTED.items():
            counts[place] = getattr(counters, name)
        sums[layout.DEEPEST] = counters.deepest_overlap
        sums[layout.OUTER_X], sums[layout.OUTER_Y] = counters.outer_momentum

    def tell_counters(self, counters: Counters) -> None:
        """Let counters say what the kernels have counted."""
        counts, sums = self.counts, self.sums
        for name, place in COUNTED.items():
            setattr(counters, name, int(counts[place]))
        counters.deepest_overlap = float(sums[layout.DEEPEST])
        counters.outer_momentum = [float(sums[layout.OUTER_X]), float(sums[layout.OUTER_Y])]

    @property
    def memory(self) -> int:
        """Bytes of the arrays that kernels work in."""
        arrays = [self.state.place_of, *(array for array in self.arrays if array is not None)]
        return sum(int(array.nbytes) for array in arrays)

    @property
    def due(self) -> Floats:
        """(n,) when the next events of disks are due, in the order of their places."""
        return self.state.disks[: self.state.n, layout.DUE]

    def set_epoch(self, epoch: int) -> None:
        """Set the epoch of the clock."""
        self.state.epoch = self.counts[layout.EPOCH] = epoch
        begin = two_sum(epoch * self.stage.epoch_length, self.stage.start_time)
        self.sums[layout.EPOCH_BEGIN], self.sums[layout.EPOCH_ERROR] = begin

    def set_now(self, now: float) -> None:
        """Set the remainder of the clock."""
        self.state.now = now
        self.sums[layout.NOW] = now

    def turn_over(self, end: float, epochs: int, exponent: int) -> None:
        """Let the clock turn over at a time of its window, by some epochs; the cells are those of the disks then.

        exponent: of the new window.
        """
        self._turn_over(end, epochs, exponent)
        if self.grid.day_length < shortest_day(self._latest_day()):
            self._choose_days()
        schedule(self.arrays, self.grid, self.counts, self.state.now)
        self._predict(0, self.state.n, self.state.now)

    def jump(self, end: float, epochs: int, exponent: int) -> None:
        """The same, where disks may have left the cells that they are in at that time."""
        self._turn_over(end, epochs, exponent)
        self.predict_afresh()

    def _turn_over(self, end: float, epochs: int, exponent: int) -> None:
        state = self.state
        shift = epochs * state.epoch_length
        turn_over(self.arrays, self.grid, self.rules, end, shift)
        self.set_epoch(state.epoch + epochs)
        state.begin_window(exponent)
        state.window_rows = 0
        self.choose_screen()
        self.set_now(end - shift)

    def _latest_day(self) -> float:
        """A time up to which days have numbers."""
        state = self.state
        end: float = state.window_end
        if math.isinf(end):
            ahead = float(self.due[np.isfinite(self.due)].max(initial=0.0))
            end = 2.0 * max(state.now, ahead, window_length(state.window, state.epoch_length))
        return end

    def choose_screen(self) -> None:
        """Set within which span contacts are ordered exactly, as it is in the present window."""
        stage, window = self.stage, self.state.window
        if window != self._screened:
            length = window_length(window, self.state.epoch_length)
            self.rules = self.rules._replace(tie_screen=screen_in(stage.tie_screen, length, stage.epoch_length))
            self._screened = window

    def choose_cells(self, motion: Motion) -> None:
        """Choose cells for the disks where they are, and predict all of them anew."""
        self.grids.choose(motion)
        self.predict_afresh()

    def give_up_cells(self) -> None:
        """Do without cells from now on."""
        self.grids = Grids(self.stage, None)
        self.predict_afresh()

    def make_room(self, place: int, motion: Motion, for_ever: bool) -> None:
        """Make cells anew for the disks where they are, or deeper ones, because a cell was full that a disk was to enter.

        On the open plane new cells follow disks that part or fall.  If no stop time makes an end of that (for_ever), they stay
        where they are once nothing else happens, so that all disks come to rest in outer cells.
        """
        events, epoch, now = self._remade
        same_time = (epoch, now) == (self.state.epoch, self.state.now)
        soon = int(self.counts[layout.EVENTS]) - events < SOON * self.state.n and self.stage.size is not None
        if same_time or soon or (for_ever and events == self.counts[layout.EVENTS]):
            self.grids.deepen(int(self.state.words[place, layout.FLAGS]) // layout.FIRST_LEVEL)
            self.predict_afresh()
        else:
            self.choose_cells(motion)

    def predict_afresh(self) -> None:
        """Fill cells and calendar anew, with more slots as long as a cell is full."""
        self.choose_screen()
        state, now = self.state, self.state.now
        self._remade = int(self.counts[layout.EVENTS]), state.epoch, now
        while True:
            self._lay_out()
            full = fill(self.arrays, self.grid, self.rules, now)
            if full < 0:
                break
            self.grids.deepen(full)
        self.due[:] = now
        schedule(self.arrays, self.grid, self.counts, now)
        self._predict(0, state.n, self._floor)
        self.schedule()

    def _lay_out(self) -> None:
        """Make arrays for the cells that have been chosen; they are empty."""
        state = self.state
        self.grid = self.grids.grid(self._lanes)
        state.set_levels(self.grids.level)
        self.arrays = Arrays(
            state.memory,
            self.grids.slots(),
            self.grids.near(),
            state.several.reshape(-1),
            self._mass,
            state.low.reshape(-1) if state.low_parts else None,
            self._features,
            self.grids.table(),
            self._supports,
            state.sides_in_memory,
            self._images,
            self._shares,
            self._species,
            self._pairs,
            state.contacts_in_memory,
            self._buffer.view(np.uint8) if self.keep_rows else None,
            None if state.turning is None else state.turning.reshape(-1),
            self._spins,
            self.grids.near_walls(),
        )

    def compile_loop(self, motion: Motion) -> None:
        """Have the loop compiled for disks that move so, before there is anything that it could do."""
        self.grids.choose(motion)
        self.choose_screen()
        self._lay_out()
        run(self.arrays, self.grid, self.rules, self.counts, self.sums, self.state.now, 0, 0)

    def predict_one(self, i: int, floor: float) -> None:
        """Predict disk i anew; what is before `floor` does not count."""
        self.arrays = self.arrays._replace(several=self.state.several.reshape(-1))  # which may have grown
        place = int(self.state.place_of[i])
        self._predict(place, place + 1, floor)

    def renew_stale(self) -> bool:
        """Whether nothing but stale predictions was ahead; they are made anew then."""
        stale = self._stale()
        if not np.array_equal(stale, np.isfinite(self.due)):
            return False
        self._renew(stale)
        return True

    def next_contact(self) -> float:
        """When the earliest contact that is predicted is due, a remainder; inf without one. Stale ones are made anew."""
        self._renew(self._stale())
        partner = self.state.words[: self.state.n, layout.PARTNER]
        return float(self.due[(partner >= 0) | (partner <= layout.WALL)].min(initial=np.inf))

    def _stale(self) -> NDArray[np.bool_]:
        words, n = self.state.words, self.state.n
        partner = words[:n, layout.PARTNER]
        count = words[np.maximum(partner, 0), layout.COUNT]
        stale: NDArray[np.bool_] = (partner >= 0) & (words[:n, layout.PARTNER_COUNT] & (layout.COUNTS - 1) != count)
        return stale

    def _renew(self, stale: NDArray[np.bool_]) -> None:
        for i in np.flatnonzero(stale).tolist():
            self._predict(i, i + 1, self._floor)

    @property
    def _floor(self) -> float:
        """As `calendar.earliest_floor`."""
        now: float = self.state.now
        return now if self.grids.posts is None else 2.0 * now - float(latest_tie(now, self.rules.tie_screen))

    def _predict(self, begin: int, end: int, floor: float) -> None:
        predict_some(self.arrays, self.grid, self.rules, self.counts, begin, end, self.state.now, floor)

    def schedule(self) -> None:
        """Make the calendar anew, with days of a fitting length."""
        self._choose_days()
        schedule(self.arrays, self.grid, self.counts, self.state.now)

    def _choose_days(self) -> None:
        day = day_length(self.due, self.state.now, self._latest_day(), self.state.n)
        self.grid = self.grid._replace(day_length=day, days_per_time=1.0 / day)

    def flush(self) -> None:
        """Take the rows out of the buffer; the kernels get another one."""
        count = int(self.counts[layout.ROW_COUNT])
        self.counts[layout.ROW_COUNT] = 0
        if count and self.keep_rows:
            if self._spins is not None:
                self._blocks.append(with_spins(self._buffer[:count], self._spins.reshape(-1, 2)[:count]))
                return
            self._blocks.append(self._buffer[:count])
            self._buffer = self._buffers.blank()
            self.arrays = self.arrays._replace(rows=self._buffer.view(np.uint8))

    def add_rows(self, rows: Rows) -> None:
        """Put rows that no kernel wrote behind those that have been flushed."""
        self._blocks.append(rows)

    def take_rows(self) -> Rows:
        """The rows since the last call, an array of ROW."""
        self.flush()
        blocks, self._blocks = self._blocks, []
        if len(blocks) == 1:
            return blocks[0]
        return np.concatenate(blocks) if blocks else np.empty(0, row_of(self._spins is not None))
