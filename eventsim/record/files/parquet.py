"""Parquet logs, by pyarrow: row groups of one length, the metadata as JSON under the key `eventsim`."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import ExitStack
from pathlib import Path
from typing import IO, Any

import numpy as np

from eventsim.errors import LogError
from eventsim.reading import reading
from eventsim.record.events import FIELDS, SPIN_ROW, Column, Rows
from eventsim.record.files.journal import METADATA, WHOLE, Columns, JournalSink, open_journal
from eventsim.record.files.sink import Format, Opened
from eventsim.record.files.table import labels_of, rows_from_columns
from eventsim.record.provenance import Provenance, columns_kept, provenance_from_text

try:
    import pyarrow as pa
    import pyarrow.parquet as pq
    from pyarrow import csv
except ImportError:
    raise LogError("parquet logs need pyarrow: install eventsim-disks[parquet]") from None

TEXTS = tuple(name for name, field in FIELDS.items() if field.labelled)
NULLABLE = frozenset(name for name, field in FIELDS.items() if SPIN_ROW[name].kind == "f" and field.missing is not None)
NOT_ONE = "not a whole parquet event log"

GROUP = 1 << 15
"""Rows in a group, which are held at a time: more would push what the engine needs out of the caches that cores share."""

LEAN: dict[str, Any] = {"use_dictionary": list(TEXTS), "write_statistics": False, "compression": "none"}
"""How columns are written: whole numbers as small differences, floats as they are.  Statistics, dictionaries of numbers and
compression would take longer than the simulation, and gain less."""


class ParquetSink(JournalSink):
    """Writes parquet; kind and wall are dictionaries of text, missing is null."""

    _writer: Any = None

    def _begin(self) -> None:
        whole = {name: "DELTA_BINARY_PACKED" for name in self.columns if name not in TEXTS and SPIN_ROW[name].kind == "i"}
        schema = _schema(self.columns)
        self._writer = pq.ParquetWriter(self.part / WHOLE, schema, store_schema=False, column_encoding=whole, **LEAN)
        self._metadata: list[str] = []
        self._group: Columns = {name: np.empty(GROUP, SPIN_ROW[name]) for name in self.columns}
        self._filled = 0

    def _put(self, columns: Columns) -> None:
        count, taken = len(columns["event"]), 0
        while taken < count:
            taking = min(count - taken, GROUP - self._filled)
            for name, column in self._group.items():
                column[self._filled : self._filled + taking] = columns[name][taken : taken + taking]
            self._filled, taken = self._filled + taking, taken + taking
            if self._filled == GROUP:
                self._write_group()

    def _describe(self, text: str) -> None:
        self._metadata.append(text)

    def _complete(self) -> None:
        if self._filled:
            self._write_group()
        self._writer.add_key_value_metadata({METADATA: "".join(self._metadata)})
        self._stop()

    def _write_group(self) -> None:
        arrays = [_array(column[: self._filled], name, self.provenance) for name, column in self._group.items()]
        self._writer.write_table(pa.Table.from_arrays(arrays, schema=_schema(self.columns)))
        self._filled = 0

    def _stop(self) -> None:
        writer, self._writer = self._writer, None
        if writer is not None:
            writer.close()


def write_plain_table(path: Path, columns: dict[str, list[Any]], metadata: dict[str, str]) -> None:
    """Write a table that is no log; None is null.  A column of mixed types becomes text."""
    arrays = {}
    for name, values in columns.items():
        try:
            arrays[name] = pa.array(values)
        except (pa.ArrowInvalid, pa.ArrowTypeError):
            arrays[name] = pa.array([None if value is None else str(value) for value in values])
    pq.write_table(pa.table(arrays).replace_schema_metadata(metadata), path)


def open_parquet(path: Path) -> Opened:
    """The metadata of a parquet log, and its rows in blocks, one group after the other."""
    with ExitStack() as opened:
        file = pq.ParquetFile(opened.enter_context(reading(path, LogError, NOT_ONE)))
        text = (file.metadata.metadata or {}).get(METADATA.encode())
        if text is None:
            raise LogError(f"{path}: not an event log: its metadata have no key {METADATA}")
        provenance = provenance_from_text(text.decode(), str(path))
        return Opened(provenance, _blocks(opened.pop_all(), file, provenance))
    raise AssertionError("either metadata or an error")


def _blocks(opened: ExitStack, file: Any, provenance: Provenance) -> Generator[Rows]:
    names = columns_kept(provenance)
    with opened:
        for number in range(file.num_row_groups):  # batches of the library take three times as much memory
            group = file.read_row_group(number, columns=list(names))
            yield rows_from_columns({name: _column(group.column(name)) for name in names}, provenance)


def columns_of_csv(text: bytes, names: tuple[str, ...]) -> dict[str, Column] | None:
    """The columns of lines of CSV without quotation marks, where empty is missing; None for what is not plainly such."""
    if b'"' in text:
        return None
    kinds = {name: pa.string() if name in TEXTS else pa.from_numpy_dtype(SPIN_ROW[name]) for name in names}
    read = csv.ReadOptions(column_names=list(names))
    options = csv.ConvertOptions(column_types=kinds, null_values=[""], strings_can_be_null=False)
    try:
        table = csv.read_csv(pa.py_buffer(text), read, csv.ParseOptions(quote_char=False), options)
    except pa.ArrowInvalid:
        return None
    if any(table.column(name).null_count for name in names if SPIN_ROW[name].kind == "i" and name not in TEXTS):
        return None
    return {name: _column(table.column(name)) for name in names}


def _schema(names: tuple[str, ...]) -> Any:
    """The columns of a file; only floats can be null, and what cannot be is written faster."""
    text = pa.dictionary(pa.int32(), pa.string())
    kinds = {name: text if name in TEXTS else pa.from_numpy_dtype(SPIN_ROW[name]) for name in names}
    return pa.schema([pa.field(name, kind, nullable=name in NULLABLE) for name, kind in kinds.items()])


def _array(values: Column, name: str, provenance: Provenance) -> Any:
    """A column as pyarrow has it, the same memory.  `pa.array` would look whether it is one of pandas, and load all of that."""
    labels = labels_of(name, provenance.wall_names)
    if labels is None:
        return _numbers(values)
    codes = np.where(values < 0, np.int32(len(labels) - 1), values.astype(np.int32))  # -1 is the last label
    texts = [text.encode() for text in labels.tolist()]
    ends = np.cumsum([0, *map(len, texts)], dtype=np.int32)
    dictionary = pa.StringArray.from_buffers(len(texts), pa.py_buffer(ends), pa.py_buffer(b"".join(texts)))
    return pa.DictionaryArray.from_arrays(_numbers(codes), dictionary)


def _numbers(values: Column) -> Any:
    """Numbers (n,), NaN as null."""
    there = ~np.isnan(values) if values.dtype.kind == "f" else None
    known = None if there is None or there.all() else pa.py_buffer(np.packbits(there, bitorder="little"))
    return pa.Array.from_buffers(pa.from_numpy_dtype(values.dtype), len(values), [known, pa.py_buffer(values)])


def _column(column: Any) -> Column:
    values: Column = column.to_numpy()
    return values


def is_parquet_log(file: IO[bytes]) -> bool:
    """Whether an open file is a log."""
    return METADATA.encode() in (pq.read_metadata(file).metadata or {})


FORMAT = Format(ParquetSink, open_parquet, open_journal, is_parquet_log)
