"""Columns of a .parquet file, by pyarrow."""

from __future__ import annotations

from pathlib import Path

from eventsim.errors import EventsimError
from eventsim.readers.samples import Columns
from eventsim.reading import reading

try:
    import pyarrow.parquet as pq
except ImportError:
    raise EventsimError("parquet files need pyarrow: install eventsim-disks[parquet]") from None


def parquet_columns(path: Path) -> Columns:
    """The columns of a file by their names in small letters; EventsimError for what is no such file."""
    with reading(path, EventsimError, "is not a whole parquet file") as file:
        table = pq.read_table(file)
        return {name.lower(): table.column(name).to_numpy() for name in table.column_names}
