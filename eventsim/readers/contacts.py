"""Contacts that an engine tells of: who met whom, when.

Columns: time, a, b, wall.  b is -1 or empty at a contact with a wall, whose name `wall` may tell.  An event log is such a table.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eventsim.errors import EventsimError
from eventsim.readers import read_columns
from eventsim.readers.columns import demand_alike, numbers_of
from eventsim.readers.samples import Columns, Floats
from eventsim.reading import told_as

CONTACTS = ("pair", "wall")
"""Kinds of rows of an event log that are contacts."""

SAME = 1e-9
"""Of the latest time: contacts that are nearer are at one time, told with rounding."""


@dataclass(frozen=True, slots=True)
class ToldContacts:
    """Contacts in order of time: time (K,), a and b (K,), a < b or b = -1; wall: (K,) names, empty where none is told."""

    time: Floats
    a: NDArray[np.int64]
    b: NDArray[np.int64]
    wall: tuple[str, ...]

    @property
    def step(self) -> float:
        """The least time between two of them at different times: a step of an engine that has steps; inf where there are none."""
        apart = np.diff(self.time)
        apart = apart[apart > SAME * np.abs(self.time).max(initial=0.0)]
        return float(apart.min(initial=np.inf))

    def since(self, time: float) -> ToldContacts:
        """Those after a time."""
        first = int(np.searchsorted(self.time, time, side="right"))
        return ToldContacts(self.time[first:], self.a[first:], self.b[first:], self.wall[first:])


def read_contacts(path: Path, n: int, counted: int = 0) -> ToldContacts:
    """The contacts between n disks, the first of which is number `counted`, and with walls.

    Raises:
        EventsimError: naming the file, for what is no such table.
    """
    with told_as(path, EventsimError, "does not tell contacts"):
        return _told(read_columns(path), path, n, counted)


def _told(named: Columns, path: Path, n: int, counted: int) -> ToldContacts:
    missing = [name for name in ("time", "a", "b") if name not in named]
    if missing:
        raise EventsimError(f"{path}: lacks {', '.join(missing)}: contacts have the columns time, a, b (-1: a wall), wall")
    demand_alike(named, ("time", "a", "b", "wall", "kind"), str(path))
    kept = np.ones(len(named["time"]), dtype=bool)
    if "kind" in named:
        kept = np.isin(list(map(str, named["kind"].tolist())), CONTACTS)
    b = named["b"][kept]
    if b.dtype.kind in "UO":
        b = np.where(b == "", "-1", b)
    wall = list(map(str, named["wall"][kept].tolist())) if "wall" in named else [""] * int(kept.sum())
    time, a, b = (
        numbers_of(column, name, str(path)) for name, column in (("time", named["time"][kept]), ("a", named["a"][kept]), ("b", b))
    )
    return told_from(time, a, np.where(np.isfinite(b), b, -1.0), wall, n, str(path), counted)


def told_from(
    time: Floats, a: Floats, b: Floats, wall: Sequence[str], n: int, source: str, counted: int = 0
) -> ToldContacts:
    """Contacts from columns, in which the first of n disks is number `counted`.

    Raises:
        EventsimError: where they name disks that there are not.
    """
    if not np.all(np.isfinite(time)):
        row = int(np.argmin(np.isfinite(time)))
        raise EventsimError(f"{source}: row {row}: time = {time[row]}: must be finite")
    alone = b == -1.0
    for name, column, at_wall in (("a", a, False), ("b", b, alone)):
        wrong = ~(((column >= counted) & (column < counted + n) & (column == np.floor(column))) | at_wall)
        if wrong.any():
            row = int(np.argmax(wrong))
            count = f"{counted} to {counted + n - 1}{', as in the motion' if counted else ''}"
            raise EventsimError(f"{source}: row {row}: {name} = {column[row]:g}: names no disk; they are {count}")
    if np.any(a == b):
        raise EventsimError(f"{source}: row {int(np.argmax(a == b))}: a disk meets itself")
    low, high = np.minimum(a, b) - counted, np.maximum(a, b) - counted
    order = np.argsort(time, kind="stable")
    return ToldContacts(
        time[order],
        np.where(alone, a - counted, low)[order].astype(np.int64),
        np.where(alone, -1, high)[order].astype(np.int64),
        tuple(wall[k] for k in order),
    )
