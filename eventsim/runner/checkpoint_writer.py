"""Writes the checkpoints of a run: when one is due, and what is written then."""

from __future__ import annotations

import sys
from pathlib import Path
from time import perf_counter

from eventsim.engines.base import Session, Stop
from eventsim.errors import CheckpointError
from eventsim.record.digest import Progress
from eventsim.record.events import Rows
from eventsim.record.files import FileSink
from eventsim.record.files.claim import Claim
from eventsim.record.provenance import Provenance, provenance_text
from eventsim.runner.checkpoint import Checkpoint, Every, KeptLog, save_checkpoint
from eventsim.suffixes import PART

USUALLY = Every(seconds=60.0)

GOES_ON_AFTER = ("until", "events", "quiet", "interrupted")
"""Ends after which a run can be continued; before a collapse the last checkpoint stays the one to go on from."""


class CheckpointWriter:
    """Writes the checkpoints of one run to one file.

    every: how often.  provenance, stop: of the run.  log: where its rows go, None where they are not kept.  While this one is not
    closed, another run that is to write the same file is refused (CheckpointError).
    """

    def __init__(self, path: Path, every: Every, provenance: Provenance, stop: Stop, log: FileSink | None) -> None:
        self._path = path
        self._every = every
        self._provenance = provenance
        self._text = provenance_text(provenance)
        self._stop = stop
        self._log = log
        self._events: int | None = None
        self._time = 0.0
        self._claim = Claim(path.with_name(path.name + PART), CheckpointError, f"the checkpoint {path.name}")
        self._claim.take(make=True)

    def close(self) -> None:
        """Let another run write the file."""
        self._claim.remove()

    def next_stop(self, stop: Stop, events: int) -> Stop:
        """The stop, or an earlier one where the next checkpoint is due by the number of events."""
        each = self._every.events
        if each is None:
            return stop
        due = (events // each + 1) * each
        return Stop(stop.until, due if stop.events is None else min(due, stop.events))

    def is_due(self, events: int, stopped: str | None) -> bool:
        """Whether this is the beginning, an end, or the time."""
        if self._events is None or stopped in GOES_ON_AFTER:
            return True
        if stopped is not None:
            return False
        if self._every.events is not None and events // self._every.events > self._events // self._every.events:
            return True
        return self._every.seconds is not None and perf_counter() - self._time >= self._every.seconds

    def save(
        self, session: Session, last_rows: Rows, elapsed: float, written: float, digest: Progress | None = None
    ) -> None:
        """Write a checkpoint; all rows so far have been written.  elapsed, written: seconds so far.  digest: of a compact log.

        Raises CheckpointError where the first one cannot be written.  Later a full disk is no reason to give up a long run: that
        is told on stderr, and the checkpoint before stays.
        """
        log = None if self._log is None else KeptLog(self._log.path, self._log.provenance.compact, self._log.sync())
        counters = session.counters.copy()
        checkpoint = Checkpoint(
            self._provenance, self._stop, self._every, session.snapshot(), counters, log, last_rows, elapsed, written, digest
        )
        try:
            save_checkpoint(self._path, checkpoint, self._text)
        except CheckpointError as error:
            if self._events is None:
                raise
            print(f"note: {error}; the run goes on with the checkpoint before", file=sys.stderr)
        self._events, self._time = counters.events, perf_counter()
