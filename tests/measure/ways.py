"""How far disks have come, flight by flight: what displacements of a meter must agree with."""

import numpy as np


def displacements(table, disk, times):
    """How far a disk has come since the start (T, 2) at ascending times, wraps not taken back."""
    low, high = np.searchsorted(table.disk, [disk, disk + 1])
    time, duration = table.time[low:high], table.duration[low:high, None]
    velocity, pull = table.velocity[low:high], table.pull[low:high]
    gone = np.zeros_like(velocity)
    gone[1:] = np.cumsum(duration * (velocity + 0.5 * duration * pull), axis=0)[:-1]
    flight = np.maximum(np.searchsorted(time, times, side="right") - 1, 0)
    lag = (times - time[flight])[:, None]
    return gone[flight] + lag * (velocity[flight] + 0.5 * lag * pull[flight])
