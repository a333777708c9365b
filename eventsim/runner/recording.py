"""Where the rows of a run go: memory, a log file, a digest, whoever else takes them; beside the engine where they are many."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from queue import Queue
from threading import Thread
from time import perf_counter

from eventsim.record.digest import Digester, Progress
from eventsim.record.events import Rows, blank_rows, joined
from eventsim.record.files import FileSink, continued_sink, open_log, open_sink
from eventsim.record.provenance import Ending, Kick, Provenance, Recorded, has_spin, kicks_of
from eventsim.runner.options import RunOptions


class Recording:
    """The rows of one run on their way to those who keep them.

    file: the log file, None where there is none.  memory: the log in memory, None where there is none.

    Raises:
        LogError: where the log file cannot be written, or is not the one that the run goes on with.
    """

    def __init__(self, wanted: RunOptions, provenance: Provenance) -> None:
        self.memory = MemorySink(provenance) if wanted.log is True else None
        self.file = _file_sink(wanted, provenance)
        self._digester = Digester(has_spin(provenance.scene)) if wanted.digest or wanted.log is not False else None
        self._sinks = [sink for sink in (self.memory, self.file) if sink is not None]
        takers = [sink.write for sink in self._sinks]
        self._writer = Writer(takers + ([] if self._digester is None else [self._digester.update]) + wanted.takers)
        self.write, self.settle = self._writer.write, self._writer.settle

    def go_on(self, wanted: RunOptions) -> None:
        """Take into the digest what the log file holds already: a compact one lacks it, and the checkpoint has it."""
        if self.file is None or self._digester is None:
            return
        assert wanted.resumed is not None
        if wanted.resumed.digest is not None:
            self._digester.go_on(wanted.resumed.digest)
            return
        for rows in open_log(self.file.part, verify=False).blocks:
            self._digester.update(rows)

    @property
    def digest_so_far(self) -> Progress | None:
        """How far the digest has come, of a compact log, from which it could not be computed again."""
        compact = self.file is not None and self.file.provenance.compact
        return self._digester.progress() if compact and self._digester is not None else None

    @property
    def waited_s(self) -> float:
        """Seconds that the engine has waited for rows to be written."""
        return self._writer.waited_s

    def close(self, epoch: int, remainder: float, stopped: str) -> str | None:
        """End with the run, at that time for that reason; the digest, None where none is computed."""
        self._writer.finish()
        digest = None if self._digester is None else self._digester.hexdigest()
        for sink in self._sinks:
            sink.close(Ending(epoch, remainder, stopped, digest))
        return digest

    def break_off(self, has_rows: bool) -> None:
        """End where something broke the run off: a log that has rows stays as NAME.part, which can be read."""
        self._writer.abandon()
        for sink in self._sinks:
            sink.leave() if has_rows else sink.abandon()


def _file_sink(wanted: RunOptions, provenance: Provenance) -> FileSink | None:
    """The writer of the log file: a new one, or that of the run that goes on."""
    if isinstance(wanted.log, bool):
        return None
    path = Path(wanted.log)
    if wanted.resumed is None:
        return open_sink(path, provenance, compact=wanted.compact)
    assert wanted.resumed.log is not None, "only a run that kept a log goes on with one"
    return continued_sink(path, provenance, wanted.compact, wanted.resumed.log.mark)


class MemorySink:
    """Keeps the rows of a run in memory; `recorded()` is what has been written so far, at the cost of what came since.

    The rows that it gave never change: later ones are written behind them, where there is room.
    """

    def __init__(self, provenance: Provenance) -> None:
        self._provenance = provenance
        self._blocks: list[Rows] = []
        self._room, self._count = blank_rows(0, has_spin(provenance.scene)), 0
        self._kicks: list[Kick] = []
        self._ending: Ending | None = None

    def write(self, rows: Rows) -> None:
        """Append a block of rows; it is copied, so the caller may reuse it."""
        self._blocks.append(rows.copy())

    def close(self, ending: Ending | None = None) -> None:
        """Say where the run ended, or stands."""
        self._ending = ending

    def leave(self) -> None:
        """Memory holds what it holds."""

    def abandon(self) -> None:
        """Forget all rows."""
        self.forget(0)

    def forget(self, count: int) -> None:
        """Forget the rows behind the first `count`."""
        rows = self._gathered()[:count]
        self._room, self._count, self._kicks = rows.copy(), len(rows), kicks_of(rows)

    def recorded(self) -> Recorded:
        """Return the rows so far as a log."""
        rows = self._gathered()
        return Recorded(self._provenance.finished(self._ending, tuple(self._kicks), len(rows)), rows)

    def _gathered(self) -> Rows:
        """The rows so far as one array: behind those that were asked for before come the others."""
        if self._blocks:
            added, self._blocks = joined(self._blocks), []
            before, count = self._room[: self._count], self._count + len(added)
            if self._count == 0:
                self._room = added
            elif count > len(self._room):
                self._room = joined([before, added, before])  # as much again
            else:
                self._room[self._count : count] = added
            self._count = count
            self._kicks += kicks_of(added)
        return self._room[: self._count]


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
