"""Sizes: at which distance disks turn round, in sums of their radii."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from eventsim.record.events import Floats, Kind
from eventsim.validation.judge.faults import SURE, Fault
from eventsim.validation.judge.flights import Turn
from eventsim.validation.judge.surroundings import Surroundings
from eventsim.validation.judge.told import Met

ENOUGH = 6
"""Contacts from which a size is told."""

OTHER_SIZE = 0.01
"""Of the radii: what differs by less is a margin, as solvers keep."""


def wrong_sizes(met: Sequence[Met], around: Surroundings, resolution: float) -> Fault | None:
    """The fault of disks that turn at another distance than that of their radii; None where they do not, or nobody can tell.

    Steps find contacts late, and springs give way, by more the faster disks meet: where the distance at which the flights
    before and after cross goes to with the speed of approach, that is the sum of the radii.

    Args:
        met: contacts in order of time.
        around: their disks and walls.
        resolution: a smaller distance cannot be told, length.
    """
    radius = around.stage.radius
    seen: dict[int, list[tuple[float, float, float, float]]] = {int(Kind.PAIR): [], int(Kind.WALL): []}
    for one in met:
        turns = [turn for turn in one.turns if turn is not None]
        if not one.alone or not turns or not all(turn.is_sharp for turn in turns):
            continue
        kind, a, other = one.key
        if kind == Kind.PAIR:
            found, reach = (_between(turns, around), float(radius[a] + radius[other])) if len(turns) == 2 else (None, 0.0)
        else:
            found, reach = _from_wall(turns[0], other, around), float(radius[a])
        if found is not None and reach > 0.0:
            distance, approach = found
            seen[kind].append((one.time, distance / reach, approach / reach, resolution / reach))
    faults = [_fault(np.array(rows), kind == Kind.PAIR) for kind, rows in seen.items() if len(rows) >= ENOUGH]
    return min((fault for fault in faults if fault is not None), key=lambda fault: fault.time, default=None)


def _between(turns: Sequence[Turn], around: Surroundings) -> tuple[float, float] | None:
    """(distance, speed of approach) of two disks when their flights cross."""
    one, other = turns
    weights = [math.hypot(*turn.change) for turn in turns]
    time = (weights[0] * one.time + weights[1] * other.time) / sum(weights)
    ends = [turn.place + turn.before * (time - turn.time) for turn in turns]
    apart = around.apart(ends[0], ends[1])
    distance = math.hypot(*apart)
    return (distance, float((one.before - other.before) @ apart) / distance) if distance > 0.0 else None


def _from_wall(turn: Turn, wall: int, around: Surroundings) -> tuple[float, float] | None:
    """(distance, speed of approach) of a disk and the surface of a wall away from which it turns."""
    found = []
    for surface in around.surfaces:
        if around.wall_of(surface) == wall:
            normal, distance = around.to_wall(surface, turn.place)
            if math.isfinite(distance) and float(turn.change @ np.array(normal)) > 0.0:
                found.append((abs(distance), -float(turn.before @ np.array(normal))))
    return min(found, default=None)


def _fault(rows: Floats, pairs: bool) -> Fault | None:
    """The fault of contacts (time, distance, speed of approach, resolution), in reaches."""
    time, distance, approach, resolution = rows.T
    design = np.column_stack([np.ones(len(rows)), approach])
    (size, slope), *_ = np.linalg.lstsq(design, distance, rcond=None)
    left = distance - design @ np.array([size, slope])
    error = math.sqrt(float(left @ left) / (len(rows) - 2) * float(np.linalg.pinv(design.T @ design)[0, 0]))
    if abs(size - 1.0) <= max(OTHER_SIZE, SURE * error, float(resolution.max())):
        return None
    what = "the sum of their radii" if pairs else "their radius from walls"
    said = f"radius: disks turn at {size:.3g} of {what} ({len(rows)} contacts from t = {time[0]:.6g} on)"
    return Fault(float(time[0]), "radius", said)
