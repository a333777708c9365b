"""The fast engine in the middle of a run: kernels do the work, Python does what is rare."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from eventsim.engines.base import Motion, Session, Snapshot, Stop
from eventsim.engines.clock_end import at_the_last_epoch
from eventsim.engines.drift import only_wraps
from eventsim.engines.fast import FastOptions, layout, tally
from eventsim.engines.fast.compiled import is_compiling, link, mark_warm, timed_compiling
from eventsim.engines.fast.machine import FOREVER, Machine
from eventsim.engines.fast.rules import kind_of
from eventsim.engines.fast.rulings import Rulings
from eventsim.engines.reference.ahead import meets_again
from eventsim.formulas.clock import FIRST_WINDOW, MOST_EPOCHS, remainder_since, window_length
from eventsim.formulas.motion import position, velocity
from eventsim.record.events import Rows
from eventsim.scene.stage import Stage

COLUMNS = ("t", "x", "y", "vx", "vy", "wraps_x", "wraps_y", "contact_time", "at_once")
"""What a snapshot has one number of for every disk."""

LOW_COLUMNS = ("low_vx", "low_vy")
"""The same, where velocities have low parts."""

LOW_PLACES = ("low_x", "low_y")
"""The same, where places have low parts."""

LARGEST_BUDGET = 1 << 40


class FastSession(Session):
    """The fast engine in the middle of a run.

    keep_rows: whether the log is wanted.  saved: the snapshot that it goes on from; None: the beginning.
    """

    name = "fast"

    def __init__(
        self,
        stage: Stage,
        keep_rows: bool = True,
        options: FastOptions | None = None,
        saved: Snapshot | None = None,
    ) -> None:
        super().__init__(stage)
        options = options or FastOptions()
        self._marked: object = False
        self._idle = 0.0  # time since the end of the last window that had rows
        self._behind: Snapshot | None = None  # where the last flight began, in an earlier window
        self._machine = Machine(stage, keep_rows, options.lanes, options.sizes)
        self.state = self._machine.state
        self._rulings = Rulings(self._machine, self.counters)
        self._columns = (
            *COLUMNS,
            *(LOW_COLUMNS if stage.low_parts else ()),
            *(LOW_PLACES if stage.low_places else ()),
        )
        with timed_compiling(self._note_compiling):
            link()
        if saved is None:
            self._begin()
        else:
            self.restore(saved)

    def advance(self, stop: Stop, budget: int) -> str | None:
        """Simulate until the stop or for about `budget` steps; the reason to stop, None where the budget ended first."""
        tally.take_from(self.counters, self._machine.counts, self._machine.sums)
        try:
            with timed_compiling(self._note_compiling):
                stopped = self._advance(stop, budget)
            if stopped == "quiet" and stop.until is None:
                self._go_back()
            machine = self._machine
            if machine.grid.deep != self._marked:  # the one thing in a kind that a run may change
                mark_warm(kind_of(self.stage, machine.grids, machine.keep_rows))
                self._marked = machine.grid.deep
            return stopped
        finally:
            tally.tell(self.counters, self._machine.counts, self._machine.sums)
            self.reason, self.refused = self._rulings.reason, self._rulings.refused

    @property
    def prepares(self) -> bool:
        """Whether the session only prepares itself, so that an interrupt may break in."""
        return is_compiling()

    def _note_compiling(self, seconds: float) -> None:
        self.compile_s += seconds

    def _advance(self, stop: Stop, budget: int) -> str | None:
        machine, state = self._machine, self.state
        counts = machine.counts
        for_ever = stop.until is None
        target = FOREVER if stop.events is None else min(stop.events, FOREVER)
        last = int(counts[layout.STEPS]) + min(budget, LARGEST_BUDGET)
        while counts[layout.STEPS] < last:
            until = self._remainder(stop.until)
            turns = state.window_end <= until
            limit = state.window_end if turns else math.nextafter(until, math.inf)
            status = machine.run(limit, target, last - int(counts[layout.STEPS]))
            if status == layout.STATUS_EVENTS:
                return "events"
            if status == layout.STATUS_ROWS:
                machine.flush()
                return None  # so that whoever takes the rows can begin
            if status == layout.STATUS_TIE:
                if (stopped := self._rulings.resolve_instant()) is not None:
                    return stopped
            elif status == layout.STATUS_STUCK:
                return self._rulings.give_up(int(state.labels[counts[layout.DISK]]))
            elif status == layout.STATUS_FULL:
                machine.make_room(int(counts[layout.DISK]), self.motion(), for_ever)
            elif status in (layout.STATUS_LIMIT, layout.STATUS_IDLE):
                empty = bool(np.isinf(machine.due[0]) and np.all(np.isinf(machine.due)))
                if status == layout.STATUS_IDLE and not empty:
                    machine.schedule()
                elif turns and not (empty and for_ever):
                    idles = for_ever and not state.window_rows
                    if idles and self._only_looks():
                        machine.give_up_cells()
                        continue
                    if state.epoch >= MOST_EPOCHS:
                        due, end = machine.next_contact(), state.window_end
                        word, self._rulings.reason = at_the_last_epoch(self.stage, state.epoch, end, due)
                        if word != "quiet":
                            self._pass_to(end)
                        return word
                    self._remember(for_ever)
                    self._idle = self._idle + state.window_end if idles else 0.0
                    self._rulings.forget()
                    machine.turn_over()
                    self.counters.turnovers += 1
                    if idles and self._drifts():
                        return "quiet"
                elif empty or not machine.renew_stale():
                    self._pass_to(until)
                    return "quiet" if empty or not self._meets_again() else "until"
        return None

    @property
    def memory(self) -> int:
        """Bytes of the arrays that kernels work in."""
        return self._machine.memory

    def _meets_again(self) -> bool:
        """Whether more is ahead than passages from cell to cell."""
        if self.stage.size is not None or self._machine.next_contact() < math.inf:
            return True
        return meets_again(self.stage, self.snapshot(), self.motion())

    def _only_looks(self) -> bool:
        """Whether nothing is ahead but looking for smaller disks, which on the open plane has no end."""
        partners = self.state.words[: self.state.n, layout.PARTNER]
        return self._machine.grid.levels is not None and bool(np.isin(partners, (layout.LOOK, layout.NOTHING)).all())

    def _drifts(self) -> bool:
        """Whether disks will wrap for ever, and never meet anything again."""
        state = self.state
        straight = not (np.any(state.gravity_x.every()) or np.any(state.gravity_y.every()))
        return straight and only_wraps(self.stage, state.vx.every(), state.vy.every(), self._idle)

    def _remember(self, for_ever: bool) -> None:
        """Before the clock turns over: keep where the last flight began; on the open plane it may have been the last of all."""
        if not for_ever:
            self._behind = None
        elif self.stage.size is None and (self.state.window_rows or self._behind is None):
            self._behind = replace(self.snapshot(), now=float(self.state.t.every().max()))

    def _go_back(self) -> None:
        """Stand where the last flight began: how far a search for contacts went that are not there is no part of a run."""
        last = float(self.state.t.every().max())
        if self._behind is not None and not self.state.window_rows:
            self.restore(self._behind)
        elif last < self.state.now:
            self.restore(replace(self.snapshot(), now=last))

    def _pass_to(self, until: float) -> None:
        if self.state.now < until < math.inf:
            self._machine.set_now(until)

    def _remainder(self, until: float | None) -> float:
        if until is None:
            return math.inf
        return remainder_since(self.state.epoch, self.stage.epoch_length, until, self.stage.start_time)

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
        tally.take_from(self.counters, self._machine.counts, self._machine.sums)  # which a restored run has set back
        self._rulings.kick(i, vx, vy)

    def take_rows(self) -> Rows:
        """The rows since the last call, an array of ROW."""
        return self._machine.take_rows()

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
        s, self._idle, self._behind = self.state, 0.0, None
        self._rulings.forget()
        self._machine.set_epoch(saved.epoch)
        s.window, s.window_rows = saved.window, saved.window_rows
        s.window_end = window_length(s.window, s.epoch_length)
        self._machine.set_now(saved.now)
        for name in self._columns:
            getattr(s, name).set_all(getattr(saved, name))
        s.forget_all()
        for i, met in enumerate(saved.met):
            if met:
                s.met[i] = met
        with timed_compiling(self._note_compiling):
            self._machine.choose_cells(self.motion())

    def _begin(self) -> None:
        """Go to the beginning, where all but the flights is zero."""
        s, stage = self.state, self.stage
        self._machine.set_epoch(0)
        s.window, s.window_rows = FIRST_WINDOW, 0
        s.window_end = window_length(s.window, s.epoch_length)
        self._machine.set_now(0.0)
        for name in ("x", "y", "vx", "vy"):
            getattr(s, name).set_all(getattr(stage, name))
        s.contact_time.set_all(-math.inf)
        s.forget_all()
        with timed_compiling(self._note_compiling):
            self._machine.choose_cells(self.motion())
