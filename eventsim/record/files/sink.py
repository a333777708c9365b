"""What all streaming writers share: a log grows under NAME.part and gets its name when it is whole."""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from pathlib import Path

from eventsim.errors import LogError
from eventsim.record.events import COLUMNS, COMPACT_COLUMNS, Rows
from eventsim.record.provenance import Ending, Kick, Provenance, kicks_of

PART = ".part"


class FileSink(ABC):
    """A streaming writer of one log file; memory is bounded by the block that is written.

    A format supplies `_open`, `_append`, `_finish` and `_discard`. OSError becomes LogError.
    """

    def __init__(self, path: Path, provenance: Provenance, kicks: tuple[Kick, ...] | None) -> None:
        """Open `NAME.part`; kicks: None where they are to be taken from the rows, which then are full."""
        self.path = path
        self.part = path.with_name(path.name + PART)
        self.provenance = provenance
        self.columns = COMPACT_COLUMNS if provenance.compact else COLUMNS
        self._kicks_come_with_rows = kicks is None
        self._kicks = list(kicks or ())
        self._count = 0
        if path.is_dir():
            raise LogError(f"{path}: is a directory, so no log can be written there")
        if not path.parent.is_dir():
            raise LogError(f"{path}: the directory {path.parent} does not exist")
        try:
            self._open()
        except OSError as error:
            raise self._unwritable(error) from None

    def write(self, rows: Rows) -> None:
        """Append a block of rows."""
        if self._kicks_come_with_rows:
            self._kicks += kicks_of(rows)
        self._count += len(rows)
        try:
            self._append(rows)
        except OSError as error:
            raise self._unwritable(error) from None

    def close(self, ending: Ending | None = None) -> None:
        """Complete the metadata and give the file its name. ending: where the run ended."""
        try:
            self._finish(self.provenance.finished(ending, tuple(self._kicks), self._count))
            os.replace(self.part, self.path)
        except OSError as error:
            raise self._unwritable(error) from None

    def abandon(self) -> None:
        """Remove what has been written; no file appears."""
        self._discard()

    def _unwritable(self, error: OSError) -> LogError:
        return LogError(f"{self.path}: cannot be written ({error.strerror or error})")

    @abstractmethod
    def _open(self) -> None: ...

    @abstractmethod
    def _append(self, rows: Rows) -> None: ...

    @abstractmethod
    def _finish(self, provenance: Provenance) -> None:
        """Leave the whole file under `self.part`."""

    @abstractmethod
    def _discard(self) -> None: ...
