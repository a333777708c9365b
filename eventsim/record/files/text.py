"""What the text formats share: one line of metadata that is completed in place, then one line per row."""

from __future__ import annotations

import os
import shutil
from abc import abstractmethod
from collections.abc import Callable, Generator
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import IO, NamedTuple

import numpy as np

from eventsim.errors import LogError
from eventsim.reading import reading, reason_of
from eventsim.record.events import Column, Rows
from eventsim.record.files.sink import FileSink, Format, Opened, demand_same
from eventsim.record.provenance import BEFORE_SCENE, Provenance, provenance_from_text, provenance_text
from eventsim.suffixes import PART

RESERVE = 512
"""Blanks after the first metadata line, so that the ending can be entered without moving the rows."""

TAIL = b', "kicks": '
"""Where the part of the metadata begins that the end of a run changes."""

PAGE = 4096
"""Bytes that a file system writes as one: a tail within a page is either the old one or the new one, even after a kill."""

BLOCK_BYTES = 1 << 23
"""Of lines that are read together: some 30,000 rows."""

CHUNK = 1 << 20

BYTE_ORDER_MARK = "\ufeff"


class TextForm(NamedTuple):
    """How a text format is read.

    prefix: what stands before the metadata in their line.  header_of: what must stand between metadata and rows.  parse: lines
    to rows; it may raise ValueError, TypeError, OverflowError or KeyError.
    """

    prefix: str
    header_of: Callable[[Provenance], str]
    parse: Callable[[list[bytes], Provenance], Rows]


class TextSink(FileSink):
    """Writes a line of metadata and one line per row; flushed after each block, so that it can be followed."""

    prefix = ""
    """What stands before the metadata in their line."""

    _file: IO[bytes] | None = None

    @abstractmethod
    def header(self) -> str:
        """Return what stands between metadata and rows."""

    @abstractmethod
    def lines(self, rows: Rows) -> str:
        """Return the lines of a block of rows, each ended by a newline."""

    def _open(self) -> None:
        if self.part.is_dir():
            shutil.rmtree(self.part)
        self._file = self.part.open("w+b")
        stem, tail = self._head(self.provenance)
        self._room = len(tail) + RESERVE
        if len(stem) % PAGE + self._room > PAGE:
            stem = stem.ljust(len(stem) + PAGE - len(stem) % PAGE)
        self._cut = len(stem)
        self._file.write(stem + tail.ljust(self._room) + b"\n" + self.header().encode())
        self._file.flush()

    def _reopen(self, rows: int) -> None:
        self._file = self.part.open("r+b")
        head = self._file.readline().removesuffix(b"\n")
        metadata = head.removeprefix(self.prefix.encode())
        if TAIL not in metadata or not metadata.isascii():
            raise LogError(f"{self.part}: not an event log: the first line does not hold its scene")
        found = provenance_from_text(metadata.decode(), str(self.part))
        demand_same(found, self.provenance, self.part)
        self.provenance = replace(self.provenance, engine=found.engine)  # it stands before the cut
        self._cut = head.rindex(TAIL)
        self._room = len(head) - self._cut
        self._file.truncate(self._end_of_row(rows))
        self._file.seek(self._cut)
        self._file.write(self._head(self.provenance)[1].ljust(self._room))
        self._file.seek(0, os.SEEK_END)
        self._file.flush()

    def _end_of_row(self, rows: int) -> int:
        """Where so many rows, at least one, end; LogError where there are fewer."""
        assert self._file is not None
        headed = self.header().count("\n")
        place, left = self._file.tell(), headed + rows
        while True:
            chunk = self._file.read(CHUNK)
            found = chunk.count(b"\n")
            if not chunk:
                raise LogError(f"{self.part}: holds {max(rows - left, 0)} rows of {rows}")
            if found < left:
                place, left = place + len(chunk), left - found
            else:
                at = 0
                for _ in range(left):
                    at = chunk.index(b"\n", at) + 1
                return place + at

    def _append(self, rows: Rows) -> None:
        if len(rows):
            assert self._file is not None
            self._file.write(self.lines(rows).encode())
            self._file.flush()

    def _sync(self) -> None:
        assert self._file is not None
        os.fsync(self._file.fileno())

    def _finish(self, provenance: Provenance) -> Path:
        assert self._file is not None
        stem, tail = self._head(provenance)
        if len(tail) <= self._room:
            self._file.seek(self._cut)
            self._file.write(tail.ljust(self._room))
            self._release()
            return self.part
        # Many kicks of a compact log do not fit: the rows are copied behind a longer line.
        longer = self.part.with_name(self.part.name + PART)
        self._file.seek(self._cut + self._room)
        with open(longer, "wb") as whole:
            whole.write(stem + tail)
            shutil.copyfileobj(self._file, whole)
        self._release()
        longer.replace(self.part)
        return self.part

    def _release(self) -> None:
        file, self._file = self._file, None
        if file is not None:
            file.close()

    def _discard(self) -> None:
        self.part.unlink(missing_ok=True)

    def _head(self, provenance: Provenance) -> tuple[bytes, bytes]:
        """The line of the metadata, cut before what the end of a run changes."""
        head = (self.prefix + provenance_text(provenance)).encode("ascii")
        cut = head.rindex(TAIL)
        return head[:cut], head[cut:]


