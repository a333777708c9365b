"""What those ask of a log who look at its rows, wherever these are."""

from __future__ import annotations

from collections.abc import Generator
from pathlib import Path
from typing import Protocol

from eventsim.record.events import Rows
from eventsim.record.provenance import Provenance
from eventsim.scene import Scene


class AnyLog(Protocol):
    """A log whose rows can be gone through any number of times: in memory, or in a file.

    path: the file, None where it comes from a run.
    """

    path: Path | None
    provenance: Provenance

    def __len__(self) -> int: ...

    @property
    def scene(self) -> Scene:
        """The realised scene that the log tells about."""

    def blocks(self) -> Generator[Rows]:
        """Yield the full rows block by block."""


class LogInMemory(AnyLog, Protocol):
    """A log whose rows are at hand."""

    rows: Rows

    def expand(self) -> LogInMemory:
        """Return the full log."""
