"""The column `time`: the exact clock of many rows, rounded to the scene's clock."""

from __future__ import annotations

from eventsim.formulas.expansion import two_sum
from eventsim.record.events import Column, Floats


def clock_times(epoch: Column, remainder: Floats, epoch_length: float, start_time: float) -> Floats:
    """Return start_time + epoch * epoch_length + remainder (n,), the rounding errors of both sums carried along."""
    first, first_error = two_sum(epoch * epoch_length, start_time)
    second, second_error = two_sum(first, remainder)
    times: Floats = second + (first_error + second_error)
    return times