def words_of(values: Column, missing: str) -> list[str]:
    """Return numbers as the shortest texts that read back as the same bits; NaN as `missing`."""
    words = list(map(repr, values.tolist()))
    if values.dtype.kind == "f":
        for index in np.flatnonzero(np.isnan(values)).tolist():
            words[index] = missing
    return words


def text_format(sink: type[TextSink], form: TextForm) -> Format:
    """The format of a text log."""
    beginning = (form.prefix + BEFORE_SCENE).encode()
    marked = BYTE_ORDER_MARK.encode() + beginning

    def is_log(file: IO[bytes]) -> bool:
        return file.read(len(marked)).startswith((beginning, marked))

    return Format(sink, lambda path: open_text(path, form), lambda path: open_text(path, form), is_log)


def open_text(path: Path, form: TextForm) -> Opened:
    """The metadata of a text log and its rows in blocks; of a growing file an unfinished last line is left out."""
    with ExitStack() as opened:
        file = opened.enter_context(reading(path, LogError, "not an event log of this format"))
        head = _line(file, path).removeprefix(BYTE_ORDER_MARK).rstrip("\n")  # some editors add the mark, and other line ends
        if not head.startswith(form.prefix):
            raise LogError(f"{path}: not an event log: the first line does not hold its scene")
        provenance = provenance_from_text(head.removeprefix(form.prefix), str(path))
        header = form.header_of(provenance)
        if header and _line(file, path) != header:
            raise LogError(f"{path}: the columns are not those of an event log: {header.strip()}")
        return Opened(provenance, _blocks(opened.pop_all(), file, form, provenance, path))
    raise AssertionError("either metadata or an error")


def _blocks(
    opened: ExitStack, file: IO[bytes], form: TextForm, provenance: Provenance, path: Path
) -> Generator[Rows]:
    number = 2 + form.header_of(provenance).count("\n")
    with opened:
        while block := _whole(file.readlines(BLOCK_BYTES), path):
            yield _parse_block(form.parse, block, provenance, f"{path}", number)
            number += len(block)


def _line(file: IO[bytes], path: Path) -> str:
    return b"".join(_whole([file.readline()], path)).decode("utf-8").replace("\r\n", "\n")


def _whole(lines: list[bytes], path: Path) -> list[bytes]:
    """Those of some lines that end; only the last one of a file that grows may not."""
    if not lines or lines[-1].endswith(b"\n") or lines == [b""]:
        return lines
    if path.suffix == PART:
        return lines[:-1]
    raise LogError(
        f"{path}: the last line is not whole; the file was cut off (named {path.name}{PART}, it is read up to there)"
    )


def _parse_block(
    parse: Callable[[list[bytes], Provenance], Rows], block: list[bytes], provenance: Provenance, path: str, number: int
) -> Rows:
    """Parse a block; where that fails, parse line by line to name the first bad one."""
    try:
        return parse(block, provenance)
    except Exception as error:  # whatever a parser raises over lines that may say anything
        place, reason = f"lines {number} to {number + len(block) - 1}", error
        for offset, line in enumerate(block):
            try:
                parse([line], provenance)
            except Exception as single:
                place, reason = f"line {number + offset}", single
                break
        raise LogError(f"{path}: {place}: not a row of an event log ({reason_of(reason)})") from None
