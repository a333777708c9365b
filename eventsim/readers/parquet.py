"""Columns of a .parquet file, by pyarrow."""

from __future__ import annotations

from pathlib import Path

from eventsim.errors import EventsimError
from eventsim.readers.samples import Named
from eventsim.reading import MOST_HELD, reading

try:
    import pyarrow.parquet as pq
except ImportError:
    raise EventsimError("parquet files need pyarrow: install eventsim-disks[parquet]") from None


def parquet_columns(path: Path) -> Named:
    """The columns of a file; EventsimError for what is no such file."""
    with reading(path, EventsimError, "is not a whole parquet file") as file:
        found = pq.ParquetFile(file)
        if (size := sum(found.metadata.row_group(k).total_byte_size for k in range(found.num_row_groups))) > MOST_HELD:
            raise ValueError(f"its columns have {size} bytes; at most {MOST_HELD} are read")
        table = found.read()
        return [(name, table.column(name).to_numpy()) for name in table.column_names]
