"""NPZ logs: one array per column (kind and wall as text) and the array `eventsim` with the metadata as JSON.

Columns grow as raw files in the directory NAME.npz.part (the journal) and are put together when the log is closed: the file of
the last one becomes the archive, and the others are copied behind it.  What hardly changes from row to row is deflated, in
passing, and what repeats itself only once; the rest would shrink little and take more time than the simulation.
"""

from __future__ import annotations

import io
import os
import zipfile
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, ExitStack
from pathlib import Path
from types import MappingProxyType
from typing import IO, Any

import numpy as np

from eventsim.errors import LogError, told_as
from eventsim.record.events import ROW, Column, Rows
from eventsim.record.files.archive import Deflated, Entry, Stored, write_archive
from eventsim.record.files.counting import Counting
from eventsim.record.files.journal import GROUP, METADATA, NUMBER, ROOM, WHOLE, Columns, JournalSink, open_journal
from eventsim.record.files.runs import STEADY
from eventsim.record.files.sink import Format, Opened
from eventsim.record.files.table import labels_of, rows_from_columns
from eventsim.record.provenance import Provenance, columns_kept, provenance_from_text

DEFLATED_FILE = ".deflated"


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
            entry.finish(_header(ROW[name] if labels is None else labels.dtype, self._count))
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
    with ExitStack() as opened, _told(path):
        archive = opened.enter_context(zipfile.ZipFile(path))
        if f"{METADATA}.npy" not in archive.namelist():
            raise LogError(f"{path}: not an event log: there is no array named {METADATA}")
        text = _Array(archive, METADATA, opened)
        provenance = provenance_from_text(text.read(text.count).tobytes().decode("ascii"), str(path))
        arrays = {name: _Array(archive, name, opened) for name in columns_kept(provenance)}
        if len({array.count for array in arrays.values()}) > 1:
            raise LogError(f"{path}: not an event log: its columns differ in length")
        return Opened(provenance, _blocks(opened.pop_all(), arrays, provenance, path))
    raise AssertionError("either metadata or an error")


def _blocks(
    opened: ExitStack, arrays: dict[str, _Array], provenance: Provenance, path: Path
) -> Iterator[Rows]:
    with opened, _told(path):
        for first in range(0, arrays[NUMBER].count, GROUP):
            taken = min(GROUP, arrays[NUMBER].count - first)
            yield rows_from_columns({name: array.read(taken) for name, array in arrays.items()}, provenance)


class _Array:
    """An array (count,) of an archive, read from its beginning to its end."""

    def __init__(self, archive: zipfile.ZipFile, name: str, opened: ExitStack) -> None:
        """Open it; raises ValueError where its length and that of its entry do not agree."""
        entry = archive.getinfo(f"{name}.npy")
        self._file = opened.enter_context(archive.open(entry))
        shape, _, dtype = _read_header(self._file)
        if len(shape) != 1 or dtype.hasobject or dtype.itemsize == 0:
            raise ValueError(f"{name} is no column of numbers or texts")
        if self._file.tell() + shape[0] * dtype.itemsize != entry.file_size:
            raise ValueError(f"{name} is not as long as it says")
        self.count, self._dtype = shape[0], dtype

    def read(self, count: int) -> Column:
        """The next `count` numbers or texts."""
        data = self._file.read(count * self._dtype.itemsize)
        if len(data) != count * self._dtype.itemsize:
            raise ValueError("the file was cut off")
        return np.frombuffer(data, self._dtype)


def _read_header(file: IO[bytes]) -> tuple[tuple[int, ...], bool, np.dtype[Any]]:
    version = np.lib.format.read_magic(file)
    if version == (1, 0):
        return np.lib.format.read_array_header_1_0(file)
    return np.lib.format.read_array_header_2_0(file)


def _header(dtype: np.dtype[Any], count: int) -> bytes:
    """What an .npy file begins with."""
    header = {"descr": np.lib.format.dtype_to_descr(dtype), "fortran_order": False, "shape": (count,)}
    target = io.BytesIO()
    np.lib.format.write_array_header_2_0(target, header)
    return target.getvalue()


def _told(path: Path) -> AbstractContextManager[None]:
    return told_as(LogError, path, "not a whole .npz event log")


FORMAT = Format(NpzSink, open_npz, open_journal)
