"""The digest of a log: one SHA-256 that two logs share exactly when they tell the same story.

Rows are hashed in chunks, and the hashes of the chunks in turn: so a checkpoint can carry a digest on, and a chunk can be
checked alone.
"""

from __future__ import annotations

import hashlib
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from eventsim.record.events import OFFSETS, ROW, SPIN_ROW, SPINS, Rows, has_spins

CHUNK = 1 << 16
"""Rows that are hashed together."""

INTEGERS = ("kind", "a", "b", "wall", "epoch")
PAIRS = {"xa": "place_a", "vxa": "velocity_a", "xb": "place_b", "vxb": "velocity_b"}
"""Two floats that lie side by side in rows and records are copied as one complex number: half the passes."""

RECORD = np.dtype(
    [(name, "<i8") for name in INTEGERS]
    + [("remainder", "<f8")]
    + [(name, "<c16") for name in ("place_a", "place_b", "velocity_a", "velocity_b")]
)
SPIN_RECORD = np.dtype([*((name, RECORD[name]) for name in RECORD.names or ()), *((name, "<f8") for name in SPINS)])
"""That of scenes with spin."""

FLOATS = ("remainder", *PAIRS.values())
PIECE = 1 << 11
"""Rows that are made records of at a time: these, and the rows, stay in a core's own cache."""

def _pairs_of(row: np.dtype[Any]) -> np.dtype[Any]:
    names, offsets = list(PAIRS.values()), [OFFSETS[first] for first in PAIRS]
    return np.dtype({"names": names, "formats": ["<c16"] * len(PAIRS), "offsets": offsets, "itemsize": row.itemsize})


PAIRS_OF_ROWS = {row: _pairs_of(row) for row in (ROW, SPIN_ROW)}

Records = NDArray[np.void]


class Progress(NamedTuple):
    """How far a digest has come: the hashes of whole chunks, one behind the other, and the records (n,) of the chunk begun."""

    chunks: bytes
    records: Records


class Chunked:
    """A running digest of records: SHA-256 over the SHA-256 of each chunk; the cut into blocks does not matter."""

    def __init__(self, record: np.dtype[Any]) -> None:
        self._records = np.empty(CHUNK, dtype=record)
        self._sha = hashlib.sha256()
        self._filled = 0
        self._chunks = bytearray()

    def next_records(self, most: int) -> Records:
        """Return room for at most so many records, to be filled and then `add`ed."""
        return self._records[self._filled : min(self._filled + most, CHUNK)]

    def add(self, records: Records) -> None:
        """Take the records that lie in the room."""
        self._sha.update(records.view(np.uint8).data)
        self._filled += len(records)
        if self._filled == CHUNK:
            self._chunks += self._sha.digest()
            self._sha, self._filled = hashlib.sha256(), 0

    def progress(self) -> Progress:
        """Return how far it has come."""
        return Progress(bytes(self._chunks), self._records[: self._filled].copy())

    def go_on(self, progress: Progress) -> None:
        """Go on from there."""
        self._chunks, self._sha, self._filled = bytearray(progress.chunks), hashlib.sha256(), 0
        room = self.next_records(len(progress.records))
        room[:] = progress.records
        self.add(room)

    def hexdigest(self) -> str:
        """Return the digest of all so far, 64 hexadecimal digits."""
        begun = self._sha.digest() if self._filled else b""
        return hashlib.sha256(bytes(self._chunks) + begun).hexdigest()


class Digester:
    """The running digest of what rows tell, in order.

    Each row contributes the little-endian 64-bit values kind code, a, b, wall index, epoch, remainder, positions
    (xa, ya, xb, yb), velocities (vxa, vya, vxb, vyb), and, where disks have spin, spin_a and spin_b. -0.0 counts as 0.0 and
    there is one NaN, since neither sign nor payload of these is physics. Event number, time, impulse and joint are no part of it.
    """

    def __init__(self, spin: bool = False) -> None:
        """spin: whether disks have spin."""
        self._sum = Chunked(record_of(spin))
        self._spins = SPINS if spin else ()
        self._floats = (*FLOATS, *self._spins)
        self.progress, self.go_on, self.hexdigest = self._sum.progress, self._sum.go_on, self._sum.hexdigest

    def update(self, rows: Rows) -> None:
        """Add a block of full rows, in pieces."""
        first = 0
        while first < len(rows):
            records = self._sum.next_records(min(PIECE, len(rows) - first))
            piece = rows[first : first + len(records)]
            for name in INTEGERS:
                records[name] = piece[name]
            np.add(piece["remainder"], 0.0, out=records["remainder"])  # -0.0 + 0.0 is 0.0
            pairs = piece.view(PAIRS_OF_ROWS[piece.dtype])
            for name in PAIRS.values():
                np.add(pairs[name], 0.0, out=records[name])
            for name in self._spins:
                np.add(piece[name], 0.0, out=records[name])
            if any(np.isnan(records[name]).any() for name in self._floats):
                floats = records.view(np.float64).reshape(len(piece), -1)[:, len(INTEGERS) :]
                np.copyto(floats, np.nan, where=np.isnan(floats))
            self._sum.add(records)
            first += len(records)


class StoredDigester:
    """The running digest of rows as a file stores them: every column that it has, each as 64 bits; there is one NaN."""

    def __init__(self, columns: tuple[str, ...]) -> None:
        """columns: of the file, all or those of a compact log."""
        self._columns = columns
        self._floats = [name for name in columns if SPIN_ROW[name].kind == "f"]
        self._sum = Chunked(np.dtype([(name, "<f8" if name in self._floats else "<i8") for name in columns]))
        self.hexdigest = self._sum.hexdigest

    def update(self, rows: Rows) -> None:
        """Add a block of rows, in pieces."""
        first = 0
        while first < len(rows):
            records = self._sum.next_records(min(PIECE, len(rows) - first))
            piece = rows[first : first + len(records)]
            for name in self._columns:
                records[name] = piece[name]
            for name in self._floats:
                np.copyto(records[name], np.nan, where=np.isnan(records[name]))
            self._sum.add(records)
            first += len(records)


def record_of(spin: bool) -> np.dtype[Any]:
    """Return what a row contributes to a digest, of a scene with or without spin."""
    return SPIN_RECORD if spin else RECORD


def digest_of(rows: Rows) -> str:
    """Return the digest of full rows."""
    digester = Digester(has_spins(rows))
    digester.update(rows)
    return digester.hexdigest()
