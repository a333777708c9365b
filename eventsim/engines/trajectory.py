"""A sampled trajectory: where all disks were at some times, for engines whose motion does not follow from their log."""

from __future__ import annotations

import bisect

import numpy as np

from eventsim.errors import LogError
from eventsim.formulas.motion import position, velocity
from eventsim.record.events import Floats, State
from eventsim.record.places import on_scene_axes

MOST_SAMPLES = 1024
"""Samples that are held; when there are more, every second one is dropped and the next ones come half as often."""


class Trajectory:
    """Samples every 1, 2, 4, ... steps, never more than MOST_SAMPLES of them; in between, free flight from the one before.

    gravity: (gx, gy) or None; corner, period: as in a Stage. Memory: 32 bytes per disk and sample.
    """

    def __init__(
        self,
        gravity: tuple[float, float] | None,
        corner: tuple[float, float],
        period: tuple[float | None, float | None],
    ) -> None:
        self._gravity = gravity or (0.0, 0.0)
        self._corner, self._period = corner, period
        self._every = 1
        self._steps: list[int] = []
        self._times: list[float] = []
        self._flights: list[Floats] = []

    @property
    def times(self) -> Floats:
        """The times of the samples, counted from the beginning of the run."""
        return np.array(self._times)

    def is_due(self, step: int) -> bool:
        """Whether a step is one to be sampled."""
        return step % self._every == 0

    def steps_to_next(self, step: int) -> int:
        """Steps from `step` to the next sample."""
        return self._every - step % self._every

    def append(self, step: int, time: float, x: Floats, y: Floats, vx: Floats, vy: Floats) -> None:
        """Keep where all disks are after a step, at a time since the beginning; positions relative to the corner."""
        if len(self._steps) == MOST_SAMPLES:
            self._every *= 2
            self._steps, self._times, self._flights = self._steps[::2], self._times[::2], self._flights[::2]
            if step % self._every:
                return
        self._steps.append(step)
        self._times.append(time)
        self._flights.append(np.array([x, y, vx, vy]))

    def forget_after(self, step: int) -> None:
        """Drop the samples after a step: the run goes on from there another way."""
        keep = bisect.bisect_right(self._steps, step)
        del self._steps[keep:], self._times[keep:], self._flights[keep:]

    def state_at(self, time: float, start_time: float = 0.0) -> State:
        """Return the state at a time on a clock that starts at `start_time`; LogError before the first sample."""
        since = time - start_time
        place = bisect.bisect_right(self._times, since) - 1
        if place < 0:
            raise LogError(f"there is no state at time {time!r}: the run begins at {start_time!r}")
        lag = since - self._times[place]
        (x, y, vx, vy), (gx, gy) = self._flights[place], self._gravity
        columns = [
            on_scene_axes(_inside(position(at, v, lag, g), length), corner, length)
            for at, v, g, corner, length in (
                (x, vx, gx, self._corner[0], self._period[0]),
                (y, vy, gy, self._corner[1], self._period[1]),
            )
        ]
        return State(time, np.column_stack(columns), np.column_stack([velocity(vx, lag, gx), velocity(vy, lag, gy)]))


def _inside(x: Floats, length: float | None) -> Floats:
    return x if length is None else np.mod(x, length)
