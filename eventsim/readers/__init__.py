"""Readers of what other programs wrote: places of disks at times, and contacts.

    samples    what all readers give: positions at times
    columns    tables of named columns, one row for each disk and time, or one for each time
    csv, npz, parquet   give such columns
    xyz, gsd, lammps   formats of molecular dynamics
    contacts   who met whom, when
"""

from __future__ import annotations

from pathlib import Path

from eventsim import suffixes
from eventsim.errors import EventsimError
from eventsim.readers.columns import samples_of
from eventsim.readers.csv import csv_columns
from eventsim.readers.npz import npz_columns
from eventsim.readers.samples import Column, Columns, Named, Samples
from eventsim.reading import told_as

TABLES = {".csv": csv_columns, ".npz": npz_columns}
SHORT = {"t": "time", "id": "disk"}


def read_columns(path: Path) -> Columns:
    """The columns of a .csv, .npz or .parquet file by their names, in small letters and the longer one of two.

    Raises:
        EventsimError: naming the file, for what cannot be read.
    """
    suffix = path.suffix.lower()
    if suffix == ".parquet":
        from eventsim.readers.parquet import parquet_columns

        found = parquet_columns(path)
    elif suffix in TABLES:
        found = TABLES[suffix](path)
    else:
        raise EventsimError(f"{path}: a table ends in {', '.join(suffixes.READ_TABLES)}")
    return _by_name(found, str(path))


def _by_name(found: Named, source: str) -> Columns:
    columns: dict[str, Column] = {}
    for name, column in found:
        known = SHORT.get(name.strip().lower(), name.strip().lower())
        if known in columns:
            raise EventsimError(f"{source}: has more than one column {known}")
        columns[known] = column
    return columns


def samples_in(table: Named, source: str, dt: float | None = None) -> Samples:
    """Where all disks are at the times of a table in memory, as in a file; EventsimError where it does not tell that."""
    return samples_of(_by_name(table, source), source, dt)


def read_samples(path: Path, dt: float | None = None, least: int = 2) -> Samples:
    """Where all disks are at the times of a file.

    Args:
        path: a file that ends in .csv, .npz, .parquet, .xyz, .gsd, .dump or .lammpstrj.
        dt: the time between two frames, for a file that tells no times; of .gsd and dumps, that of a step.
        least: so many frames an .xyz, .gsd or dump must have.

    Raises:
        EventsimError: naming the file, for what cannot be read or is not the same disks at each time.
    """
    suffix = path.suffix.lower()
    with told_as(path, EventsimError, "does not tell positions at times"):
        if suffix == ".xyz":
            from eventsim.readers.xyz import read_xyz

            return read_xyz(path, dt, least)
        if suffix == ".gsd":
            from eventsim.readers.gsd import read_gsd

            return read_gsd(path, dt, least)
        if suffix in suffixes.DUMPS:
            from eventsim.readers.lammps import read_dump

            return read_dump(path, dt, least)
        if suffix not in suffixes.READ_TABLES:
            raise EventsimError(f"{path}: positions at times are read from {', '.join(suffixes.TRAJECTORIES)}")
        return samples_of(read_columns(path), str(path), dt)


def read_start(path: Path, frame: int | None = None) -> Samples:
    """Where all disks are at one time.

    Args:
        path: a file that ends in .xyz, .gsd, .dump, .lammpstrj, .data or .lmp.
        frame: which of its frames, from 0 on, or from -1 back; None: it must have one.

    Raises:
        EventsimError: naming the file.
    """
    if path.suffix.lower() in suffixes.LAMMPS_DATA:
        from eventsim.readers.lammps import read_data

        with told_as(path, EventsimError, "is no whole data file"):
            samples = read_data(path)
    else:
        samples = read_samples(path, 1.0, 1)
    count = len(samples.times)
    if frame is None and count > 1:
        raise EventsimError(f"{path}: holds {count} frames; one start needs one: say frame = 0, or -1 for the last")
    if frame is not None and not -count <= frame < count:
        raise EventsimError(f"{path}: frame = {frame}: must be from {-count} to {count - 1}, for {count} frames")
    return samples.at(0 if frame is None else frame)
