"""NPZ logs: one array per column (kind and wall as text) and the array `eventsim` with the metadata as JSON.

Columns grow as raw files in the directory NAME.npz.part (the journal) and are put together when the log is closed: the file of
the last one becomes the archive, and the others are copied behind it.  What hardly changes from row to row is deflated, in
passing, and what repeats itself only once; the rest would shrink little and take more time than the simulation.
"""

from __future__ import annotations

import io
import os
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from eventsim.errors import LogError
from eventsim.record.events import ROW, Column
from eventsim.record.files.archive import Deflated, Entry, Stored, write_archive
from eventsim.record.files.counting import Counting
from eventsim.record.files.journal import METADATA, NUMBER, ROOM, WHOLE, Columns, JournalSink
from eventsim.record.files.runs import STEADY
from eventsim.record.files.table import DAMAGE, checked_log, columns_kept, labels_of, rows_from_columns
from eventsim.record.provenance import provenance_from_text
from eventsim.replay.log import EventLog

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


def read_npz(path: Path) -> EventLog:
    """Read an NPZ log; raise LogError where it is none."""
    try:
        with np.load(path, allow_pickle=False) as archive:
            if METADATA not in archive:
                raise LogError(f"{path}: not an event log: there is no array named {METADATA}")
            text = bytes(np.asarray(archive[METADATA], dtype=np.uint8)).decode("ascii")
            provenance = provenance_from_text(text, str(path))
            columns: dict[str, Column] = {name: archive[name] for name in columns_kept(provenance)}
            if any(column.shape != columns["event"].shape for column in columns.values()):
                raise LogError(f"{path}: not an event log: its columns differ in length")
            rows = rows_from_columns(columns, provenance)
    except OSError as error:
        raise LogError(f"{path}: cannot be read ({error.strerror or error})") from None
    except (*DAMAGE, zipfile.BadZipFile, zlib.error) as error:
        raise LogError(f"{path}: not a whole .npz event log ({error})") from None
    return checked_log(provenance, rows, path)


def _header(dtype: np.dtype[Any], count: int) -> bytes:
    """What an .npy file begins with."""
    header = {"descr": np.lib.format.dtype_to_descr(dtype), "fortran_order": False, "shape": (count,)}
    target = io.BytesIO()
    np.lib.format.write_array_header_2_0(target, header)
    return target.getvalue()
