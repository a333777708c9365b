"""A zip archive whose entries grow side by side, each in a file of its own, and are put together at the end.

Python's zipfile writes one entry after the other.  Here the work per byte (checksum, deflating) is done as the bytes come,
and the end is a copy.  Source: PKWARE, .ZIP File Format Specification 6.3 (sizes and offsets in the zip64 fields, so that
no length is a special case).
"""

from __future__ import annotations

import shutil
import struct
import zlib
from collections.abc import Iterable
from pathlib import Path
from typing import IO

STORED, DEFLATED = 0, 8
VERSION = 45
"""Of the specification: the first with zip64."""

DATE = (1 << 5) | 1
"""1 January 1980, always, so that equal contents are equal files."""

IN_ZIP64 = 0xFFFFFFFF
FASTEST = 1
COPY = 1 << 20
STORED_BLOCK = 65535
"""The longest stored block of the deflate format."""


class Entry:
    """An entry that grows; `head`, which is known last, goes before what was written.

    deflated: its bytes are, into the file `path`; else somebody else writes them there, as they are.
    """

    def __init__(self, name: str, path: Path, deflated: bool) -> None:
        self.name = name.encode("ascii")
        self.path = path
        self._file: IO[bytes] | None = path.open("wb") if deflated else None
        self.head = b""
        self._size = self._crc = 0
        self._deflate = zlib.compressobj(FASTEST, zlib.DEFLATED, -zlib.MAX_WBITS) if deflated else None

    def write(self, data: bytes) -> None:
        """Append bytes, or take note of them where they are written by somebody else."""
        self._size += len(data)
        self._crc = zlib.crc32(data, self._crc)
        if self._file is not None and self._deflate is not None:
            self._file.write(self._deflate.compress(data))

    def finish(self, head: bytes) -> None:
        """All bytes have come; `head`, shorter than 64 kB, is put before them."""
        assert len(head) <= STORED_BLOCK
        if self._file is not None and self._deflate is not None:
            self._file.write(self._deflate.flush())
        self.close()
        self.head = head

    def close(self) -> None:
        """Let go of the file."""
        if self._file is not None:
            self._file.close()

    def copy_to(self, target: IO[bytes]) -> bytes:
        """Write the finished entry where `target` stands; the record of it for the directory of the archive."""
        offset = target.tell()
        head = self.head
        if self._deflate is not None:  # a block of deflate's that says what it is
            head = struct.pack("<BHH", 0, len(head), len(head) ^ 0xFFFF) + head
        crc = combined_crc(zlib.crc32(self.head), self._crc, self._size)
        sizes = struct.pack("<QQ", len(self.head) + self._size, len(head) + self.path.stat().st_size)
        method = STORED if self._deflate is None else DEFLATED
        common = struct.pack("<HHHHHIIIH", VERSION, 0, method, 0, DATE, crc, IN_ZIP64, IN_ZIP64, len(self.name))
        target.write(b"PK\x03\x04" + common + struct.pack("<H", 4 + len(sizes)) + self.name)
        target.write(struct.pack("<HH", 1, len(sizes)) + sizes + head)
        with self.path.open("rb") as source:
            shutil.copyfileobj(source, target, COPY)
        sizes += struct.pack("<Q", offset)
        record = b"PK\x01\x02" + struct.pack("<H", VERSION) + common
        record += struct.pack("<HHHHII", 4 + len(sizes), 0, 0, 0, 0, IN_ZIP64)
        return record + self.name + struct.pack("<HH", 1, len(sizes)) + sizes


def write_archive(path: Path, entries: Iterable[Entry]) -> None:
    """Write an archive of finished entries."""
    with path.open("wb") as target:
        records = [entry.copy_to(target) for entry in entries]
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
    power, factor = 8 * length, 1 << 30  # x
    while power:
        if power & 1:
            first = _product(factor, first)
        factor = _product(factor, factor)
        power >>= 1
    return first ^ second


def _product(a: int, b: int) -> int:
    """a b modulo the polynomial."""
    total = 0
    for bit in range(31, -1, -1):
        if a >> bit & 1:
            total ^= b
        b = b >> 1 ^ POLYNOMIAL if b & 1 else b >> 1
    return total
