"""The fast engine in the middle of a run: kernels do the work, Python does what is rare."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from eventsim.engines.base import Motion, Snapshot, Stop
from eventsim.engines.exact_session import ExactSession
from eventsim.engines.fast import FastOptions, layout
from eventsim.engines.fast.compiled import announce, is_compiling, link, mark_warm, timed_compiling
from eventsim.engines.fast.machine import FOREVER, Machine
from eventsim.engines.fast.python_resolver import PythonResolver
from eventsim.engines.fast.rules import kind_of
from eventsim.engines.fast.state import FastState
from eventsim.engines.reference.ahead import meets_again
from eventsim.formulas.motion import position, velocity
from eventsim.record.events import Floats, Rows
from eventsim.scene.stage import Stage

LARGEST_BUDGET = 1 << 40
FEW_STEPS = 1024
"""Steps of a kernel where the clock has jumped and its contact is to come, which no budget ends."""


class FastSession(ExactSession):
    """The fast engine in the middle of a run.

    keep_rows: whether the log is wanted.  saved: the snapshot that it goes on from; None: the beginning.
    others: waits for who compiles all kernels but the loop meanwhile; None: nobody does.
    """

    name = "fast"
    state: FastState

    def __init__(
        self,
        stage: Stage,
        keep_rows: bool = True,
        options: FastOptions | None = None,
        saved: Snapshot | None = None,
        others: Callable[[], object] | None = None,
    ) -> None:
        super().__init__(stage)
        options = options or FastOptions()
        self._marked: object = False
        self._open: Snapshot  # the flights of the open window
        self._machine = Machine(stage, keep_rows, options.lanes, options.sizes)
        self.state = self._machine.state
        self._resolver = PythonResolver(self._machine, self.counters)
        with timed_compiling(self._note_compiling):
            if saved is None:
                self._machine.set_epoch(0)
                self._machine.set_now(0.0)
                self.state.begin(stage)
            else:
                self._fly_as(saved)
            if others is not None:
                announce(bool(stage.features))
                self._machine.compile_loop(self.motion())
                others()
            link(bool(stage.features))
            self._predict_afresh()

    def advance(self, stop: Stop, budget: int) -> str | None:
        """Simulate until the stop or for about `budget` steps; the reason to stop, None where the budget ended first."""
        self._machine.take_counters(self.counters)
        try:
            stopped = super().advance(stop, budget)
        finally:
            self._machine.tell_counters(self.counters)
        machine = self._machine
        if machine.grid.deep != self._marked:  # the one thing in a kind that a run may change
            mark_warm(kind_of(self.stage, machine.grids, machine.keep_rows))
            self._marked = machine.grid.deep
        return stopped

    def compile(self, with_loop: bool = True) -> None:
        """Compile all that a run may need: an event, a turnover, a look at an instant.  The session is of no use after that.

        with_loop: False where another process compiles that for an event.
        """
        if with_loop:
            self.advance(Stop(events=1), 1)
        with timed_compiling(self._note_compiling):
            self._machine.turn_over(self.state.now, 0, self.state.window)
            self._resolver.waiting()
            self._resolver.contacts_until(self.state.now)

    @property
    def prepares(self) -> bool:
        """Whether the session only prepares itself, so that an interrupt may break in."""
        return is_compiling()

    def _note_compiling(self, seconds: float) -> None:
        self.compile_s += seconds

    def _advance(self, stop: Stop, budget: int) -> str | None:
        with timed_compiling(self._note_compiling):
            return self._run(stop, budget)

    def _run(self, stop: Stop, budget: int) -> str | None:
        machine, state = self._machine, self.state
        counts = machine.counts
        for_ever = stop.until is None
        target = FOREVER if stop.events is None else min(stop.events, FOREVER)
        last = int(counts[layout.STEPS]) + min(budget, LARGEST_BUDGET)
        while counts[layout.STEPS] < last or self._before is not None:
            until = self._remainder(stop.until)
            turns = state.window_end <= until
            limit = state.window_end if turns else math.nextafter(until, math.inf)
            if waits := self._before is not None:
                limit = min(limit, self._latest)
            now, most = state.now, target
            if state.opened:
                kept, most = (counts.copy(), machine.sums.copy()), min(target, int(counts[layout.EVENTS]) + 1)
            steps = last - int(counts[layout.STEPS]) if self._before is None else FEW_STEPS
            status = machine.run(limit, most, steps)
            if state.opened and (state.window_rows or status == layout.STATUS_TIE) and state.now != self._missed:
                contact = state.now
                self._undo(*kept, now)
                if not self._jump(contact):
                    self._predict_afresh()
                    return self._stop_at_the_end(contact)
                continue
            if state.window_rows:
                self._came()
            if status == layout.STATUS_EVENTS and counts[layout.EVENTS] >= target:
                return "events"
            if status == layout.STATUS_ROWS:
                machine.flush()
                if self._before is None:
                    return None  # so that whoever takes the rows can begin
            elif status == layout.STATUS_TIE:
                stopped = self._resolver.resolve_instant()
                if state.window_rows:
                    self._came()
                if stopped is not None:
                    return self._stop_as_told(stopped)
            elif status == layout.STATUS_STUCK:
                return self._stop_as_told(self._resolver.give_up(int(state.labels[counts[layout.DISK]])))
            elif status == layout.STATUS_FULL:
                machine.make_room(int(counts[layout.DISK]), self.motion(), for_ever)
            elif status in (layout.STATUS_LIMIT, layout.STATUS_IDLE):
                empty = bool(np.isinf(machine.due[0]) and np.all(np.isinf(machine.due)))
                if status == layout.STATUS_IDLE and not empty:
                    machine.schedule()
                elif self._before is not None:
                    if self._jump_back(until, stop.until):
                        return "until"
                elif waits:
                    continue  # what it waited for has come; the window goes on
                elif turns and not (empty and for_ever):
                    if for_ever and not state.window_rows and self._only_looks():
                        machine.give_up_cells()
                    elif (stopped := self._end_window(for_ever)) is not None:
                        return stopped
                elif (
                    state.opened and not empty and (near := self._contact_near(until)) is not None and self._jump(near)
                ):
                    pass
                elif empty or not machine.renew_stale():
                    self._pass_to(until)
                    return "quiet" if empty or not self._meets_again() else "until"
            if for_ever and state.opened and self._only_looks():
                machine.give_up_cells()
        return None

    def _stop_as_told(self, stopped: str) -> str:
        """Stop as the resolver says, and for its reasons."""
        told = self._resolver
        self.reason, self.refused, self.sunk = told.reason, told.refused, told.sunk
        return stopped

    def _leave_open(self, epochs: int | None) -> None:
        self._open = self.snapshot()
        super()._leave_open(epochs)

    def _turn(self, end: float, epochs: int, exponent: int, strayed: bool) -> None:
        self._resolver.forget()
        (self._machine.jump if strayed else self._machine.turn_over)(end, epochs, exponent)

    def _fly_as(self, saved: Snapshot) -> None:
        self._resolver.forget()
        self._machine.set_epoch(saved.epoch)
        self._machine.set_now(saved.now)
        self.state.restore(saved)

    def _predict_afresh(self) -> None:
        self._machine.choose_cells(self.motion())

    def _set_now(self, now: float) -> None:
        self._machine.set_now(now)

    def _begin_window(self, exponent: int) -> None:
        self.state.begin_window(exponent)
        self._machine.choose_screen()

    def _next_contact(self) -> float:
        return self._machine.next_contact()

    def _meets_on_the_plane(self) -> bool:
        return meets_again(self.stage, self.snapshot(), self.motion())

    def _undo(self, counts: NDArray[np.int64], sums: Floats, now: float) -> None:
        """Forget the row that kernels have found in the open window."""
        machine = self._machine
        for place in (layout.EVENTS, layout.PAIRS, layout.WALLS, layout.ROW_COUNT):
            machine.counts[place] = counts[place]
        for place in (layout.DEEPEST, layout.OUTER_X, layout.OUTER_Y):
            machine.sums[place] = sums[place]
        self._be_open(self._open)
        machine.set_now(now)

    def _search(self, goal: float, now: float) -> float | None:
        machine, state = self._machine, self.state
        if not np.any(machine.due < goal):
            return None
        kept, status = (machine.counts.copy(), machine.sums.copy()), layout.STATUS_BUDGET
        while not state.window_rows and status not in (layout.STATUS_TIE, layout.STATUS_LIMIT):
            status = machine.run(goal, int(machine.counts[layout.EVENTS]) + 1, LARGEST_BUDGET)
            if status == layout.STATUS_ROWS:
                machine.flush()
                kept[0][layout.ROW_COUNT] = 0
            elif status == layout.STATUS_FULL:
                machine.make_room(int(machine.counts[layout.DISK]), self.motion(), False)
            elif status == layout.STATUS_IDLE:
                if not np.any(machine.due < goal):
                    break
                machine.schedule()
        found = state.now if state.window_rows or status == layout.STATUS_TIE else None
        self._undo(*kept, now)
        self._predict_afresh()
        return found

    @property
    def memory(self) -> int:
        """Bytes of the arrays that kernels work in."""
        return self._machine.memory

    def _only_looks(self) -> bool:
        """Whether nothing is ahead but looking for smaller disks, which on the open plane has no end."""
        partners = self.state.words[: self.state.n, layout.PARTNER]
        return self._machine.grid.levels is not None and bool(np.isin(partners, (layout.LOOK, layout.NOTHING)).all())

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
            None if s.spin is None else s.spin.every(),
        )

    def kick(self, i: int, vx: float, vy: float) -> None:
        """Set the velocity of disk i from outside, now."""
        self._machine.take_counters(self.counters)  # which a restored run has set back
        super().kick(i, vx, vy)

    def _kick(self, i: int, vx: float, vy: float) -> None:
        self._resolver.kick(i, vx, vy)
        if int(self.state.place_of[i]) < (self._machine.grids.posts or 0):  # it moves from now on
            self._predict_afresh()

    def _pair_contacts(self) -> int:
        return int(self._machine.counts[layout.PAIRS])

    def take_rows(self) -> Rows:
        """The rows since the last call, an array of ROW."""
        return self._machine.take_rows()

    def restore(self, saved: Snapshot) -> None:
        """Go on from a snapshot, this engine's or another's."""
        with timed_compiling(self._note_compiling):
            super().restore(saved)
