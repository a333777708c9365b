"""The column `time`: the exact clock of many rows, rounded to the scene's clock."""

from __future__ import annotations

from typing import TypeVar

from eventsim.record.events import Column, Floats

Number = TypeVar("Number", Floats, float)


def clock_times(epoch: Column, remainder: Floats, epoch_length: float, start_time: float) -> Floats:
    """Return start_time + epoch * epoch_length + remainder (n,), the rounding errors of both sums carried along."""
    first, first_error = two_sum(epoch * epoch_length, start_time)
    second, second_error = two_sum(first, remainder)
    return second + (first_error + second_error)


def two_sum(a: Number, b: Number | float) -> tuple[Number, Number]:
    """Return a + b and its rounding error. Source: D. E. Knuth, TAOCP 2, 4.2.2, theorem B."""
    total = a + b
    back = total - a
    return total, (a - (total - back)) + (b - back)
