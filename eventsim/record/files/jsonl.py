"""JSON lines: the first line holds the scene and metadata, each further line one row as an object."""

from __future__ import annotations

import json

import numpy as np

from eventsim.record.events import Rows
from eventsim.record.files.sink import Format
from eventsim.record.files.table import labels_of, rows_from_columns
from eventsim.record.files.text import TextForm, TextSink, text_format, words_of
from eventsim.record.provenance import Provenance, columns_kept


class JsonlSink(TextSink):
    """Writes JSON lines; missing is null."""

    def header(self) -> str:
        """Return nothing: rows follow the metadata at once."""
        return ""

    def lines(self, rows: Rows) -> str:
        """Return one object per row."""
        columns = []
        for name in self.columns:
            labels = labels_of(name, self.provenance.wall_names)
            if labels is None:
                words = words_of(rows[name], missing="null")
                if np.isinf(rows[name]).any():
                    words = [word.replace("inf", "Infinity") for word in words]
                columns.append(words)
            else:
                texts = [json.dumps(label) for label in labels.tolist()]
                columns.append([texts[code] for code in rows[name].tolist()])
        template = "{" + ", ".join(f'"{name}": %s' for name in self.columns) + "}"
        return "\n".join(map(template.__mod__, zip(*columns, strict=True))) + "\n"


def _parse(lines: list[bytes], provenance: Provenance) -> Rows:
    records = json.loads(b"[%b]" % b",".join(lines))
    if len(records) != len(lines) or not all(isinstance(record, dict) for record in records):
        raise ValueError("one object was expected")
    try:
        columns = {name: [record[name] for record in records] for name in columns_kept(provenance)}
    except KeyError as error:
        raise ValueError(f"the key {error} is missing") from None
    return rows_from_columns(columns, provenance)


FORMAT: Format = text_format(JsonlSink, TextForm("", lambda provenance: "", _parse))
