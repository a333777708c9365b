"""CSV logs: a `# ` line with the scene and metadata as JSON, a header row, then one row per line.

`pandas.read_csv(path, comment="#")` reads them.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from importlib.util import find_spec

from eventsim.record.events import FIELDS, SPIN_ROW, Rows
from eventsim.record.files.sink import Format
from eventsim.record.files.table import labels_of, rows_from_columns
from eventsim.record.files.text import TextForm, TextSink, text_format, words_of
from eventsim.record.provenance import Provenance, columns_kept

PREFIX = "# "

MANY_LINES = 10_000
"""From so many on, loading pyarrow takes less time than it saves: it reads numbers six times as fast as Python."""


class CsvSink(TextSink):
    """Writes CSV; missing is empty."""

    prefix = PREFIX

    def header(self) -> str:
        """Return the names of the columns."""
        return _header(self.provenance)

    def lines(self, rows: Rows) -> str:
        """Return one line per row."""
        columns = []
        for name in self.columns:
            labels = labels_of(name, self.provenance.wall_names)
            if labels is None:
                columns.append(words_of(rows[name], missing=""))
            else:
                texts = [_quoted(label) for label in labels.tolist()]
                columns.append([texts[code] for code in rows[name].tolist()])
        return "\n".join(map(",".join, zip(*columns, strict=True))) + "\n"


def _header(provenance: Provenance) -> str:
    return ",".join(columns_kept(provenance)) + "\n"


def _quoted(label: str) -> str:
    """Quote a name that would be taken apart, or for a comment."""
    if any(mark in label for mark in ',"#'):
        return '"' + label.replace('"', '""') + '"'
    return label


def _parse(lines: list[bytes], provenance: Provenance) -> Rows:
    names = columns_kept(provenance)
    if len(lines) >= MANY_LINES and find_spec("pyarrow") is not None:
        from eventsim.record.files.parquet import columns_of_csv

        columns = columns_of_csv(b"".join(lines), names)
        if columns is not None and len(columns[names[0]]) == len(lines):
            return rows_from_columns(columns, provenance)
    return rows_from_columns(_columns([line.decode("utf-8") for line in lines], names), provenance)


def _columns(lines: list[str], names: tuple[str, ...]) -> dict[str, Sequence[object]]:
    """The values of lines by columns; ValueError for what is no value of its column."""
    try:
        records = list(csv.reader(lines, strict=True))
    except csv.Error as error:
        raise ValueError(str(error)) from None
    columns: dict[str, Sequence[object]] = {}
    if any(len(record) != len(names) for record in records):
        raise ValueError(f"{len(names)} values were expected")
    for name, words in zip(names, zip(*records, strict=True), strict=True):
        if FIELDS[name].labelled:
            columns[name] = words
        elif SPIN_ROW[name].kind == "f":
            columns[name] = [float(word) if word else math.nan for word in words]
        else:
            columns[name] = list(map(int, words))
    return columns


FORMAT: Format = text_format(CsvSink, TextForm(PREFIX, _header, _parse))
