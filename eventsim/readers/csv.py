"""Columns of a .csv file: a header, then rows; lines that begin with # are comments, and the last of them may be the header.

Values are separated by commas; by semicolons or tabs where the header has these and no comma.
"""

from __future__ import annotations

import csv
import re
from pathlib import Path

import numpy as np

from eventsim.errors import EventsimError
from eventsim.readers.samples import Named
from eventsim.reading import reading


def csv_columns(path: Path) -> Named:
    """The columns of a file as texts (object arrays: a long one takes no more room); EventsimError for what is no such table."""
    with reading(path, EventsimError, "is not a table of comma-separated values") as file:
        text = [line for line in file.read().decode("utf-8-sig").splitlines() if line.strip()]
        lines = [line for line in text if not line.startswith("#")]
        if lines and _is_number(lines[0]):
            above = [line[1:] for line in text[: text.index(lines[0])]]
            lines[:0] = above[-1:]
        between = next((mark for mark in ",;\t" if mark in lines[0]), ",") if lines else ","
        rows = list(csv.reader(lines, delimiter=between))
    if not rows:
        raise EventsimError(f"{path}: has no header")
    header = [name.strip() for name in rows[0]]
    if _is_number(header[0]):
        raise EventsimError(f"{path}: has no header line: its first line must name the columns, as time,x0,y0,x1,y1 or time,a,b")
    for number, row in enumerate(rows[1:]):
        if len(row) != len(header):
            raise EventsimError(f"{path}: row {number} has {len(row)} values under {len(header)} names")
    return [(name, np.array([row[place].strip() for row in rows[1:]], dtype=object)) for place, name in enumerate(header)]


def _is_number(line: str) -> bool:
    """Whether a line begins with a number: rows do, names do not."""
    try:
        float(re.split("[,;\t]", line)[0])
    except ValueError:
        return False
    return True
