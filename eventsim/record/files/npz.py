"""NPZ logs: one array per column (kind and wall as text) and the array `eventsim` with the metadata as JSON.

Columns grow as raw files in the directory NAME.npz.part and are put together when the log is closed. Floats are
stored as they are, whole numbers and texts deflated: those shrink, floats hardly do.
"""

from __future__ import annotations

import shutil
import zipfile
import zlib
from pathlib import Path
from typing import IO, Any

import numpy as np

from eventsim.errors import LogError
from eventsim.record.events import ROW, Column, Rows
from eventsim.record.files.sink import PART, FileSink
from eventsim.record.files.table import checked_log, columns_kept, labels_of, rows_from_columns
from eventsim.record.log import EventLog
from eventsim.record.provenance import Provenance, provenance_from_text, provenance_text

METADATA = "eventsim"
CHUNK = 1 << 16
"""Rows copied at a time."""


class NpzSink(FileSink):
    """Writes NPZ."""

    _files: dict[str, IO[bytes]]

    def _open(self) -> None:
        if self.part.is_dir():
            shutil.rmtree(self.part)  # left over from a run that was killed
        self.part.mkdir()
        self._files = {name: self._spill(name).open("wb") for name in self.columns}

    def _append(self, rows: Rows) -> None:
        for name, file in self._files.items():
            file.write(rows[name].tobytes())

    def _finish(self, provenance: Provenance) -> None:
        for file in self._files.values():
            file.close()
        whole = self.part.with_name(self.part.name + PART)
        with zipfile.ZipFile(whole, "w", allowZip64=True) as archive:
            self._add_text(archive, provenance_text(provenance))
            for name in self.columns:
                self._add_column(archive, name)
        shutil.rmtree(self.part)
        whole.replace(self.part)

    def _discard(self) -> None:
        for file in self._files.values():
            file.close()
        shutil.rmtree(self.part, ignore_errors=True)

    def _spill(self, name: str) -> Path:
        return self.part / name

    def _add_text(self, archive: zipfile.ZipFile, text: str) -> None:
        letters = np.frombuffer(text.encode("ascii"), dtype=np.uint8)
        with archive.open(_entry(METADATA, zipfile.ZIP_DEFLATED), "w") as target:
            _write_header(target, letters.dtype, len(letters))
            target.write(letters.tobytes())

    def _add_column(self, archive: zipfile.ZipFile, name: str) -> None:
        labels = labels_of(name, self.provenance.wall_names)
        stored = ROW[name].kind == "f"
        entry = _entry(name, zipfile.ZIP_STORED if stored else zipfile.ZIP_DEFLATED)
        with open(self._spill(name), "rb") as source, archive.open(entry, "w", force_zip64=True) as target:
            _write_header(target, ROW[name] if labels is None else labels.dtype, self._count)
            while chunk := source.read(CHUNK * ROW[name].itemsize):
                target.write(chunk if labels is None else labels[np.frombuffer(chunk, ROW[name])].tobytes())


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
    except (ValueError, TypeError, KeyError, EOFError, OverflowError, zipfile.BadZipFile, zlib.error) as error:
        raise LogError(f"{path}: not a whole .npz event log ({error})") from None
    return checked_log(provenance, rows, path)


def _entry(name: str, compression: int) -> zipfile.ZipInfo:
    """Describe an entry with a fixed date, so that equal logs are equal files."""
    entry = zipfile.ZipInfo(f"{name}.npy", date_time=(1980, 1, 1, 0, 0, 0))
    entry.compress_type = compression
    return entry


def _write_header(target: IO[bytes], dtype: np.dtype[Any], count: int) -> None:
    header = {"descr": np.lib.format.dtype_to_descr(dtype), "fortran_order": False, "shape": (count,)}
    np.lib.format.write_array_header_2_0(target, header)
