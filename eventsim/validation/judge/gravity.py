"""Gravity: the acceleration with which disks fly free, whatever they meet later."""

from __future__ import annotations

import math

import numpy as np

from eventsim.record.events import Floats
from eventsim.validation.judge.faults import SURE, Fault
from eventsim.validation.judge.flights import Flights, free_flights
from eventsim.validation.judge.outcome import CLEAR
from eventsim.validation.judge.surroundings import Surroundings
from eventsim.validation.judge.told import NEAR

UNEXPLAINED = 0.1
"""Of the squares: where one acceleration leaves more of what flights show, it is not gravity; a drag depends on the velocity."""

MANY = 3
"""Flights whose one acceleration is no drag; fewer tell where it is along the scene's gravity."""

ROUNDED = 10.0
"""Noise of positions, over the square of its time, in the acceleration of a flight from its ends and its middle."""

DIGITS = 1e-3
"""Of the acceleration: a component that is less is told as 0."""

LAST_BITS = 1e-12
"""Of the size of a disk: positions of float64 are not better."""


def wrong_gravity(flights: Flights, around: Surroundings, mass: Floats, speed: float) -> Fault | None:
    """The fault of disks that fly with another acceleration than the scene's; None where they do not, or nobody can tell.

    Flights are looked at in the order in which they end, until they tell.

    Args:
        flights: the paths.
        around: what they may lie on.
        mass: (n,), inf for immovable disks.
        speed: of a typical disk.
    """
    noise = ROUNDED * max(flights.blur, LAST_BITS * (float(np.median(around.stage.radius)) or 1.0))
    pull = np.array(around.stage.gravity or (0.0, 0.0))
    own = math.hypot(*pull)
    excess, weight = np.empty((0, 2)), np.empty(0)
    longest, begun = 0.0, math.inf
    for flight in sorted(free_flights(flights), key=lambda flight: flight.end):
        if not math.isfinite(mass[flight.disk]) or _lies(flights, around, flight.disk, flight.middle):
            continue
        excess, weight = np.vstack([excess, flight.acceleration - pull]), np.append(weight, flight.lasts**4 / noise**2)
        longest, begun = max(longest, flight.lasts), min(begun, flight.begun)
        off = weight @ excess / weight.sum()
        size = math.hypot(*off)
        least = CLEAR * own if own else CLEAR * speed / longest
        if size <= max(least, SURE / math.sqrt(float(weight.sum()))):
            continue
        left = float(weight @ np.sum((excess - off) ** 2, axis=1))
        if left > UNEXPLAINED * float(weight @ np.sum(excess**2, axis=1)):
            continue
        if len(weight) < MANY and not (own and abs(off[0] * pull[1] - off[1] * pull[0]) < UNEXPLAINED * size * own):
            continue
        flown, (gx, gy) = pull + off, pull
        x, y = np.where(np.abs(flown) > DIGITS * max(own, size), flown, 0.0).tolist()
        said = f"gravity: disks fly with acceleration ({x:.3g}, {y:.3g}), not ({gx:g}, {gy:g}), from t = {begun:.6g} on"
        return Fault(begun, "gravity", said)
    return None


def _lies(flights: Flights, around: Surroundings, disk: int, sample: int) -> bool:
    """Whether a disk is so near to something that it may lie on it, or roll along it."""
    radius, place = around.stage.radius, flights.place[sample]
    if any(around.to_wall(surface, place[disk])[1] < float(radius[disk]) * (1.0 + NEAR) for surface in around.surfaces):
        return True
    apart = np.hypot(*around.apart(place[disk], place).T) - (radius + radius[disk]) * (1.0 + NEAR)
    apart[disk] = math.inf
    return bool(apart.min() < 0.0)
