"""How far disks have turned: what a spoke shows, counted from the start of a run, along x there."""

from __future__ import annotations

import numpy as np

from eventsim.record.events import Floats, Rows
from eventsim.scene.stage import Stage


class Turns:
    """The angles of all disks, followed from row to row."""

    def __init__(self, stage: Stage, spin: Floats) -> None:
        """spin: angular velocities (n,) at the start."""
        self._angle, self._spin = np.zeros(stage.n), spin.copy()
        self._since = np.full(stage.n, stage.start_time)

    def take(self, rows: Rows, clock: Floats) -> None:
        """Take up rows, which come at ascending times (R,)."""
        pair = np.flatnonzero(rows["b"] >= 0)
        row = np.concatenate([np.arange(len(rows)), pair])
        disk = np.concatenate([rows["a"], rows["b"][pair]]).astype(np.int64)
        order = np.lexsort((row, disk))
        row, disk = row[order], disk[order]
        spin = np.concatenate([rows["spin_a"], rows["spin_b"][pair]])[order]
        time, first = clock[row], np.diff(disk, prepend=-1) != 0
        before, since = np.roll(spin, 1), np.roll(time, 1)
        before[first], since[first] = self._spin[disk[first]], self._since[disk[first]]
        np.add.at(self._angle, disk, before * (time - since))
        last = np.diff(disk, append=-1) != 0
        self._spin[disk[last]], self._since[disk[last]] = spin[last], time[last]

    def at(self, time: float) -> Floats:
        """Return the angles (n,) at a time after the last row."""
        return self._angle + self._spin * (time - self._since)
