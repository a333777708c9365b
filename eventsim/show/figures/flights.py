"""The free flights of a log as one table: what trajectories, displacements and free paths are made of."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eventsim.errors import LogError
from eventsim.record.events import Floats, Kind
from eventsim.record.log import EventLog
from eventsim.record.replay import Replay
from eventsim.show.strokes import contact_places

PARABOLA_PIECES = 16
"""Straight pieces in which a flight under gravity is drawn."""


@dataclass(frozen=True, slots=True)
class FlightTable:
    """Free flights (F,), disk by disk, in the order of time.

    time: when it begins. duration: until the disk's next event or the end of the log. place, velocity: (F, 2) at its
    beginning. pull: (F, 2) acceleration. pair: whether it begins with a contact of two disks. first: whether it is its
    disk's first.
    """

    disk: NDArray[np.int64]
    time: Floats
    duration: Floats
    place: Floats
    velocity: Floats
    pull: Floats
    pair: NDArray[np.bool_]
    first: NDArray[np.bool_]

    def pieces(self) -> tuple[Floats, Floats]:
        """Return times (P, 2) and places (P, 2, 2) of both ends of straight pieces, not wrapped around the domain."""
        parts = PARABOLA_PIECES if self.pull.any() else 1
        share = np.linspace(0.0, 1.0, parts + 1)
        lag = self.duration[:, None] * share
        place = self.place[:, None] + lag[..., None] * (
            self.velocity[:, None] + 0.5 * lag[..., None] * self.pull[:, None]
        )
        time = self.time[:, None] + lag
        ends = np.stack([place[:, :-1], place[:, 1:]], axis=2).reshape(-1, 2, 2)
        return np.stack([time[:, :-1], time[:, 1:]], axis=2).reshape(-1, 2), ends

    def of(self, disks: NDArray[np.int64]) -> FlightTable:
        """Return the flights of some disks."""
        return self.at(np.flatnonzero(np.isin(self.disk, disks)))

    def at(self, places: NDArray[np.int64]) -> FlightTable:
        """Return the flights at some places of the table."""
        return FlightTable(*(getattr(self, name)[places] for name in self.__slots__))

    def lengths(self) -> Floats:
        """Return the length of each flight (F,); under gravity by Simpson's rule for the speed."""
        lag = self.duration[:, None]
        speeds = [np.hypot(*(self.velocity + share * lag * self.pull).T) for share in (0.0, 0.5, 1.0)]
        lengths: Floats = self.duration * (speeds[0] + 4.0 * speeds[1] + speeds[2]) / 6.0
        return lengths


def flight_table(replay: Replay) -> FlightTable:
    """Return all free flights of a log."""
    log, stage, disks = replay.log, replay.stage, replay.log.scene.disks
    start, end = replay.span
    rows = log.rows
    disk, place = contact_places(rows, stage.corner)
    pair = rows["b"] >= 0
    row = np.sort(np.concatenate([np.arange(len(rows)), np.flatnonzero(pair)]))
    is_b = np.zeros(len(row), dtype=np.bool_)
    is_b[1:] = row[1:] == row[:-1]
    velocity = np.column_stack(
        [np.where(is_b, rows[f"{name}b"][row], rows[f"{name}a"][row]) for name in ("vx", "vy")]
    )
    n = stage.n
    all_disks = np.concatenate([np.arange(n), disk])
    order = np.argsort(all_disks, kind="stable")
    all_disks = all_disks[order]
    time = np.concatenate([np.full(n, start), rows["time"][row]])[order]
    first = np.ones(len(order), dtype=np.bool_)
    first[1:] = all_disks[1:] != all_disks[:-1]
    until = np.full(len(order), end)
    until[:-1] = np.where(first[1:], end, time[1:])
    pull = np.zeros((len(order), 2))
    if stage.gravity is not None:
        pull[np.isfinite(disks.mass)[all_disks]] = stage.gravity
    return FlightTable(
        disk=all_disks,
        time=time,
        duration=np.maximum(until - time, 0.0),
        place=np.concatenate([disks.position, place])[order],
        velocity=np.concatenate([disks.velocity, velocity])[order],
        pull=pull,
        pair=np.concatenate([np.zeros(n, dtype=np.bool_), rows["kind"][row] == Kind.PAIR])[order],
        first=first,
    )


def replay_with_time(log: EventLog) -> Replay:
    """Return the replay of a log; raise LogError where no time passes in it."""
    replay = Replay(log)
    start, end = replay.span
    if start == end:
        raise LogError(f"there is nothing to draw: the log ends where it begins, at {start!r}")
    return replay


def with_events(log: EventLog, kind: Kind | None = None) -> None:
    """Raise LogError where a log has no events (of a kind)."""
    if len(log) == 0:
        raise LogError("there is nothing to draw: the log has no events")
    if kind is not None and not (log.kind == kind).any():
        raise LogError(f"there is nothing to draw: the log has no {kind.label} contacts")
