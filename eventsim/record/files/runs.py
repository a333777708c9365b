"""Columns that hardly change from row to row, kept as runs: so many rows with the same values, in a file that grows."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from eventsim.record.events import FIELDS, ROW, Column, Rows

STEADY = tuple(name for name, field in FIELDS.items() if field.steady)
RUN = np.dtype([("end", "<i8"), *((name, ROW[name]) for name in STEADY)])
"""end: how many rows of the log there are up to the end of the run."""


def runs_of(columns: dict[str, Column], first: int) -> Rows:
    """The runs of a block of rows, an array of RUN; first: how many rows there are before it."""
    is_last = np.zeros(len(columns[STEADY[0]]), np.bool_)
    is_last[-1:] = True
    for name in STEADY:
        is_last[:-1] |= columns[name][1:] != columns[name][:-1]
    last = np.flatnonzero(is_last)
    runs = np.empty(len(last), RUN)
    runs["end"] = first + last + 1
    for name in STEADY:
        runs[name] = columns[name][last]
    return runs


def rows_in_runs(path: Path) -> int:
    """How many rows the runs of a file tell of."""
    runs = _runs(path)
    return int(runs["end"][-1]) if len(runs) else 0


def cut_runs(path: Path, rows: int) -> None:
    """Leave only the runs of the first `rows` rows, which there are."""
    runs = _runs(path)
    whole = int(np.searchsorted(runs["end"], rows))
    cut = np.array(runs[whole : whole + 1] if rows else runs[:0])
    cut["end"] = rows
    del runs  # there are systems that cut no file that is looked at
    os.truncate(path, whole * RUN.itemsize)
    with path.open("ab") as file:
        file.write(cut.tobytes())


def columns_of_runs(path: Path, first: int, count: int) -> dict[str, Column]:
    """The columns of `count` > 0 rows from row `first` on, which there are."""
    runs = _runs(path)
    ends = runs["end"]
    begin, end = np.searchsorted(ends, first, side="right"), np.searchsorted(ends, first + count)
    met = np.array(runs[begin : end + 1])
    lengths = np.diff(np.minimum(met["end"], first + count), prepend=first)
    return {name: np.repeat(met[name], lengths) for name in STEADY}


def _runs(path: Path) -> Rows:
    """The whole runs of a file, looked at where they are: only what is needed of them is read."""
    count = path.stat().st_size // RUN.itemsize
    return np.memmap(path, RUN, "r", shape=(count,)) if count else np.empty(0, RUN)
