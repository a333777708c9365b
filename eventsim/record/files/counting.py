"""The numbers of rows, 0, 1, 2, ..., as an entry of an archive: a third of their size for a hundredth of deflating's work.

256 numbers in a row differ in their lowest bytes only, which are the same in any 256.  So a page of them is its first number
and, always the same, the text "next byte, then the seven before the last": a literal and a match for each number.
Source: P. Deutsch, DEFLATE Compressed Data Format Specification 1.3, RFC 1951 (1996), 3.2.4 and 3.2.6.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from eventsim.record.events import Column
from eventsim.record.files.archive import Deflated, deflated_alone

PAGE = 256
STORED = bytes([0, 8, 0, 0xF7, 0xFF])
"""What announces eight bytes stored as they are."""


def _repeated() -> Column:
    """The deflated text of 255 numbers after the first of a page, up to the next whole byte."""
    literal = [f"{0x30 + byte:08b}" if byte < 144 else f"{0x190 + byte - 144:09b}" for byte in range(1, PAGE)]
    seven_bytes, eight_before = "0000101", "00101" + "1"
    fixed_codes, end, stored = "010", "0000000", "000"
    bits = fixed_codes + "".join(byte + seven_bytes + eight_before for byte in literal) + end + stored
    text = np.packbits(np.frombuffer(bits.encode(), np.uint8) - ord("0"), bitorder="little").tobytes()
    return np.frombuffer(text + b"\x00\x00\xff\xff", np.uint8)


REPEATED = _repeated()


class Counting(Deflated):
    """The numbers 0, 1, 2, ... as int64; of what is written only the length counts."""

    def __init__(self, name: str, path: Path) -> None:
        super().__init__(name, path)
        self._count = 0

    def write(self, column: Column) -> None:
        """Append so many numbers as an array (n,) has."""
        self._count += len(column)
        self._write_up_to(self._count // PAGE * PAGE)

    def finish(self, head: bytes) -> None:
        """All has come: deflate what fills no page too, and end the text."""
        rest = np.arange(self.size // 8, self._count, dtype="<i8").tobytes()
        self._add(rest, deflated_alone(rest))
        super().finish(head)

    def _write_up_to(self, end: int) -> None:
        numbers = np.arange(self.size // 8, end, dtype="<i8")
        if len(numbers):
            pages = np.empty((len(numbers) // PAGE, len(STORED) + 8 + len(REPEATED)), np.uint8)
            pages[:, : len(STORED)] = np.frombuffer(STORED, np.uint8)
            pages[:, len(STORED) : -len(REPEATED)] = _bytes(numbers[::PAGE])
            pages[:, -len(REPEATED) :] = REPEATED
            self._add(numbers.tobytes(), pages.tobytes())


def _bytes(numbers: Column) -> Column:
    """The bytes of numbers, (n, 8)."""
    return np.ascontiguousarray(numbers).view(np.uint8).reshape(-1, 8)
