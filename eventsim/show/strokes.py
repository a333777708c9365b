"""Strokes: trails behind disks and arrows of their velocities, each the lines of all disks in a single path."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator

import numpy as np
from matplotlib.path import Path
from numpy.typing import NDArray

from eventsim.record.events import Floats, Rows, State
from eventsim.record.replay import Replay
from eventsim.show.frames import Frame

HEAD = 0.3
"""Length of an arrow's head, a share of the arrow."""

BANDS, STRONGEST = 12, 0.85
"""Shades in which a trail fades, and the opacity of the newest."""


def arrows(tail: Floats, along: Floats) -> Path:
    """Return arrows from `tail` (N, 2) along `along` (N, 2) as one path."""
    tip = tail + along
    beside = np.column_stack([-along[:, 1], along[:, 0]])
    left, right = tip - HEAD * (along - 0.5 * beside), tip - HEAD * (along + 0.5 * beside)
    points = np.stack([tail, tip, left, tip, right], axis=1).reshape(-1, 2)
    codes = np.tile(
        np.array([Path.MOVETO, Path.LINETO, Path.MOVETO, Path.LINETO, Path.LINETO], dtype=np.uint8), len(tail)
    )
    return Path(points, codes)


class Trails:
    """Where the disks have been in the last frames: through the places of all contacts, so corners are sharp."""

    def __init__(self, replay: Replay, frames: int) -> None:
        """frames: how many of them a trail reaches back."""
        self._replay = replay
        self._before: State | None = None
        self._longest = max(frames, 1)
        self._pieces: deque[tuple[Floats, NDArray[np.uint8]]] = deque(maxlen=self._longest)

    def follow(self, frame: Frame) -> Iterator[tuple[Path, float]]:
        """Add the way since the previous frame; yield the paths to draw, from the faintest on, each with its alpha.

        A frame before the previous one begins a new trail.
        """
        if self._before is not None and self._before.time > frame.state.time:
            self._pieces.clear()
        elif self._before is not None:
            self._pieces.append(self._piece(self._before.position, frame))
        self._before = frame.state
        pieces = list(self._pieces)
        size = -(-self._longest // BANDS)
        for first in range(len(pieces) % size - size if len(pieces) % size else 0, len(pieces), size):
            points, codes = zip(*pieces[max(first, 0) : first + size], strict=True)
            age = len(pieces) - first - size
            yield Path(np.concatenate(points), np.concatenate(codes)), STRONGEST * (1.0 - age / self._longest)

    def _piece(self, before: Floats, frame: Frame) -> tuple[Floats, NDArray[np.uint8]]:
        """Return the ways of all disks through one frame: points, and codes that begin a new line where a disk does."""
        n = len(before)
        disk, place = contact_places(frame.recent, self._replay.stage.corner)
        disks = np.concatenate([np.arange(n), disk, np.arange(n)])
        points = np.concatenate([before, place, frame.state.position])
        order = np.argsort(disks, kind="stable")
        disks, points = disks[order], points[order]
        begins = np.ones(len(disks), dtype=np.bool_)
        begins[1:] = disks[1:] != disks[:-1]
        for axis, length in enumerate(self._replay.stage.period):
            if length is not None:  # a way across a periodic boundary goes on at the other side
                begins[1:] |= np.abs(points[1:, axis] - points[:-1, axis]) > 0.5 * length
        return points, np.where(begins, Path.MOVETO, Path.LINETO).astype(np.uint8)


def contact_places(rows: Rows, corner: tuple[float, float]) -> tuple[NDArray[np.int64], Floats]:
    """Return the disks (K,) of rows and where their centres were (K, 2) on the scene's axes, in the order of the rows."""
    pair = rows["b"] >= 0
    row = np.concatenate([np.arange(len(rows)), np.flatnonzero(pair)])
    disk = np.concatenate([rows["a"], rows["b"][pair]]).astype(np.int64)
    x = np.concatenate([rows["xa"], rows["xb"][pair]])
    y = np.concatenate([rows["ya"], rows["yb"][pair]])
    order = np.argsort(row, kind="stable")
    return disk[order], np.column_stack([x, y])[order] + corner
