"""The layout of what happened: kinds of events, rows of a log, and the state of all disks at one time."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray


class Kind(IntEnum):
    """What a row of the log records; the number is the code in arrays and in the digest."""

    PAIR = 0
    WALL = 1
    REST = 2
    KICK = 3

    @property
    def label(self) -> str:
        """The text that files show for this kind."""
        return self.name.lower()


LABELS = tuple(kind.label for kind in Kind)

ROW = np.dtype(
    [
        ("event", "<i8"),
        ("time", "<f8"),
        ("kind", "<i4"),
        ("a", "<i4"),
        ("b", "<i4"),
        ("wall", "<i4"),
        ("xa", "<f8"),
        ("ya", "<f8"),
        ("vxa", "<f8"),
        ("vya", "<f8"),
        ("xb", "<f8"),
        ("yb", "<f8"),
        ("vxb", "<f8"),
        ("vyb", "<f8"),
        ("impulse", "<f8"),
        ("joint", "<i8"),
        ("epoch", "<i8"),
        ("remainder", "<f8"),
    ]
)
"""One row per impulse; b, wall and joint are -1 and floats NaN where there is none.  128 bytes without gaps: two cache lines."""

COLUMNS: tuple[str, ...] = tuple(ROW.names or ())
OFFSETS = {name: int(field[1]) for name, field in (ROW.fields or {}).items()}
"""Where each column lies in a row, bytes."""

COMPACT_COLUMNS: tuple[str, ...] = ("event", "kind", "a", "b", "wall", "joint", "epoch", "remainder")
"""What a compact log keeps; replay computes the others."""

Rows: TypeAlias = NDArray[np.void]
Floats: TypeAlias = NDArray[np.float64]
Column: TypeAlias = NDArray[Any]


def blank_rows(count: int) -> Rows:
    """Return `count` rows in which everything is missing: zeros for event, epoch and kind, else -1 or NaN."""
    rows = np.zeros(count, dtype=ROW)
    for name in COLUMNS:
        if ROW[name].kind == "f":
            rows[name] = np.nan
    for name in ("b", "wall", "joint"):
        rows[name] = -1
    return rows


@dataclass(frozen=True, slots=True)
class State:
    """Where all disks are at one time.

    time: on the scene's clock. position, velocity: float64 arrays (N, 2) on the scene's axes, as in a scene file;
    along a period the position lies inside the domain.
    """

    time: float
    position: Floats
    velocity: Floats
