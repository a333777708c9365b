"""What the text formats share: one line of metadata that is completed in place, then one line per row."""

from __future__ import annotations

import shutil
from abc import abstractmethod
from collections.abc import Callable, Iterator
from itertools import islice
from pathlib import Path
from typing import IO

import numpy as np

from eventsim.errors import LogError
from eventsim.record.events import Column, Rows, blank_rows
from eventsim.record.files.sink import PART, FileSink
from eventsim.record.files.table import checked_log
from eventsim.record.log import EventLog
from eventsim.record.provenance import Provenance, provenance_from_text, provenance_text

RESERVE = 512
"""Blanks after the first metadata line, so that the ending can be entered without moving the rows."""

BLOCK_LINES = 1 << 15


class TextSink(FileSink):
    """Writes a line of metadata and one line per row; flushed after each block, so that it can be followed."""

    prefix = ""
    """What stands before the metadata in their line."""

    _file: IO[bytes]

    @abstractmethod
    def header(self) -> str:
        """Return what stands between metadata and rows."""

    @abstractmethod
    def lines(self, rows: Rows) -> str:
        """Return the lines of a block of rows, each ended by a newline."""

    def _open(self) -> None:
        self._file = self.part.open("w+b")
        head = self._head(self.provenance) + b" " * RESERVE
        self._head_length = len(head)
        self._file.write(head + b"\n" + self.header().encode())
        self._file.flush()

    def _append(self, rows: Rows) -> None:
        if len(rows):
            self._file.write(self.lines(rows).encode())
            self._file.flush()

    def _finish(self, provenance: Provenance) -> None:
        head = self._head(provenance)
        if len(head) <= self._head_length:
            self._file.seek(0)
            self._file.write(head.ljust(self._head_length))
            self._file.close()
            return
        # Many kicks of a compact log do not fit: the rows are copied behind a longer line.
        longer = self.part.with_name(self.part.name + PART)
        self._file.seek(self._head_length)
        with open(longer, "wb") as whole:
            whole.write(head)
            shutil.copyfileobj(self._file, whole)
        self._file.close()
        longer.replace(self.part)

    def _discard(self) -> None:
        self._file.close()
        self.part.unlink(missing_ok=True)

    def _head(self, provenance: Provenance) -> bytes:
        return (self.prefix + provenance_text(provenance)).encode("ascii")


def words_of(values: Column, missing: str) -> list[str]:
    """Return numbers as the shortest texts that read back as the same bits; NaN as `missing`."""
    words = list(map(repr, values.tolist()))
    if values.dtype.kind == "f":
        for index in np.flatnonzero(np.isnan(values)).tolist():
            words[index] = missing
    return words


def read_text(
    path: Path,
    prefix: str,
    header_of: Callable[[Provenance], str],
    parse: Callable[[list[str], Provenance], Rows],
) -> EventLog:
    """Read a text log in blocks of lines; of a growing file (NAME.part) an unfinished last line is left out.

    header_of: what must stand between metadata and rows. parse: lines without newline to rows; it may raise
    ValueError, TypeError, OverflowError or KeyError. Raises LogError.
    """
    try:
        with open(path, encoding="utf-8-sig") as file:  # editors on some systems add a mark and other line ends
            lines = _whole_lines(file, path)
            head = next(lines, "")
            if not head.startswith(prefix):
                raise LogError(f"{path}: not an event log: the first line does not hold its scene")
            provenance = provenance_from_text(head.removeprefix(prefix), str(path))
            header = header_of(provenance)
            if header and next(lines, "") + "\n" != header:
                raise LogError(f"{path}: the columns are not those of an event log: {header.strip()}")
            blocks = [blank_rows(0)]
            number = 2 + header.count("\n")
            while block := list(islice(lines, BLOCK_LINES)):
                blocks.append(_parse_block(parse, block, provenance, f"{path}", number))
                number += len(block)
    except UnicodeDecodeError:
        raise LogError(f"{path}: not a text file, so not an event log of this format") from None
    except OSError as error:
        raise LogError(f"{path}: cannot be read ({error.strerror or error})") from None
    return checked_log(provenance, np.concatenate(blocks), path)


def _whole_lines(file: IO[str], path: Path) -> Iterator[str]:
    """Yield lines without their newline."""
    for line in file:
        if line.endswith("\n"):
            yield line[:-1]
        elif path.suffix != PART:
            raise LogError(
                f"{path}: the last line is not whole; the file was cut off (named {path.name}{PART}, it is read up to there)"
            )


def _parse_block(
    parse: Callable[[list[str], Provenance], Rows], block: list[str], provenance: Provenance, path: str, number: int
) -> Rows:
    """Parse a block; where that fails, parse line by line to name the first bad one."""
    wrong = (ValueError, TypeError, OverflowError, KeyError)
    try:
        return parse(block, provenance)
    except wrong as error:
        place, reason = f"lines {number} to {number + len(block) - 1}", error
        for offset, line in enumerate(block):
            try:
                parse([line], provenance)
            except wrong as single:
                place, reason = f"line {number + offset}", single
                break
        raise LogError(f"{path}: {place}: not a row of an event log ({reason})") from None
