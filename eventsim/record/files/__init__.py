"""Log files: which format a suffix names, and the streaming writers and readers of each.

Every format is one module with a sink and a reader; what a run writes grows as NAME.part, which can be read too.
pyarrow is imported by the parquet module alone, and only when a parquet file is written or read.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from os import PathLike
from pathlib import Path

import numpy as np

from eventsim.errors import LogError
from eventsim.record.events import Rows, blank_rows
from eventsim.record.files.journal import open_journal
from eventsim.record.files.looks import demand_looks
from eventsim.record.files.sink import PART, FileSink, Mark, demand_same, part_of
from eventsim.record.files.table import checked_log
from eventsim.record.files.text import TextForm, open_text, read_text
from eventsim.record.provenance import Provenance
from eventsim.replay.log import EventLog

SUFFIXES = (".csv", ".jsonl", ".npz", ".parquet")
TEXT_SUFFIXES = (".csv", ".jsonl")

__all__ = ["SUFFIXES", "FileSink", "Mark", "continued_sink", "open_sink", "reader_for", "rows_so_far"]


def open_sink(path: str | PathLike[str], provenance: Provenance, compact: bool = False) -> FileSink:
    """Open a streaming writer for `path`, in the format of its suffix.

    The file grows as `NAME.part` (text formats may be followed there) and gets its name when closed.
    provenance: of the rows that will come. Raises LogError for an unknown suffix or a place that cannot be
    written.
    """
    file = Path(path)
    kept = replace(provenance, compact=compact, ending=None, rows=None)
    kicks = provenance.kicks if provenance.compact else None
    return _sink_type(file)(file, kept, kicks)


def _sink_type(path: Path) -> type[FileSink]:
    match _suffix(path):
        case ".csv":
            from eventsim.record.files.csv import CsvSink

            return CsvSink
        case ".jsonl":
            from eventsim.record.files.jsonl import JsonlSink

            return JsonlSink
        case ".npz":
            from eventsim.record.files.npz import NpzSink

            return NpzSink
        case _:
            from eventsim.record.files.parquet import ParquetSink

            return ParquetSink


def continued_sink(path: Path, provenance: Provenance, compact: bool, mark: Mark) -> FileSink:
    """Open a streaming writer that goes on behind the first rows of a log, those up to `mark`.

    They are in `NAME.part`, where a run was killed, else in the whole log, which keeps its name until the longer one is whole.
    provenance: of the run that goes on.  Raises LogError where neither has these rows.
    """
    if mark.rows == 0:
        return open_sink(path, provenance, compact)
    part = part_of(path)
    kept = replace(provenance, compact=compact)
    reasons = []
    if part.exists():
        try:
            return _sink_type(path)(path, kept, None, mark)
        except LogError as error:
            reasons.append(str(error))
    if path.exists():
        log = reader_for(path)(path)
        demand_same(log.provenance, kept, path)
        if len(log) >= mark.rows:
            sink = open_sink(path, provenance, compact)
            sink.copy(log.rows[: mark.rows], mark.kicks)
            return sink
        reasons.append(f"{path}: holds {len(log)} rows of {mark.rows}")
    if not reasons:
        reasons.append(f"{path}: there is neither this log nor {part.name}")
    raise LogError(f"the log of {mark.rows} rows cannot be continued: {'; '.join(reasons)}")


def rows_so_far(sink: FileSink) -> Iterator[Rows]:
    """The full rows that a writer has written, in blocks; those of a compact log all at once."""
    part = sink.part
    provenance, blocks = _opened_part(part)
    if not provenance.compact:
        yield from blocks
        return
    rows = np.concatenate([blank_rows(0), *blocks])
    yield EventLog(replace(provenance, kicks=sink.sync().kicks), rows).expand().rows


def reader_for(path: Path) -> Callable[[Path], EventLog]:
    """Return the reader for a log file; `NAME.part`, a log that grows or was cut short, is read by the format of NAME."""
    growing = path.suffix == PART
    suffix = _suffix(Path(path.stem) if growing else path)
    if not path.exists():
        written = part_of(path)
        hint = f"; {written} is there, what a run has written so far" if written.exists() else ""
        raise LogError(f"{path}: no such file{hint}")
    if growing:
        return _read_part
    if not path.is_file():
        raise LogError(f"{path}: not a file")
    demand_looks(path, suffix)
    match suffix:
        case ".npz":
            from eventsim.record.files.npz import read_npz

            return read_npz
        case ".parquet":
            from eventsim.record.files.parquet import read_parquet

            return read_parquet
        case _:
            form = _text_form(suffix)
            return lambda file: read_text(file, form)


def _read_part(part: Path) -> EventLog:
    """A log that grows, up to its last whole row."""
    provenance, blocks = _opened_part(part)
    return checked_log(provenance, np.concatenate([blank_rows(0), *blocks]), part)


def _opened_part(part: Path) -> tuple[Provenance, Iterator[Rows]]:
    """The metadata and the rows of a log that grows."""
    suffix = _suffix(Path(part.stem))
    if suffix in TEXT_SUFFIXES:
        if not part.is_file():
            raise LogError(f"{part}: not a file")
        return open_text(part, _text_form(suffix))
    return open_journal(part)


def _text_form(suffix: str) -> TextForm:
    if suffix == ".csv":
        from eventsim.record.files.csv import FORM

        return FORM
    from eventsim.record.files.jsonl import FORM

    return FORM


def _suffix(path: Path) -> str:
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        known = ", ".join(SUFFIXES)
        if not path.suffix:
            raise LogError(f"{path}: this name has no suffix, and that of a log ends in one of {known}")
        raise LogError(f"{path}: the suffix {path.suffix!r} names no log format; use one of {known}")
    return suffix
