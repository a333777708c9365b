"""Contacts at one instant: which are, and how many of them are too many."""

from __future__ import annotations

import math

import numpy as np

from eventsim.engines.exact_state import ExactState
from eventsim.formulas.doubt import AT_ONCE, is_still, kept_up_instant, kept_up_way
from eventsim.formulas.real import Real
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
    """(share of the clock, number): contacts of a disk closer than this are at one instant, and so many of them too many.

    Under gravity so are contacts after flights that rounding of the clock may keep up.
    """
    if stage.settles:
        return kept_up_instant(stage.law.loss()), AT_ONCE_INELASTIC
    if stage.law.loses_energy():
        return AT_ONCE, AT_ONCE_INELASTIC
    most = AT_ONCE_ELASTIC
    if stage.mass is not None:
        driven = np.isinf(stage.mass) & ((stage.vx != 0.0) | (stage.vy != 0.0))
        if np.any(driven | (stage.mass == 0.0)):
            return AT_ONCE_SQUEEZED, most
        most = int(min(max(most, BETWEEN_HEAVY * math.sqrt(stage.mass_ratio)), MOST_AT_ONCE))
    return AT_ONCE, most


def stillness_of(stage: Stage) -> float | None:
    """The way, as a part of the coordinates, that a disk must come between two contacts to have flown; None: any."""
    return kept_up_way(stage.law.loss()) if stage.settles else None


class Instants:
    """Counts the contacts of every disk at one instant.

    share: of the clock, within which contacts are at one instant; None: what suits the scene.  limit: so many are too many.
    """

    def __init__(self, stage: Stage, state: ExactState, share: float | None) -> None:
        self._state = state
        usual, self.limit = instant_of(stage)
        self._share = usual if share is None else share
        self._share_of_series = AT_ONCE if share is None else share
        self._stillness = stillness_of(stage) if share is None else None
        self._settles = stage.settles

    def is_still(self, i: int, t: Real) -> bool:
        """Whether disk i has not come further, since its flight began, than the last bits of its place."""
        state = self._state
        if self._stillness is None:
            return False
        flight = *state.place(i, t), state.vx[i], state.vy[i], *state.speed(i, t), t - state.t[i]
        return is_still(*flight, self._stillness)

    def is_series(self, i: int, place: int) -> bool:
        """Whether disk i met that wall already last, and bounces on it are exact however low."""
        met = self._state.met[i]
        return (self._settles or self.ends(place)) and len(met) == 1 and met[0][0] == -1 - place

    def ends(self, place: int) -> bool:
        """Whether a series on a wall comes to an end: it is straight, and disks rest on it."""
        supports = self._state.supports
        return supports is not None and supports[place] is not None

    def note(self, i: int, t: Real, idle: bool, still: bool, ends: bool = False) -> None:
        """Note a contact of disk i; of idle ones, which change nothing, a third at the same instant is too many.

        still: it is as good as at the instant of the one before, because the disk did not move in between.  ends: it is of a
        series on a straight wall, which rounding does not keep up.
        """
        state = self._state
        weight = self.limit // 3 + 1 if idle else 1
        again = still or t - state.contact_time[i] <= (self._share_of_series if ends else self._share) * t
        state.at_once[i] = state.at_once[i] + weight if again else weight
        state.contact_time[i] = t
