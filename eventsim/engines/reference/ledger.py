"""What contacts leave behind: momentum from outside, the deepest overlap, rows of the log."""

from __future__ import annotations

import math
from typing import Any, TypeAlias

from eventsim.engines.base import Counters
from eventsim.engines.exact_state import ExactState
from eventsim.engines.reference.masses import Masses
from eventsim.formulas.impulse import wall_impulse
from eventsim.formulas.real import Real
from eventsim.record.events import Kind
from eventsim.scene.stage import Stage

Row: TypeAlias = tuple[Any, ...]
MISSING = math.nan


class Ledger:
    """Books into `counters`, and keeps rows if asked to."""

    def __init__(self, stage: Stage, state: ExactState, masses: Masses, counters: Counters, keep_rows: bool) -> None:
        self._stage = stage
        self._state = state
        self._masses = masses
        self._counters = counters
        self._keep_rows = keep_rows
        self.rows: list[Row] = []

    def book(self, jx: Real, jy: Real) -> None:
        """Note momentum that came from outside the disks of finite mass."""
        momentum = self._counters.outer_momentum
        momentum[0] += jx
        momentum[1] += jy

    def book_pair(self, a: int, b: int, jx: Real, jy: Real) -> None:
        """Note the momentum that an immovable disk gave to the other one; (jx, jy) is what a received."""
        if self._masses.is_immovable(b):
            self.book(jx, jy)
        elif self._masses.is_immovable(a):
            self.book(-jx, -jy)

    def book_wall(self, i: int, du: Real, dw: Real) -> Real:
        """Note the momentum that a wall gave disk i; its magnitude.  An immovable disk has none to speak of."""
        mass = self._masses.of(i)
        if not math.isinf(mass):
            self.book(mass * du, mass * dw)
        return wall_impulse(mass, du, dw)

    def book_kick(self, i: int, du: float, dw: float) -> float:
        """Note the momentum that a kick gave disk i; its magnitude."""
        mass = self._masses.of(i)
        if math.isinf(mass):
            return MISSING
        self.book(mass * du, mass * dw)
        return mass * math.hypot(du, dw)

    def book_support(self, i: int, t: Real, sign: float) -> None:
        """Note that a wall begins (+1) or ceases (-1) to support disk i, if it rests on one."""
        support, gravity = self._state.support_of(i), self._stage.gravity
        if support is None or gravity is None:
            return
        passed = self._state.epoch * self._stage.epoch_length + float(t)
        total = self._counters.support_force
        for axis, (along, whole) in enumerate(zip((support.ax, support.ay), gravity, strict=True)):
            force = sign * (self._masses.of(i) * (along - whole))
            total[axis] += force
            self._counters.outer_momentum[axis] -= force * passed

    def note_overlap(self, a: int, b: int, distance: Real, reach: Real) -> None:
        """Note by which part of their reach two disks of usual mass overlap at a contact, if that is the deepest so far."""
        overlap = (reach - distance) / reach
        if overlap > self._counters.deepest_overlap and self._masses.is_usual(a) and self._masses.is_usual(b):
            self._counters.deepest_overlap = overlap

    def log(self, t: Real, kind: Kind, a: int, b: int, wall: int, impulse: Real, joint: int) -> None:
        """Count an event, and keep its row if rows are kept."""
        state, counters = self._state, self._counters
        if self._keep_rows:
            other: tuple[Any, ...] = (MISSING, MISSING, MISSING, MISSING)
            if b >= 0:
                other = (state.x[b], state.y[b], state.vx[b], state.vy[b])
            flight: Row = (state.x[a], state.y[a], state.vx[a], state.vy[a])
            row = (counters.events, 0.0, kind, a, b, wall, *flight, *other, impulse, joint, state.epoch, t)
            if state.spin is not None:
                row = (*row, state.spin[a], state.spin[b] if b >= 0 else MISSING)
            self.rows.append(row)
        counters.events += 1
        state.window_rows += 1
