"""The fast engine in the middle of a run: kernels do the work, Python does what is rare."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from eventsim.engines.base import Counters, Motion, Snapshot, Stop, rows_from
from eventsim.engines.fast import layout
from eventsim.engines.fast.buffers import ROOM, Buffers
from eventsim.engines.fast.compiled import link, mark_warm, timed_compiling
from eventsim.engines.fast.grids import Grids
from eventsim.engines.fast.instant import contacts_between, due_at
from eventsim.engines.fast.lanes import lanes_work
from eventsim.engines.fast.layout import Arrays, Grid
from eventsim.engines.fast.loop import fill, predict_some, run, schedule, turn_over
from eventsim.engines.fast.order import along_a_curve
from eventsim.engines.fast.plan import ORDERED_DISKS, Sizes, day_length, shortest_day
from eventsim.engines.fast.rules import features_of, kind_of, rules_of, supports_of
from eventsim.engines.fast.state import FastState
from eventsim.engines.reference.calendar import CONTACT, Event
from eventsim.engines.reference.generation import Ties, components, disks_of, row_order
from eventsim.engines.reference.loop import endless, refused
from eventsim.engines.reference.resolve import Resolver
from eventsim.engines.reference.rests import TwoSupportsError
from eventsim.formulas.clock import FIRST_WINDOW, MOST_EPOCHS, next_window, remainder_since, window_length
from eventsim.formulas.motion import position, velocity
from eventsim.formulas.roots import NEARLY
from eventsim.formulas.simultaneous import SqueezedError
from eventsim.record.events import ROW, Floats, Rows
from eventsim.record.times import two_sum
from eventsim.scene.stage import Stage

COLUMNS = ("t", "x", "y", "vx", "vy", "wraps_x", "wraps_y", "contact_time", "at_once")
"""What a snapshot has one number of for every disk."""

LOW_COLUMNS = ("low_vx", "low_vy")
"""The same, where velocities have low parts."""
ROUNDS = 2.0
"""Times around the domain without an event after which disks that move along an axis are known to meet nothing."""

FOREVER, LARGEST_BUDGET = 1 << 60, 1 << 40
FEW_STEPS = 256
TOO_FEW_DAYS, TOO_MANY_DAYS = 0.5, 6.0
"""Days that an event may take, on the average of so many steps; outside, the length of a day is chosen anew."""


class FastSession:
    """The fast engine in the middle of a run.

    stage: what is simulated.  keep_rows: whether the log is wanted.  lanes: predict eight pairs at a time; None: where the
    processor can.  sizes: the cells, None for none; left out, the engine chooses.
    """

    name = "fast"

    def __init__(
        self,
        stage: Stage,
        keep_rows: bool = True,
        lanes: bool | None = None,
        sizes: Sizes | tuple[Sizes, ...] | str | None = "auto",
        saved: Snapshot | None = None,
    ) -> None:
        self.stage = stage
        self.counters = Counters()
        self.reason: str | None = None
        self.refused = False
        self._keep_rows = keep_rows
        self._counts = np.zeros(13, np.int64)
        self._sums = np.zeros(6)
        self._grids = Grids(stage, sizes)
        straight = stage.gravity is None
        plain = stage.mass is None or not np.any(np.isinf(stage.mass) | (stage.mass == 0.0))
        wanted = lanes_work() if lanes is None else lanes
        self._lanes = 8 if wanted and straight and plain else None
        order = along_a_curve(stage.x, stage.y) if stage.n >= ORDERED_DISKS else np.arange(stage.n)
        self.state = FastState(stage, order, self._counts)
        self._columns = (*COLUMNS, *LOW_COLUMNS) if stage.low_parts else COLUMNS
        self._rules = rules_of(stage)
        self._features = features_of(stage)
        self._supports = supports_of(stage)
        self._mass = None if stage.mass is None else np.ascontiguousarray(stage.mass[order])
        self._buffers = Buffers()
        self._buffer = self._buffers.blank() if keep_rows else np.empty(0, ROW)
        self._counts[layout.ROOM] = ROOM if keep_rows else 2 * FOREVER
        self._blocks: list[Rows] = []
        self.compile_s = 0.0
        self._marked: object = False
        self._days = self._steps = 0
        self._remade = 0, 0, 0.0
        self._found, self._times = np.empty((64, 4), np.int64), np.empty(64)
        self._ties = Ties(stage, self.state)
        self._spent: set[Event] = set()
        self._resolver: Resolver | None = None
        self._grid: Grid
        self._arrays: Any
        with timed_compiling(self._note_compiling):
            link()
        if saved is None:
            self._begin()
        else:
            self.restore(saved)

    def advance(self, stop: Stop, budget: int) -> str | None:
        """Simulate until the stop or for about `budget` steps; the reason to stop, None where the budget ended first."""
        self._take_counters()
        try:
            with timed_compiling(self._note_compiling):
                stopped = self._advance(stop, budget)
            if self._grid.deep != self._marked:  # the one thing in a kind that a run may change
                mark_warm(kind_of(self.stage, self._grids, self._keep_rows))
                self._marked = self._grid.deep
            return stopped
        finally:
            self._tell_counters()

    def _note_compiling(self, seconds: float) -> None:
        self.compile_s += seconds

    def _advance(self, stop: Stop, budget: int) -> str | None:
        state, counts = self.state, self._counts
        target = FOREVER if stop.events is None else min(stop.events, FOREVER)
        last = int(counts[layout.STEPS]) + min(budget, LARGEST_BUDGET)
        while counts[layout.STEPS] < last:
            until = self._remainder(stop.until)
            turns = state.window_end <= until
            limit = state.window_end if turns else math.nextafter(until, math.inf)
            status = self._run(limit, target, last - int(counts[layout.STEPS]))
            if status == layout.STATUS_EVENTS:
                return "events"
            if status == layout.STATUS_ROWS:
                self._flush()
                return None  # rows are best drained while they are in the caches
            if status == layout.STATUS_TIE:
                if (stopped := self._resolve_instant()) is not None:
                    return stopped
            elif status == layout.STATUS_STUCK:
                return self._give_up(int(state.labels[counts[layout.DISK]]))
            elif status == layout.STATUS_FULL:
                self._make_room(int(counts[layout.DISK]), stop)
            elif status in (layout.STATUS_LIMIT, layout.STATUS_IDLE):
                empty = bool(np.isinf(self._due[0]) and np.all(np.isinf(self._due)))
                if status == layout.STATUS_IDLE and not empty:
                    self._schedule()
                elif turns and not (empty and stop.until is None):
                    if stop.until is None and state.window_rows == 0:
                        if self._drifts():
                            return "quiet"
                        if self._only_looks():
                            self._grids = Grids(self.stage, None)
                            self._predict_afresh()
                            continue
                    if state.epoch >= MOST_EPOCHS:
                        return "quiet"
                    self._turn_over()
                else:
                    self._pass_to(until)
                    return "quiet" if empty else "until"
        return None

    def _run(self, limit: float, target: int, budget: int) -> int:
        counts = self._counts
        day, steps = int(counts[layout.DAY]), int(counts[layout.STEPS])
        status: int = run(self._arrays, self._grid, self._rules, counts, self._sums, limit, target, budget)
        self.state.now = float(self._sums[layout.NOW])
        self._days += int(counts[layout.DAY]) - day
        self._steps += int(counts[layout.STEPS]) - steps
        if self._steps > max(self.state.n, FEW_STEPS):
            if not TOO_FEW_DAYS < self._days / self._steps < TOO_MANY_DAYS:
                self._schedule()
            self._days = self._steps = 0
        return status

    @property
    def memory(self) -> int:
        """Bytes of the arrays that kernels work in."""
        arrays = [self.state.place_of, *(array for array in self._arrays if array is not None)]
        return sum(int(array.nbytes) for array in arrays)

    @property
    def _due(self) -> Floats:
        return self.state.disks[: self.state.n, layout.DUE]

    def _resolve_instant(self) -> str | None:
        """Resolve the contacts of the present instant that are predicted by now, by the reference engine's rules.

        Returns why the run stops here, None where it goes on.
        """
        state, now = self.state, self.state.now
        self._flush()
        near = self._contacts_until(now * NEARLY)
        generation = self._ties.settle(near) if any(event.time == now for event in near) else []
        resolver = self._opened_resolver()
        waiting = [int(state.labels[i]) for i in self._find(due_at, self._counts, now)[:, 0]]
        changed: list[int] = []
        for component in components(generation):
            try:
                changed += resolver.resolve(component)
            except (SqueezedError, TwoSupportsError) as refusal:
                self._keep(resolver)
                self.refused = True
                stopped, self.reason = refused(refusal, component)
                return stopped
        self._keep(resolver)
        self._arrays = self._arrays._replace(several=state.several.reshape(-1))
        for i in set(changed):
            self._predict_one(i, now)
        self._fly_on(near, generation, set(changed), waiting)
        stuck = next((i for i in changed if state.at_once[i] >= resolver.at_once_limit), None)
        return None if stuck is None else self._give_up(stuck)

    def _fly_on(self, near: list[Event], resolved: list[Event], changed: set[int], waiting: list[int]) -> None:
        """Predict disks anew whose contacts at the present time, resolved or not, came to nothing.

        Under gravity, which closes the gap, such a contact is still due.
        """
        now, falls = self.state.now, self.stage.gravity is not None
        if not falls:
            self._spent = {event for event in self._spent if event.time >= now}
            self._spent.update(event for event in resolved if changed.isdisjoint(disks_of(event)))
        left = {i for event in set(near).difference(resolved) if event.time == now for i in disks_of(event)}
        for i in waiting:
            if i not in changed:
                self._predict_one(i, now if falls or i in left else math.nextafter(now, math.inf))

    def _contacts_until(self, latest: float) -> list[Event]:
        """All contacts from the present time on that have not come to nothing, each once, in the order of rows."""
        labels, count = self.state.labels, self.state.count
        events = set()
        found = self._find(contacts_between, self._rules, self._counts, self.state.now, latest)
        for (i, partner, kx, ky), time in zip(found.tolist(), self._times.tolist(), strict=False):
            a = int(labels[i])
            b = int(labels[partner]) if partner >= 0 else partner
            if b >= 0 and b < a:
                a, b, kx, ky = b, a, -kx, -ky
            events.add(Event(time, CONTACT, a, b, (kx, ky), count[a], count[b] if b >= 0 else 0))
        return sorted(events - self._spent, key=lambda event: (row_order(event), event.image))

    def _find(self, search: Any, *where: Any) -> np.ndarray[Any, Any]:
        """What a search finds, with as much room as it needs."""
        while True:
            times = (self._times,) if search is contacts_between else ()
            count = search(self._arrays, self._grid, *where, self._found, *times)
            if count <= len(self._found):
                return self._found[:count].copy()
            self._found, self._times = np.empty((2 * count, 4), np.int64), np.empty(2 * count)

    def _opened_resolver(self) -> Resolver:
        """The reference engine's resolver on these records; it keeps its own lists, so only who needs it opens it."""
        if self._resolver is None:
            self._resolver = Resolver(self.stage, self.state, self.counters, self._keep_rows)
        self._tell_counters()
        return self._resolver

    def _keep(self, resolver: Resolver) -> None:
        """Take over what the resolver has counted and logged."""
        rows = resolver.take_rows()
        if rows:
            self._blocks.append(rows_from(rows, self.stage.epoch_length, self.stage.start_time))
        self._take_counters()

    def _take_counters(self) -> None:
        """Let the kernels go on from what the counters say."""
        counts, counters = self._counts, self.counters
        counts[layout.EVENTS] = counters.events
        counts[layout.PAIRS], counts[layout.WALLS] = counters.pair_contacts, counters.wall_contacts
        counts[layout.WRAPS], counts[layout.CROSSINGS] = counters.wraps, counters.crossings
        counts[layout.STALE] = counters.stale
        self._sums[layout.DEEPEST] = counters.deepest_overlap
        self._sums[layout.OUTER_X], self._sums[layout.OUTER_Y] = counters.outer_momentum

    def _tell_counters(self) -> None:
        """Let the counters say what the kernels have counted."""
        counts, counters = self._counts, self.counters
        counters.events = int(counts[layout.EVENTS])
        counters.pair_contacts, counters.wall_contacts = int(counts[layout.PAIRS]), int(counts[layout.WALLS])
        counters.wraps, counters.crossings = int(counts[layout.WRAPS]), int(counts[layout.CROSSINGS])
        counters.stale = int(counts[layout.STALE])
        counters.deepest_overlap = float(self._sums[layout.DEEPEST])
        counters.outer_momentum = [float(self._sums[layout.OUTER_X]), float(self._sums[layout.OUTER_Y])]

    def _flush(self) -> None:
        """Hand the rows of the buffer on; the kernels get a new one."""
        count = int(self._counts[layout.ROW_COUNT])
        self._counts[layout.ROW_COUNT] = 0
        if count and self._keep_rows:
            self._blocks.append(self._buffer[:count])
            self._buffer = self._buffers.blank()
            self._arrays = self._arrays._replace(rows=self._buffer.view(np.uint8))

    def _turn_over(self) -> None:
        state = self.state
        self.counters.turnovers += 1
        end = state.window_end
        turn_over(self._arrays, self._grid, self._rules, end)
        self._set_epoch(state.epoch + (1 << state.window))
        state.window = next_window(state.window, state.window_rows, state.n, state.window_cap)
        state.window_end = window_length(state.window, state.epoch_length)
        state.window_rows = 0
        self._set_now(0.0)
        if self._grid.day_length < shortest_day(state.window_end):
            self._choose_days()
        schedule(self._arrays, self._grid, self._counts, 0.0)
        self._predict(0, state.n, 0.0)

    def _set_epoch(self, epoch: int) -> None:
        self._spent.clear()
        self.state.epoch = self._counts[layout.EPOCH] = epoch
        begin = two_sum(epoch * self.stage.epoch_length, self.stage.start_time)
        self._sums[layout.EPOCH_BEGIN], self._sums[layout.EPOCH_ERROR] = begin

    def _set_now(self, now: float) -> None:
        self.state.now = now
        self._sums[layout.NOW] = now

    def _make_room(self, place: int, stop: Stop) -> None:
        """Make cells anew for the disks where they are, or deeper ones, because a cell was full that a disk was to enter.

        On the open plane new cells follow disks that part or fall.  If no stop time makes an end of that, they stay where they
        are once nothing else happens, so that all disks come to rest in outer cells.
        """
        events, epoch, now = self._remade
        same_time = (epoch, now) == (self.state.epoch, self.state.now)
        if same_time or (stop.until is None and events == self._counts[layout.EVENTS]):
            self._grids.deepen(int(self.state.words[place, layout.FLAGS]) // layout.FIRST_LEVEL)
        else:
            self._grids.choose(self.motion())
        self._predict_afresh()

    def _predict_afresh(self) -> None:
        """Fill cells and calendar anew, with more slots as long as a cell is full."""
        state, stage, now = self.state, self.stage, self.state.now
        self._remade = int(self._counts[layout.EVENTS]), state.epoch, now
        while True:
            self._grid = self._grids.grid(self._lanes)
            state.set_levels(self._grids.level)
            self._arrays = Arrays(
                state.memory,
                self._grids.slots(),
                self._grids.near(),
                state.several.reshape(-1),
                self._mass,
                state.low.reshape(-1) if state.low_parts else None,
                self._features,
                self._grids.table(),
                self._supports,
                self._buffer.view(np.uint8) if self._keep_rows else None,
            )
            full = fill(self._arrays, self._grid, self._rules, now)
            if full < 0:
                break
            self._grids.deepen(full)
        self._due[:] = now
        schedule(self._arrays, self._grid, self._counts, now)
        self._predict(0, stage.n, now)
        self._schedule()

    def _predict(self, begin: int, end: int, floor: float) -> None:
        """Predict the disks in these places anew; what is before `floor` does not count."""
        predict_some(self._arrays, self._grid, self._rules, self._counts, begin, end, self.state.now, floor)

    def _predict_one(self, i: int, floor: float) -> None:
        """Predict disk i anew; what is before `floor` does not count."""
        place = int(self.state.place_of[i])
        self._predict(place, place + 1, floor)

    def _choose_days(self) -> None:
        """Choose a fitting length of the days, for a calendar that is to be made anew."""
        day = day_length(self._due, self.state.now, self.state.window_end, self.state.n)
        self._grid = self._grid._replace(day_length=day, days_per_time=1.0 / day)

    def _schedule(self) -> None:
        """Make the calendar anew, with days of a fitting length."""
        self._choose_days()
        schedule(self._arrays, self._grid, self._counts, self.state.now)

    def _only_looks(self) -> bool:
        """Whether nothing is ahead but looking for smaller disks, which on the open plane has no end."""
        partners = self.state.words[: self.state.n, layout.PARTNER]
        return self._grid.levels is not None and bool(np.isin(partners, (layout.LOOK, layout.NOTHING)).all())

    def _drifts(self) -> bool:
        """Whether all disks have one velocity, for good, and nothing to meet: they would wrap for ever.

        Along an axis they come by the same places again, where they have met nothing if this window was long enough.
        """
        stage, state = self.stage, self.state
        vx, vy = state.vx.every(), state.vy.every()
        if np.ptp(vx) != 0.0 or np.ptp(vy) != 0.0 or np.any(state.gravity_x.every()) or np.any(state.gravity_y.every()):
            return False
        if not (stage.boundaries or stage.features):
            return True
        around = max((length for length in stage.period if length is not None), default=math.inf)
        rounds = state.window_end * max(abs(vx[0]), abs(vy[0])) / around
        return bool(vx[0] * vy[0] == 0.0 and rounds > ROUNDS)

    def _pass_to(self, until: float) -> None:
        if self.state.now < until < math.inf:
            self._set_now(until)

    def _remainder(self, until: float | None) -> float:
        if until is None:
            return math.inf
        return remainder_since(self.state.epoch, self.stage.epoch_length, until, self.stage.start_time)

    def _give_up(self, i: int) -> str:
        stopped, self.reason = endless(self.state, self.stage, i)
        return stopped

    @property
    def clock(self) -> tuple[int, float]:
        """Where the clock stands: (epoch, remainder)."""
        return self.state.epoch, self.state.now

    def motion(self) -> Motion:
        """Where all disks are now."""
        s = self.state
        lag = s.now - s.t.every()
        gx, gy = s.gravity_x.every(), s.gravity_y.every()
        vx, vy = s.vx.every(), s.vy.every()
        return Motion(
            position(s.x.every(), vx, lag, gx),
            position(s.y.every(), vy, lag, gy),
            velocity(vx, lag, gx),
            velocity(vy, lag, gy),
            s.wraps_x.every().astype(np.int64),
            s.wraps_y.every().astype(np.int64),
        )

    def kick(self, i: int, vx: float, vy: float) -> None:
        """Set the velocity of disk i from outside, now."""
        self._flush()
        resolver = self._opened_resolver()
        resolver.kick(i, vx, vy)
        self._keep(resolver)
        self._predict_one(i, self.state.now)

    def take_rows(self) -> Rows:
        """The rows since the last call, an array of ROW."""
        self._flush()
        blocks, self._blocks = self._blocks, []
        if len(blocks) == 1:
            return blocks[0]
        return np.concatenate(blocks) if blocks else np.empty(0, ROW)

    def snapshot(self) -> Snapshot:
        """All that the future depends on."""
        s = self.state
        return Snapshot(
            epoch=s.epoch,
            window=s.window,
            window_rows=s.window_rows,
            now=s.now,
            met=tuple(s.met[i] for i in range(s.n)),
            **{name: tuple(getattr(s, name).every().tolist()) for name in self._columns},
        )

    def restore(self, saved: Snapshot) -> None:
        """Go on from a snapshot, this engine's or another's."""
        s = self.state
        self._set_epoch(saved.epoch)
        s.window, s.window_rows = saved.window, saved.window_rows
        s.window_end = window_length(s.window, s.epoch_length)
        self._set_now(saved.now)
        for name in self._columns:
            getattr(s, name).set_all(getattr(saved, name))
        s.forget_all()
        for i, met in enumerate(saved.met):
            if met:
                s.met[i] = met
        with timed_compiling(self._note_compiling):
            self._grids.choose(self.motion())
            self._predict_afresh()

    def _begin(self) -> None:
        """Go to the beginning, where all but the flights is zero."""
        s, stage = self.state, self.stage
        self._set_epoch(0)
        s.window, s.window_rows = FIRST_WINDOW, 0
        s.window_end = window_length(s.window, s.epoch_length)
        self._set_now(0.0)
        for name in ("x", "y", "vx", "vy"):
            getattr(s, name).set_all(getattr(stage, name))
        s.contact_time.set_all(-math.inf)
        s.forget_all()
        with timed_compiling(self._note_compiling):
            self._grids.choose(self.motion())
            self._predict_afresh()
