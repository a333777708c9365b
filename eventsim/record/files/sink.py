"""What all streaming writers share: a log grows under NAME.part and gets its name when it is whole."""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from collections.abc import Callable, Generator, Iterable
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import IO, NamedTuple

from eventsim.errors import LogError
from eventsim.record.digest import StoredDigester
from eventsim.record.events import Rows
from eventsim.record.files.atomic import demand_place
from eventsim.record.files.claim import Claim
from eventsim.record.provenance import Ending, Kick, Provenance, columns_kept, kicks_of
from eventsim.suffixes import PART


class Mark(NamedTuple):
    """How far a log has come: its rows, and the velocities that were set in them."""

    rows: int
    kicks: tuple[Kick, ...]


class FileSink(ABC):
    """A streaming writer of one log file; memory is bounded by the block that is written.

    A format supplies `_open`, `_reopen`, `_append`, `_sync`, `_finish`, `_release` and `_discard`. OSError becomes LogError.
    """

    def __init__(
        self, path: Path, provenance: Provenance, kicks: tuple[Kick, ...] | None, mark: Mark | None = None
    ) -> None:
        """Open `NAME.part`.

        kicks: None where they are to be taken from the rows, which then are full.  mark: go on behind these rows of the
        part that is there, which may have more; None: begin.
        """
        self.path = path
        self.part = part_of(path)
        self.provenance = provenance
        self.columns = columns_kept(provenance)
        self._kicks_come_with_rows = kicks is None
        self._kicks = list(kicks or ()) if mark is None else list(mark.kicks)
        self._count = 0 if mark is None else mark.rows
        self._stored = StoredDigester(self.columns)
        demand_place(path, LogError)
        if path.is_dir():
            raise LogError(f"{path}: is a directory, so no log can be written there")
        if not path.parent.is_dir():
            raise LogError(f"{path}: the directory {path.parent} does not exist")
        self._claim = Claim(self.part)
        try:
            if mark is None:
                self._open()
            else:
                self._reopen(mark.rows)
            self._claim.take()
        except (LogError, OSError) as error:
            self.leave()
            raise self._unwritable(error) if isinstance(error, OSError) else error from None

    def write(self, rows: Rows) -> None:
        """Append a block of rows."""
        self.copy(rows, kicks_of(rows) if self._kicks_come_with_rows else ())

    def copy(self, rows: Rows, kicks: Iterable[Kick]) -> None:
        """Append a block of rows; kicks: the velocities that were set in them, which compact rows do not have."""
        try:
            self.part.stat()  # an unlinked file takes rows without a word
            self._append(rows)
        except OSError as error:
            raise self._unwritable(error) from None
        self._stored.update(rows)
        self._kicks += kicks
        self._count += len(rows)

    def remember(self, rows: Rows) -> None:
        """Take into the digest a block of rows that the part has already."""
        self._stored.update(rows)

    def sync(self) -> Mark:
        """Have all rows so far on the disk, whatever happens to the machine; how far the log has come."""
        try:
            self._sync()
        except OSError as error:
            raise self._unwritable(error) from None
        return Mark(self._count, tuple(self._kicks))

    def close(self, ending: Ending | None = None) -> None:
        """Complete the metadata and give the file its name. ending: where the run ended."""
        if ending is not None:
            ending = replace(ending, stored=self._stored.hexdigest())
        try:
            whole = self._finish(self.provenance.finished(ending, tuple(self._kicks), self._count))
            os.replace(whole, self.path)
            if whole != self.part:
                self._discard()
            self._claim.release()
        except OSError as error:
            raise self._unwritable(error) from None

    def leave(self) -> None:
        """Let go of the part: what has been written stays there and can be read."""
        with suppress(OSError):  # what could not be written before cannot be now
            self._release()
        self._claim.release()

    def abandon(self) -> None:
        """Remove what has been written; no file appears."""
        self.leave()
        with suppress(OSError):
            self._discard()

    def _unwritable(self, error: OSError) -> LogError:
        if not self.path.parent.is_dir():
            return LogError(f"{self.path}: cannot be written any more: its directory has vanished")
        kept = (
            f"; {self.part} keeps what was written before and can be read" if self._count and self.part.exists() else ""
        )
        return LogError(f"{self.path}: cannot be written ({error.strerror or error}){kept}")

    @abstractmethod
    def _open(self) -> None: ...

    @abstractmethod
    def _reopen(self, rows: int) -> None:
        """Open the part that is there and cut it off behind so many rows; LogError where it has fewer, or others."""

    @abstractmethod
    def _append(self, rows: Rows) -> None: ...

    @abstractmethod
    def _sync(self) -> None: ...

    @abstractmethod
    def _finish(self, provenance: Provenance) -> Path:
        """Make the whole file and say where it is: the part itself, or another one beside it."""

    @abstractmethod
    def _release(self) -> None: ...

    @abstractmethod
    def _discard(self) -> None: ...


class Opened(NamedTuple):
    """A log file that is read: where it comes from, and its rows block by block."""

    provenance: Provenance
    blocks: Generator[Rows]


class Format(NamedTuple):
    """How logs of one suffix are written and read; the readers raise LogError.

    is_log: whether an open file is a log, damaged or not; it may raise what its library does over a file of another format.
    """

    sink: type[FileSink]
    open_whole: Callable[[Path], Opened]
    open_part: Callable[[Path], Opened]
    is_log: Callable[[IO[bytes]], bool]


def part_of(path: Path) -> Path:
    """Where a log grows until it is whole."""
    return path.with_name(path.name + PART)


def demand_same(found: Provenance, wanted: Provenance, path: Path) -> None:
    """Raise LogError where a log that is to be continued tells another story than the run that goes on."""

    def story(provenance: Provenance) -> Provenance:
        return replace(provenance, kicks=(), ending=None, rows=None, command=None, engine="")

    if story(found) != story(wanted):
        raise LogError(f"{path}: is not the log of the run that goes on: its scene, version or columns are others")
