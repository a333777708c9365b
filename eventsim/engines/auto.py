"""The engine `auto`: begins with the reference engine and hands over to the fast one, mid-run, when the job proves long.

Both write the same log, so there is no seam; a small scene never loads the compiler.  Where kernels have to be compiled first and
a second core is free, another process compiles half of them.
"""

from __future__ import annotations

import math
import pickle
import sys
from contextlib import suppress
from time import perf_counter, thread_time

import numpy as np

from eventsim.compiler import INTERPRET, SWITCH, has_compiler, is_interpreted, is_switched_off
from eventsim.engines.base import BrokenOffError, Motion, Session, Snapshot, Stop
from eventsim.engines.reference import AutoOptions, ReferenceOptions
from eventsim.engines.reference.loop import ReferenceSession
from eventsim.engines.warming import Warming, may_warm
from eventsim.errors import EventsimError
from eventsim.formulas.clock import clock_time
from eventsim.formulas.laws import Own
from eventsim.record.events import Rows
from eventsim.scene.stage import Stage

LARGE = 10_000
"""Disks from which on the reference engine is not even begun with."""

COLD, WARM = 10.0, 0.6
"""CPU seconds that it takes until the fast engine runs: with kernels to compile, with compiled ones on disk."""

PATIENCE, SAMPLE = 0.1, 0.02
"""CPU seconds of the reference engine with its beginning, and of its stints alone, before its rate is trusted."""

SURE = 0.8
"""CPU seconds that are foreseen for the reference engine: with more it is not begun with where compiled kernels are on disk.

With these numbers no guess costs more than a fifth of the better engine's time, a forecast that is twice the truth a third.
"""


def first_engine(stage: Stage, stop: Stop, keep_rows: bool = True) -> str:
    """The engine that a run of this stage to this stop begins with."""
    if not has_compiler():
        return "reference"
    if stage.n >= LARGE:
        return "fast"
    is_long = reference_seconds(stage, stop) > SURE
    return "fast" if is_long and _is_warm(stage, _at_start(stage), keep_rows) else "reference"


class AutoSession(Session):
    """A session of the engine that suits, another one after the job has proved long.

    keep_rows: whether the log is wanted.
    """

    name = "auto"

    def __init__(self, stage: Stage, keep_rows: bool = True, options: AutoOptions | None = None) -> None:
        super().__init__(stage)
        self._keep_rows = keep_rows
        self._options = options or AutoOptions()
        self._spent = self._sampled = 0.0
        self._begun = 0, 0.0
        self._may_change = self._options == AutoOptions()
        self._opened: Session | None = None
        self._is_cold = False
        self._loading = 0.0
        self._changing = False
        self.at_work = "reference"
        self._rows: list[Rows] = []

    @property
    def _session(self) -> Session:
        """The engine's session; opened here where somebody asks for it before it is known what the job is."""
        return self._opened if self._opened is not None else self._open(Stop())

    def _open(self, stop: Stop) -> Session:
        began = perf_counter()
        if self._may_change:
            self.at_work = first_engine(self.stage, stop, self._keep_rows)
            if self.at_work == "fast" and self._is_bound_to_python():
                self.at_work = "reference"
        if self.at_work == "fast":
            try:
                self._is_cold = not _is_warm(self.stage, _at_start(self.stage), self._keep_rows)
                self._opened = self._opened_fast(began)
            except BrokenOffError:  # there is nothing yet that could be kept
                raise KeyboardInterrupt from None
        else:
            self._loading += perf_counter() - began
            began = thread_time()
            self._opened = ReferenceSession(self.stage, self._keep_rows, ReferenceOptions(self._options.check))
            self._spent = thread_time() - began
        self._speak_for(self._opened)
        return self._opened

    def _speak_for(self, session: Session) -> None:
        """Have to say what the engine's session has to say."""
        self.counters, self.reason = session.counters, session.reason
        self.refused, self.sunk = session.refused, session.sunk
        self.compile_s = self._loading + session.compile_s

    @property
    def prepares(self) -> bool:
        """Whether the session only prepares itself, so that an interrupt may break in."""
        return self._changing or (self._opened is not None and self._opened.prepares)

    def _opened_fast(self, began: float, saved: Snapshot | None = None) -> Session:
        """A session of the fast engine; all since `began` went into loading and compiling it."""
        self._changing, others, session = True, None, None
        try:
            from eventsim.engines.fast.session import FastSession

            if self._is_cold and may_warm():
                with suppress(OSError, pickle.PicklingError, TypeError, AttributeError):
                    others = Warming(self.stage, self._keep_rows, saved)
            session = FastSession(self.stage, self._keep_rows, saved=saved, others=others.wait if others else None)
        finally:
            self._changing = False
            if others is not None:
                others.end()
            self._loading += perf_counter() - began - (0.0 if session is None else session.compile_s)
        return session

    @property
    def clock(self) -> tuple[int, float]:
        """Where the clock stands: (epoch, remainder)."""
        return (0, 0.0) if self._opened is None else self._opened.clock  # it is not known yet what the job is

    def advance(self, stop: Stop, budget: int) -> str | None:
        """Simulate until the stop or for about `budget` steps; the reason to stop, None where the budget ended first."""
        session = self._open(stop) if self._opened is None else self._opened
        if self._sampled == 0.0:
            self._begun = self.counters.events, self._time
        began = thread_time()
        try:
            stopped = session.advance(stop, budget)
            taken = thread_time() - began
            self._spent, self._sampled = self._spent + taken, self._sampled + taken
            knows = self._spent > PATIENCE and self._sampled > SAMPLE
            if stopped is None and self._may_change and self.at_work == "reference" and knows:
                self._reconsider(stop)
        finally:
            self._speak_for(self._session)
        return stopped

    @property
    def _time(self) -> float:
        return clock_time(*self.clock, self.stage.epoch_length, self.stage.start_time)

    def _reconsider(self, stop: Stop) -> None:
        """Hand over if the reference engine would take longer than it takes to begin with the fast one."""
        if not has_compiler():
            self._may_change = False
            switches = [name for name, is_set in ((SWITCH, is_switched_off()), (INTERPRET, is_interpreted())) if is_set]
            why = f"{switches[0]} tells not to compile" if switches else "is not installed"
            note = f"the engine fast needs numba, which {why}: this run goes on with the reference engine"
            print(f"note: {note}", file=sys.stderr)
            return
        if self._is_bound_to_python():
            return
        left = self._sampled * self._share_left(stop)
        if left < WARM or (self._is_cold and left < COLD):
            return
        began = perf_counter()
        self._is_cold = not _is_warm(self.stage, self.motion(), self._keep_rows)
        self._loading += perf_counter() - began
        if left > (COLD if self._is_cold else WARM):
            self._hand_over()

    def _is_bound_to_python(self) -> bool:
        """Whether a law of the user's own cannot be compiled; it is said once."""
        if isinstance(self.stage.law, Own):
            from eventsim.engines.fast.rules import law_in_kernels

            try:
                law_in_kernels(self.stage.law)
            except EventsimError as error:
                print(f"note: {error}: so does this run", file=sys.stderr)
                self._may_change = False
        return not self._may_change

    def _share_left(self, stop: Stop) -> float:
        """What is left of the job, in parts of what this session has done."""
        left = []
        events, time = self._begun
        if stop.events is not None:
            left.append((stop.events - self.counters.events) / max(self.counters.events - events, 1))
        if stop.until is not None:
            passed = self._time - time
            left.append((stop.until - self._time) / passed if passed > 0.0 else float("inf"))
        return min(left, default=0.0)

    def _hand_over(self) -> None:
        before = self._session
        fast = self._opened_fast(perf_counter(), saved=before.snapshot())
        fast.counters.copy_from(before.counters)
        self._rows.append(before.take_rows())
        self.begun_by, self.at_work, self._opened = self.at_work, "fast", fast

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


