"""The engine `auto`: begins with the reference engine and hands over to the fast one, mid-run, when the job proves long.

Both write the same log, so there is no seam; a small scene never loads the compiler.
"""

from __future__ import annotations

import sys
from importlib.util import find_spec
from time import thread_time
from typing import Any

import numpy as np

from eventsim.engines.base import Counters, Motion, Session, Snapshot, Stop
from eventsim.engines.reference import ReferenceSession
from eventsim.formulas.clock import clock_time
from eventsim.record.events import Rows
from eventsim.scene.stage import Stage

LARGE = 10_000
"""Disks from which on the reference engine is not even begun with."""

COLD, WARM = 10.0, 0.6
"""CPU seconds that it takes until the fast engine runs: with kernels to compile, with compiled ones on disk."""

PATIENCE = 0.1
"""CPU seconds of the reference engine before its rate is trusted; with it and `WARM` no guess costs more than a fifth."""

MISSING = "the fast engine needs numba, which is not installed: pip install 'eventsim-disks[fast]'"


def has_compiler() -> bool:
    """Whether the fast engine can be used."""
    return find_spec("numba") is not None


def first_engine(stage: Stage) -> str:
    """The engine that a run of this stage begins with."""
    return "fast" if stage.n >= LARGE and has_compiler() else "reference"


class AutoSession:
    """A session of the engine that suits, another one after the job has proved long.

    stage: what is simulated.  keep_rows: whether the log is wanted.  at_work: the name of the engine in use; before: of the one
    that handed over to it, if one did.
    """

    def __init__(self, stage: Stage, keep_rows: bool = True, **options: Any) -> None:
        self.stage = stage
        self._keep_rows = keep_rows
        self._spent = 0.0
        self._may_change = not options
        self.at_work = "reference" if options else first_engine(stage)
        self.before: str | None = None
        self._session: Session
        if self.at_work == "fast":
            self._session = _fast(stage, keep_rows)
        else:
            self._session = ReferenceSession(stage, keep_rows, **options)
        self._rows: list[Rows] = []

    @property
    def compile_s(self) -> float:
        """Seconds spent on compiling."""
        return float(getattr(self._session, "compile_s", 0.0))

    @property
    def counters(self) -> Counters:
        """How often what happened."""
        return self._session.counters

    @property
    def reason(self) -> str | None:
        """A sentence on why it stopped, where there is more to say."""
        return self._session.reason

    @property
    def refused(self) -> bool:
        """Whether it stopped at what it knows that it cannot resolve."""
        return bool(getattr(self._session, "refused", False))

    @property
    def clock(self) -> tuple[int, float]:
        """Where the clock stands: (epoch, remainder)."""
        return self._session.clock

    def advance(self, stop: Stop, budget: int) -> str | None:
        """Simulate until the stop or for about `budget` steps; the reason to stop, None where the budget ended first."""
        began = thread_time()
        stopped = self._session.advance(stop, budget)
        self._spent += thread_time() - began
        if stopped is None and self._may_change and self.at_work == "reference" and self._spent > PATIENCE:
            self._reconsider(stop)
        return stopped

    def _reconsider(self, stop: Stop) -> None:
        """Hand over if the reference engine would take longer than it takes to begin with the fast one."""
        if not has_compiler():
            self._may_change = False
            print(f"note: {MISSING} (this run goes on with the reference engine)", file=sys.stderr)
            return
        left = self._spent * self._share_left(stop)
        if left < WARM:
            return
        from eventsim.engines.fast.compiled import is_warm  # loads the compiler: worth it from here on
        from eventsim.engines.fast.rules import kind_of

        if left > (WARM if is_warm(kind_of(self.stage, self._keep_rows)) else COLD):
            self._hand_over()

    def _share_left(self, stop: Stop) -> float:
        """What is left of the job, in parts of what is done."""
        left = []
        done = self._session.counters.events
        if stop.events is not None:
            left.append((stop.events - done) / max(done, 1))
        if stop.until is not None:
            stage = self.stage
            now = clock_time(*self._session.clock, stage.epoch_length, stage.start_time)
            passed = now - stage.start_time
            left.append((stop.until - now) / passed if passed > 0.0 else float("inf"))
        return min(left, default=0.0)

    def _hand_over(self) -> None:
        before = self._session
        self._rows.append(before.take_rows())
        self.before, self.at_work = self.at_work, "fast"
        self._session = _fast(self.stage, self._keep_rows, saved=before.snapshot())
        self._session.counters.copy_from(before.counters)

    def take_rows(self) -> Rows:
        """The rows since the last call, an array of ROW."""
        blocks, self._rows = self._rows, []
        rows = self._session.take_rows()
        return np.concatenate([*blocks, rows]) if blocks else rows

    def motion(self) -> Motion:
        """Where all disks are now."""
        return self._session.motion()

    def kick(self, i: int, vx: float, vy: float) -> None:
        """Set the velocity of disk i from outside, now."""
        self._session.kick(i, vx, vy)

    def snapshot(self) -> Snapshot:
        """All that the future depends on."""
        return self._session.snapshot()

    def restore(self, saved: Snapshot) -> None:
        """Go on from a snapshot, this engine's or another's."""
        self._session.restore(saved)


def _fast(stage: Stage, keep_rows: bool, saved: Snapshot | None = None) -> Session:
    from eventsim.engines.fast import FastSession

    return FastSession(stage, keep_rows, saved=saved)
