"""Log files: which format a suffix names, and the streaming writers and readers of each.

Every format is one module with a sink and a reader. pyarrow is imported by the parquet module alone, and only when
a parquet file is written or read.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from os import PathLike
from pathlib import Path

from eventsim.errors import LogError
from eventsim.record.files.looks import demand_looks
from eventsim.record.files.sink import PART, FileSink
from eventsim.record.log import EventLog
from eventsim.record.provenance import Provenance

SUFFIXES = (".csv", ".jsonl", ".npz", ".parquet")
TEXT_SUFFIXES = (".csv", ".jsonl")

__all__ = ["SUFFIXES", "FileSink", "open_sink", "reader_for"]


def open_sink(path: str | PathLike[str], provenance: Provenance, compact: bool = False) -> FileSink:
    """Open a streaming writer for `path`, in the format of its suffix.

    The file grows as `NAME.part` (text formats may be followed there) and gets its name when closed.
    provenance: of the rows that will come. Raises LogError for an unknown suffix or a place that cannot be
    written.
    """
    file = Path(path)
    kept = replace(provenance, compact=compact, ending=None, rows=None)
    kicks = provenance.kicks if provenance.compact else None
    match _suffix(file):
        case ".csv":
            from eventsim.record.files.csv import CsvSink

            return CsvSink(file, kept, kicks)
        case ".jsonl":
            from eventsim.record.files.jsonl import JsonlSink

            return JsonlSink(file, kept, kicks)
        case ".npz":
            from eventsim.record.files.npz import NpzSink

            return NpzSink(file, kept, kicks)
        case _:
            from eventsim.record.files.parquet import ParquetSink

            return ParquetSink(file, kept, kicks)


def reader_for(path: Path) -> Callable[[Path], EventLog]:
    """Return the reader for a log file; `NAME.part` of a text format is read by the format of NAME."""
    growing = path.suffix == PART
    suffix = _suffix(Path(path.stem) if growing else path)
    if growing and suffix not in TEXT_SUFFIXES:
        raise LogError(f"{path}: an unfinished {suffix} log cannot be read (.csv and .jsonl can)")
    if not path.exists():
        raise LogError(f"{path}: no such file")
    if not path.is_file():
        raise LogError(f"{path}: not a file")
    if not growing:
        demand_looks(path, suffix)
    match suffix:
        case ".csv":
            from eventsim.record.files.csv import read_csv

            return read_csv
        case ".jsonl":
            from eventsim.record.files.jsonl import read_jsonl

            return read_jsonl
        case ".npz":
            from eventsim.record.files.npz import read_npz

            return read_npz
        case _:
            from eventsim.record.files.parquet import read_parquet

            return read_parquet


def _suffix(path: Path) -> str:
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        shown = f"the suffix {path.suffix!r}" if path.suffix else "no suffix"
        raise LogError(f"{path}: {shown} names no log format; use one of {', '.join(SUFFIXES)}")
    return suffix
