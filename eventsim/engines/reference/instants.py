"""Contacts at one instant: which are, and how many of them are too many."""

from __future__ import annotations

import math

import numpy as np

from eventsim.engines.reference.state import EngineState
from eventsim.formulas.real import Real
from eventsim.formulas.rest import AT_ONCE, is_still
from eventsim.scene.stage import Stage

AT_ONCE_ELASTIC, AT_ONCE_INELASTIC = 100_000, 100
"""Contacts of one disk at one instant that are too many.  Elastic sequences end, if late; inelastic ones of this length are a
collapse."""

BETWEEN_HEAVY, MOST_AT_ONCE = 8.0, 1 << 30
"""A light disk between a heavy one and a wall has up to pi sqrt(M/m) contacts, all at one instant where the clock cannot tell
them apart: so many roots of the mass ratio are not too many.  The fast engine counts in int32."""

AT_ONCE_SQUEEZED = 2.0**-32
"""As AT_ONCE, where energy has no bound: between moving immovable disks, or as a tracer, a disk can be driven to ever faster
contacts, whose number would be the inverse root of AT_ONCE before the clock stands still."""


def instant_of(stage: Stage) -> tuple[float, int]:
    """(share of the clock, number): contacts of a disk closer than this are at one instant, and so many of them too many."""
    if stage.law.loses_energy():
        return AT_ONCE, AT_ONCE_INELASTIC
    most = AT_ONCE_ELASTIC
    if stage.mass is not None:
        driven = np.isinf(stage.mass) & ((stage.vx != 0.0) | (stage.vy != 0.0))
        if np.any(driven | (stage.mass == 0.0)):
            return AT_ONCE_SQUEEZED, most
        most = int(min(max(most, BETWEEN_HEAVY * math.sqrt(stage.mass_ratio)), MOST_AT_ONCE))
    return AT_ONCE, most


class Instants:
    """Counts the contacts of every disk at one instant.

    share: of the clock, within which contacts are at one instant; None: what suits the scene.  limit: so many are too many.
    """

    def __init__(self, stage: Stage, state: EngineState, share: float | None) -> None:
        self._state = state
        usual, self.limit = instant_of(stage)
        self._share = usual if share is None else share
        self._settles = stage.settles and share is None

    def is_still(self, i: int, t: Real) -> bool:
        """Whether disk i has not come further, since its flight began, than the last bits of its place."""
        state = self._state
        if not self._settles:
            return False
        return is_still(*state.place(i, t), state.vx[i], state.vy[i], *state.speed(i, t), t - state.t[i])

    def is_series(self, i: int, place: int) -> bool:
        """Whether disk i met that straight wall already last."""
        state = self._state
        if state.supports is None or state.supports[place] is None:
            return False
        return len(state.met[i]) == 1 and state.met[i][0][0] == -1 - place

    def note(self, i: int, t: Real, idle: bool, still: bool) -> None:
        """Note a contact of disk i; of idle ones, which change nothing, a third at the same instant is too many.

        still: it is as good as at the instant of the one before, because the disk did not move in between.
        """
        state = self._state
        weight = self.limit // 3 + 1 if idle else 1
        again = still or t - state.contact_time[i] <= self._share * t
        state.at_once[i] = state.at_once[i] + weight if again else weight
        state.contact_time[i] = t
