"""Columns of an .npz file: its arrays."""

from __future__ import annotations

from pathlib import Path

from eventsim.errors import EventsimError
from eventsim.readers.samples import Named
from eventsim.reading import Npz, reading


def npz_columns(path: Path) -> Named:
    """The arrays of a file; EventsimError for what is no such file."""
    with reading(path, EventsimError, "is not an npz file with arrays of numbers") as file:
        arrays = Npz(file)
        return [(name, arrays.read(name)) for name in arrays.names]