def _at_start(stage: Stage) -> Motion:
    still = np.zeros(stage.n, np.int64)
    return Motion(stage.x, stage.y, stage.vx, stage.vy, still, still)


def _is_warm(stage: Stage, motion: Motion, keep_rows: bool) -> bool:
    """Whether the kernels for a scene are on disk; this loads the compiler, so it is asked when that is worth it anyway."""
    from eventsim.engines.fast.compiled import is_warm
    from eventsim.engines.fast.plan import Grids
    from eventsim.engines.fast.rules import kind_of

    grids = Grids(stage, "auto")
    grids.choose(motion)
    return is_warm(kind_of(stage, grids, keep_rows))


START, EVENT, GROWTH = 2e-5, 1.4e-5, 0.21
"""CPU seconds that the reference engine takes for a disk to begin with, and, times n**GROWTH, for an event among n disks."""

DENSEST = 0.9
"""A packing fraction near the closest packing, where the contact value would leave all bounds."""


def reference_seconds(stage: Stage, stop: Stop) -> float:
    """CPU seconds of the reference engine until a stop; without one that can be foreseen, those of the beginning."""
    jobs = [] if stop.events is None else [float(stop.events)]
    if stop.until is not None and (rate := contact_rate(stage)) is not None:
        jobs.append(rate * max(stop.until - stage.start_time, 0.0))
    return START * stage.n + EVENT * math.pow(stage.n, GROWTH) * min(jobs, default=0.0)


def contact_rate(stage: Stage) -> float | None:
    """Contacts of pairs per time as in a gas of hard disks at equilibrium; None on the open plane.

    Source: Henderson, Mol. Phys. 30, 971 (1975), doi:10.1080/00268977500102511 (the contact value).
    """
    if stage.size is None:
        return None
    area = stage.size[0] * stage.size[1]
    eta = min(float(np.sum(math.pi * stage.radius**2)) / area, DENSEST)
    relative_speed = math.sqrt(2.0) * float(np.mean(np.hypot(stage.vx, stage.vy)))
    reach = 2.0 * float(np.mean(stage.radius))
    contact_value = (1.0 - 7.0 / 16.0 * eta) / (1.0 - eta) ** 2
    return 0.5 * stage.n**2 * 2.0 * reach * relative_speed * contact_value / area
