"""The digest of a log: one SHA-256 that two logs share exactly when they tell the same story."""

from __future__ import annotations

import hashlib

import numpy as np

from eventsim.record.events import Rows

INTEGERS = ("kind", "a", "b", "wall", "epoch")
FLOATS = ("remainder", "xa", "ya", "xb", "yb", "vxa", "vya", "vxb", "vyb")
RECORD = np.dtype([(name, "<i8") for name in INTEGERS] + [(name, "<f8") for name in FLOATS])


class Digester:
    """A running SHA-256 over rows in order; the cut into blocks does not matter.

    Each row contributes the little-endian 64-bit values kind code, a, b, wall index, epoch, remainder, positions
    (xa, ya, xb, yb), velocities (vxa, vya, vxb, vyb). -0.0 counts as 0.0 and there is one NaN, since
    neither sign nor payload of these is physics. Event number, time, impulse and joint are no part of it.
    """

    def __init__(self) -> None:
        self._sha = hashlib.sha256()

    def update(self, rows: Rows) -> None:
        """Add a block of full rows."""
        records = np.empty(len(rows), dtype=RECORD)
        for name in INTEGERS:
            records[name] = rows[name]
        for name in FLOATS:
            values = rows[name] + 0.0  # -0.0 + 0.0 is 0.0
            np.copyto(values, np.nan, where=np.isnan(values))
            records[name] = values
        self._sha.update(records.view(np.uint8).data)

    def hexdigest(self) -> str:
        """Return the digest of all rows so far, 64 hexadecimal digits."""
        return self._sha.hexdigest()


BLOCK = 1 << 16


def digest_of(rows: Rows) -> str:
    """Return the digest of full rows, in blocks so that the copy stays small."""
    digester = Digester()
    for first in range(0, len(rows), BLOCK):
        digester.update(rows[first : first + BLOCK])
    return digester.hexdigest()
