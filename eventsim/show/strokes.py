"""Strokes: trails behind disks and arrows of their velocities, each the lines of all disks in a single path."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator

import numpy as np
from matplotlib.path import Path

from eventsim.record.events import Floats, Rows
from eventsim.replay.flight_table import FlightTable, flights_between, flights_from
from eventsim.replay.motion import Motion
from eventsim.replay.passage import Moment
from eventsim.show.frames import MOST_RECENT, Frame
from eventsim.show.images import wrapped_pieces

HEAD = 0.3
"""Length of an arrow's head, a share of the arrow."""

SAG = 0.25
"""Pixels by which a straight piece of a trail may miss the parabola."""

FEWEST = 2
"""Pieces in which a way that needs so many is drawn even in a crowd that has room for less."""

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


def spokes(centre: Floats, angle: Floats, radius: Floats) -> Path:
    """Return lines from centres (N, 2) to the edges of disks at angles (N,) as one path."""
    tip = centre + radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    codes = np.tile(np.array([Path.MOVETO, Path.LINETO], dtype=np.uint8), len(centre))
    return Path(np.stack([centre, tip], axis=1).reshape(-1, 2), codes)


class Trails:
    """Where the disks have been in the last frames: through the places of all contacts, so corners are sharp."""

    def __init__(self, motion: Motion, frames: int, scale: float) -> None:
        """frames: how many of them a trail reaches back. scale: pixels per length of the scene."""
        self._scene, self._stage = motion.log.scene, motion.stage
        self._before: Moment | None = None
        self._longest, self._scale = max(frames, 1), scale
        self._pieces: deque[Floats] = deque(maxlen=self._longest)

    def follow(self, frame: Frame) -> Iterator[tuple[Path, float]]:
        """Add the way since the previous frame; yield the paths to draw, from the faintest on, each with its alpha.

        A first frame, and one with too many rows since the previous one, begins a new trail.
        """
        if frame.recent is None:
            self._pieces.clear()
        elif self._before is not None:
            self._pieces.append(self._pieces_between(self._before, frame.recent, frame.state.time))
            while sum(map(len, self._pieces)) > MOST_RECENT and len(self._pieces) > 1:
                self._pieces.popleft()
        self._before = frame.moment
        pieces = list(self._pieces)
        size = -(-self._longest // BANDS)
        for first in range(-(-len(pieces) % size), len(pieces), size):
            points = np.concatenate(pieces[max(first, 0) : first + size]).reshape(-1, 2)
            codes = np.tile(np.array([Path.MOVETO, Path.LINETO], dtype=np.uint8), len(points) // 2)
            age = len(pieces) - first - size
            yield Path(points, codes), STRONGEST * (1.0 - age / self._longest)

    def _pieces_between(self, before: Moment, rows: Rows, end: float) -> Floats:
        """Return the ways of all disks from one frame to the next as straight pieces (P, 2, 2), inside the domain."""
        table = flights_between(self._stage, flights_from(before.state, before.pull), rows, end)
        _, ends, disk = table.pieces(self._parts(table))
        return wrapped_pieces(ends, disk, self._scene.domain.period, self._scene.domain.origin)[0]

    def _parts(self, table: FlightTable) -> int:
        """Return into how many pieces flights are cut, that they look like parabolas and there is room for a whole trail."""
        pieces = table.duration * np.sqrt(np.hypot(*table.pull.T) * self._scale / (8.0 * SAG))  # one sags by g t^2 / 8
        needed = np.ceil(pieces.max(initial=0.0))
        room = MOST_RECENT // (self._longest * max(len(table.disk), 1))
        return int(max(min(needed, max(room, FEWEST)), 1))
