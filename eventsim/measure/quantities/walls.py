"""Walls: the mean force on each, and the pressure on each of its sides."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from eventsim.measure.entries import Expected, average
from eventsim.measure.expected import CLOSED, two_in_a_box
from eventsim.measure.measures import Measure
from eventsim.measure.records import Records
from eventsim.measure.sums import SIDES
from eventsim.measure.walls import sides_of
from eventsim.scene.stage import stage_of

FORCE, PRESSURE = "mass length / time^2", "energy / length^2"


def measures(records: Records) -> Iterator[Measure]:
    """Yield momentum per time of each wall (and the weight of disks at rest on it); per length and side where there is a gas."""
    ensemble = records.ensemble
    if not ensemble.n or not records.plan.walls:
        return
    closed = two_in_a_box(records)
    pressed = records.no_temperature is None and ensemble.n > 1
    for place, (name, (length, sides)) in enumerate(
        zip(records.wall_names, sides_of(ensemble.scene, stage_of(ensemble.scene)), strict=True)
    ):
        impulse = [records.wall(place, side) for side in range(SIDES)]
        theory = Expected(closed[f"force_{name}"], 0.0, CLOSED) if f"force_{name}" in closed else None
        yield average(records, f"force_{name}", sum(impulse, np.zeros_like(records.time)), records.time, FORCE, theory)
        hit = [side for side in (0, 1) if impulse[side].any()]
        both = len(hit) == 2 and sides[0]
        if both:
            for side in hit:
                yield average(records, f"force_{name}_{sides[side]}", impulse[side], records.time, FORCE)
        if pressed and length > 0.0:
            for side in hit or [0]:
                called = f"pressure_{name}_{sides[side]}" if both else f"pressure_{name}"
                yield average(records, called, impulse[side], length * records.time, PRESSURE)
