"""The journal of a binary log that grows, in the directory NAME.part: each column is a raw file, steady ones are runs.

Beside it the format's own file comes into being, of which a run that was killed would leave nothing to read.  The journal keeps
every row that was written: the shortest file says how many are whole.  What it would not need to keep it does not: writing it,
and removing it in the end, is a good part of what a log costs.
"""

from __future__ import annotations

import os
import shutil
from abc import abstractmethod
from collections.abc import Generator, Iterable, Iterator
from itertools import chain, islice
from pathlib import Path
from typing import IO, TypeAlias

import numpy as np

from eventsim.errors import LogError
from eventsim.reading import reading, told_as
from eventsim.record.events import FIELDS, SPIN_ROW, SPINS, Column, Rows, blank_rows
from eventsim.record.files.runs import columns_of_runs, cut_runs, rows_in_runs, runs_of
from eventsim.record.files.sink import FileSink, Opened, demand_same
from eventsim.record.provenance import (
    BEFORE_SCENE,
    Provenance,
    columns_kept,
    provenance_from_text,
    provenance_text,
    text_after_scene,
)
from eventsim.scene.files import scene_beside, scene_texts
from eventsim.suffixes import PART

METADATA = "eventsim"
"""The file with the metadata beside the columns."""

WHOLE = "whole"
"""The format's own file, in the making."""

RUNS = "runs"
"""The file with the runs of the steady columns."""

NUMBER = "event"
"""The column that is counted anew when a journal is read."""

TEXTS = 2
"""Pieces of the text of a scene that are made with a block of rows: Python is busy with them for less than half of the time that
a block of the fast engine takes, and those of 100,000 disks come within a second."""

ROOM = 512
"""Bytes that the raw file of a column begins with, for what a format may want to stand before the numbers."""

GROUP = 1 << 17
"""Rows held at a time."""

DAMAGED = "not an event log that grows, or damaged"

Columns: TypeAlias = dict[str, Column]
"""The columns of a block of rows by their names, each (n,) and contiguous: taken apart once, for all that is done with them."""


class JournalSink(FileSink):
    """Keeps a journal beside the format's own file.

    A format supplies `_begin`, `_put`, `_describe`, `_complete` and `_stop`.  The metadata tell every disk of the scene:
    their text is made in passing, a piece with every block of rows, where the writer's thread has time for it.
    """

    _journal: dict[str, IO[bytes]]
    _texts: Iterator[str]

    @abstractmethod
    def _begin(self) -> None:
        """Begin the format's own file."""

    @abstractmethod
    def _put(self, columns: Columns) -> None:
        """Append to it a block that the journal has."""

    @abstractmethod
    def _describe(self, text: str) -> None:
        """Append to its metadata."""

    @abstractmethod
    def _complete(self) -> None:
        """Have the whole file at `self.part / WHOLE`."""

    @abstractmethod
    def _stop(self) -> None:
        """Close the files of the format, whatever is in them."""

    def _open(self) -> None:
        self._journal = {}
        if self.part.is_dir():
            self._discard()  # left over from a run that was killed
        self.part.unlink(missing_ok=True)
        # A run may be killed at any moment: the journal comes in one piece, and goes in one.
        begun = self._beside()
        try:
            begun.mkdir()
            scene = scene_beside(self.provenance.scene, begun)
            (begun / METADATA).write_text(provenance_text(self.provenance, scene), encoding="ascii")
            (begun / RUNS).touch()
            for name in raw(self.columns):
                (begun / name).touch()
                os.truncate(begun / name, ROOM)
            begun.replace(self.part)
        except BaseException:
            shutil.rmtree(begun, ignore_errors=True)
            raise
        self._go_on()

    def _reopen(self, rows: int) -> None:
        self._journal = {}
        demand_same(journal_provenance(self.part), self.provenance, self.part)
        found = rows_in_journal(self.part, self.columns)
        if found < rows:
            raise LogError(f"{self.part}: holds {found} rows of {rows}")
        for name in raw(self.columns):
            _part_from_others(self.part / name)
            os.truncate(self.part / name, ROOM + rows * SPIN_ROW[name].itemsize)
        cut_runs(self.part / RUNS, rows)
        self._go_on()
        for columns in columns_of_journal(self.part, self.columns, rows):
            self._put(columns)

    def _go_on(self) -> None:
        files = (*raw(self.columns), RUNS)
        self._journal = {name: (self.part / name).open("ab", buffering=0) for name in files}
        self._texts = chain([BEFORE_SCENE], scene_texts(self.provenance.scene))
        self._begin()

    def _append(self, rows: Rows) -> None:
        columns = {name: np.ascontiguousarray(rows[name]) for name in self.columns}
        for name in raw(self.columns):
            _write_all(self._journal[name], columns[name])
        _write_all(self._journal[RUNS], runs_of(columns, self._count).view(np.uint8))
        self._put(columns)
        for text in islice(self._texts, TEXTS):
            self._describe(text)

    def _sync(self) -> None:
        for file in self._journal.values():
            os.fsync(file.fileno())

    def _finish(self, provenance: Provenance) -> Path:
        for text in chain(self._texts, [text_after_scene(provenance)]):
            self._describe(text)
        self._complete()
        self._release()
        return self.part / WHOLE

    def _release(self) -> None:
        files, self._journal = self._journal, {}
        for file in files.values():
            file.close()
        self._stop()

    def _discard(self) -> None:
        gone = self._beside()
        self.part.replace(gone)
        shutil.rmtree(gone, ignore_errors=True)

    def _beside(self) -> Path:
        """A free name for a journal that is not yet, or no more, one to be read."""
        path = self.part.with_name(self.part.name + "~")
        shutil.rmtree(path, ignore_errors=True)
        return path


