"""The windows of the clock, worked out from the log alone."""

from __future__ import annotations

import bisect
from fractions import Fraction

import numpy as np

from eventsim.errors import LogError
from eventsim.formulas.clock import FIRST_WINDOW, next_window, remainder_since, window_length
from eventsim.record.events import Column
from eventsim.scene.stage import Stage

MOST_WINDOWS = 10_000_000
"""Windows that are counted at once, in some seconds."""


class Windows:
    """The schedule of turnovers: window w begins at epoch `start[w]` and is `length[w]` long (time).

    It follows from the number of rows in each window, and goes on past the last row by the same rule, as far as
    somebody asks.
    """

    start: list[int]
    length: list[float]

    def __init__(self, stage: Stage, epochs: Column) -> None:
        self._stage = stage
        self._exponent = FIRST_WINDOW
        self.start = [0]
        self.length = [window_length(FIRST_WINDOW, stage.epoch_length)]
        epoch, counts = _runs(epochs)
        self._rows = dict(zip(epoch.tolist(), counts.tolist(), strict=True))

    def _extend(self) -> None:
        epoch, exponent = self.start[-1], self._exponent
        self._exponent = next_window(exponent, self._rows.get(epoch, 0), self._stage.n, self._stage.window_cap)
        self.start.append(epoch + (1 << exponent))
        self.length.append(window_length(self._exponent, self._stage.epoch_length))

    def _demand_near(self, epochs: int | Fraction) -> None:
        """Refuse what would take for ever; a run turns its clock over, and so counts every window."""
        ahead = (epochs - self.start[-1]) / (1 << self._stage.window_cap)
        if ahead > MOST_WINDOWS:
            raise LogError(
                f"the log does not reach so far: that is more than {MOST_WINDOWS} turns of the clock behind its rows"
            )

    def index_of(self, epochs: Column) -> Column:
        """Return the window of each row from its epoch."""
        epoch, counts = _runs(epochs)
        return np.repeat(np.array([self.window_at(value) for value in epoch.tolist()], dtype=np.int64), counts)

    def window_at(self, epoch: int) -> int:
        """Return the window that begins at an epoch; LogError where none does."""
        self._demand_near(epoch)
        while self.start[-1] < epoch:
            self._extend()
        window = bisect.bisect_left(self.start, epoch)
        if self.start[window] != epoch:
            raise LogError(f"the log does not fit its scene: no window of the clock begins at epoch {epoch}")
        return window

    def place(self, time: float) -> tuple[int, float]:
        """Return (window, remainder) of a time on the scene's clock; the remainder is rounded once."""
        epochs = (Fraction(time) - Fraction(self._stage.start_time)) / Fraction(self._stage.epoch_length)
        self._demand_near(epochs)
        while self.start[-1] <= epochs:
            self._extend()
        window = max(bisect.bisect_right(self.start, epochs) - 1, 0)
        remainder = remainder_since(self.start[window], self._stage.epoch_length, time, self._stage.start_time)
        if remainder >= self.length[window]:  # rounded up to the end of the window: the clock has turned over
            return window + 1, 0.0
        return window, remainder


def _runs(epochs: Column) -> tuple[Column, Column]:
    """Return (values, counts) of the epochs, which only grow."""
    first = np.flatnonzero(np.diff(epochs, prepend=-1))
    return epochs[first], np.diff(first, append=len(epochs))
