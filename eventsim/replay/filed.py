"""Logs that stay in their file: gone through block by block as often as somebody asks, and never held as a whole."""

from __future__ import annotations

from collections.abc import Generator
from os import PathLike
from pathlib import Path

from eventsim.record.events import Rows, unchangeable
from eventsim.record.files import open_log
from eventsim.record.provenance import Provenance
from eventsim.replay.log import AnyLog, EventLog, stream_log
from eventsim.scene import Scene

MOST_HELD = 1_000_000
"""Rows up to which those of a file are held (128 MB) once they have been read: the way through them again is short then."""


class FiledLog:
    """A full log in its file, of any length.  Whoever changes the file meanwhile gets a LogError or what it then says."""

    def __init__(self, path: Path, provenance: Provenance) -> None:
        """provenance: what the file says of itself."""
        self.path: Path | None = path
        self.provenance = provenance
        self._file = path
        self._rows = provenance.rows
        self._verified = False
        self._held: list[Rows] | None = None

    def __len__(self) -> int:
        if self._rows is None:
            self._rows = sum(map(len, self.blocks()))
        return self._rows

    @property
    def scene(self) -> Scene:
        """The realised scene that the log tells about."""
        return self.provenance.scene

    def blocks(self) -> Generator[Rows]:
        """Yield the rows block by block; the first time, warn (LogWarning) where they are not those of the run."""
        if self._held is not None:
            yield from self._held
            return
        held: list[Rows] | None = None if (self._rows or 0) > MOST_HELD else []
        count = 0
        for rows in stream_log(self._file, verify=not self._verified)[1]:
            count += len(rows)
            held = None if held is None or count > MOST_HELD else [*held, rows]
            yield unchangeable(rows)
        self._held, self._verified, self._rows = held, True, count


def open_filed(path: str | PathLike[str]) -> AnyLog:
    """Return the log in a file as it lies there; a compact one is read.

    Raises LogError with a sentence where it is no log.
    """
    file = Path(path)
    provenance, blocks = open_log(file)
    blocks.close()
    return EventLog.loaded(file) if provenance.compact else FiledLog(file, provenance)
