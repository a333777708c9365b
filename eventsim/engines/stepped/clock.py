"""The clock of a stepped run: whole steps, told in the epochs and remainders of a log."""

from __future__ import annotations

import numpy as np

from eventsim.engines.base import Stop
from eventsim.errors import EventsimError
from eventsim.formulas.clock import FIRST_WINDOW, MOST_EPOCHS, next_window, window_length
from eventsim.record.events import Rows
from eventsim.record.times import clock_times
from eventsim.scene.disks import typical_speed
from eventsim.scene.stage import Stage

GRID_SLACK = 1e-9
"""In steps: a stop time that misses the grid of steps by less is meant to be on it (0.1 is not ten times 0.01 in binary)."""


class StepClock:
    """Counts steps, and places rows in the windows of the clock by the rule that replay expects.

    dt: the step size.  The k-th step ends at the time k dt, one rounding away, however many there were.
    """

    def __init__(self, stage: Stage, dt: float) -> None:
        self._stage = stage
        self.dt = dt
        self.steps = 0
        self.now = 0.0
        self.epoch, self.window, self.window_rows = 0, FIRST_WINDOW, 0

    def steps_until(self, stop: Stop) -> int | None:
        """Steps that are left before a stop time; None without one."""
        if stop.until is None:
            return None
        return int((stop.until - self._stage.start_time) / self.dt + GRID_SLACK) - self.steps

    def count(self, steps: int) -> None:
        """Steps were done."""
        self.steps += steps
        self.now = self.steps * self.dt

    def pass_to(self, until: float) -> None:
        """Let time pass to a stop time between two steps: disks fly free for so long, nothing is looked for."""
        self.now = max(self.now, until - self._stage.start_time)

    def place(self, rows: Rows) -> Rows:
        """Set epoch, remainder and time of rows, in order of time, whose remainder counts from the beginning."""
        since = rows["remainder"].copy()
        first = 0
        while first < len(rows):
            self._turn_to(float(since[first]))
            last = first + max(int(np.searchsorted(since[first:], self._window_end)), 1)
            rows["epoch"][first:last] = self.epoch
            rows["remainder"][first:last] = since[first:last] - self.epoch * self._stage.epoch_length
            self.window_rows += last - first
            first = last
        rows["time"] = clock_times(rows["epoch"], rows["remainder"], self._stage.epoch_length, self._stage.start_time)
        return rows

    @property
    def reading(self) -> tuple[int, float]:
        """(epoch, remainder) of now; all rows so far have been placed before."""
        self._turn_to(self.now)
        return self.epoch, self.now - self.epoch * self._stage.epoch_length

    @property
    def _window_end(self) -> float:
        length = self._stage.epoch_length
        return self.epoch * length + window_length(self.window, length)

    def _turn_to(self, time: float) -> None:
        stage = self._stage
        if time >= MOST_EPOCHS * stage.epoch_length:
            last = stage.start_time + MOST_EPOCHS * stage.epoch_length
            raise EventsimError(f"a step of {self.dt:g} leads beyond t = {last:g}, where the clock of a scene so fast ends")
        while time >= self._window_end:
            self.epoch += 1 << self.window
            self.window = next_window(self.window, self.window_rows, stage.n, stage.clock.window_cap)
            self.window_rows = 0
            if self.window >= stage.clock.window_cap:  # windows without a row, all of one length
                empty = int((time - self.epoch * stage.epoch_length) / window_length(self.window, stage.epoch_length))
                self.epoch += max(empty - 1, 0) << self.window


def usual_step(stage: Stage) -> float:
    """A twentieth of the time in which a disk of typical speed flies its radius; with gravity, falls it."""
    radius = float(np.median(stage.radius)) or 1.0
    speed = typical_speed(stage.vx, stage.vy)
    if stage.gravity is not None:
        speed = max(speed, float(np.sqrt(2.0 * np.hypot(*stage.gravity) * radius)))
    return 0.05 * radius / speed if speed > 0.0 else 1.0 / 60.0
