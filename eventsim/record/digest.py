"""The digest of a log: one SHA-256 that two logs share exactly when they tell the same story."""

from __future__ import annotations

import hashlib

import numpy as np

from eventsim.record.events import OFFSETS, ROW, Rows

INTEGERS = ("kind", "a", "b", "wall", "epoch")
PAIRS = {"xa": "place_a", "vxa": "velocity_a", "xb": "place_b", "vxb": "velocity_b"}
"""Two floats that lie side by side in rows and records are copied as one complex number: half the passes."""

RECORD = np.dtype(
    [(name, "<i8") for name in INTEGERS]
    + [("remainder", "<f8")]
    + [(name, "<c16") for name in ("place_a", "place_b", "velocity_a", "velocity_b")]
)
FLOATS = ("remainder", *PAIRS.values())
PIECE = 1 << 11
"""Rows that are made records of at a time: these, and the rows, stay in a core's own cache."""

PAIRS_OF_ROWS = np.dtype(
    {
        "names": list(PAIRS.values()),
        "formats": ["<c16"] * len(PAIRS),
        "offsets": [OFFSETS[first] for first in PAIRS],
        "itemsize": ROW.itemsize,
    }
)


class Digester:
    """A running SHA-256 over rows in order; the cut into blocks does not matter.

    Each row contributes the little-endian 64-bit values kind code, a, b, wall index, epoch, remainder, positions
    (xa, ya, xb, yb), velocities (vxa, vya, vxb, vyb). -0.0 counts as 0.0 and there is one NaN, since
    neither sign nor payload of these is physics. Event number, time, impulse and joint are no part of it.
    """

    def __init__(self) -> None:
        self._sha = hashlib.sha256()
        self._records = np.empty(PIECE, dtype=RECORD)

    def update(self, rows: Rows) -> None:
        """Add a block of full rows, in pieces."""
        for first in range(0, len(rows), PIECE):
            piece = rows[first : first + PIECE]
            records = self._records[: len(piece)]
            for name in INTEGERS:
                records[name] = piece[name]
            np.add(piece["remainder"], 0.0, out=records["remainder"])  # -0.0 + 0.0 is 0.0
            pairs = piece.view(PAIRS_OF_ROWS)
            for name in PAIRS.values():
                np.add(pairs[name], 0.0, out=records[name])
            if any(np.isnan(records[name]).any() for name in FLOATS):
                floats = records.view(np.float64).reshape(len(piece), -1)[:, len(INTEGERS) :]
                np.copyto(floats, np.nan, where=np.isnan(floats))
            self._sha.update(records.view(np.uint8).data)

    def hexdigest(self) -> str:
        """Return the digest of all rows so far, 64 hexadecimal digits."""
        return self._sha.hexdigest()


def digest_of(rows: Rows) -> str:
    """Return the digest of full rows."""
    digester = Digester()
    digester.update(rows)
    return digester.hexdigest()
