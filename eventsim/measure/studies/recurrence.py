"""Recurrence times of a billiard: how long until a flight leaves the boundary again as it once did, to within a cell.

The boundary map is cut into cells of equal area.  Of each contact it is told when its disk next has one in the same cell.

Source of the mean: M. Kac, Bull. Amer. Math. Soc. 53, 1002 (1947), doi:10.1090/S0002-9904-1947-08927-8: where every cell is
visited by its share, contacts come back after as many contacts as there are cells, so after that many mean free times.
"""

from __future__ import annotations

import numpy as np

from eventsim.measure.blocking import block_average
from eventsim.measure.boundary_map import Contacts, boundary_map
from eventsim.measure.entries import UNSURE, Expected, averaged, beside, dash
from eventsim.measure.found import Found, lasting
from eventsim.measure.measures import Measure
from eventsim.record.events import Floats
from eventsim.replay.log import AnyLog

ARCS, SINES = 16, 16
"""Cells along the boundary and across the sine of the angle."""

TURNS = 10
"""Times as many contacts of a disk as there are cells: with fewer, what has not come back yet is too much."""

TOLD = 64
"""Times at which the share of what has not come back is told."""


def found(log: AnyLog, discard: float | None) -> Found:
    """Return mean recurrence times in contacts and in time, and the share that has not come back by a time."""
    mapped = boundary_map(log)
    if isinstance(mapped, str):
        return Found((dash("recurrence_time", "time", mapped),))
    blocks = list(mapped.all_contacts(log))
    every = Contacts(*(np.concatenate([np.empty(0), *(block[k] for block in blocks)]) for k in range(len(Contacts._fields))))
    late = every.time >= log.scene.start_time + (discard or 0.0)
    every = Contacts(*(column[late] for column in every))
    cells, disks = ARCS * SINES, max(int(mapped.movers.sum()), 1)
    if len(every.time) < TURNS * cells * disks:
        why = f"{len(every.time):,} contacts: too few to come back; at least {TURNS * cells:,} of each disk"
        return Found((dash("recurrence_time", "time", why),))
    contacts, times = _returns(every, mapped.table.perimeter)
    speed = float(np.hypot(*log.scene.disks.velocity[mapped.movers].T).mean())
    quantities = (
        _mean("recurrence_contacts", contacts, "1", float(cells)),
        _mean("recurrence_time", times, "time", cells * mapped.table.mean_free_path / speed),
    )
    told = np.linspace(0.0, float(times.max()), TOLD)
    return Found(quantities, {"recurrence": lasting(times, told, "longer")})


def _returns(every: Contacts, length: float) -> tuple[Floats, Floats]:
    """How many contacts, and how much time, lie between contacts in one cell that follow each other, in the order of return."""
    arc = np.minimum((every.arc / length * ARCS).astype(np.int64), ARCS - 1)
    sine = np.clip(((every.sine + 1.0) * (0.5 * SINES)).astype(np.int64), 0, SINES - 1)
    disk = every.disk.astype(np.int64)
    order = np.lexsort((every.event, disk))
    number = np.empty(len(order), np.int64)  # of a contact among those of its disk
    begins = np.flatnonzero(np.diff(disk[order], prepend=-1))
    number[order] = np.arange(len(order)) - np.repeat(begins, np.diff(begins, append=len(order)))
    cell = (disk * ARCS + arc) * SINES + sine
    order = np.lexsort((every.event, cell))
    again = np.flatnonzero(np.diff(cell[order]) == 0)
    first, next_ = order[again], order[again + 1]
    back = np.argsort(every.event[next_], kind="stable")
    first, next_ = first[back], next_[back]
    return (number[next_] - number[first]).astype(np.float64), every.time[next_] - every.time[first]


def _mean(name: str, times: Floats, unit: str, kac: float) -> Measure:
    bar = block_average(times)
    entry = averaged(name, bar, unit, None if bar.independent else UNSURE)
    return beside(entry, Expected(kac, 0.0, "Kac: cells x mean free time, if every cell is visited by its share"))
