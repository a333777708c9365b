"""From the columns of a file to checked rows: labels become codes, and what cannot be a log is refused."""

from __future__ import annotations

import warnings
from collections.abc import Generator, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np

from eventsim.errors import LogError, LogWarning
from eventsim.reading import as_floats
from eventsim.record.digest import StoredDigester
from eventsim.record.events import FIELDS, LABELS, SPIN_ROW, Column, Kind, Rows, blank_rows, columns_of
from eventsim.record.provenance import UNCHECKED, Provenance, columns_kept, has_spin

BLOCK = 1 << 12
"""Rows that are filled in, or looked at, at a time: they stay in a core's own cache."""


def labels_of(name: str, wall_names: Sequence[str]) -> Column | None:
    """Return the texts that a column of codes stands for (the last one for the code -1), or None for numbers."""
    if not FIELDS[name].labelled:
        return None
    return np.array(LABELS) if name == "kind" else np.array([*wall_names, ""])


def rows_from_columns(columns: Mapping[str, Sequence[object] | Column], provenance: Provenance) -> Rows:
    """Return rows (n,) from equally long columns, kind and wall as text, a missing float as NaN or None.

    Raises ValueError, TypeError, OverflowError or KeyError for what does not fit its column.
    """
    values = {name: _values(columns[name], name, provenance) for name in columns_kept(provenance)}
    spin = has_spin(provenance.scene)
    missing = blank_rows(1, spin)
    rows = np.empty(len(columns["event"]), missing.dtype)
    for first in range(0, len(rows), BLOCK):
        block = rows[first : first + BLOCK]
        for name in columns_of(spin):
            block[name] = values[name][first : first + BLOCK] if name in values else missing[name][0]
    return rows


def _values(column: Sequence[object] | Column, name: str, provenance: Provenance) -> Column:
    labels = labels_of(name, provenance.wall_names)
    if labels is not None:
        return codes_of(np.asarray(column, dtype=np.str_), labels, name)
    return as_floats(column) if SPIN_ROW[name].kind == "f" else integers_of(column, SPIN_ROW[name])


def codes_of(texts: Column, labels: Column, name: str) -> Column:
    """Return for each text its place among the labels, -1 for an empty one; ValueError for an unknown text."""
    order = np.argsort(labels)
    place = np.searchsorted(labels, texts, sorter=order)
    codes = order[np.minimum(place, len(labels) - 1)]
    unknown = labels[codes] != texts
    if unknown.any():
        raise ValueError(f"{name} {str(texts[np.argmax(unknown)])!r} is unknown")
    codes[texts == ""] = -1
    return codes


def integers_of(values: Sequence[object] | Column, dtype: np.dtype[Any]) -> Column:
    """Return integers of the wanted width; ValueError for fractions, texts and numbers that are too large."""
    exact = np.asarray(values)
    if exact.dtype.kind not in "iu":
        raise ValueError("a whole number was expected")
    narrow = exact.astype(dtype, copy=False)
    if (narrow != exact).any():
        raise ValueError("a whole number is too large")
    return narrow


def checked(provenance: Provenance, blocks: Generator[Rows], path: Path) -> Generator[Rows]:
    """Yield rows block by block if they can be those of their scene.

    Raises:
        LogError: naming the file and the first bad row, or how many rows are missing in the end.
    """
    count = epoch = 0
    with closing(blocks):
        for rows in blocks:
            for first in range(0, len(rows), BLOCK):
                block = rows[first : first + BLOCK]
                for rule, broken in _rules(block, count + first, epoch, provenance).items():
                    if broken.any():
                        raise LogError(f"{path}: row {count + first + int(np.argmax(broken))}: {rule}")
                epoch = block["epoch"][-1]
            count += len(rows)
            yield rows
    if provenance.rows not in (None, count):
        raise LogError(f"{path}: holds {count} rows where {provenance.rows} were written; the file was cut off")


def verified(provenance: Provenance, blocks: Generator[Rows], path: Path) -> Generator[Rows]:
    """Yield rows block by block; warn (LogWarning) after the last one where they are not as the run stored them.

    Also where nothing vouches for their scene, as in format 1, or for rows of a log that was not closed.
    """
    if provenance.bits == 1:
        warnings.warn(f"{path}: {UNCHECKED}", LogWarning, stacklevel=2)
    stored = None if provenance.ending is None else provenance.ending.stored
    digester = StoredDigester(columns_kept(provenance))
    with closing(blocks):
        for rows in blocks:
            if stored is not None:
                digester.update(rows)
            yield rows
    if provenance.ending is None:
        warnings.warn(f"{path}: was not closed, so nothing tells whether its rows were changed", LogWarning, stacklevel=2)
    if stored not in (None, digester.hexdigest()):
        words = f"{path} is not what its run wrote: its rows have another digest than the one it was closed with"
        warnings.warn(words, LogWarning, stacklevel=2)


def _rules(rows: Rows, first: int, epoch: int, provenance: Provenance) -> dict[str, Column]:
    """What rows (n,) may not be, and which are; the one before them is row `first` - 1, of that epoch."""
    count, walls = len(provenance.scene.disks), len(provenance.wall_names)
    has_wall = (rows["kind"] == Kind.WALL) | (rows["kind"] == Kind.REST)
    clock = rows["epoch"], rows["remainder"]
    return {
        "events are not numbered 0, 1, 2, ...": rows["event"] != np.arange(first, first + len(rows)),
        f"column a names no disk of the scene (0 to {count - 1})": (rows["a"] < 0) | (rows["a"] >= count),
        f"column b names no disk of the scene (0 to {count - 1})": (rows["b"] < -1) | (rows["b"] >= count),
        "kind is none of a log": (rows["kind"] < 0) | (rows["kind"] >= len(LABELS)),
        "wall is none of the scene": (rows["wall"] < -1) | (rows["wall"] >= walls),
        "a pair needs a second disk and only a pair has one": (rows["b"] >= 0) != (rows["kind"] == 0),
        "a pair needs two different disks": rows["a"] == rows["b"],
        "a contact with a wall needs its name and only such a contact has one": (rows["wall"] >= 0) != has_wall,
        "joint is neither -1 nor an earlier event": (rows["joint"] < -1) | (rows["joint"] > rows["event"]),
        "the remainder is not a time >= 0": ~((clock[1] >= 0) & np.isfinite(clock[1])),
        "the epoch runs backwards": np.diff(clock[0], prepend=epoch) < 0,
    }
