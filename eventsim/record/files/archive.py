"""A zip archive whose entries grow side by side, each in a file of its own, and are put together at the end.

Python's zipfile writes one entry after the other.  Here the work per byte (checksum, deflating) is done as the bytes come,
and the end is a copy.  Source: PKWARE, .ZIP File Format Specification 6.3 (sizes and offsets in the zip64 fields, so that
no length is a special case).
"""

from __future__ import annotations

import os
import shutil
import struct
import zlib
from abc import ABC, abstractmethod
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import IO, NamedTuple

import numpy as np

from eventsim.record.events import Column

VERSION = 45
"""Of the specification: the first with zip64."""

DATE = (1 << 5) | 1
"""1 January 1980, always, so that equal contents are equal files."""

IN_ZIP64 = 0xFFFFFFFF
FASTEST = 1
COPY = 1 << 20
PADDING, GROWTH_HINT = 0xA220, 0xA028
STORED_BLOCK = 65535
"""The longest stored block of the deflate format."""

END_OF_DEFLATED = b"\x03\x00"
"""An empty last block: it ends a text in the deflate format."""

PIECE = 1 << 13
"""Numbers that are deflated together."""


class Entry(ABC):
    """An entry that grows at `path`; `head`, which is known last, goes before what was written."""

    method: int
    room = 0
    """Bytes of the file before those of the entry."""

    def __init__(self, name: str, path: Path) -> None:
        self.name = name.encode("ascii")
        self.path = path
        self.head = b""
        self.size = self.crc = 0

    @abstractmethod
    def write(self, column: Column) -> None:
        """Append the numbers of a contiguous array (n,)."""

    def finish(self, head: bytes) -> None:
        """All has come; `head`, shorter than 64 kB, is put before it."""
        assert len(head) <= STORED_BLOCK
        self.head = head
        self.close()

    @abstractmethod
    def close(self) -> None:
        """Let go of the file."""

    @abstractmethod
    def packed_head(self) -> bytes:
        """The head as the archive holds it."""

    def copy_to(self, target: IO[bytes]) -> bytes:
        """Write the finished entry where `target` stands; the record of it for the directory of the archive."""
        offset = target.tell()
        packed = self.path.stat().st_size - self.room
        header, record = self._headers(packed, offset, b"")
        target.write(header)
        with self.path.open("rb") as source:
            source.seek(self.room)
            shutil.copyfileobj(source, target, COPY)
        return record

    def begin_with(self, target: IO[bytes]) -> bytes:
        """The same where the archive is to grow from the file of the finished entry: nothing is copied."""
        packed = self.path.stat().st_size - self.room
        bare, _ = self._headers(packed, 0, b"")
        blank = self.room - len(bare) - struct.calcsize("<HHHH")
        padding = struct.pack("<HHHH", PADDING, blank + 4, GROWTH_HINT, blank) + bytes(blank)
        header, record = self._headers(packed, 0, padding)
        target.write(header)
        target.seek(0, os.SEEK_END)
        return record

    def _headers(self, packed: int, offset: int, padding: bytes) -> tuple[bytes, bytes]:
        """What stands before `packed` bytes of the entry at an offset, and the record for the directory."""
        head = self.packed_head()
        crc = combined_crc(zlib.crc32(self.head), self.crc, self.size)
        sizes = struct.pack("<QQ", len(self.head) + self.size, len(head) + packed)
        common = struct.pack("<HHHHHIIIH", VERSION, 0, self.method, 0, DATE, crc, IN_ZIP64, IN_ZIP64, len(self.name))
        header = b"PK\x03\x04" + common + struct.pack("<H", 4 + len(sizes) + len(padding)) + self.name
        header += struct.pack("<HH", 1, len(sizes)) + sizes + padding + head
        sizes += struct.pack("<Q", offset)
        record = b"PK\x01\x02" + struct.pack("<H", VERSION) + common
        record += struct.pack("<HHHHII", 4 + len(sizes), 0, 0, 0, 0, IN_ZIP64)
        return header, record + self.name + struct.pack("<HH", 1, len(sizes)) + sizes


class Stored(Entry):
    """Bytes that somebody else writes at `path`, as they are, behind so much room; here they are only noted."""

    method = 0

    def __init__(self, name: str, path: Path, room: int = 0) -> None:
        super().__init__(name, path)
        self.room = room

    def write(self, column: Column) -> None:
        """Take note of an array that is written at `path`."""
        self.size += column.nbytes
        self.crc = zlib.crc32(column.data, self.crc)

    def close(self) -> None:
        """Nothing is held."""

    def packed_head(self) -> bytes:
        """The head itself."""
        return self.head


