"""The reference loop on balls, at one precision: it goes on until a comparison cannot be answered."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from eventsim.engines.base import Motion, Stop
from eventsim.engines.certified.ball import Ball, deviation, radius_of
from eventsim.engines.certified.calendar import CertifiedCalendar
from eventsim.engines.certified.predict import CertifiedPredictor
from eventsim.engines.certified.resolve import CertifiedResolver
from eventsim.engines.reference import ReferenceOptions
from eventsim.engines.reference.calendar import CONTACT, Event
from eventsim.engines.reference.generation import row_order
from eventsim.engines.reference.loop import ReferenceSession
from eventsim.record.events import Floats
from eventsim.scene.stage import Stage


class CertifiedLoop(ReferenceSession):
    """One attempt at a proof; number makes balls from floats."""

    name = "certified"
    predictor = CertifiedPredictor
    resolver = CertifiedResolver

    def __init__(self, stage: Stage, keep_rows: bool, number: Callable[[float], Ball]) -> None:
        self._begun = False
        super().__init__(stage, keep_rows, ReferenceOptions(grid=None), number)

    def advance(self, stop: Stop, budget: int) -> str | None:
        """Simulate until the stop or for about `budget` steps.

        Raises Undecided where a comparison has no answer at this precision; the events so far are proven.
        """
        if not self._begun:
            self._begun = True
            self._predict_afresh()
        return super().advance(stop, budget)

    def _predict_afresh(self) -> None:
        """Fill the calendar; not before the first step, so that a loop exists even if its first prediction is undecided."""
        if self._begun:
            super()._predict_afresh()

    def _new_calendar(self) -> Any:
        return CertifiedCalendar(self.is_stale)

    def _pop_generation(self) -> list[Event]:
        """Take out all contacts of the earliest time, which is proven to be theirs, that are not stale."""
        first = self.calendar.pop()
        generation = [first]
        while (event := self.calendar.first()) is not None and event.time == first.time and event.rank == CONTACT:
            self.calendar.pop()
            if self.is_stale(event):
                self.counters.stale += 1
            elif event != generation[-1]:
                generation.append(event)
        generation.sort(key=row_order)
        return generation

    def _only_wraps(self) -> bool:
        """Whether disks will wrap for ever; not known of velocities that are no floats."""
        return not any(deviation(v, float(v)) for v in (*self.state.vx, *self.state.vy)) and super()._only_wraps()

    def _sunk_speeds(self) -> str | None:
        """None: velocities are not rounded here."""
        return None

    def _go_back(self) -> None:
        """Stay: all pairs are predicted, so nothing is searched for beyond the last contact."""

    @property
    def clock(self) -> tuple[int, float]:
        """Where the clock stands: (epoch, remainder), the remainder rounded."""
        return self.state.epoch, float(self.state.now)

    def motion(self) -> Motion:
        """Where all disks are now, rounded."""
        numbers = np.array([[float(number) for number in flight] for flight in self._flights()])
        wraps = np.array([self.state.wraps_x, self.state.wraps_y], dtype=np.int64)
        spin = None if self.state.spin is None else np.array([float(number) for number in self.state.spin])
        return Motion(numbers[:, 0], numbers[:, 1], numbers[:, 2], numbers[:, 3], wraps[0], wraps[1], spin)

    def radii(self) -> Floats:
        """How far the true x, y, vx, vy may be from the middles of their balls: (n, 4); length, and length / time."""
        return np.array([[radius_of(number) for number in flight] for flight in self._flights()])

    def spin_radius(self) -> float:
        """How far the true spins may be from the middles of their balls; 1 / time."""
        return max((radius_of(number) for number in self.state.spin or ()), default=0.0)

    def distances(self) -> Floats:
        """How far the true x, y, vx, vy may be from the floats of `motion`: (n, 4); length, and length / time."""
        return np.array([[deviation(number, float(number)) for number in flight] for flight in self._flights()])

    def _flights(self) -> list[tuple[Any, ...]]:
        state = self.state
        return [(*state.place(i, state.now), *state.speed(i, state.now)) for i in range(state.n)]
