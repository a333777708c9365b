"""Runs of rows: what the schedule of the clock depends on, gathered from a log that is never held as a whole."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from eventsim.record.events import Kind, Rows, blank_rows, joined


class Kicked(NamedTuple):
    """A row that is a kick: its number, the disk, when, and the velocity that it sets."""

    row: int
    disk: int
    remainder: float
    velocity: tuple[float, float]


class Runs:
    """The rows of one epoch each, and the kicks among them.

    Attributes:
        count: rows in all.
        first: the first row of each run, and `count` behind the last one.
        epoch, remainder: of the first row of each run.
        begun_by_kick: whether that row is a kick.
        latest: the largest remainder of the last run; 0 without one.
    """

    def __init__(self, blocks: Iterable[Rows]) -> None:
        """blocks: the full rows of a log in order."""
        self.count, self.latest, last = 0, 0.0, -1
        leaders, kicks, places, kicked = [blank_rows(0)[["epoch", "remainder", "kind"]]], [blank_rows(0)], [], []
        for rows in blocks:
            if not len(rows):
                continue
            begins = np.flatnonzero(np.diff(rows["epoch"], prepend=last))
            leaders.append(rows[begins][["epoch", "remainder", "kind"]])
            places.extend((begins + self.count).tolist())
            kicks_here = np.flatnonzero(rows["kind"] == Kind.KICK)
            kicks.append(rows[kicks_here])
            kicked.extend((kicks_here + self.count).tolist())
            highest = float(rows["remainder"][begins[-1] if len(begins) else 0 :].max())
            self.latest = highest if len(begins) else max(self.latest, highest)
            self.count += len(rows)
            last = int(rows["epoch"][-1])
        found = np.concatenate(leaders)
        self.first: list[int] = [*places, self.count]
        self.epoch, self.remainder = found["epoch"].copy(), found["remainder"].copy()
        self.begun_by_kick = found["kind"] == Kind.KICK
        self._kicked, self._kicks = kicked, joined(kicks)

    def __len__(self) -> int:
        return len(self.epoch)

    def kicks_in(self, first: int, end: int) -> list[Kicked]:
        """Return the kicks among the rows from `first` to before `end`."""
        low, high = bisect_left(self._kicked, first), bisect_left(self._kicked, end)
        return [self.kick(row) for row in self._kicked[low:high]]

    def kick(self, row: int) -> Kicked:
        """Return the kick that a row is."""
        found = self._kicks[bisect_left(self._kicked, row)]
        return Kicked(row, int(found["a"]), float(found["remainder"]), (float(found["vxa"]), float(found["vya"])))
