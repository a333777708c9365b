"""Free flights as one table: what trails, trajectories, displacements and free paths are made of."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from eventsim.record.events import Floats, Kind, Rows, State
from eventsim.replay.replay import Replay

PARABOLA_PIECES = 16
"""Straight pieces in which a whole flight under gravity is drawn."""

Indices: TypeAlias = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class FlightTable:
    """Free flights (F,), disk by disk, in the order of time.

    time: when it begins. duration: until the disk's next event or the end of the log. place, velocity: (F, 2) at its
    beginning. pull: (F, 2) acceleration. pair: whether it begins with a contact of two disks. first: whether it is its
    disk's first.
    """

    disk: Indices
    time: Floats
    duration: Floats
    place: Floats
    velocity: Floats
    pull: Floats
    pair: NDArray[np.bool_]
    first: NDArray[np.bool_]

    def pieces(self, parts: int = PARABOLA_PIECES) -> tuple[Floats, Floats, Indices]:
        """Return straight pieces: times (P, 2) and places (P, 2, 2) of their ends, not wrapped, and the disks (P,).

        parts: into how many a flight under gravity is cut.
        """
        parts = parts if self.pull.any() else 1
        share = np.linspace(0.0, 1.0, parts + 1)
        lag = self.duration[:, None] * share
        place = self.place[:, None] + lag[..., None] * (
            self.velocity[:, None] + 0.5 * lag[..., None] * self.pull[:, None]
        )
        time = self.time[:, None] + lag
        ends = np.stack([place[:, :-1], place[:, 1:]], axis=2).reshape(-1, 2, 2)
        return np.stack([time[:, :-1], time[:, 1:]], axis=2).reshape(-1, 2), ends, np.repeat(self.disk, parts)

    def of(self, disks: Indices) -> FlightTable:
        """Return the flights of some disks."""
        return self.at(np.flatnonzero(np.isin(self.disk, disks)))

    def at(self, places: Indices) -> FlightTable:
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
    disks = replay.log.scene.disks
    start, end = replay.span
    return flights_between(replay, State(start, disks.position, disks.velocity), replay.log.rows, end)


def flights_between(replay: Replay, start: State, rows: Rows, end: float) -> FlightTable:
    """Return the free flights that lead from a state through the rows after it to a time."""
    stage, n = replay.stage, replay.stage.n
    pair = rows["b"] >= 0
    row = np.concatenate([np.arange(len(rows)), np.flatnonzero(pair)])
    disk = np.concatenate([np.arange(n), rows["a"], rows["b"][pair]]).astype(np.int64)
    order = np.lexsort((np.concatenate([np.full(n, -1), row]), disk))
    disk = disk[order]
    kind = np.concatenate([np.full(n, -1), rows["kind"][row]])[order]
    wall = np.concatenate([np.full(n, -1), rows["wall"][row]])[order]

    def both(one: str, other: str) -> Floats:
        """Return a column of the rows for disk a of all, then for disk b of the pairs."""
        values: Floats = np.concatenate([rows[one], rows[other][pair]])
        return values

    place = np.column_stack([both("xa", "xb"), both("ya", "yb")]) + stage.corner
    velocity = np.column_stack([both("vxa", "vxb"), both("vya", "vyb")])
    time = np.concatenate([np.full(n, start.time), rows["time"][row]])[order]
    first = np.ones(len(disk), dtype=np.bool_)
    first[1:] = disk[1:] != disk[:-1]
    until = np.full(len(disk), end)
    until[:-1] = np.where(first[1:], end, time[1:])
    pull = np.zeros((len(disk), 2))
    if stage.gravity is not None:
        pull[np.isfinite(replay.log.scene.disks.mass)[disk]] = stage.gravity
        if stage.supports is not None:
            rests = (order >= n) & (kind == Kind.REST)
            pull[rests] = stage.slopes[wall[rests]]
            pull[order < n] = replay.acceleration_at(start.time)
    return FlightTable(
        disk=disk,
        time=time,
        duration=np.maximum(until - time, 0.0),  # logged times may step back by an ulp
        place=np.concatenate([start.position, place])[order],
        velocity=np.concatenate([start.velocity, velocity])[order],
        pull=pull,
        pair=kind == Kind.PAIR,
        first=first,
    )
