"""What a contact duration costs where disks come to rest: under gravity they bounce about so often, and never lie still."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from eventsim.scene.numbers import Point
from eventsim.scene.stage import Stage

SHARE = 0.03
"""Of the time in which a disk falls by its diameter: a contact duration of this leaves bounces that nobody sees."""


class Settling(NamedTuple):
    """Of disks that come to rest: how many there may be, and a contact duration that suits them, None for points."""

    disks: int
    duration: float | None

    def rule(self) -> str:
        """The duration that suits, and why."""
        if self.duration is None:
            return "the longer it is, the fewer"
        return f"contact_duration = {self.duration:g} suits, {100 * SHARE:g} % of sqrt(2 r / g)"

    def cost(self, duration: float) -> str:
        """How often disks at rest bounce with a contact duration."""
        return f"bounces about every {duration:g}: up to {self.disks / duration:.2g} contacts per unit of time"


def settling_of(stage: Stage) -> Settling | None:
    """What holds of a scene; None where nothing falls onto anything."""
    if stage.gravity is None:
        return None
    falls = np.ones(stage.n, dtype=bool) if stage.mass is None else np.isfinite(stage.mass)
    if not falls.any() or not (stage.surfaces or not falls.all()):
        return None
    return settling(int(falls.sum()), float(stage.radius[falls].min()), stage.gravity)


def settling(disks: int, radius: float, gravity: Point) -> Settling:
    """What holds of so many disks that fall, the smallest of which has a radius."""
    pull = math.hypot(*gravity)
    duration = float(f"{SHARE * math.sqrt(2.0 * radius / pull):.1g}") if radius > 0.0 and pull > 0.0 else None
    return Settling(disks, duration)


def remedy_of(stage: Stage) -> str:
    """What is left to do about contacts that pile up in a scene, and what that costs where disks come to rest."""
    words, settling = stage.law.remedy(), settling_of(stage)
    if settling is None:
        return words
    if stage.law.duration is not None:
        longer = settling.duration is not None and settling.duration > stage.law.duration
        return f"{words}: {settling.rule()}" if longer else words
    price = "a disk that would rest then bounces about so often, so a short one makes a run long"
    return f"{words}; {price}: {settling.rule()}"
