"""The fast engine in the middle of a run: kernels do the work, Python does what is rare."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from eventsim.engines.base import Motion, Session, Snapshot, Stop
from eventsim.engines.ends import end_of_clock, sunk_speeds
from eventsim.engines.fast import FastOptions, layout, tally
from eventsim.engines.fast.compiled import is_compiling, link, mark_warm, timed_compiling
from eventsim.engines.fast.machine import FOREVER, Machine
from eventsim.engines.fast.rules import kind_of
from eventsim.engines.fast.rulings import Rulings
from eventsim.engines.only_wraps import only_wraps
from eventsim.engines.reference.ahead import meets_again
from eventsim.engines.turnover import epochs_to_kick, epochs_to_wrap, exponent_after, exponent_kicked
from eventsim.formulas.clock import EARLY, FIRST_WINDOW, MOST_EPOCHS, epochs_before, remainder_since
from eventsim.formulas.motion import position, velocity
from eventsim.record.events import Floats, Rows
from eventsim.scene.stage import Stage

COLUMNS = ("t", "x", "y", "vx", "vy", "wraps_x", "wraps_y", "contact_time", "at_once")
"""What a snapshot has one number of for every disk."""

LOW_COLUMNS = ("low_vx", "low_vy")
"""The same, where velocities have low parts."""

LOW_PLACES = ("low_x", "low_y")
"""The same, where places have low parts."""

LARGEST_BUDGET = 1 << 40
FEW_STEPS = 1024
"""Steps of a kernel where the clock has jumped and its contact is to come, which no budget ends."""


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
        self._open: Snapshot  # the flights of the open window
        self._before: Snapshot | None = None  # the same, when the clock has jumped to a contact that is still to come
        self._awaited = 0.0  # when that contact is due in the open window
        self._missed = -1.0  # when one is due in it that does not come where the clock jumps to
        self._clear = 0.0  # none is due in it before
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
            rulings = self._rulings
            self.reason, self.refused, self.sunk = rulings.reason, rulings.refused, rulings.sunk

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
        while counts[layout.STEPS] < last or self._before is not None:
            until = self._remainder(stop.until)
            turns = state.window_end <= until
            limit = state.window_end if turns else math.nextafter(until, math.inf)
            if self._before is not None:
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
                    machine.choose_cells(self.motion())
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
                stopped = self._rulings.resolve_instant()
                if state.window_rows:
                    self._came()
                if stopped is not None:
                    return stopped
            elif status == layout.STATUS_STUCK:
                return self._rulings.give_up(int(state.labels[counts[layout.DISK]]))
            elif status == layout.STATUS_FULL:
                machine.make_room(int(counts[layout.DISK]), self.motion(), for_ever)
            elif status in (layout.STATUS_LIMIT, layout.STATUS_IDLE):
                empty = bool(np.isinf(machine.due[0]) and np.all(np.isinf(machine.due)))
                if status == layout.STATUS_IDLE and not empty:
                    machine.schedule()
                elif self._before is not None:
                    if self._jump_back(until, stop.until):
                        return "until"
                elif turns and not (empty and for_ever):
                    if for_ever and not state.window_rows and self._only_looks():
                        machine.give_up_cells()
                    elif (stopped := self._end_window(for_ever)) is not None:
                        return stopped
                elif state.opened and not empty and (near := self._contact_near(until)) is not None and self._jump(near):
                    pass
                elif empty or not machine.renew_stale():
                    self._pass_to(until)
                    return "quiet" if empty or not self._meets_again() else "until"
            if for_ever and state.opened and self._only_looks():
                machine.give_up_cells()
        return None

    def _end_window(self, for_ever: bool) -> str | None:
        """Let the clock turn over, or the window stay open if it had no row.

        Why the run stops there: the clock has come to its end, or nothing is ahead but wraps.
        """
        machine, state = self._machine, self.state
        if not (state.window_rows or state.opened) and state.epoch < MOST_EPOCHS:
            epochs = self._epochs_to_wrap()
            if epochs is None or epochs > 1 << state.window:
                self._open = self.snapshot()
                state.stay_open(epochs)
                self._clear, self._missed = 0.0, -1.0
                return None
        if state.epoch >= MOST_EPOCHS:  # nothing more can be logged
            return self._stop_at_the_end(machine.next_contact())
        if state.window_rows and (sentence := sunk_speeds(self.stage, state.window_rows, state.anchors)) is not None:
            self._rulings.reason = sentence
            self._pass_to(state.window_end)
            return "digits"
        idles = for_ever and not state.window_rows
        self._remember(for_ever)
        self._idle = self._idle + state.window_end if idles else 0.0
        self._rulings.forget()
        self.counters.turnovers += 1
        machine.turn_over(
            state.window_end,
            int(state.window_end / state.epoch_length),
            exponent_after(self.stage, state.window, state.window_rows, state.anchors),
        )
        return "quiet" if idles and self._only_wraps() else None

    def _came(self) -> None:
        """A row has come: the clock does not jump back, and a window that was open ends with the epoch."""
        self._before = None
        self.state.close()

    def _epochs_to_wrap(self) -> int | None:
        return epochs_to_wrap(self.stage, self.state.epoch, self.state.window, self.state.anchors())

    def _stop_at_the_end(self, due: float) -> str:
        """Stop at the end of the clock, at or before a time at which the next contact is due: why."""
        state = self.state
        end = min(state.window_end, (MOST_EPOCHS - state.epoch) * state.epoch_length) if state.opened else state.window_end
        word, self._rulings.reason = end_of_clock(self.stage, state.epoch, end, due, self._meets_again())
        if word != "quiet":
            self._pass_to(end)
        return word

    def _jump(self, due: float) -> bool:
        """Let the clock jump from an open window to a contact that is due there; whether it counts so far.

        All disks are advanced to shortly before it, and predicted anew.  If no row comes there, the clock jumps back.
        """
        state = self.state
        epochs = epochs_before(due, state.window, state.epoch_length)
        if state.epoch + epochs > MOST_EPOCHS:
            return False
        self._before, self._awaited = replace(self._open, now=state.now), due
        exponent = exponent_after(self.stage, state.window, 0, state.anchors)
        self._turn_over_now(epochs * state.epoch_length, epochs, exponent)
        return True

    def _turn_over_now(self, end: float, epochs: int, exponent: int) -> None:
        self._rulings.forget()
        self.counters.turnovers += 1
        self._machine.jump(end, epochs, exponent)

    def _jump_back(self, until: float, stop: float | None) -> bool:
        """Be in the open window again where the contact does not come, or not until the stop; whether that is reached."""
        assert self._before is not None
        before, self._before = self._before, None
        stops = until < self._latest
        self._missed = -1.0 if stops else self._awaited
        self.counters.turnovers -= 1
        self._machine.set_epoch(before.epoch)
        self._be_open(max(before.now, self._remainder(stop)) if stops else before.now)
        self._machine.choose_cells(self.motion())
        return stops

    @property
    def _latest(self) -> float:
        """The time behind a jump at which the contact that it was for has come, or does not come."""
        return 2.0 * self.state.epoch_length

    def _be_open(self, now: float) -> None:
        """Be at a time of the open window; nothing is predicted yet."""
        self._set_flights(self._open)
        self.state.stay_open(self._epochs_to_wrap())
        self._machine.set_now(now)

    def _undo(self, counts: NDArray[np.int64], sums: Floats, now: float) -> None:
        """Forget the row that kernels have found in the open window."""
        machine = self._machine
        for place in (layout.EVENTS, layout.PAIRS, layout.WALLS, layout.ROW_COUNT):
            machine.counts[place] = counts[place]
        for place in (layout.DEEPEST, layout.OUTER_X, layout.OUTER_Y):
            machine.sums[place] = sums[place]
        self._be_open(now)

    def _contact_near(self, until: float) -> float | None:
        """The time of a contact that is due behind `until`, but for which the clock jumps to a time before it; else None.

        After the jump the same contact may come until then, since the times are rounded.
        """
        machine, state = self._machine, self.state
        ahead = (until // state.epoch_length + 1.0 + EARLY) * state.epoch_length
        goal = min(ahead, state.window_end)
        if goal <= self._clear or not np.any(machine.due < goal):
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
        self._undo(*kept, until)
        machine.choose_cells(self.motion())
        if found is None:
            self._clear = goal
        return None if found == self._missed else found

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

    def _only_wraps(self) -> bool:
        """Whether disks will wrap for ever, and never meet anything again."""
        return only_wraps(self.stage, self.state.anchors(), self._idle)

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
        self._shorten_window(i, vx, vy)
        self._rulings.kick(i, vx, vy)

    def _shorten_window(self, i: int, vx: float, vy: float) -> None:
        """Let the clock turn over at a kick before which nothing happened for long, or whose disk is too fast for the window."""
        stage, state = self.stage, self.state
        exponent = exponent_kicked(stage, state.window, lambda: state.anchors().kicked(i, vx, vy))
        epochs = epochs_to_kick(stage, state.epoch, state.now, state.window_rows, exponent < state.window)
        if epochs:
            self._turn_over_now(state.now, epochs, exponent)
        elif state.now < state.epoch_length:
            state.begin_window(exponent)
            self._machine.choose_screen()

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
            sides=s.sides_of_all(),
            **{name: tuple(getattr(s, name).every().tolist()) for name in self._columns},
        )

    def restore(self, saved: Snapshot) -> None:
        """Go on from a snapshot, this engine's or another's."""
        self._idle, self._behind, self._before = 0.0, None, None
        self._clear, self._missed = 0.0, -1.0
        self._machine.set_epoch(saved.epoch)
        self._machine.set_now(saved.now)
        self._set_flights(saved)
        self.state.close()
        with timed_compiling(self._note_compiling):
            self._machine.choose_cells(self.motion())

    def _set_flights(self, saved: Snapshot) -> None:
        """Fly on, and count the rows of the window, as a snapshot says."""
        s = self.state
        self._rulings.forget()
        s.window_rows = saved.window_rows
        s.begin_window(saved.window)
        for name in self._columns:
            getattr(s, name).set_all(getattr(saved, name))
        s.forget_all()
        for i, met in enumerate(saved.met):
            if met:
                s.met[i] = met
        s.set_sides(saved.sides)

    def _begin(self) -> None:
        """Go to the beginning, where all but the flights is zero."""
        s, stage = self.state, self.stage
        self._machine.set_epoch(0)
        self._machine.set_now(0.0)
        s.window_rows = 0
        s.begin_window(FIRST_WINDOW)
        for name in ("x", "y", "vx", "vy"):
            getattr(s, name).set_all(getattr(stage, name))
        s.contact_time.set_all(-math.inf)
        s.forget_all()
        with timed_compiling(self._note_compiling):
            self._machine.choose_cells(self.motion())
