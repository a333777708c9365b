"""What all stepped engines share: the contract of a session, kept step by step.

Their log has a row for each impulse that they found, at the time of the step (or within it, where an engine looks there), with
positions and velocities as the engine had them.  Read as a log of free flights it replays about the engine's own motion, not its
bits: so a run also has a sampled trajectory, and `Run.state_at` reads that.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from time import thread_time
from typing import Any

import numpy as np

from eventsim.engines.base import Motion, Session, Snapshot, Stop
from eventsim.engines.stepped.clock import StepClock, usual_step
from eventsim.engines.stepped.disks import Moving, moving_disks
from eventsim.engines.stepped.found import BUFFER, MOVED, ROW_COUNT, Found, nothing_found, take_counters, tell_counters
from eventsim.engines.stepped.ground import ground_of
from eventsim.engines.trajectory import Trajectory
from eventsim.errors import EventsimError
from eventsim.formulas.motion import position, velocity
from eventsim.record.events import ROW, Kind, Rows, blank_rows
from eventsim.scene.stage import Stage

FOREVER = 2**62

VAIN_STEPS = 1_000_000
"""Steps without an event after which a run without a stop time is called quiet: a stepped engine cannot know that."""


class SteppedSession(Session):
    """A stepped engine in the middle of a run; engines add `_run`.

    dt: the step, time; None: the usual one.  stepping_s: CPU seconds of its steps alone, without what is asked of them.
    Raises EventsimError for a step that is not a positive number, and for scenes that the engine does not know.
    """

    name = "stepped engine"

    def __init__(self, stage: Stage, keep_rows: bool = True, dt: float | None = None) -> None:
        super().__init__(stage)
        if stage.law.beyond_steps is not None:
            raise EventsimError(f"{self.name} cannot simulate this scene: it knows no {stage.law.beyond_steps}")
        self.dt = usual_step(stage) if dt is None else float(dt)
        if not 0.0 < self.dt < math.inf:
            raise EventsimError(f"{self.name}: dt = {self.dt!r}: a step must be a finite time above 0")
        self.ground = ground_of(stage)
        self.disks: Moving = moving_disks(stage)
        self.found: Found = nothing_found(BUFFER if keep_rows else 0)
        self.clock_of_steps = StepClock(stage, self.dt)
        self.trajectory: Trajectory = Trajectory(stage.gravity, stage.corner, stage.period)
        self.stepping_s = 0.0
        self._keep_rows = keep_rows
        self._sampled = True
        self._blocks: list[Rows] = []
        self._sample()

    @abstractmethod
    def _run(self, steps: int, most_events: int) -> int:
        """Do at most so many steps, until so many events in all; how many were done, fewer where a list gets old."""

    def advance(self, stop: Stop, budget: int) -> str | None:
        """Simulate until the stop or for about `budget` steps; the reason to stop, None where the budget ended first."""
        clock = self.clock_of_steps
        take_counters(self.found, self.counters)
        most_events = FOREVER if stop.events is None else stop.events
        vain = self._vain_from(stop)
        while budget > 0:
            if self.counters.events >= most_events:
                return "events"
            left = clock.steps_until(stop)
            if left is not None and left <= 0:
                assert stop.until is not None
                clock.pass_to(float(stop.until))
                return "until"
            steps = min(budget, FOREVER if left is None else left)
            if self._sampled:
                steps = min(steps, self.trajectory.steps_to_next(clock.steps))
            began = thread_time()
            done = self._run(steps, most_events)
            self.stepping_s += thread_time() - began
            self._read_back()
            clock.count(done)
            tell_counters(self.found, self.counters)
            self.counters.steps = clock.steps
            self._flush()
            if self._sampled and done == steps and self.trajectory.is_due(clock.steps):
                self._sample()
            budget -= max(done, 1)
            if vain is not None and self.counters.events == vain[1] and clock.steps > vain[0] + VAIN_STEPS:
                return "quiet"
        return None

    def _read_back(self) -> None:
        """Take over what a library has moved, where steps do not."""

    def only_step(self) -> None:
        """Do from here on what the engine needs for its motion and nothing more, for a stopwatch: the trajectory ends here."""
        self._sampled = False

    def _vain_from(self, stop: Stop) -> tuple[int, int] | None:
        """(step, events) since when nothing may have happened; None with a stop time."""
        return None if stop.until is not None else (self.clock_of_steps.steps, self.counters.events)

    def _sample(self) -> None:
        m = self.disks
        self.trajectory.append(self.clock_of_steps.steps, self.clock_of_steps.now, m.x, m.y, m.vx, m.vy)

    def _make_room(self, rows: int) -> None:
        """Have a buffer for at least so many rows: those of one step."""
        if self._keep_rows and len(self.found.rows) < rows:
            self._flush()
            self.found = self.found._replace(rows=np.zeros(rows + BUFFER, ROW))

    def _flush(self) -> None:
        count = int(self.found.counts[ROW_COUNT])
        self.found.counts[ROW_COUNT] = 0
        if count and self._keep_rows:
            rows = self.found.rows[:count].copy()
            rows.sort(order=("remainder", "event"))
            rows["event"] = np.sort(rows["event"])
            self._blocks.append(self.clock_of_steps.place(rows))

    def take_rows(self) -> Rows:
        """The rows since the last call, an array of ROW."""
        blocks, self._blocks = self._blocks, []
        return np.concatenate(blocks) if blocks else blank_rows(0)

    @property
    def clock(self) -> tuple[int, float]:
        """Where the clock stands: (epoch, remainder)."""
        return self.clock_of_steps.reading

    def motion(self) -> Motion:
        """Where all disks are now: between two steps they fly free."""
        m, (gx, gy) = self.disks, self.stage.gravity or (0.0, 0.0)
        lag = self.clock_of_steps.now - self.clock_of_steps.steps * self.dt
        return Motion(
            position(m.x, m.vx, lag, gx),
            position(m.y, m.vy, lag, gy),
            velocity(m.vx, lag, gx),
            velocity(m.vy, lag, gy),
            m.wraps_x.copy(),
            m.wraps_y.copy(),
        )

    def kick(self, i: int, vx: float, vy: float) -> None:
        """Set the velocity of a disk from outside, at the last step; a row of the log."""
        m = self.disks
        finite = not math.isinf(m.mass[i])
        given = [m.mass[i] * (vx - m.vx[i]), m.mass[i] * (vy - m.vy[i])] if finite else [0.0, 0.0]
        self.counters.outer_momentum = [sum(both) for both in zip(self.counters.outer_momentum, given, strict=True)]
        m.vx[i], m.vy[i] = vx, vy
        self.counters.kicks += 1
        self.counters.events += 1
        if self._keep_rows:
            row = blank_rows(1)
            row["event"], row["kind"], row["a"] = self.counters.events - 1, Kind.KICK, i
            row["xa"], row["ya"], row["vxa"], row["vya"] = m.x[i], m.y[i], vx, vy
            row["impulse"] = math.hypot(*given) if finite else math.nan
            row["remainder"] = self.clock_of_steps.now
            self._blocks.append(self.clock_of_steps.place(row))
        self._kicked()

    def _kicked(self) -> None:
        """A disk has got another velocity."""

    def snapshot(self) -> Snapshot:
        """Return all that the future depends on; `met` holds what this engine remembers of contacts."""
        m, clock = self.disks, self.clock_of_steps
        x, y, vx, vy = (tuple(values.tolist()) for values in (m.x, m.y, m.vx, m.vy))
        wraps_x, wraps_y = tuple(m.wraps_x.tolist()), tuple(m.wraps_y.tolist())
        times = (clock.now,) * self.stage.n
        zeros = (0,) * self.stage.n
        memory = (clock.steps, *self._memory())
        place = clock.epoch, clock.window, clock.window_rows, clock.now
        return Snapshot(*place, times, x, y, vx, vy, wraps_x, wraps_y, memory, times, zeros)

    def restore(self, saved: Snapshot) -> None:
        """Go on from a snapshot of this engine."""
        m, clock = self.disks, self.clock_of_steps
        columns = (saved.x, saved.y, saved.vx, saved.vy, saved.wraps_x, saved.wraps_y)
        for values, column in zip((m.x, m.y, m.vx, m.vy, m.wraps_x, m.wraps_y), columns, strict=True):
            values[:] = column
        clock.epoch, clock.window, clock.window_rows, clock.now = (
            saved.epoch,
            saved.window,
            saved.window_rows,
            saved.now,
        )
        clock.steps = int(saved.met[0])
        self.trajectory.forget_after(clock.steps)
        self.found.sums[MOVED] = math.inf  # lists of neighbours are those of another state
        self._remember(saved.met[1:])

    def _memory(self) -> tuple[Any, ...]:
        """What an engine remembers of contacts."""
        return ()

    def _remember(self, memory: tuple[Any, ...]) -> None:
        """Take back what `_memory` gave."""
