"""The loop: pop the earliest event, advance, resolve, predict; a session that can be stopped and continued anywhere."""

from __future__ import annotations

from typing import Any

import numpy as np

from eventsim.engines.base import Motion, Snapshot, Stop, rows_from
from eventsim.engines.exact_session import ExactSession
from eventsim.engines.reference import ReferenceOptions
from eventsim.engines.reference.advance import cross, refill, wrap
from eventsim.engines.reference.ahead import meets_again
from eventsim.engines.reference.aimed import Aimed
from eventsim.engines.reference.calendar import CONTACT, CROSSING, WRAP, Calendar, Event
from eventsim.engines.reference.cells import Cells, Grid, plan
from eventsim.engines.reference.generation import Ties, components
from eventsim.engines.reference.invariants import check_invariants
from eventsim.engines.reference.predict import Predictor
from eventsim.engines.reference.resolve import Resolver
from eventsim.engines.reference.rests import TwoSupportsError
from eventsim.engines.reference.state import EngineState
from eventsim.engines.reference.sunk import Sunk
from eventsim.engines.reference.unresolvable import UnlawfulError, endless, refused
from eventsim.formulas.clock import window_length
from eventsim.formulas.doubt import latest_tie, screen_in
from eventsim.formulas.real import NEVER, Real
from eventsim.formulas.simultaneous import SqueezedError
from eventsim.record.events import Rows
from eventsim.scene.stage import Stage


class ReferenceSession(ExactSession):
    """The reference engine in the middle of a run.

    keep_rows: whether the log is wanted.  number: what makes the engine's numbers from floats.
    """

    name = "reference"
    state: EngineState
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
        self._predictor = self.predictor(stage, self.state, self.calendar, self.cells)
        self._resolver = self.resolver(stage, self.state, self.counters, keep_rows)
        self._ties = Ties(stage, self.state)
        self._sunk = Sunk(stage, self.state) if number is float else None
        self._aimed = Aimed(stage, self.state) if number is float else None
        self._predict_afresh()

    def _new_calendar(self) -> Calendar:
        return Calendar()

    def _advance(self, stop: Stop, budget: int) -> str | None:
        """Pop and resolve events until the stop or for about `budget` of them."""
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
            due = NEVER if event is None else event.time
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
                return "quiet"
            if due > until:
                if state.opened and (contact := self._contact_near(until)) is not None and self._jump(contact):
                    until = self._remainder(stop.until)
                    continue
                self._pass_to(until)
                return "until" if self._meets_again() else "quiet"
            if state.opened and event.rank == CONTACT and due != self._missed:
                if not self._jump(due):
                    return self._stop_at_the_end(due)
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
                    self._came()
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
            self.reason, self.sunk = sunk, self._sunk.sank and self.stage.law.loses_energy()
            return "digits"
        if self._aimed is not None and (doubtful := self._aimed.reason(generation)) is not None:
            self.reason = doubtful
            return "digits"
        changed: list[int] = []
        for component in components(generation):
            try:
                changed += self._resolver.resolve(component)
            except (SqueezedError, TwoSupportsError, UnlawfulError) as refusal:
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

    def _give_up(self, i: int) -> str:
        stopped, self.reason = endless(self.state, self.stage, i)
        return stopped

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

    def _turn(self, end: Real, epochs: int, exponent: int, strayed: bool) -> None:
        self.state.turn_over(end, epochs, exponent)
        self._predict_afresh()

    def _fly_as(self, saved: Snapshot) -> None:
        self.state.restore(saved)

    def _set_now(self, now: Real) -> None:
        self.state.now = now

    def _begin_window(self, exponent: int) -> None:
        self.state.begin_window(exponent)

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

    def _meets_on_the_plane(self) -> bool:
        return meets_again(self.stage, self.snapshot(), self.motion())

    def _search(self, goal: float, now: Real) -> Real | None:
        state, calendar = self.state, self.calendar
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
            self._be_open(saved)
            state.now = now
            self._predict_afresh()
        return found

    def motion(self) -> Motion:
        """Where all disks are now."""
        state = self.state
        places = np.array([state.place(i, state.now) for i in range(state.n)])
        speeds = np.array([state.speed(i, state.now) for i in range(state.n)])
        wraps = np.array([state.wraps_x, state.wraps_y], dtype=np.int64)
        spin = None if state.spin is None else np.array(list(map(float, state.spin)))
        return Motion(places[:, 0], places[:, 1], speeds[:, 0], speeds[:, 1], wraps[0], wraps[1], spin)

    def _kick(self, i: int, vx: float, vy: float) -> None:
        self._resolver.kick(i, vx, vy)
        self._predictor.predict(i, self.state.now)

    def take_rows(self) -> Rows:
        """The rows since the last call, an array of ROW."""
        return rows_from(self._resolver.take_rows(), self.stage)
