"""Displaced: all disks elsewhere at once from one sample to the next, and flying on as before, as no contacts put them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from eventsim.validation.judge.faults import Fault
from eventsim.validation.judge.flights import Flights

MOST = 0.5
"""Of all disks: so many at least are displaced alike, by what disks that turn then do not hide in the median."""

ALIKE = 0.1
"""Of a displacement: by how much those of disks may differ, and by how much they may fly on otherwise in a step."""

FEWEST = 3
"""Disks of which a common displacement is told from what each one does."""


def displacements(flights: Flights, resolution: float) -> Iterator[tuple[Fault, tuple[float, float]]]:
    """Faults of all disks at once, with the span of time whose turns they explain; O(T n).

    resolution: a smaller displacement cannot be told, length.
    """
    times, place = flights.times, flights.place
    if len(times) < 4 or place.shape[1] < FEWEST:
        return
    steps = np.diff(times)[:, None, None]
    fallen = flights.pull * (0.5 * (times[1:] + times[:-1]) - times[0])[:, None, None]
    speed = np.diff(place, axis=0) / steps - fallen
    off = steps[1:-1] * (speed[1:-1] - 0.5 * (speed[:-2] + speed[2:]))
    turned = steps[1:-1] * (speed[2:] - speed[:-2])
    common = np.median(off, axis=1)
    size = np.hypot(*common.T)
    for k in np.flatnonzero(size > resolution).tolist():
        alike = np.hypot(*(off[k] - common[k]).T) < ALIKE * size[k]
        alike &= np.hypot(*turned[k].T) < ALIKE * size[k]
        if alike.mean() < MOST:
            continue
        before, after, (dx, dy) = float(times[k + 1]), float(times[k + 2]), common[k].tolist()
        said = f"jump: all disks are displaced by ({dx:.3g}, {dy:.3g}) between t = {before:.6g} and {after:.6g}"
        yield Fault(before, "jump", said, ()), (float(times[k]), float(times[min(k + 3, len(times) - 1)]))
