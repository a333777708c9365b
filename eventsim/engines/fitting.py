"""Whether a snapshot can be one of a scene: what comes from a file is looked at before a compiled engine trusts it."""

from __future__ import annotations

from dataclasses import MISSING, fields

import numpy as np

from eventsim.engines.base import Snapshot
from eventsim.formulas.clock import window_length
from eventsim.formulas.motion import position
from eventsim.record.events import Floats
from eventsim.scene.stage import Stage

OUTSIDE = 2.0**-10
"""How far outside the domain, in parts of its size, a disk may be: generous, since rounding puts it there by far less."""

LARGEST = 1e200
"""Lengths, speeds and times whose products are still numbers."""

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
    if not (0 <= snapshot.epoch < 2**62 and 0 <= snapshot.window <= stage.window_cap and snapshot.window_rows >= 0):
        raise ValueError("its clock cannot stand there")
    end = window_length(snapshot.window, stage.epoch_length)
    t = np.array(snapshot.t)
    if not (0.0 <= snapshot.now <= end and np.all((t >= 0.0) & (t <= snapshot.now))):
        raise ValueError("its flights begin before their window, or after the present")
    _demand_inside(snapshot, stage, t)


def _demand_columns(snapshot: Snapshot, stage: Stage) -> None:
    """One number for each disk, finite; only a disk that never met anybody did so at -inf."""
    for item in fields(Snapshot):
        column = getattr(snapshot, item.name)
        if not isinstance(column, tuple):
            continue
        if len(column) != stage.n and (column or item.default is MISSING):
            raise ValueError(f"{item.name} has {len(column)} entries for {stage.n} disks")
        if item.name == "met":
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
    held = np.zeros(stage.n, bool) if stage.mass is None else np.isinf(stage.mass)
    columns = ((snapshot.x, snapshot.vx), (snapshot.y, snapshot.vy))
    for axis, ((places, speeds), size) in enumerate(zip(columns, stage.size, strict=True)):
        g = None if stage.gravity is None else np.where(held, 0.0, stage.gravity[axis])
        there = np.array(places)
        here = position(there, np.array(speeds), snapshot.now - t, g)
        for place in (there, here):
            if not np.all((place >= -OUTSIDE * size) & (place <= (1.0 + OUTSIDE) * size)):
                raise ValueError("a disk is outside the domain")
