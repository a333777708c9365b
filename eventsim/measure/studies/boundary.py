"""The boundary map of a billiard as columns, one row a contact; see `measure.boundary_map`."""

from __future__ import annotations

import numpy as np

from eventsim.measure.boundary_map import boundary_map
from eventsim.measure.entries import dash
from eventsim.measure.found import Found
from eventsim.measure.measures import Measure
from eventsim.replay.log import AnyLog


def found(log: AnyLog, discard: float | None) -> Found:
    """Return the length of the boundary, and event, time, disk, arc length and sine of every contact with it."""
    mapped = boundary_map(log)
    if isinstance(mapped, str):
        return Found((dash("boundary_length", "length", mapped),))
    begun = log.scene.start_time + (discard or 0.0)
    blocks = list(mapped.all_contacts(log))
    kept = [block.time >= begun for block in blocks]
    columns = {
        name: np.concatenate([getattr(block, name)[late] for block, late in zip(blocks, kept, strict=True)]).tolist()
        for name in ("event", "time", "disk", "arc", "sine")
    }
    length = Measure(float(mapped.table.perimeter), unit="length", name="boundary_length")
    return Found((length,), {"boundary": columns if blocks else {}})
