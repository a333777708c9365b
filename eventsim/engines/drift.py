"""When nothing is ahead but wraps: straight flights around a periodic domain that will never meet anything."""

from __future__ import annotations

import numpy as np

from eventsim.record.events import Floats
from eventsim.scene.stage import Stage

ROUNDS = 2.0
"""Times around the domain, relative to each other, after which disks that move along an axis are known not to meet."""


def only_wraps(stage: Stage, vx: Floats, vy: Floats, idle: float) -> bool:
    """Whether straight flights of these velocities (n,), which met nothing for a time `idle`, will wrap for ever.

    So it is where all are alike and there are no walls; and where all go along one axis, as seen from one of them or, where
    there are walls, from these, after so long a time that whatever could meet, disks and walls, has passed each other.
    O(n log n).
    """
    walls = bool(stage.boundaries or stage.features)
    if not walls and np.ptp(vx) == 0.0 and np.ptp(vy) == 0.0:
        return True
    for length, along, across in zip(stage.period, (vx, vy), (vy, vx), strict=True):
        if length is not None and not (across if walls else across - across[0]).any():
            speeds = np.unique(np.append(along, 0.0) if walls else along)
            return len(speeds) == 1 or float(np.diff(speeds).min()) * idle > ROUNDS * length
    return False