class Deflated(Entry):
    """Bytes deflated piece by piece, each by itself, so that a piece like the one before it costs only a look.

    labels: what the numbers stand for, in the archive; None: themselves.  Pieces are cut by the count of the numbers, so the
    archive does not tell in which blocks they came.
    """

    method = 8

    def __init__(self, name: str, path: Path, labels: Column | None = None) -> None:
        super().__init__(name, path)
        self._file = path.open("wb")
        self._labels = labels
        self._waiting: list[Column] = []
        self._last = _Piece(b"", b"", 0, 0)

    def write(self, column: Column) -> None:
        """Append the numbers, or labels, of an array (n,)."""
        self._waiting.append(column)
        if sum(map(len, self._waiting)) >= PIECE:
            waiting = np.concatenate(self._waiting)
            *pieces, rest = np.split(waiting, range(PIECE, len(waiting) + 1, PIECE))
            for piece in pieces:
                self._deflate(piece)
            self._waiting = [rest]

    def finish(self, head: bytes) -> None:
        """All has come: deflate the last piece too, and end the text."""
        if self._waiting:
            self._deflate(np.concatenate(self._waiting))
        self._file.write(END_OF_DEFLATED)
        super().finish(head)

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def packed_head(self) -> bytes:
        """A block of deflate's that is stored, and says so."""
        return struct.pack("<BHH", 0, len(self.head), len(self.head) ^ 0xFFFF) + self.head

    def _deflate(self, column: Column) -> None:
        raw = column.tobytes()
        if raw != self._last.raw:
            data = raw if self._labels is None else self._labels[column].tobytes()
            deflated = deflated_alone(data)
            self._last = _Piece(raw, deflated, len(data), zlib.crc32(data))
            self._add(data, deflated)
        else:
            self._file.write(self._last.deflated)
            self.crc = _product(_shift(self._last.size), self.crc) ^ self._last.crc
            self.size += self._last.size

    def _add(self, data: bytes, deflated: bytes) -> None:
        """Append a text; deflated: as it is in the archive."""
        self._file.write(deflated)
        self.crc = zlib.crc32(data, self.crc)
        self.size += len(data)


class _Piece(NamedTuple):
    """A piece of an entry: its numbers; as it is in the archive; of its text: the length and the CRC."""

    raw: bytes
    deflated: bytes
    size: int
    crc: int


def deflated_alone(data: bytes) -> bytes:
    """A text in the deflate format that refers to nothing before it, up to a whole byte, and may be followed by more."""
    deflate = zlib.compressobj(FASTEST, zlib.DEFLATED, -zlib.MAX_WBITS)
    return deflate.compress(data) + deflate.flush(zlib.Z_FULL_FLUSH)


def write_archive(path: Path, entries: Sequence[Entry]) -> None:
    """Write an archive of finished entries; where one has grown at `path` itself, the file becomes the archive."""
    there = next((entry for entry in entries if entry.path == path), None)
    with path.open("wb" if there is None else "r+b") as target:
        first = None if there is None else there.begin_with(target)
        records = [first if entry is there and first is not None else entry.copy_to(target) for entry in entries]
        count, begin = len(records), target.tell()
        target.write(b"".join(records))
        end = target.tell()
        directory = struct.pack("<QQQQ", count, count, end - begin, begin)
        target.write(b"PK\x06\x06" + struct.pack("<QHHII", 44, VERSION, VERSION, 0, 0) + directory)
        target.write(b"PK\x06\x07" + struct.pack("<IQI", 0, end, 1))
        target.write(b"PK\x05\x06" + struct.pack("<HHHHIIH", 0, 0, count, count, IN_ZIP64, IN_ZIP64, 0))


POLYNOMIAL = 0xEDB88320
"""Of CRC-32; the highest bit of a number is the coefficient of x^0."""


def combined_crc(first: int, second: int, length: int) -> int:
    """The CRC-32 of two texts in a row from those of the texts, the second `length` bytes long: O(log length).

    A text moved by a bit is multiplied by x modulo the polynomial, so the first is multiplied by x^(8 length).
    """
    return _product(_power(8 * length), first) ^ second


@lru_cache(maxsize=8)
def _shift(length: int) -> int:
    """What a text is multiplied by where one of this length follows; asked for the same few lengths again and again."""
    return _power(8 * length)


def _power(exponent: int) -> int:
    """x^exponent modulo the polynomial."""
    total, factor = 1 << 31, 1 << 30  # 1, x
    while exponent:
        if exponent & 1:
            total = _product(factor, total)
        factor = _product(factor, factor)
        exponent >>= 1
    return total


def _product(a: int, b: int) -> int:
    """a b modulo the polynomial."""
    total = 0
    for bit in range(31, -1, -1):
        if a >> bit & 1:
            total ^= b
        b = b >> 1 ^ POLYNOMIAL if b & 1 else b >> 1
    return total
