"""Free flights as one table: what trails, trajectories, displacements and free paths are made of."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from eventsim.formulas.motion import position, velocity
from eventsim.record.events import Floats, Kind, Rows, State
from eventsim.replay.flight import start_flights
from eventsim.replay.motion import Motion, pull_of
from eventsim.scene.stage import Stage

PARABOLA_PIECES = 16
"""Straight pieces in which a whole flight under gravity is drawn."""

Indices: TypeAlias = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class FlightTable:
    """Free flights (F,), disk by disk, in the order of time.

    time: when it begins. duration: until the disk's next event or the end of the log. place, velocity: (F, 2) at its
    beginning. pull: (F, 2) acceleration. pair: whether it begins with a contact of two disks; deflected: and the other one
    has mass. first: whether it is its disk's first.
    """

    disk: Indices
    time: Floats
    duration: Floats
    place: Floats
    velocity: Floats
    pull: Floats
    pair: NDArray[np.bool_]
    deflected: NDArray[np.bool_]
    first: NDArray[np.bool_]

    def pieces(self, parts: int = PARABOLA_PIECES) -> tuple[Floats, Floats, Indices]:
        """Return straight pieces: times (P, 2) and places (P, 2, 2) of their ends, not wrapped, and the disks (P,).

        parts: into how many a flight under gravity is cut.
        """
        parts = parts if self.pull.any() else 1
        share = np.linspace(0.0, 1.0, parts + 1)
        lag = self.duration[:, None] * share
        place = position(self.place[:, None], self.velocity[:, None], lag[..., None], self.pull[:, None])
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
        speeds = [np.hypot(*velocity(self.velocity, share * lag, self.pull).T) for share in (0.0, 0.5, 1.0)]
        lengths: Floats = self.duration * (speeds[0] + 4.0 * speeds[1] + speeds[2]) / 6.0
        return lengths


def flight_table(motion: Motion) -> FlightTable:
    """Return all free flights of a log."""
    return together(list(flights(motion)))


def flights(motion: Motion, until: float | None = None) -> Iterator[FlightTable]:
    """Yield the free flights of a log as they end, those of a block of rows together, and last those that nothing ended.

    until: a time behind which nothing is told; None: the end of the log.
    """
    end = motion.span[1] if until is None else until
    flown = starting(motion)
    flown = replace(flown, duration=np.maximum(end - flown.time, 0.0))  # a log without rows ends them all
    with closing(motion.log.blocks()) as blocks:
        for rows in blocks:
            told = rows if until is None else rows[rows["time"] <= until]
            table, last = _followed(motion.stage, flown, told, end)
            flown = table.at(np.flatnonzero(last))
            yield table.at(np.flatnonzero(~last))
            if len(told) < len(rows):
                break
    yield flown


def starting(motion: Motion) -> FlightTable:
    """Return the flights that disks begin with."""
    stage, disks = motion.stage, motion.log.scene.disks
    pull = pull_of(start_flights(stage), stage.n)
    return flights_from(State(stage.start_time, disks.position, disks.velocity), pull)


def flights_from(start: State, pull: Floats) -> FlightTable:
    """Return flights of all disks that begin in a state, and have not lasted yet; pull: (n, 2), what gravity does to them."""
    n = len(pull)
    never, every = np.zeros(n, np.bool_), np.ones(n, np.bool_)
    time = np.full(n, start.time)
    return FlightTable(np.arange(n), time, np.zeros(n), start.position, start.velocity, pull, never, never, every)


def flights_between(stage: Stage, flown: FlightTable, rows: Rows, end: float) -> FlightTable:
    """Return the free flights that lead from those of all disks through the rows after them to a time."""
    return _followed(stage, flown, rows, end)[0]


def _followed(stage: Stage, flown: FlightTable, rows: Rows, end: float) -> tuple[FlightTable, NDArray[np.bool_]]:
    """The same, and which flight is the last of its disk."""
    table = together([flown, _begun(stage, rows)])
    last = np.diff(table.disk, append=-1) != 0
    until = np.full(len(last), end)
    until[:-1] = np.where(last[:-1], end, table.time[1:])
    return replace(table, duration=np.maximum(until - table.time, 0.0)), last  # logged times may step back by an ulp


def _begun(stage: Stage, rows: Rows) -> FlightTable:
    """The flights that rows begin, disk by disk, and have not lasted yet."""
    pair = rows["b"] >= 0
    row = np.concatenate([np.arange(len(rows)), np.flatnonzero(pair)])
    disk = np.concatenate([rows["a"], rows["b"][pair]]).astype(np.int64)
    order = np.lexsort((row, disk))
    row, disk = row[order], disk[order]

    def both(one: str, other: str) -> Floats:
        """Return a column of the rows for disk a of all, then for disk b of the pairs."""
        values: Floats = np.concatenate([rows[one], rows[other][pair]])[order]
        return values

    pull = np.zeros((len(disk), 2))
    if stage.gravity is not None:
        pull[:] = pull_of(start_flights(stage), stage.n)[disk]
        if stage.supports is not None:
            rests = rows["kind"][row] == Kind.REST
            pull[rests] = stage.slopes[rows["wall"][row[rests]]]
    met = rows["kind"][row] == Kind.PAIR
    other = np.where(met, both("b", "a").astype(np.int64), disk)
    return FlightTable(
        disk=disk,
        time=rows["time"][row],
        duration=np.zeros(len(disk)),
        place=np.column_stack([both("xa", "xb"), both("ya", "yb")]) + stage.corner,
        velocity=np.column_stack([both("vxa", "vxb"), both("vya", "vyb")]),
        pull=pull,
        pair=met,
        deflected=met if stage.mass is None else met & (stage.mass[other] > 0.0),
        first=np.zeros(len(disk), np.bool_),
    )


def together(tables: Sequence[FlightTable]) -> FlightTable:
    """Return the flights of tables, of which the later ones follow the earlier ones, as one table."""
    order = np.argsort(np.concatenate([table.disk for table in tables]), kind="stable")
    names = FlightTable.__slots__
    return FlightTable(*(np.concatenate([getattr(table, name) for table in tables])[order] for name in names))
