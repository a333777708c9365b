"""How long the reference engine will take for a job, told before it begins: within a factor of two or so."""

from __future__ import annotations

import math

import numpy as np

from eventsim.engines.base import Stop
from eventsim.scene.stage import Stage

START, EVENT, GROWTH = 2e-5, 1.4e-5, 0.21
"""CPU seconds that the reference engine takes for a disk to begin with, and, times n**GROWTH, for an event among n disks."""

DENSEST = 0.9
"""A packing fraction near the closest packing, where the contact value would leave all bounds."""


def reference_seconds(stage: Stage, stop: Stop) -> float:
    """CPU seconds of the reference engine until a stop; without one that can be foreseen, those of the beginning."""
    jobs = [] if stop.events is None else [float(stop.events)]
    if stop.until is not None and (rate := contact_rate(stage)) is not None:
        jobs.append(rate * max(stop.until - stage.start_time, 0.0))
    return START * stage.n + EVENT * math.pow(stage.n, GROWTH) * min(jobs, default=0.0)


def contact_rate(stage: Stage) -> float | None:
    """Contacts of pairs per time as in a gas of hard disks at equilibrium; None on the open plane.

    Source: Henderson, Mol. Phys. 30, 971 (1975), doi:10.1080/00268977500102511 (the contact value).
    """
    if stage.size is None:
        return None
    area = stage.size[0] * stage.size[1]
    eta = min(float(np.sum(math.pi * stage.radius**2)) / area, DENSEST)
    relative_speed = math.sqrt(2.0) * float(np.mean(np.hypot(stage.vx, stage.vy)))
    reach = 2.0 * float(np.mean(stage.radius))
    contact_value = (1.0 - 7.0 / 16.0 * eta) / (1.0 - eta) ** 2
    return 0.5 * stage.n**2 * 2.0 * reach * relative_speed * contact_value / area
