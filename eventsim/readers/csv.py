"""Columns of a .csv file: a header, then rows; lines that begin with # are comments.

Values are separated by commas; by semicolons or tabs where the header has these and no comma.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from eventsim.errors import EventsimError
from eventsim.readers.samples import Named
from eventsim.reading import reading


def csv_columns(path: Path) -> Named:
    """The columns of a file as texts (object arrays: a long one takes no more room); EventsimError for what is no such table."""
    with reading(path, EventsimError, "is not a table of comma-separated values") as file:
        text = file.read().decode("utf-8-sig")
        lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
        between = next((mark for mark in ",;\t" if mark in lines[0]), ",") if lines else ","
        rows = list(csv.reader(lines, delimiter=between))
    if not rows:
        raise EventsimError(f"{path}: has no header")
    header = rows[0]
    for number, row in enumerate(rows[1:]):
        if len(row) != len(header):
            raise EventsimError(f"{path}: row {number} has {len(row)} values under {len(header)} names")
    return [(name, np.array([row[place].strip() for row in rows[1:]], dtype=object)) for place, name in enumerate(header)]
