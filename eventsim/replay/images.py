"""Over which sides of a periodic domain disks have gone: what leads from a place inside it to one that goes on."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from eventsim.errors import LogError
from eventsim.formulas.motion import position
from eventsim.record.events import Floats, State
from eventsim.replay.flight_table import FlightTable, Indices, flights
from eventsim.replay.motion import Motion

SURE = 0.25
"""Periods by which a place that goes on may be beside one that its state has: more, and its images are not known."""


def images_of(motion: Motion, states: Sequence[State]) -> Indices:
    """Return the images (T, N, 2) of disks: a disk's place that goes on is `position + image * size`; at the start 0.

    states: at ascending times.  O(rows + N T).  Raises LogError where flights of a log do not lead to its states.
    """
    scene = motion.log.scene
    found = np.zeros((len(states), len(scene.disks), 2), dtype=np.int64)
    if not any(scene.domain.periodic) or not states:
        return found
    times = np.array([state.time for state in states])
    moved = np.zeros(found.shape)
    for table in flights(motion, float(times[-1])):
        _add(moved, table, times)
    for axis, period in enumerate(scene.domain.period):
        if period is not None:
            place = np.stack([state.position[:, axis] for state in states])
            images = (scene.disks.position[:, axis] + moved[:, :, axis] - place) / period
            if np.any(np.abs(images - np.rint(images)) > SURE):
                raise LogError("the flights of this log do not lead to its states: how often disks went round is not known")
            found[:, :, axis] = np.rint(images)
    return found


def _add(moved: Floats, table: FlightTable, times: Floats) -> None:
    """Add to `moved` (T, N, 2) what flights bring about until each of the times."""
    begins = np.searchsorted(times, table.time, side="right")
    ends = np.searchsorted(times, table.time + table.duration, side="left")
    done = np.zeros(moved.shape)
    over = ends < len(times)
    np.add.at(done, (ends[over], table.disk[over]), _way(table, table.duration)[over])
    moved += np.cumsum(done, axis=0)
    count = np.maximum(ends - begins, 0)
    flying = np.repeat(np.arange(len(count)), count)
    which = np.arange(len(flying)) - np.repeat(np.cumsum(count) - count, count) + begins[flying]
    part = table.at(flying)
    np.add.at(moved, (which, part.disk), _way(part, times[which] - part.time))


def _way(table: FlightTable, lag: Floats) -> Floats:
    """The displacements (F, 2) of flights after `lag` (F,)."""
    way: Floats = position(np.zeros_like(table.place), table.velocity, lag[:, None], table.pull)
    return way


def unwrapped(motion: Motion, states: Sequence[State], images: Indices) -> list[State]:
    """Return the states with places that go on over the sides."""
    size = np.array([period or 0.0 for period in motion.log.scene.domain.period])
    return [
        State(state.time, state.position + image * size, state.velocity, state.scene, state.spin)
        for state, image in zip(states, images, strict=True)
    ]
