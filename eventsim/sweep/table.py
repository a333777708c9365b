"""The table of a sweep: one row a run, as CSV or Parquet, with where it comes from."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path

from eventsim import suffixes
from eventsim.errors import EventsimError
from eventsim.reading import reading
from eventsim.record.files.atomic import atomic_write, demand_place
from eventsim.sweep.task import Cell, Row

FORMAT = 1


def check_suffix(path: Path) -> Path:
    """The path of a table; EventsimError where it is none that can be written."""
    if path.suffix.lower() not in suffixes.TABLES:
        raise EventsimError(f"{path}: a table is written as {' or '.join(suffixes.TABLES)}")
    demand_place(path)
    if not path.parent.is_dir():
        raise EventsimError(f"{path}: there is no directory {path.parent}")
    return path


def columns_of(rows: Sequence[Row]) -> list[str]:
    """All columns, in the order in which the rows bring them."""
    return list(dict.fromkeys(key for row in rows for key in row))


def write_table(path: Path, rows: Sequence[Row], provenance: Mapping[str, object]) -> None:
    """Write rows to .csv (missing: empty; a first line that begins with "# " carries the provenance) or .parquet."""
    text = json.dumps(provenance)
    with atomic_write(path) as part:
        if path.suffix.lower() == ".csv":
            with part.open("w", newline="", encoding="utf-8") as file:
                file.write(f"# {text}\n")
                writer = csv.DictWriter(file, columns_of(rows), restval="", lineterminator="\n")
                writer.writeheader()
                writer.writerows({key: _text(value) for key, value in row.items()} for row in rows)
        else:
            from eventsim.record.files.parquet import write_plain_table

            columns = {key: [_missing(row.get(key)) for row in rows] for key in columns_of(rows)}
            write_plain_table(part, columns, {"eventsim_sweep": text})


def load_table(path: str | Path) -> list[Row]:
    """The rows of a table that was written as .csv; missing entries are None."""
    with reading(Path(path), EventsimError, "is not the table of a sweep") as file:
        lines = (line for line in io.TextIOWrapper(file, encoding="utf-8", newline="") if not line.startswith("# "))
        return [{key: _cell(text) for key, text in row.items()} for row in csv.DictReader(lines)]


def _text(value: Cell) -> str:
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    if isinstance(value, bool):
        return str(value).lower()
    return repr(value) if isinstance(value, float) else str(value)


def _missing(value: Cell) -> Cell:
    return None if isinstance(value, float) and math.isnan(value) else value


def _cell(text: str) -> Cell:
    if text == "":
        return None
    if text in ("true", "false"):
        return text == "true"
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text
