"""The window: the rectangle of a scene that every picture of a run shows, be it a movie, a page or a figure."""

from __future__ import annotations

import numpy as np

from eventsim.formulas.motion import position
from eventsim.record.events import Floats
from eventsim.replay.flight_table import FlightTable, flights
from eventsim.replay.motion import Motion
from eventsim.show.outlines import Rectangle, wall_lines

MARGIN = 0.02
"""Share of the larger side that is left free around hard boundaries and open scenes."""

FAR = 1.0
"""Disks that fly away after many contacts are followed by at most this share of what is seen besides, on each side."""

MANY = 4.0
"""Events of a disk from which on the flights between them are what a picture is of, and not the last ones."""


def window_of(motion: Motion, until: float | None = None) -> Rectangle:
    """Return what pictures of a run show: its domain; on the open plane walls and the flights of all disks.

    until: a time behind which nothing is looked at; None: the end of the log.
    """
    scene = motion.log.scene
    if scene.domain.size is not None:
        (x0, y0), (width, height) = scene.domain.origin, scene.domain.size
        margin = MARGIN * max(width, height)
        free = [0.0 if periodic else margin for periodic in scene.domain.periodic]
        return x0 - free[0], y0 - free[1], x0 + width + free[0], y0 + height + free[1]
    events, centres, last = 0, [scene.disks.position], None
    for table in flights(motion, until):
        if last is not None and len(last.disk):  # flights that events ended
            events, centres = events + len(last.disk), [*centres, ends_of(last)]
        last = table
    assert last is not None  # the flights that nothing ended
    reach = float(scene.disks.radius.max())
    places = np.concatenate([*wall_lines(scene), *(near + side * reach for near in centres for side in (-1, 1))])
    low, high = places.min(axis=0), places.max(axis=0)
    away, extent = ends_of(last), np.inf
    if events >= MANY * len(scene.disks):
        extent = FAR * (float((high - low).max()) or 1.0)
    low = np.maximum(np.minimum(low, away[0] - reach), low - extent)
    high = np.minimum(np.maximum(high, away[1] + reach), high + extent)
    margin = MARGIN * float((high - low).max() or 1.0)
    return float(low[0] - margin), float(low[1] - margin), float(high[0] + margin), float(high[1] + margin)


def ends_of(table: FlightTable) -> Floats:
    """Return the least and the largest coordinates (2, 2) of centres in some flights, the tops of parabolas included."""
    with np.errstate(divide="ignore", invalid="ignore"):
        turn = np.where(table.pull != 0.0, -table.velocity / table.pull, 0.0)
    end = np.broadcast_to(table.duration[:, None], turn.shape)
    lags = (np.zeros_like(turn), np.clip(turn, 0.0, end), end)
    places = np.concatenate([position(table.place, table.velocity, lag, table.pull) for lag in lags])
    return np.stack([places.min(axis=0), places.max(axis=0)])
