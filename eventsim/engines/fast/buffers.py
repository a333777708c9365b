"""The buffers that kernels fill with rows, and that are filled again once nobody looks at their rows any more."""

from __future__ import annotations

import sys

import numpy as np

from eventsim.record.events import ROW, Rows

ROOM = 1 << 13
"""Rows in a buffer, a megabyte: fewer would keep Python busy, more would stand in the way of what the caches hold."""

MOST = 16
"""Buffers that are kept for another time: those that wait for the writer, and a few more."""


class Buffers:
    """A pool of buffers.  New memory would cost a tenth of a run's time: the system hands it out page by page, each wiped."""

    def __init__(self) -> None:
        self._pool: list[Rows] = []

    def blank(self) -> Rows:
        """A buffer (ROOM,) whose rows nobody holds, neither the caller nor whoever took rows of it."""
        for buffer, looks in zip(self._pool, _looks(self._pool), strict=True):
            if looks == UNSEEN:
                return buffer
        buffer = _new()
        if len(self._pool) < MOST:
            self._pool.append(buffer)
        return buffer


def _new() -> Rows:
    """A buffer (ROOM,) that begins with a cache line; views of it refer to it, not to the memory below, so they are counted."""
    memory = np.empty((ROOM + 1) * ROW.itemsize, np.uint8)
    start = -memory.ctypes.data % ROW.itemsize
    return np.frombuffer(memory.data[start : start + ROOM * ROW.itemsize], ROW)


def _looks(pool: list[Rows]) -> list[int]:
    """How many references there are to each buffer, views of its rows included, and those that counting takes."""
    return [sys.getrefcount(buffer) for buffer in pool]


UNSEEN = _looks([np.empty(0, ROW)])[0]
"""The count of a buffer that only the pool has: counted, since it depends on the Python that counts."""
