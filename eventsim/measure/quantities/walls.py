"""Walls: the mean force across each, the pressure on each of its sides, and the force along those that pull."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from eventsim.measure.entries import Expected, average
from eventsim.measure.expected import CLOSED, two_in_a_box
from eventsim.measure.measures import Measure
from eventsim.measure.pull import walls_that_pull
from eventsim.measure.records import Records
from eventsim.measure.sums import END, SIDES
from eventsim.measure.walls import sides_of
from eventsim.record.events import Floats
from eventsim.scene.stage import stage_of

MOST_NAMES = 3
"""Of walls in one sentence."""

FORCE, PRESSURE = "mass length / time^2", "energy / length^2"
ALONG = "of the disks on the wall, along it: + is towards +x, +y, from start to end, counter-clockwise"


def measures(records: Records) -> Iterator[Measure]:
    """Yield momentum across each wall per time (and the weight of disks at rest on it); per length and side where there is a gas.

    Of walls that grip or heat also the momentum along them that disks give them.
    """
    ensemble = records.ensemble
    if not ensemble.n or not records.plan.walls:
        return
    closed = two_in_a_box(records)
    pressed = records.no_temperature is None and ensemble.n > 1
    stage = stage_of(ensemble.scene)
    pulls = walls_that_pull(stage)
    for place, (name, (length, sides)) in enumerate(zip(records.wall_names, sides_of(ensemble.scene, stage), strict=True)):
        impulse = [records.wall(place, side) for side in range(SIDES)]
        theory = Expected(closed[f"force_{name}"], 0.0, CLOSED) if f"force_{name}" in closed else None
        yield average(records, f"force_{name}", sum(impulse, np.zeros_like(records.time)), records.time, FORCE, theory)
        hit = _hit(impulse)
        both = len(hit) == 2 and sides[0]
        if both:
            for side in hit:
                yield average(records, f"force_{name}_{sides[side]}", impulse[side], records.time, FORCE)
        if pulls[place]:
            given = [records.shear(place, side) for side in range(SIDES)]
            yield average(records, f"shear_{name}", sum(given, np.zeros_like(records.time)), records.time, FORCE, note=ALONG)
            for side in hit if both else ():
                yield average(records, f"shear_{name}_{sides[side]}", given[side], records.time, FORCE, note=ALONG)
        if pressed and length > 0.0:
            for side in hit or [0]:
                called = f"pressure_{name}_{sides[side]}" if both else f"pressure_{name}"
                yield average(records, called, impulse[side], length * records.time, PRESSURE)


def legend(records: Records) -> Iterator[str]:
    """Yield which sides of walls are which, and where these are not all of a wall."""
    ensemble = records.ensemble
    if not ensemble.n or not records.plan.walls:
        return
    told: set[tuple[str, str]] = set()
    ends = []
    for place, (name, (_, sides)) in enumerate(
        zip(records.wall_names, sides_of(ensemble.scene, stage_of(ensemble.scene)), strict=True)
    ):
        impulse = [records.wall(place, side) for side in range(SIDES)]
        if sides[0] and len(_hit(impulse)) == 2:
            told.add(sides)
            ends += [name] if impulse[END].any() else []
    if ("left", "right") in told:
        yield "left and right of a wall: as seen from its start to its end"
    if ends:
        whose = ", ".join(ends[:MOST_NAMES]) + (" and others" if len(ends) > MOST_NAMES else "")
        yield f"the ends of {whose} take a share: the two sides of such a wall do not add up to its force"


def _hit(impulse: Sequence[Floats]) -> list[int]:
    """Which of the two sides of a wall took up momentum."""
    return [side for side in (0, 1) if impulse[side].any()]
