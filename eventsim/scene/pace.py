"""The pace of a scene: the power of two that its speeds are about, where their squares would be no floats; else 0.

Straight flights need no squares of speeds, energies do.  Velocities times 2**-pace are the same run in another unit of time
(contact times scale exactly), so energies are computed there, in units of 2**(2 pace).
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace
from decimal import Decimal

import numpy as np

from eventsim.scene.disks import Floats
from eventsim.scene.scene import Scene

SLOWEST, FASTEST = 2.0**-128, 2.0**128
"""Between these, fourth powers of the largest speed, squares of energies, are floats, and those of much smaller ones too."""

LEAST_EXPONENT, LARGEST_EXPONENT = -1022, 1024
"""Of floats with all their digits, as frexp counts."""


def pace_of(speeds: Iterable[Floats | float], falls: bool) -> int:
    """The pace of velocities, given as arrays or numbers; falls: gravity gives the clock, and speeds are moderate."""
    fastest = max((float(np.abs(speed).max()) for speed in speeds if np.size(speed)), default=0.0)
    if falls or fastest == 0.0 or SLOWEST < fastest < FASTEST:
        return 0
    return int(np.frexp(fastest)[1])


def pace_of_scene(scene: Scene, kicks: Iterable[tuple[int, float, float]] = ()) -> int:
    """The pace of a scene whose disks are given other velocities now and then: kicks (event, vx, vy)."""
    kicked = [speed for _, *velocity in kicks for speed in velocity]
    return pace_of([scene.disks.velocity, *kicked], scene.gravity is not None)


def slowed(velocity: Floats, pace: int) -> Floats:
    """Velocities times 2**-pace."""
    slow: Floats = np.ldexp(velocity, -pace) if pace else velocity
    return slow


def slowed_scene(scene: Scene, pace: int) -> Scene:
    """The scene in a unit of time that is 2**-pace of its own, beginning at time 0."""
    if not pace:
        return scene
    return replace(
        scene,
        disks=replace(scene.disks, velocity=slowed(scene.disks.velocity, pace)),
        contact_duration=later(scene.contact_duration, pace),
        equilibration=later(scene.equilibration, pace),
        start_time=0.0,
        until=None,
    )


def later(time: float | None, pace: int) -> float | None:
    """A span of time in that unit."""
    return None if time is None else float(np.ldexp(time, pace))


def as_float(value: float, power: int) -> float | None:
    """value * 2**power; None where that is no float, or one that lacks digits."""
    exponent = math.frexp(value)[1] + power
    if value and math.isfinite(value) and not LEAST_EXPONENT < exponent <= LARGEST_EXPONENT:
        return None
    return math.ldexp(value, power)


def in_words(value: float, power: int, digits: int = 4) -> str:
    """value * 2**power to so many digits, also where that is no float."""
    return f"{value:.{digits}g}" if power == 0 else f"{Decimal(value) * Decimal(2) ** power:.{digits}g}"


def typical_speed(vx: Floats, vy: Floats) -> float:
    """The root mean square of speeds (N,)."""
    pace = pace_of([vx, vy], falls=False)
    return math.ldexp(float(np.sqrt(np.mean(slowed(vx, pace) ** 2 + slowed(vy, pace) ** 2))), pace)
