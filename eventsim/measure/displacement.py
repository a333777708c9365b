"""How far disks have come: displacements at given times, and their mean squares by lag."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from eventsim.record.events import Floats
from eventsim.replay.flights import FlightTable


class MeanSquare(NamedTuple):
    """Mean squared displacement at each lag, (lags,), with its standard error over disks."""

    mean: Floats
    error: Floats


def mean_square(table: FlightTable, disks: NDArray[np.intp], times: Floats, lags: NDArray[np.intp]) -> MeanSquare:
    """Return the mean over some disks and all starts, at lags counted in evenly spread times."""
    way = np.stack([displacements(table, disk, times) for disk in disks.tolist()], axis=1)  # (T, M, 2)
    # in units of a power of two, in which squares of squares are floats and no bit changes
    unit = int(np.frexp(np.abs(way).max())[1])
    way = np.ldexp(way, -unit)
    squared = [((way[lag:] - way[:-lag]) ** 2).sum(axis=2) for lag in lags.tolist()]
    scatter = [part.mean(axis=0).std(ddof=1) if len(disks) > 1 else 0.0 for part in squared]
    mean, error = np.array([part.mean() for part in squared]), np.array(scatter) / np.sqrt(len(disks))
    with np.errstate(over="ignore", under="ignore"):  # an area may be no float in the scene's unit
        return MeanSquare(np.ldexp(mean, 2 * unit), np.ldexp(error, 2 * unit))


def displacements(table: FlightTable, disk: int, times: Floats) -> Floats:
    """Return how far a disk has come since the start (T, 2) at ascending times, wraps not taken back."""
    low, high = np.searchsorted(table.disk, [disk, disk + 1])
    time, duration = table.time[low:high], table.duration[low:high, None]
    velocity, pull = table.velocity[low:high], table.pull[low:high]
    gone = np.zeros_like(velocity)
    gone[1:] = np.cumsum(duration * (velocity + 0.5 * duration * pull), axis=0)[:-1]
    flight = np.maximum(np.searchsorted(time, times, side="right") - 1, 0)
    lag = (times - time[flight])[:, None]
    result: Floats = gone[flight] + lag * (velocity[flight] + 0.5 * lag * pull[flight])
    return result
