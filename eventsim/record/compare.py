"""How far two logs tell the same story: the same contacts, in the same order for each disk."""

from __future__ import annotations

from collections import deque
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from eventsim.record.events import Floats, Rows

Contact: TypeAlias = tuple[int, int, int, int]

COORDINATES = ("xa", "ya", "xb", "yb")
VELOCITIES = ("vxa", "vya", "vxb", "vyb")
"""Columns that say where the disks of a contact are, and how they fly after it."""


class Agreement(NamedTuple):
    """Which rows of two logs are the same contact: row pairs[k, 0] of the one is row pairs[k, 1] of the other, (K, 2).

    difference: the first row of the one that is not what happens next in the other; None where no difference was seen, be
    it that one of the logs ended.  missing, surplus: rows of the one, and of the other, that have no partner.
    """

    pairs: NDArray[np.int64]
    difference: int | None
    missing: int
    surplus: int


class Comparison:
    """Compares two logs block by block, as they grow.

    Rows are the same contact where kind, disks and wall are.  Contacts that share no disk may be in another order: what
    counts is the sequence of every disk.
    """

    def __init__(self) -> None:
        self._waiting: tuple[deque[tuple[int, Contact]], dict[int, deque[tuple[int, Contact]]]] = (deque(), {})
        self._rows = [0, 0]
        self.pairs: list[tuple[int, int]] = []
        self.difference: int | None = None

    def add(self, one: Rows, other: Rows) -> None:
        """Go on with the next rows of both logs."""
        mine, queues = self._waiting
        for contact in _contacts(other):
            for disk in contact[1:3]:
                if disk >= 0:
                    queues.setdefault(disk, deque()).append((self._rows[1], contact))
            self._rows[1] += 1
        for contact in _contacts(one):
            mine.append((self._rows[0], contact))
            self._rows[0] += 1
        while mine and self.difference is None:
            row, contact = mine[0]
            ahead = [queues.get(disk) for disk in contact[1:3] if disk >= 0]
            if any(queue and queue[0][1] != contact for queue in ahead):
                self.difference = row
            elif all(ahead):
                partners = [queue.popleft()[0] for queue in ahead if queue]
                self.pairs.append((row, partners[0]))
                mine.popleft()
            else:
                break

    def end(self) -> None:
        """Both logs are complete: the first row that only one of them has is a difference, be it behind the last of the first."""
        if self.difference is None and (self._waiting[0] or self._rows[1] > len(self.pairs)):
            mine = self._waiting[0]
            self.difference = mine[0][0] if mine else self._rows[0]

    def agreement(self) -> Agreement:
        """What has been found so far."""
        found = len(self.pairs)
        pairs = np.array(self.pairs, np.int64).reshape(-1, 2)
        return Agreement(pairs, self.difference, self._rows[0] - found, self._rows[1] - found)


def agreement(one: Rows, other: Rows) -> Agreement:
    """How far two logs agree; arrays of ROW."""
    comparison = Comparison()
    comparison.add(one, other)
    return comparison.agreement()


def deviations(
    one: Rows, other: Rows, pairs: NDArray[np.int64], columns: tuple[str, ...] = COORDINATES
) -> Floats:
    """The largest difference in one of the columns, one a pair of rows that are the same contact; in the columns' unit."""
    mine, theirs = one[pairs[:, 0]], other[pairs[:, 1]]
    largest: Floats = np.fmax.reduce([np.abs(mine[name] - theirs[name]) for name in columns])
    return largest


def time_differences(one: Rows, other: Rows, pairs: NDArray[np.int64], epoch_length: float) -> Floats:
    """How far apart in time rows are that are the same contact, one a pair; time."""
    mine, theirs = one[pairs[:, 0]], other[pairs[:, 1]]
    epochs = (mine["epoch"] - theirs["epoch"]) * epoch_length
    apart: Floats = np.abs(epochs + (mine["remainder"] - theirs["remainder"]))
    return apart


def _contacts(rows: Rows) -> list[Contact]:
    return list(zip(rows["kind"].tolist(), rows["a"].tolist(), rows["b"].tolist(), rows["wall"].tolist(), strict=True))
