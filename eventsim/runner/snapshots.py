"""Snapshots in files: nested tuples of numbers as arrays, and back; what comes back is checked against its scene."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from itertools import chain
from typing import Any, TypeAlias

import numpy as np

from eventsim.engines.base import Snapshot
from eventsim.formulas.motion import position
from eventsim.formulas.rest import SUPPORTED, held_by
from eventsim.record.events import Floats
from eventsim.scene.clock import LONGEST_WINDOW
from eventsim.scene.stage import Stage

Packed: TypeAlias = Any
"""What JSON can hold: {"value": ...}, {"numbers": name of an array} or {"lengths": name of an array, "items": packed}."""

Arrays: TypeAlias = dict[str, np.ndarray[Any, Any]]

DEEPEST = 8
"""Tuples within tuples; nothing that is packed here comes near."""


def packed(name: str, value: Any, arrays: Arrays) -> Packed:
    """Pack a value; what does not fit into JSON goes into `arrays`, under names that begin with `name`.

    A number, a text or None stays as it is.  A tuple of floats, or of whole numbers, is one array.  A tuple of tuples is the
    array of their lengths, and what they hold one behind the other, packed in turn.

    Raises TypeError for what is neither a number, a text, None nor a tuple of one kind of these.
    """
    if value is None or type(value) in (bool, int, float, str):
        return {"value": value}
    if type(value) is not tuple:
        raise TypeError(f"{name}: a {type(value).__name__} cannot be packed")
    kinds = set(map(type, value))
    if kinds <= {int} or kinds <= {float}:
        arrays[name] = np.array(value, np.float64 if float in kinds else np.int64)
        return {"numbers": name}
    if kinds == {tuple}:
        arrays[name] = np.fromiter(map(len, value), np.int64, len(value))
        return {"lengths": name, "items": packed(f"{name}.items", tuple(chain.from_iterable(value)), arrays)}
    raise TypeError(f"{name}: a tuple of {', '.join(sorted(kind.__name__ for kind in kinds))} cannot be packed")


def unpacked(form: Packed, arrays: Mapping[str, np.ndarray[Any, Any]], depth: int = 0) -> Any:
    """What was packed, of the same types.

    Raises KeyError, TypeError or ValueError for what `packed` does not give.
    """
    if "value" in form:
        return form["value"]
    if depth > DEEPEST:
        raise ValueError("tuples are nested too deeply")
    if "numbers" in form:
        return tuple(_numbers(arrays[form["numbers"]]).tolist())
    lengths = _numbers(arrays[form["lengths"]])
    items = unpacked(form["items"], arrays, depth + 1)
    ends = np.cumsum(lengths)
    if lengths.dtype.kind != "i" or np.any(lengths < 0) or len(items) != (ends[-1] if len(ends) else 0):
        raise ValueError("the lengths of tuples do not fit what they hold")
    return tuple(items[end - length : end] for end, length in zip(ends.tolist(), lengths.tolist(), strict=True))


def _numbers(array: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    if array.ndim != 1 or array.dtype not in (np.dtype(np.float64), np.dtype(np.int64)):
        raise ValueError(f"an array of {array.dtype} and shape {array.shape} is not expected")
    return array


OUTSIDE = 2.0**-10
"""How far outside the domain, in parts of its size, a disk may be: generous, since rounding puts it there by far less."""

LARGEST = 1e300
"""Lengths, speeds and times that scenes of numbers within their limits come to."""

MOST_COUNTED = 2**31 - 1
"""What the records of the compiled engine can count."""


def demand_fit(snapshot: Snapshot, stage: Stage) -> None:
    """Raise ValueError where a snapshot cannot be one of this stage; O(N)."""
    _demand_columns(snapshot, stage)
    shapes = len(stage.boundaries) + len(stage.features)
    for i, met in enumerate(snapshot.met):
        for other, kx, ky in met:
            if not (-1 - shapes < other < stage.n and max(abs(kx), abs(ky)) <= MOST_COUNTED):
                raise ValueError(f"disk {i} cannot have met {other}")
        held = held_by(met)
        if held is not None and stage.supports is not None and stage.supports[held.place] is None:
            raise ValueError(f"disk {i} cannot rest on {met[0][0]}")
    if not (0 <= snapshot.epoch < 2**62 and 0 <= snapshot.window <= LONGEST_WINDOW and snapshot.window_rows >= 0):
        raise ValueError("its clock cannot stand there")
    t = np.array(snapshot.t)
    if not (0.0 <= snapshot.now <= LARGEST and np.all((t >= 0.0) & (t <= snapshot.now))):
        raise ValueError("its flights begin before their window, or after the present")
    _demand_inside(snapshot, stage, t)


def _demand_columns(snapshot: Snapshot, stage: Stage) -> None:
    """One number for each disk, finite, low parts where the stage has them; only who never met anybody did so at -inf."""
    low = {"low_vx": stage.low_parts, "low_vy": stage.low_parts, "sides": stage.points, "spin": stage.spin is not None}
    low["contacts"] = stage.seed is not None
    for item in fields(Snapshot):
        column = getattr(snapshot, item.name)
        if not isinstance(column, tuple):
            continue
        if len(column) != (stage.n if low.get(item.name, True) else 0):
            raise ValueError(f"{item.name} has {len(column)} entries for {stage.n} disks")
        if item.name == "met":
            continue
        if item.name == "sides":
            if not all(len(sides) == len(stage.features) and set(sides) <= {-2, -1, 0, 1, 2} for sides in column):
                raise ValueError("a disk is on no side of a wall")
            continue
        values = np.array(column)
        whole = "int" in str(item.type)
        if column and (values.ndim != 1 or values.dtype.kind != ("i" if whole else "f")):
            raise ValueError(f"{item.name} has entries that are not {'whole ' if whole else ''}numbers")
        if item.name == "contact_time":
            values = np.where(values == -np.inf, 0.0, values)
        largest = MOST_COUNTED if whole else LARGEST
        if not np.all(np.abs(values) <= largest):
            raise ValueError(f"{item.name} has entries that no engine counts with")


def _demand_inside(snapshot: Snapshot, stage: Stage, t: Floats) -> None:
    """Every disk inside the domain, where its flight began and now."""
    if stage.size is None:
        return
    pull = _accelerations(snapshot, stage)
    columns = ((snapshot.x, snapshot.vx), (snapshot.y, snapshot.vy))
    for axis, ((places, speeds), size) in enumerate(zip(columns, stage.size, strict=True)):
        there = np.array(places)
        here = position(there, np.array(speeds), snapshot.now - t, None if pull is None else pull[:, axis])
        for place in (there, here):
            if not np.all((place >= -OUTSIDE * size) & (place <= (1.0 + OUTSIDE) * size)):
                raise ValueError("a disk is outside the domain")


def _accelerations(snapshot: Snapshot, stage: Stage) -> Floats | None:
    """What each disk's flight has as its acceleration (n, 2): that along its wall where it rests; None without gravity."""
    if stage.gravity is None:
        return None
    falls = np.ones(stage.n) if stage.mass is None else np.isfinite(stage.mass)
    pull: Floats = falls[:, None] * np.array(stage.gravity)
    if stage.supports is not None:
        for i, met in enumerate(snapshot.met):
            held = held_by(met)
            support = None if held is None or held.how != SUPPORTED else stage.supports[held.place]
            if support is not None:
                pull[i] = support.ax, support.ay
    return pull
