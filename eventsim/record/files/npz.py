"""NPZ logs: one array per column (kind and wall as text) and the array `eventsim` with the metadata as JSON.

Columns grow as raw files in the directory NAME.npz.part (the journal) and are put together when the log is closed: the file of
the last one becomes the archive, and the others are copied behind it.  What hardly changes from row to row is deflated, in
passing, and what repeats itself only once; the rest would shrink little and take more time than the simulation.
"""

from __future__ import annotations

import io
import os
from collections.abc import Generator, Mapping
from contextlib import ExitStack
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from eventsim.errors import LogError
from eventsim.reading import ArrayReader, Npz, reading
from eventsim.record.events import SPIN_ROW, Rows
from eventsim.record.files.archive import Deflated, Entry, Stored, write_archive
from eventsim.record.files.counting import Counting
from eventsim.record.files.journal import GROUP, METADATA, NUMBER, ROOM, WHOLE, Columns, JournalSink, open_journal
from eventsim.record.files.runs import STEADY
from eventsim.record.files.sink import Format, Opened
from eventsim.record.files.table import labels_of, rows_from_columns
from eventsim.record.provenance import Provenance, columns_kept, provenance_from_text

DEFLATED_FILE = ".deflated"
NOT_ONE = "not a whole .npz event log"


class NpzSink(JournalSink):
    """Writes NPZ."""

    _entries: Mapping[str, Entry] = MappingProxyType({})

    def _begin(self) -> None:
        self._metadata = Deflated(f"{METADATA}.npy", self.part / (METADATA + DEFLATED_FILE))
        self._length = 0
        self._entries = {name: self._entry(name) for name in self.columns}

    def _put(self, columns: Columns) -> None:
        for name, entry in self._entries.items():
            entry.write(columns[name])

    def _describe(self, text: str) -> None:
        self._metadata.write(np.frombuffer(text.encode("ascii"), np.uint8))
        self._length += len(text)

    def _complete(self) -> None:
        self._metadata.finish(_header(np.dtype(np.uint8), self._length))
        for name, entry in self._entries.items():
            labels = labels_of(name, self.provenance.wall_names)
            entry.finish(_header(SPIN_ROW[name] if labels is None else labels.dtype, self._count))
        last = self.part / self.columns[-1]
        write_archive(last, [self._metadata, *self._entries.values()])
        whole = self.part / WHOLE
        whole.unlink(missing_ok=True)
        try:
            os.link(last, whole)  # so the journal stays whole until the file has its name
        except OSError:  # there are file systems that know no second name
            last.replace(whole)

    def _stop(self) -> None:
        for entry in (self._metadata, *self._entries.values()) if self._entries else ():
            entry.close()

    def _entry(self, name: str) -> Entry:
        """What is stored as it is needs no other file than that of the journal."""
        if name == NUMBER:
            return Counting(f"{name}.npy", self.part / (name + DEFLATED_FILE))
        if name in STEADY:
            labels = labels_of(name, self.provenance.wall_names)
            return Deflated(f"{name}.npy", self.part / (name + DEFLATED_FILE), labels)
        return Stored(f"{name}.npy", self.part / name, ROOM)


def open_npz(path: Path) -> Opened:
    """The metadata of an NPZ log, and its rows in blocks, which are read side by side from all of its arrays."""
    with ExitStack() as opened:
        arrays = Npz(opened.enter_context(reading(path, LogError, NOT_ONE)))
        if METADATA not in arrays.names:
            raise LogError(f"{path}: not an event log: there is no array named {METADATA}")
        text = arrays.read(METADATA).tobytes().decode("ascii")
        provenance = provenance_from_text(text, str(path))
        readers = {name: arrays.open(name) for name in columns_kept(provenance)}
        shapes = {reader.shape for reader in readers.values()}
        if len(shapes) > 1 or len(*shapes) != 1:
            raise LogError(f"{path}: not an event log: its columns differ in length")
        return Opened(provenance, _blocks(opened.pop_all(), readers, provenance))
    raise AssertionError("either metadata or an error")


def _blocks(opened: ExitStack, readers: dict[str, ArrayReader], provenance: Provenance) -> Generator[Rows]:
    rows = readers[NUMBER].count
    with opened:
        for first in range(0, rows, GROUP):
            columns = {name: reader.read(min(GROUP, rows - first)) for name, reader in readers.items()}
            yield rows_from_columns(columns, provenance)


def _header(dtype: np.dtype[Any], count: int) -> bytes:
    """What an .npy file begins with."""
    header = {"descr": np.lib.format.dtype_to_descr(dtype), "fortran_order": False, "shape": (count,)}
    target = io.BytesIO()
    np.lib.format.write_array_header_2_0(target, header)
    return target.getvalue()


FORMAT = Format(NpzSink, open_npz, open_journal, lambda file: METADATA in Npz(file).names)
