"""What somebody who steps through a simulation has kept beside it: a log file, checkpoints."""

from __future__ import annotations

from os import PathLike
from pathlib import Path

from eventsim.engines.base import Session, Stop
from eventsim.engines.collapse import TAIL
from eventsim.record.events import Rows, blank_rows, joined
from eventsim.record.files import open_sink
from eventsim.record.provenance import Ending, Provenance
from eventsim.runner.checkpoint import Every, place_for
from eventsim.runner.checkpoint_writer import CheckpointWriter


class Keeping:
    """Writes rows and checkpoints as they come, until it is closed.

    log: the log file, which grows as NAME.part; None: none.  last_rows: for a diagnosis.

    Raises:
        LogError, CheckpointError: where files cannot be written.
    """

    def __init__(
        self, provenance: Provenance, log: str | PathLike[str] | None, checkpoint: str | PathLike[str] | None, every: Every
    ) -> None:
        self.log = None if log is None else open_sink(Path(log), provenance)
        self.last_rows, self._checkpoints = blank_rows(0), None
        if checkpoint is not None:
            try:
                self._checkpoints = CheckpointWriter(place_for(checkpoint), every, provenance, Stop(), self.log)
            except BaseException:
                self._abandon()
                raise

    def write(self, rows: Rows, session: Session) -> None:
        """Take the rows that a session has come through, and write a checkpoint where one is due."""
        self.last_rows = joined([self.last_rows, rows])[-TAIL:]
        if self.log is not None and len(rows):
            self.log.write(rows)
        self._save(session, None)

    def close(self, session: Session, stopped: str) -> None:
        """End where the session stands, for that reason: the log gets its name, a last checkpoint is written if one may be."""
        if self._checkpoints is not None:
            self._save(session, stopped)
            self._checkpoints.close()
        if self.log is not None:
            self.log.close(Ending(*session.clock, stopped))

    def _save(self, session: Session, stopped: str | None) -> None:
        if self._checkpoints is not None and self._checkpoints.is_due(session.counters.events, stopped):
            self._checkpoints.save(session, self.last_rows, 0.0, 0.0)

    def _abandon(self) -> None:
        if self.log is not None:
            self.log.abandon()