def _write_all(file: IO[bytes], column: Column) -> None:
    """Write a column to a file without a buffer, which may take less than it is given."""
    left = column.data.cast("B")
    while len(left):
        left = left[file.write(left) :]


def _part_from_others(path: Path) -> None:
    """Let a file have its bytes for itself, where a log that was just finished has them too."""
    if path.stat().st_nlink > 1:
        alone = path.with_name(path.name + PART)
        shutil.copyfile(path, alone)
        alone.replace(path)


def journal_provenance(part: Path) -> Provenance:
    """The metadata of a log that grows, or grew until its run was killed; LogError where there are none."""
    with reading(part / METADATA, LogError, DAMAGED) as file:
        text = file.read().decode("ascii")
    return provenance_from_text(text, str(part), part)


def raw(columns: Iterable[str]) -> tuple[str, ...]:
    """Those of some columns that have a file of their own."""
    return tuple(name for name in columns if name != NUMBER and not FIELDS[name].steady)


def rows_in_journal(part: Path, columns: tuple[str, ...]) -> int:
    """How many rows are whole; LogError where a file is missing."""
    with told_as(part, LogError, DAMAGED):
        sizes = {name: max((part / name).stat().st_size - ROOM, 0) for name in raw(columns)}
        counts = [size // SPIN_ROW[name].itemsize for name, size in sizes.items()]
        return min(*counts, rows_in_runs(part / RUNS))


def columns_of_journal(part: Path, names: tuple[str, ...], count: int) -> Iterator[Columns]:
    """The columns of the first `count` rows, in blocks."""
    for first in range(0, count, GROUP):
        here = min(GROUP, count - first)
        found: Columns = {NUMBER: np.arange(first, first + here), **columns_of_runs(part / RUNS, first, here)}
        for name in raw(names):
            with open(part / name, "rb") as source:
                source.seek(ROOM + first * SPIN_ROW[name].itemsize)
                found[name] = np.frombuffer(source.read(here * SPIN_ROW[name].itemsize), SPIN_ROW[name])
        yield found


def blocks_of_journal(part: Path, names: tuple[str, ...], count: int) -> Generator[Rows]:
    """The first `count` rows, in blocks."""
    with told_as(part, LogError, DAMAGED):
        for columns in columns_of_journal(part, names, count):
            rows = blank_rows(len(columns["event"]), SPINS[0] in columns)
            for name, column in columns.items():
                rows[name] = column
            yield rows


def open_journal(part: Path) -> Opened:
    """The metadata and the rows of a log that grows, in blocks; LogError where it is none."""
    provenance = journal_provenance(part)
    columns = columns_kept(provenance)
    return Opened(provenance, blocks_of_journal(part, columns, rows_in_journal(part, columns)))
