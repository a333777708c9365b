"""The loop: pop the earliest event, advance, resolve, predict; a session that can be stopped and continued anywhere."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from eventsim.engines.base import Motion, Session, Snapshot, Stop, rows_from
from eventsim.engines.collapse import LIES_STILL, named
from eventsim.engines.ends import end_of_clock, sunk_speeds
from eventsim.engines.only_wraps import only_wraps
from eventsim.engines.reference import ReferenceOptions
from eventsim.engines.reference.advance import cross, refill, wrap
from eventsim.engines.reference.ahead import meets_again
from eventsim.engines.reference.calendar import CONTACT, CROSSING, WRAP, Calendar, Event
from eventsim.engines.reference.cells import Cells, Grid, plan
from eventsim.engines.reference.generation import Ties, components
from eventsim.engines.reference.invariants import check_invariants
from eventsim.engines.reference.predict import Predictor
from eventsim.engines.reference.resolve import Resolver
from eventsim.engines.reference.rests import TwoSupportsError
from eventsim.engines.reference.state import EngineState
from eventsim.engines.reference.sunk import Sunk
from eventsim.engines.reference.wide import WidePredictor
from eventsim.engines.turnover import epochs_to_kick, epochs_to_wrap, exponent_after, exponent_kicked
from eventsim.formulas.clock import EARLY, MOST_EPOCHS, epochs_before, remainder_since, window_length
from eventsim.formulas.doubt import latest_tie, screen_in
from eventsim.formulas.real import Real
from eventsim.formulas.simultaneous import SqueezedError
from eventsim.record.events import Rows
from eventsim.scene.stage import Stage


class ReferenceSession(Session):
    """The reference engine in the middle of a run.

    keep_rows: whether the log is wanted.  number: what makes the engine's numbers from floats.
    """

    name = "reference"
    predictor: type[Predictor] = Predictor
    resolver: type[Resolver] = Resolver

    def __init__(
        self,
        stage: Stage,
        keep_rows: bool = True,
        options: ReferenceOptions | None = None,
        number: Any = float,
    ) -> None:
        super().__init__(stage)
        options = options or ReferenceOptions()
        self.state = EngineState(stage, number)
        self.calendar = self._new_calendar()
        chosen: Grid | None = plan(stage) if isinstance(options.grid, str) else options.grid
        self.cells = None if chosen is None else Cells(stage, chosen)
        self._check = options.check
        self._idle = 0.0  # time since the end of the last window that had rows
        self._behind: Snapshot | None = None  # where the last flight began, in an earlier window
        self._before: Snapshot | None = None  # the open window, when the clock has jumped to a contact that is still to come
        self._awaited: Real = 0.0  # when that contact is due in the open window
        self._missed: Real = -1.0  # when one is due in it that does not come where the clock jumps to
        self._clear: Real = 0.0  # none is due in it before
        fine = self.state.low_places and self.predictor is Predictor
        self._predictor = (WidePredictor if fine else self.predictor)(stage, self.state, self.calendar, self.cells)
        self._resolver = self.resolver(stage, self.state, self.counters, keep_rows)
        self._ties = Ties(stage, self.state)
        self._sunk = Sunk(stage, self.state) if number is float else None
        self._predict_afresh()

    def _new_calendar(self) -> Calendar:
        return Calendar()

    def advance(self, stop: Stop, budget: int) -> str | None:
        """Simulate until the stop or for about `budget` steps; the reason to stop, None where the budget ended first."""
        until, for_ever = self._remainder(stop.until), stop.until is None
        state, calendar, counters, cells = self.state, self.calendar, self.counters, self.cells
        while budget > 0 or self._before is not None:
            budget -= 1
            if stop.events is not None and counters.events >= stop.events:
                return "events"
            event = calendar.first()
            if event is not None and self.is_stale(event):
                calendar.pop()
                counters.stale += 1
                continue
            due = float("inf") if event is None else event.time
            if self._before is not None and (due > until or due >= self._latest):
                if self._jump_back(until, stop.until):
                    return "until"
                until = self._remainder(stop.until)
                continue
            if due >= state.window_end <= until and not (event is None and for_ever):
                stopped = self._end_window(for_ever)
                if stopped is not None:
                    return stopped
                until = self._remainder(stop.until)
                continue
            if event is None:
                self._pass_to(until)
                if for_ever:
                    self._go_back()
                return "quiet"
            if due > until:
                if state.opened and (contact := self._contact_near(until)) is not None and self._jump(contact):
                    until = self._remainder(stop.until)
                    continue
                self._pass_to(until)
                return "until" if self._meets_again() else "quiet"
            if state.opened and event.rank == CONTACT and due != self._missed:
                if not self._jump(due):
                    return self._stop_at_the_end(due, for_ever)
                until = self._remainder(stop.until)
                continue
            state.now = due
            if event.rank == WRAP:
                calendar.pop()
                counters.wraps += 1
                wrap(state, cells, event, self.stage.period[event.b])  # type: ignore[arg-type]
                self._predictor.predict(event.a, due)
            elif event.rank == CROSSING:
                self._cross(event)
            else:
                stopped = self._resolve_instant()
                if state.window_rows:
                    self._before = None
                    state.close()
                if stopped is not None:
                    return stopped
            if self._check:
                check_invariants(self)
        return None

    def _cross(self, event: Event) -> None:
        """Let a disk enter the next cell."""
        self.calendar.pop()
        self.counters.crossings += 1
        cross(self.cells, event)  # type: ignore[arg-type]
        self._predictor.predict_ahead(event.a, event.b, event.image[0], event.time)

    def _resolve_instant(self) -> str | None:
        """Resolve the contacts of the earliest instant that are predicted by now, then predict their disks anew."""
        generation = self._pop_generation()
        if self._sunk is not None and (sunk := self._sunk.reason(generation)) is not None:
            self.reason, self.sunk = sunk, True
            return "digits"
        changed: list[int] = []
        for component in components(generation):
            try:
                changed += self._resolver.resolve(component)
            except (SqueezedError, TwoSupportsError) as refusal:
                self.refused = True
                stopped, self.reason = refused(refusal, component)
                return stopped
        now = self.state.now
        if self.stage.gravity is not None:  # what came to nothing is still due: gravity closes the gap
            for event in generation:
                if not self.is_stale(event):
                    self.calendar.push(event)
        for i in changed:
            self._predictor.predict(i, now)
        for i in changed:
            if self.state.at_once[i] >= self._resolver.at_once_limit:
                return self._give_up(i)
        return None

    def _pop_generation(self) -> list[Event]:
        """Take out the contacts of one instant, the earliest one."""
        calendar = self.calendar
        first = calendar.pop()
        latest = latest_tie(first.time, self.tie_screen)
        second = calendar.first()
        if second is None or second.time > latest:
            return [first]
        calendar.push(first)
        near = dict.fromkeys(e for e in calendar.until(latest) if e.rank == CONTACT and not self.is_stale(e))
        generation = self._ties.settle(list(near))
        for event in generation:
            calendar.remove(event)
        return generation

    @property
    def tie_screen(self) -> float:
        """The span of time within which contacts that share a disk are ordered exactly."""
        length = window_length(self.state.window, self.stage.epoch_length)
        return screen_in(self.stage.tie_screen, length, self.stage.epoch_length)

    def is_stale(self, event: Event) -> bool:
        """Whether a disk of the event has begun another flight since the prediction."""
        count = self.state.count
        if count[event.a] != event.count_a:
            return True
        return event.rank == CONTACT and event.b >= 0 and count[event.b] != event.count_b

    def _end_window(self, for_ever: bool) -> str | None:
        """Let the clock turn over, or the window stay open if it had no row.

        Why the run stops there: the clock has come to its end, or nothing is ahead but wraps.
        """
        state = self.state
        if not (state.window_rows or state.opened) and state.epoch < MOST_EPOCHS:
            epochs = self._epochs_to_wrap()
            if epochs is None or epochs > 1 << state.window:
                state.stay_open(epochs)
                self._clear, self._missed = 0.0, -1.0
                return None
        if state.epoch >= MOST_EPOCHS:  # nothing more can be logged
            return self._stop_at_the_end(self._next_contact(), for_ever)
        if state.window_rows and (sentence := self._sunk_speeds()) is not None:
            self.reason = sentence
            self._pass_to(state.window_end)
            return "digits"
        idles = for_ever and not state.window_rows
        self._idle = self._idle + float(state.window_end) if idles else 0.0
        self._remember(for_ever)
        self._turn_over(state.window_end, int(state.window_end / state.epoch_length))
        if idles and self._only_wraps():
            self._go_back()
            return "quiet"
        return None

    def _sunk_speeds(self) -> str | None:
        """A sentence where speeds have sunk below the digits, so that the run ends with the window."""
        return sunk_speeds(self.stage, self.state.window_rows, self.state.anchors)

    def _epochs_to_wrap(self) -> int | None:
        return epochs_to_wrap(self.stage, self.state.epoch, self.state.window, self.state.anchors())

    def _stop_at_the_end(self, due: Real, for_ever: bool) -> str:
        """Stop at the end of the clock, at or before a time at which the next contact is due: why."""
        state = self.state
        end = min(state.window_end, (MOST_EPOCHS - state.epoch) * state.epoch_length) if state.opened else state.window_end
        word, self.reason = end_of_clock(self.stage, state.epoch, end, float(due), self._meets_again())
        if word != "quiet":
            self._pass_to(end)
        elif for_ever:
            self._go_back()
        return word

    def _turn_over(self, end: Real, epochs: int) -> None:
        """Let the clock go on by some epochs, at the time `end` of its window."""
        state = self.state
        self.counters.turnovers += 1
        state.turn_over(end, epochs, exponent_after(self.stage, state.window, state.window_rows, state.anchors))
        self._predict_afresh()

    def _jump(self, due: Real) -> bool:
        """Let the clock jump from an open window to a contact that is due there; whether it counts so far.

        All disks are advanced to shortly before it, and predicted anew.  If no row comes there, the clock jumps back.
        """
        state = self.state
        epochs = epochs_before(float(due), state.window, state.epoch_length)
        if state.epoch + epochs > MOST_EPOCHS:
            return False
        self._before, self._awaited = state.snapshot(), due
        self._turn_over(epochs * state.epoch_length, epochs)
        return True

    def _jump_back(self, until: Real, stop: float | None) -> bool:
        """Be in the open window again where the contact does not come, or not until the stop; whether that is reached."""
        assert self._before is not None
        before, self._before = self._before, None
        stops = bool(until < self._latest)
        self._missed = -1.0 if stops else self._awaited
        self.counters.turnovers -= 1
        self.state.restore(before)
        self._be_at(before, max(before.now, self._remainder(stop)) if stops else before.now)
        return stops

    @property
    def _latest(self) -> float:
        """The time behind a jump at which the contact that it was for has come, or does not come."""
        return 2.0 * self.state.epoch_length

    def _be_at(self, saved: Snapshot, now: Real) -> None:
        """Be at a time of the open window that a snapshot was taken in."""
        self.state.restore(replace(saved, now=now))
        self.state.stay_open(self._epochs_to_wrap())
        self._predict_afresh()

    def _contact_near(self, until: Real) -> Real | None:
        """The time of a contact that is due behind `until`, but for which the clock jumps to a time before it; else None.

        After the jump the same contact may come until then, since the times are rounded.  To find it disks enter cells that are
        ahead of them.
        """
        state, calendar = self.state, self.calendar
        ahead = (float(until) // state.epoch_length + 1.0 + EARLY) * state.epoch_length
        goal = min(ahead, state.window_end)
        if goal <= self._clear:
            return None
        saved, crossings, found = state.snapshot(), self.counters.crossings, None
        while found is None and (event := calendar.first()) is not None and event.time < goal:
            if self.is_stale(event):
                calendar.pop()
            elif event.rank == CONTACT:
                found = event.time
            else:
                state.now = event.time
                self._cross(event)
        if self.counters.crossings > crossings:
            self._be_at(saved, until)
        if found is None:
            self._clear = goal
        return None if found == self._missed else found

    def _predict_afresh(self) -> None:
        """Fill cells and calendar from the flights."""
        self.calendar.clear()
        if self.cells is not None:
            refill(self.state, self.cells)
        self._predictor.predict_all(self.state.now)

    def _next_contact(self) -> float:
        """When the earliest contact that is predicted is due, rounded; inf without one."""
        ahead = (event.time for event in self.calendar if event.rank == CONTACT and not self.is_stale(event))
        return min(map(float, ahead), default=float("inf"))

    def _meets_again(self) -> bool:
        """Whether more is ahead than passages from cell to cell."""
        if self.stage.size is not None or any(e.rank != CROSSING and not self.is_stale(e) for e in self.calendar):
            return True
        return meets_again(self.stage, self.snapshot(), self.motion())

    def _only_wraps(self) -> bool:
        """Whether disks will wrap for ever, and never meet anything again."""
        return only_wraps(self.stage, self.state.anchors(), self._idle)

    def _remember(self, for_ever: bool) -> None:
        """Before the clock turns over: keep where the last flight began; on the open plane it may have been the last of all."""
        if not for_ever:
            self._behind = None
        elif self.cells is not None and self.stage.size is None and (self.state.window_rows or self._behind is None):
            self._behind = replace(self.state.snapshot(), now=max(self.state.t))

    def _go_back(self) -> None:
        """Stand where the last flight began: how far a search for contacts went that are not there is no part of a run."""
        last = max(self.state.t)
        if self._behind is not None and not self.state.window_rows:
            self.restore(self._behind)
        elif last < self.state.now:
            self.restore(replace(self.state.snapshot(), now=last))

    def _pass_to(self, until: float) -> None:
        """Let time pass to `until`, a remainder; without a stop time it stays where it is."""
        if self.state.now < until < float("inf"):
            self.state.now = until

    def _remainder(self, until: float | None) -> float:
        if until is None:
            return float("inf")
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
        state = self.state
        places = np.array([state.place(i, state.now) for i in range(state.n)])
        speeds = np.array([state.speed(i, state.now) for i in range(state.n)])
        wraps = np.array([state.wraps_x, state.wraps_y], dtype=np.int64)
        return Motion(places[:, 0], places[:, 1], speeds[:, 0], speeds[:, 1], wraps[0], wraps[1])

    def kick(self, i: int, vx: float, vy: float) -> None:
        """Set the velocity of disk i from outside, now."""
        self._shorten_window(i, vx, vy)
        self._resolver.kick(i, vx, vy)
        self._predictor.predict(i, self.state.now)

    def _shorten_window(self, i: int, vx: float, vy: float) -> None:
        """Let the clock turn over at a kick before which nothing happened for long, or whose disk is too fast for the window."""
        stage, state = self.stage, self.state
        exponent = exponent_kicked(stage, state.window, lambda: state.anchors().kicked(i, vx, vy))
        epochs = epochs_to_kick(stage, state.epoch, state.now, state.window_rows, exponent < state.window)
        if epochs:
            self.counters.turnovers += 1
            state.turn_over(state.now, epochs, exponent)
            self._predict_afresh()
        elif state.now < state.epoch_length:
            state.begin_window(exponent)

    def take_rows(self) -> Rows:
        """The rows since the last call, an array of ROW."""
        return rows_from(self._resolver.take_rows(), self.stage.epoch_length, self.stage.start_time)

    def snapshot(self) -> Snapshot:
        """All that the future depends on."""
        return self.state.snapshot()

    def restore(self, saved: Snapshot) -> None:
        """Go on from a snapshot, this engine's or another's."""
        self.state.restore(saved)
        self._idle, self._behind, self._before = 0.0, None, None
        self._clear, self._missed = 0.0, -1.0
        self._predict_afresh()


def endless(state: EngineState, stage: Stage, i: int) -> tuple[str, str]:
    """An instant that does not end: why a run stops there, and a sentence on disk i, those around it and what is known."""
    inelastic = stage.law.loses_energy()
    what = "collapse" if inelastic or stage.gravity is not None else "digits"
    pile = _pile(state, i)
    if what == "digits":
        cause = "at this instant do not end"
    elif all(state.vx[j] == state.vy[j] == 0.0 for j in pile):
        cause = f"have no bounce: {LIES_STILL}"
    else:
        cause = (
            "follow one another faster than the clock can tell (inelastic collapse, or rest on another disk, on several walls or "
            f"on a round one); {stage.law.remedy()}"
        )
    x, y = (float(at) for at in state.place(i, state.now))
    x, y = x + stage.corner[0], y + stage.corner[1]
    return what, f"the contacts of {named(pile)} at ({x:g}, {y:g}) {cause}"


def _pile(state: EngineState, i: int) -> list[int]:
    """Disk i, and those that it is piled up with: one of two met the other one last, just now and over and over."""
    again = [j for j in range(state.n) if state.at_once[j] > 1 and state.contact_time[j] == state.contact_time[i]]
    pile, added = {i}, {i}
    while added:
        near = {j for j in again for one in added if any(met[0] == one for met in state.met[j])}
        near |= {met[0] for one in added for met in state.met[one] if met[0] in again}
        added = near - pile
        pile |= added
    return sorted(pile)


def refused(error: SqueezedError | TwoSupportsError, component: list[Event]) -> tuple[str, str]:
    """A cluster that no impulses part, or a disk on two walls: why a run stops there, and a sentence on the disks."""
    if isinstance(error, TwoSupportsError):
        return "collapse", str(error)
    disks = sorted({i for event in component for i in (event.a, event.b) if i >= 0})
    names = ", ".join(map(str, disks))
    return "collapse", f"of disks {names} one is squeezed between others, or walls, that it cannot deflect"
