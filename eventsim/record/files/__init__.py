"""Log files: the format that a suffix names, its streaming writer and its readers.

A format is a module with a sink and two readers, of a whole log and of one that grows as NAME.part.  They give the provenance
and blocks of rows; a log is made of these in `replay.log`.  pyarrow is imported only when a parquet file is written or read.
"""

from __future__ import annotations

from dataclasses import replace
from os import PathLike
from pathlib import Path

from eventsim import suffixes
from eventsim.errors import LogError
from eventsim.reading import near_file, reading, told_as
from eventsim.record.events import Rows, joined
from eventsim.record.files import csv, jsonl, npz
from eventsim.record.files.atomic import demand_place
from eventsim.record.files.sink import FileSink, Format, Mark, Opened, demand_same, part_of
from eventsim.record.files.table import checked, verified
from eventsim.record.provenance import Provenance, has_spin
from eventsim.suffixes import PART

MAGIC = {".csv": b"# {", ".jsonl": b'{"', ".npz": b"PK", ".parquet": b"PAR1"}
"""What the files of a format begin with."""

BINARY = (".npz", ".parquet")
BYTE_ORDER_MARK = b"\xef\xbb\xbf"

__all__ = ["FileSink", "Mark", "continued_sink", "open_log", "open_sink", "read_log"]


def open_sink(path: str | PathLike[str], provenance: Provenance, compact: bool = False) -> FileSink:
    """Open a streaming writer in the format of a file's suffix.

    The file grows as `NAME.part` (text formats may be followed there) and gets its name when closed.  A log that has it is
    replaced then.

    Args:
        path: of the file.
        provenance: of the rows that will come.
        compact: leave out what replay computes.

    Raises:
        LogError: for an unknown suffix, a place that cannot be written, or a file there that is no log.
    """
    file = Path(path)
    demand_replaceable(file)
    kept = replace(provenance, compact=compact, ending=None, rows=None)
    kicks = provenance.kicks if provenance.compact else None
    return _format_of(file).sink(file, kept, kicks)


def demand_replaceable(path: Path) -> None:
    """Raise LogError where a file has this name that is no log: what others wrote is not replaced.  An empty one may be."""
    form = _format_of(path)
    demand_place(path, LogError)
    if not path.is_file() or not path.stat().st_size:
        return
    try:
        with reading(path, LogError, "no event log") as file:
            found = form.is_log(file)
    except LogError:
        found = False
    if not found:
        raise LogError(f"{path}: holds no event log that a new one may replace; name another file, or remove this one")


def continued_sink(path: Path, provenance: Provenance, compact: bool, mark: Mark) -> FileSink:
    """Open a streaming writer that goes on behind the first rows of a log, those up to `mark`.

    They are in `NAME.part`, where a run was killed, else in the whole log, which keeps its name until the longer one is whole.
    Where no row had come, what stands there must still be the log of that run: another one is not replaced.

    Args:
        path: of the log.
        provenance: of the run that goes on.
        compact: whether the log is a compact one.
        mark: how far it had come.

    Raises:
        LogError: where neither file has these rows.
    """
    part = part_of(path)
    kept = replace(provenance, compact=compact)
    if mark.rows == 0:
        for file in (part, path):
            if file.exists():
                found, blocks = open_log(file)
                blocks.close()
                demand_same(found, kept, file)
                break
        return open_sink(path, provenance, compact)
    reasons = []
    if part.exists():
        try:
            sink = _format_of(path).sink(path, kept, None, mark)
            for rows in open_log(part, verify=False).blocks:
                sink.remember(rows)
            return sink
        except LogError as error:
            reasons.append(str(error))
    if path.exists():
        found, rows = read_log(path)
        demand_same(found, kept, path)
        if len(rows) >= mark.rows:
            sink = open_sink(path, provenance, compact)
            sink.copy(rows[: mark.rows], mark.kicks)
            return sink
        reasons.append(f"{path}: holds {len(rows)} rows of {mark.rows}")
    if not reasons:
        reasons.append(f"{path}: there is neither this log nor {part.name}")
    raise LogError(f"the log of {mark.rows} rows cannot be continued: {'; '.join(reasons)}")


def open_log(path: Path, verify: bool = True) -> Opened:
    """Return the provenance of a log file and its rows block by block, each checked as it comes.

    `NAME.part`, a log that grows or was cut short, is read by the format of NAME, up to its last whole row.

    Warns (LogWarning) after the last block where rows are not as the run stored them; verify: False where that is known.

    Raises:
        LogError: with a sentence where the file is no log; also while its blocks are read.
    """
    growing = path.suffix == PART
    form = _format_of(Path(path.stem) if growing else path)
    with told_as(path, LogError, "not a name of a file"):
        if not path.exists():
            written = part_of(path)
            hint = f"; {written} is there, what a run has written so far" if written.exists() else near_file(path)
            raise LogError(f"{path}: no such file{hint}")
        if not growing:
            if not path.is_file():
                raise LogError(f"{path}: not a file")
            _demand_magic(path)
    provenance, blocks = (form.open_part if growing else form.open_whole)(path)
    sound = checked(provenance, blocks, path)
    return Opened(provenance, verified(provenance, sound, path) if verify else sound)


def read_log(path: Path, verify: bool = True) -> tuple[Provenance, Rows]:
    """Return the provenance and all rows of a log file; raises LogError and warns as `open_log` does."""
    provenance, blocks = open_log(path, verify)
    return provenance, joined(list(blocks), has_spin(provenance.scene))


def _format_of(path: Path) -> Format:
    """The format of a suffix; LogError for one that names none."""
    match path.suffix.lower():
        case ".csv":
            return csv.FORMAT
        case ".jsonl":
            return jsonl.FORMAT
        case ".npz":
            return npz.FORMAT
        case ".parquet":
            from eventsim.record.files import parquet

            return parquet.FORMAT
        case "":
            raise LogError(f"{path}: this name has no suffix, and that of a log ends in one of {', '.join(suffixes.LOGS)}")
        case suffix if suffix in suffixes.SCENES:
            raise LogError(f"{path} is a scene; eventsim run {path} --log {path.with_suffix('.csv')} writes its log")
        case _:
            known = ", ".join(suffixes.LOGS)
            raise LogError(f"{path}: the suffix {path.suffix!r} names no log format; use one of {known}")


def _demand_magic(path: Path) -> None:
    """Tell a wrong suffix as such, not as damage: LogError where a file begins like a log of another format.

    A binary one has to begin like its own.
    """
    suffix = path.suffix.lower()
    try:
        with path.open("rb") as file:
            head = file.read(8).removeprefix(BYTE_ORDER_MARK)
    except OSError as error:
        raise LogError(f"{path}: cannot be read ({error.strerror or error})") from None
    found = next((form for form, magic in MAGIC.items() if head.startswith(magic)), None)
    if found != suffix and (found is not None or suffix in BINARY):
        hint = "" if found is None else f"; it looks like a {found} file, so give it that suffix"
        raise LogError(f"{path}: not a {suffix} file{hint}")
