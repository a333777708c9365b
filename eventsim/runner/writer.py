"""The writer: rows go to those who keep them, beside the engine once they come thick and fast."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from queue import Queue
from threading import Thread
from time import perf_counter

from eventsim.record.events import Rows

MANY_ROWS = 1 << 12
"""A block of so many comes from compiled kernels only: while those work, Python is free for a thread of its own."""

WAITING = 8
"""Blocks that may wait for the thread; after that the engine waits, so that memory stays bounded."""

Taker = Callable[[Rows], None]


class Writer:
    """Hands blocks of rows to takers, in order.

    waited_s: seconds that the caller has spent on it.
    """

    def __init__(self, takers: Sequence[Taker]) -> None:
        self.waited_s = 0.0
        self._takers = takers
        self._queue: Queue[Rows | None] = Queue(WAITING)
        self._thread: Thread | None = None
        self._failure: BaseException | None = None

    def write(self, rows: Rows) -> None:
        """Take a block, which nobody changes any more.  Raises what a taker raised, be it at an earlier block."""
        began = perf_counter()
        if self._thread is None and len(rows) >= MANY_ROWS and self._takers:
            self._thread = Thread(target=self._work, name="eventsim writer", daemon=True)
            self._thread.start()
        if self._thread is None:
            self._give(rows)
        else:
            self._queue.put(rows)
            self._raise_failure()
        self.waited_s += perf_counter() - began

    def finish(self) -> None:
        """Wait until all has been taken; raises what a taker raised."""
        began = perf_counter()
        if self._thread is not None:
            self._queue.put(None)
            self._thread.join()
            self._thread = None
            self._raise_failure()
        self.waited_s += perf_counter() - began

    def settle(self) -> None:
        """Wait until all so far has been taken; raises what a taker raised."""
        began = perf_counter()
        if self._thread is not None:
            self._queue.join()
            self._raise_failure()
        self.waited_s += perf_counter() - began

    def abandon(self) -> None:
        """Forget what has not been taken yet, and what went wrong."""
        self._takers = ()
        if self._thread is not None:
            self._queue.put(None)
            self._thread.join()
            self._thread = None

    def _raise_failure(self) -> None:
        if self._failure is not None:
            failure, self._failure = self._failure, None
            self._takers = ()
            raise failure

    def _give(self, rows: Rows) -> None:
        for take in self._takers:
            take(rows)

    def _work(self) -> None:
        while (rows := self._queue.get()) is not None:
            if self._failure is None:
                try:
                    self._give(rows)
                except BaseException as failure:  # told to the caller, in the caller's thread
                    self._failure = failure
            self._queue.task_done()
