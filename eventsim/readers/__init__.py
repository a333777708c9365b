"""What other programs wrote: where disks are at times, and which contacts an engine tells of.

    samples    what all readers give: positions at times
    columns    tables of named columns, one row for each disk and time, or one for each time
    csv, npz, parquet   give such columns
    xyz, gsd   formats of molecular dynamics
    contacts   who met whom, when
"""

from __future__ import annotations

from pathlib import Path

from eventsim import suffixes
from eventsim.errors import EventsimError
from eventsim.readers.columns import samples_of
from eventsim.readers.csv import csv_columns
from eventsim.readers.npz import npz_columns
from eventsim.readers.samples import Columns, Samples

TABLES = {".csv": csv_columns, ".npz": npz_columns}


def read_columns(path: Path) -> Columns:
    """The columns of a .csv, .npz or .parquet file by their names, in small letters.

    Raises:
        EventsimError: naming the file, for what cannot be read.
    """
    suffix = path.suffix.lower()
    if suffix == ".parquet":
        from eventsim.readers.parquet import parquet_columns

        return parquet_columns(path)
    if suffix not in TABLES:
        raise EventsimError(f"{path}: a table ends in {', '.join(suffixes.READ_TABLES)}")
    return TABLES[suffix](path)


def read_samples(path: Path, dt: float | None = None) -> Samples:
    """Where all disks are at the times of a file.

    Args:
        path: a file that ends in .csv, .npz, .parquet, .xyz or .gsd.
        dt: the time between two frames, for a file that tells no times.

    Raises:
        EventsimError: naming the file, for what cannot be read or is not the same disks at each time.
    """
    suffix = path.suffix.lower()
    if suffix == ".xyz":
        from eventsim.readers.xyz import read_xyz

        return read_xyz(path, dt)
    if suffix == ".gsd":
        from eventsim.readers.gsd import read_gsd

        return read_gsd(path, dt)
    if suffix not in suffixes.READ_TABLES:
        raise EventsimError(f"{path}: positions at times are read from {', '.join(suffixes.TRAJECTORIES)}")
    return samples_of(read_columns(path), str(path), dt)
