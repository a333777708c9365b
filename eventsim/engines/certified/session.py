"""A proof in the making: the loop on balls, begun again with more bits wherever a comparison could not be answered."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from eventsim.engines.base import Motion, Session, Snapshot, Stop
from eventsim.engines.certified import LEAST_BITS, CertifiedOptions
from eventsim.engines.certified.ball import Undecided, ball, working_precision
from eventsim.engines.certified.doubt import cause, in_words
from eventsim.engines.certified.loop import CertifiedLoop
from eventsim.engines.certified.traced import traced
from eventsim.errors import EventsimError
from eventsim.formulas.laws import Own
from eventsim.record.events import Floats, Rows, blank_rows
from eventsim.scene.names import plural
from eventsim.scene.stage import Stage

SETTLED = 2.0**-60
"""Radii of this part of the largest coordinate and speed change no float that is logged, or its last bit now and then."""


class Attempt(NamedTuple):
    """How far the loop came with so many bits; traced: with numbers that know where they come from, for ties."""

    bits: int
    traced: bool
    events: int


class _Ended(NamedTuple):
    """An attempt that could not go on, its loop, those of its rows that nobody has taken, and what it could not decide."""

    attempt: Attempt
    loop: CertifiedLoop
    held: list[Rows]
    doubt: str


class CertifiedSession(Session):
    """The certified engine in the middle of a run.

    What two attempts in a row, the second one with twice the bits,
    cannot decide is taken for a tie: then numbers are traced, which decides ties of rational numbers and of equal
    expressions; where this does not help either the run stops as `undecided tie`.  A run that stops there, or is broken off,
    is the attempt that came farthest; `attempts` are the other ones.
    """

    name = "certified"

    def __init__(self, stage: Stage, keep_rows: bool = True, options: CertifiedOptions | None = None) -> None:
        _refuse_laws(stage)
        _refuse_falling_points(stage)
        super().__init__(stage)
        options = options or CertifiedOptions()
        if not options.bits >= LEAST_BITS:
            raise EventsimError(f"certified: bits = {options.bits!r}: must be at least {LEAST_BITS}")
        self.attempts: list[Attempt] = []
        self._keep_rows = keep_rows
        self._first_bits, self._most_bits = options.bits, max(options.bits, options.most_bits)
        self._stopped: str | None = None
        self._emitted = 0
        self._farthest: _Ended | None = None
        self._begin(options.bits, False)

    def _begin(self, bits: int, trace: bool) -> None:
        self.bits, self.traced = bits, trace
        self._held: list[Rows] = []
        with working_precision(bits):
            self._loop = CertifiedLoop(self.stage, self._keep_rows, traced if trace else ball)
        self.counters = self._loop.counters

    @property
    def proven(self) -> int:
        """Events whose order is proven."""
        return max([self._loop.counters.events, *(attempt.events for attempt in self.attempts)])

    @property
    def clock(self) -> tuple[int, float]:
        """Where the clock stands: (epoch, remainder)."""
        return self._loop.clock

    def advance(self, stop: Stop, budget: int) -> str | None:
        """Simulate until the stop or for about `budget` steps; the reason to stop, None where the budget ended first."""
        with working_precision(self.bits):
            try:
                self._stopped = self._loop.advance(stop, budget)
                self.reason = self._loop.reason
            except Undecided as undecided:
                self._stopped = self._go_on_from(undecided, self._loop.counters.events)
            else:
                if self._stopped is not None and not self._is_settled() and 2 * self.bits <= self._most_bits:
                    self._note_attempt(self._loop.counters.events, "its numbers were not known well enough")
                    self._begin(2 * self.bits, self.traced)
                    self._stopped = None
        return self._stopped

    def _note_attempt(self, events: int, doubt: str) -> None:
        attempt = Attempt(self.bits, self.traced, events)
        self.attempts.append(attempt)
        if self._farthest is None or events > self._farthest.attempt.events:
            self._farthest = _Ended(attempt, self._loop, [*self._held, self._loop.take_rows()], doubt)

    def break_off(self) -> None:
        """End here: what any attempt has proven is kept."""
        self._stopped = "interrupted"
        self._go_back_to_the_farthest()

    def _go_back_to_the_farthest(self) -> bool:
        """Be the attempt that came farthest, if that is an earlier one; whether it is."""
        events, farthest = self._loop.counters.events, self._farthest
        if farthest is not None and farthest.attempt.events > events:
            self.attempts.append(Attempt(self.bits, self.traced, events))
            self.attempts.remove(farthest.attempt)
            self.bits, self.traced, _ = farthest.attempt
            self._loop, self._held = farthest.loop, farthest.held
            self.counters = self._loop.counters
            return True
        return False

    def _go_on_from(self, undecided: Undecided, events: int) -> str | None:
        """Begin again in a way that may decide; the reason to stop where there is none left."""
        doubt = in_words(undecided, self.stage, self.clock)
        before = [attempt.events for attempt in self.attempts if attempt.traced == self.traced]
        farther = not before or events > max(before)
        if farther and 2 * self.bits <= self._most_bits:
            self._note_attempt(events, doubt)
            self._begin(2 * self.bits, self.traced)
            return None
        if not farther and not self.traced:
            self._note_attempt(events, doubt)
            self._begin(self._first_bits, True)
            return None
        why = cause(undecided, self.bits if farther else None)
        if self._go_back_to_the_farthest():
            assert self._farthest is not None
            doubt = self._farthest.doubt
        self.reason = f"after {plural(self.proven, 'proven event')}, {doubt}; {why}"
        return "undecided tie"

    def take_rows(self) -> Rows:
        """The proven rows since the last call whose floats are settled, an array of ROW."""
        self._held.append(self._loop.take_rows())
        if self._stopped is None and not self._is_settled():
            return blank_rows(0, self.stage.spin is not None)
        rows = np.concatenate(self._held)
        self._held = []
        fresh = rows[rows["event"] >= self._emitted]
        self._emitted += len(fresh)
        return fresh

    def _is_settled(self) -> bool:
        """Whether the balls are so small that the floats that are logged are right."""
        motion, radii = self.motion(), self.radii()
        size = max(float(np.abs(motion.x).max()), float(np.abs(motion.y).max()))
        speed = max(float(np.abs(motion.vx).max()), float(np.abs(motion.vy).max()))
        settled = radii[:, :2].max() <= SETTLED * size and radii[:, 2:].max() <= SETTLED * speed
        if motion.spin is not None:
            with working_precision(self.bits):
                settled = settled and self._loop.spin_radius() <= SETTLED * float(np.abs(motion.spin).max())
        return bool(settled)

    def motion(self) -> Motion:
        """Where all disks are now, rounded to floats."""
        with working_precision(self.bits):
            return self._loop.motion()

    def radii(self) -> Floats:
        """The radii of the balls that x, y, vx, vy of each disk are proven to lie in: (n, 4)."""
        with working_precision(self.bits):
            return self._loop.radii()

    def distances(self) -> Floats:
        """How far the true x, y, vx, vy of each disk may be from `motion`: (n, 4), radius and rounding to a float."""
        with working_precision(self.bits):
            return self._loop.distances()

    def kick(self, i: int, vx: float, vy: float) -> None:
        """Refuse: a proof goes from the start to the end.

        Raises EventsimError.
        """
        raise EventsimError("the certified engine proves a run from its start: it takes no kicks")

    def snapshot(self) -> Snapshot:
        """Refuse: balls begin again from the start.

        Raises EventsimError.
        """
        raise EventsimError("the certified engine proves a run from its start: it has no snapshots")

    def restore(self, saved: Snapshot) -> None:
        """Refuse, like `snapshot`.

        Raises EventsimError.
        """
        raise EventsimError("the certified engine proves a run from its start: it has no snapshots")


def _refuse_laws(stage: Stage) -> None:
    """Raise EventsimError under a law of the user's own, which computes with floats.

    What chance gives at walls that heat is a float, too, but the same one everywhere: there the proof is of what follows.
    """
    if isinstance(stage.law, Own):
        raise EventsimError(f"the certified engine cannot prove this scene: {stage.law.name()} computes with floats")


def _refuse_falling_points(stage: Stage) -> None:
    """Raise EventsimError where points fall onto walls: on which side of a wall a point is, balls that touch it do not tell."""
    if stage.gravity is not None and stage.points:
        raise EventsimError(
            "the certified engine cannot prove this scene: it has gravity, walls and disks that are points to these (radius 0 or "
            "below the last bits of places), and on which side of a wall a point is that touches it no ball tells; give the "
            "disks a radius"
        )
