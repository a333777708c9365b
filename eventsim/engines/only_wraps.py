"""Whether only wraps are ahead: flights around a periodic domain that will never meet anything."""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations
from typing import TypeAlias

import numpy as np

from eventsim.engines.turnover import Anchors
from eventsim.scene.stage import Stage

ROUNDS = 2.0
"""Times around the domain, relative to each other, after which disks that move along an axis are known not to meet."""

FEW_DISKS = 16
"""So many disks are looked at pair by pair, in rationals."""

Period: TypeAlias = tuple[float | None, float | None]


def only_wraps(stage: Stage, flights: Anchors, idle: float) -> bool:
    """Whether flights that met nothing for a time `idle` will wrap for ever; they are straight, at least as seen from each other.

    So it is where all are alike and there are no walls.  So it is as well where each disk has come back to where it was, as seen
    from every other one and from walls, since it met anything.  Of many disks this is asked only where all go along one axis.
    O(n log n).
    """
    walls = bool(stage.boundaries or stage.features)
    vx, vy = flights.vx, flights.vy
    if not _are_straight(flights, walls):
        return False
    if not walls and np.ptp(vx) == 0.0 and np.ptp(vy) == 0.0:
        return True
    if len(vx) <= FEW_DISKS:
        velocities = list(zip(vx.tolist(), vy.tolist(), strict=True))
        if walls:
            velocities.append((0.0, 0.0))
        return all(_have_come_round(stage.period, one, other, idle) for one, other in combinations(set(velocities), 2))
    for length, along, across in zip(stage.period, (vx, vy), (vy, vx), strict=True):
        if length is not None and not (across if walls else across - across[0]).any():
            speeds = np.unique(np.append(along, 0.0) if walls else along)
            return len(speeds) == 1 or float(np.diff(speeds).min()) * idle > ROUNDS * length
    return False


def _are_straight(flights: Anchors, walls: bool) -> bool:
    """Whether nothing falls, or all fall alike and there are no walls to be seen."""
    pulls = [np.unique(pull) for pull in (flights.gx, flights.gy) if pull is not None]
    return all(len(pull) == 1 and (not walls or pull[0] == 0.0) for pull in pulls)


def _have_come_round(period: Period, one: tuple[float, float], other: tuple[float, float], idle: float) -> bool:
    """Whether two flights at these velocities have been where they are, as seen from each other, within a time.

    The way of one on the torus, as seen from the other, closes after p and q rounds along the axes, where p / q is the ratio of
    its speeds in rounds; for floats that is a ratio of whole numbers.
    """
    u, w = (Fraction(a) - Fraction(b) for a, b in zip(one, other, strict=True))
    ways = [(abs(speed), length) for speed, length in zip((u, w), period, strict=True) if speed]
    if any(length is None for _, length in ways):
        return False  # towards a wall
    rounds = [speed / Fraction(length) for speed, length in ways if length is not None]
    closed = rounds[0] / rounds[1] if len(rounds) == 2 else Fraction(1)
    return rounds[0] * Fraction(idle) > Fraction(ROUNDS) * closed.numerator
