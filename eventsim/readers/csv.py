"""Columns of a .csv file: a header, then rows; lines that begin with # are comments.

Values are separated by commas; by semicolons or tabs where the header has these and no comma.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from eventsim.errors import EventsimError
from eventsim.readers.samples import Columns
from eventsim.reading import reading


def csv_columns(path: Path) -> Columns:
    """The columns of a file as texts, by their names in small letters; EventsimError for what is no such table."""
    with reading(path, EventsimError, "is not a table of comma-separated values") as file:
        text = file.read().decode("utf-8-sig")
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    if not lines:
        raise EventsimError(f"{path}: has no header")
    between = next((mark for mark in ",;\t" if mark in lines[0]), ",")
    rows = list(csv.reader(lines, delimiter=between))
    header = [name.strip().lower() for name in rows[0]]
    if len(set(header)) < len(header):
        raise EventsimError(f"{path}: has more than one column {next(name for name in header if header.count(name) > 1)}")
    for number, row in enumerate(rows[1:]):
        if len(row) != len(header):
            raise EventsimError(f"{path}: row {number} has {len(row)} values under {len(header)} names")
    table = np.array(rows[1:], dtype=np.str_).reshape(-1, len(header))
    return {name: np.char.strip(table[:, place]) for place, name in enumerate(header)}
