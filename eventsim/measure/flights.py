"""Free flights from blocks of rows: each disk followed from contact to contact, many at a time, in memory O(disks + block).

A block's rows are sorted by disk; a flight then goes from one entry of a disk to its next, and the first from where the
last block left the disk.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from eventsim.record.events import Column, Floats, Kind, Rows
from eventsim.scene.stage import Stage


@dataclass(frozen=True, slots=True)
class Flights:
    """Free flights (F,), disk by disk.

    row: the row that ends it, or -1 where none does.  end: time since the start.  duration: time.  before: (F, 2) velocity at
    its end.  begun: (F, 2) velocity at its beginning.  after: (F, 2) velocity after the row.  way: (F, 2) displacement.
    wall: on which the disk rests in it, or -1; None where the scene knows no rest.
    """

    disk: Column
    row: Column
    wall: Column | None
    end: Floats
    duration: Floats
    begun: Floats
    before: Floats
    after: Floats
    way: Floats

    def take(self, chosen: Column) -> Flights:
        """Some of the flights."""
        columns: list[Any] = [getattr(self, name) for name in self.__slots__]
        parts: list[Any] = [None if column is None else column[chosen] for column in columns]
        return Flights(*parts)


class Follower:
    """Where every disk's present flight began: time, velocity (N, 2), and how far it had come by then (N, 2).

    pull: (N, 2) gravity in free flight; None without.  wall: (N,) on which a disk rests, or -1; None in a scene without rest.
    slopes: (walls, 2) the acceleration of a disk that rests on a wall.
    """

    def __init__(self, stage: Stage) -> None:
        n = stage.n
        self.time = np.zeros(n)
        self.velocity = np.column_stack([stage.vx, stage.vy])
        self.way = np.zeros((n, 2))
        self.pull: Floats | None = None
        if stage.gravity is not None:
            falls = np.ones(n) if stage.mass is None else np.isfinite(stage.mass)
            self.pull = falls[:, None] * np.array(stage.gravity)
        self.wall: Column | None = None if stage.supports is None else np.full(n, -1)
        self.slopes = stage.slopes

    def follow(self, rows: Rows, time: Floats, samples: Floats, watched: Column) -> tuple[Flights, Floats, Floats]:
        """The flights that rows end, and displacement and velocity (S, W, 2) of watched disks (W,) at times (S,).

        time: (R,) of the rows since the start, ascending; samples: (S,) ascending, not after the last row.
        """
        count = len(rows)
        pairs = np.flatnonzero(rows["b"] >= 0)
        width = count + 1
        row_a, row_b = np.arange(1, width), pairs + 1
        keys = np.concatenate(
            [rows["a"].astype(np.int64) * width + row_a, rows["b"][pairs].astype(np.int64) * width + row_b]
        )
        keys.sort()
        disk, row = np.divmod(keys, width)
        row -= 1
        first = np.ones(len(keys), dtype=np.bool_)
        first[1:] = disk[1:] != disk[:-1]
        mine = rows["a"][row] == disk
        after = np.column_stack([np.where(mine, rows[f"{v}a"][row], rows[f"{v}b"][row]) for v in ("vx", "vy")])
        end = time[row]
        onto = None
        if self.wall is not None:
            onto = np.where(rows["kind"][row] == Kind.REST, rows["wall"][row].astype(np.int64), -1)
        flights = self._flights(disk, row, end, after, onto, first)
        # displacement at the end of each flight, counted from the start
        gone = np.cumsum(flights.way, axis=0)
        heads = np.flatnonzero(first)
        sizes = np.diff(np.append(heads, len(keys)))
        base = self.way[disk[heads]] - (gone[heads] - flights.way[heads])
        gone += np.repeat(base, sizes, axis=0)
        seen = self._sampled(keys, width, time, end, after, onto, gone, samples, watched)
        tails = heads + sizes - 1
        last = disk[tails]
        self.time[last], self.velocity[last], self.way[last] = end[tails], after[tails], gone[tails]
        if self.wall is not None and onto is not None:
            self.wall[last] = onto[tails]
        return flights, *seen

    def rest(self, until: float, samples: Floats, watched: Column) -> tuple[Flights, Floats, Floats]:
        """The flights that are under way at the end of the run, all disks; and the samples of `follow`."""
        n = len(self.time)
        end = np.maximum(self.time, until)
        everyone = np.arange(n)
        none = np.full(n, -1)
        nothing, nowhere = np.empty(0), np.empty((0, 2))
        seen = self._sampled(np.empty(0, np.int64), 1, nothing, nothing, nowhere, self.wall, nowhere, samples, watched)
        flights = self._flights(everyone, none, end, self.velocity, self.wall, np.ones(n, dtype=np.bool_))
        self.way += flights.way
        self.time = end
        return flights, *seen

    def _flights(
        self, disk: Column, row: Column, end: Floats, after: Floats, onto: Column | None, first: Column
    ) -> Flights:
        """The flights that rows end; onto: the wall on which a disk rests after its row, or -1."""
        start = np.empty_like(end)
        start[1:] = end[:-1]
        begun = np.empty_like(after)
        begun[1:] = after[:-1]
        start[first], begun[first] = self.time[disk[first]], self.velocity[disk[first]]
        wall: Column | None = None
        if self.wall is not None and onto is not None:
            wall = np.empty_like(onto)
            wall[1:] = onto[:-1]
            wall[first] = self.wall[disk[first]]
        duration = np.maximum(end - start, 0.0)
        lag = duration[:, None]
        if self.pull is None:
            before, way = begun, begun * lag
        else:
            pull = self._acceleration(self.pull, disk, wall)
            before, way = begun + pull * lag, lag * (begun + 0.5 * lag * pull)
        return Flights(disk, row, wall, end, duration, begun, before, after, way)

    def _acceleration(self, pull: Floats, disk: Column, wall: Column | None) -> Floats:
        """(..., 2) of disks in flights, free or along the walls that they rest on."""
        if wall is None:
            return pull[disk]
        return np.where((wall >= 0)[..., None], self.slopes[wall], pull[disk])

    def _sampled(
        self,
        keys: Column,
        width: int,
        time: Floats,
        end: Floats,
        after: Floats,
        onto: Column | None,
        gone: Floats,
        samples: Floats,
        watched: Column,
    ) -> tuple[Floats, Floats]:
        """Displacement and velocity (S, W, 2) at sample times, from the entry of each disk that is the last before it."""
        reached = np.searchsorted(time, samples, side="right")
        query = watched * width + reached[:, None]
        place = np.searchsorted(keys, query, side="right") - 1
        disk = np.broadcast_to(watched, query.shape)
        wall = None if self.wall is None else self.wall[disk]
        if len(keys):
            inside = (place >= 0) & (keys[place] >= disk * width)
            anchor = np.where(inside, end[place], self.time[disk])
            velocity = np.where(inside[..., None], after[place], self.velocity[disk])
            way = np.where(inside[..., None], gone[place], self.way[disk])
            if wall is not None and onto is not None:
                wall = np.where(inside, onto[place], wall)
        else:
            anchor, velocity, way = self.time[disk], self.velocity[disk], self.way[disk]
        lag = (samples[:, None] - anchor)[..., None]
        if self.pull is None:
            return way + velocity * lag, velocity
        pull = self._acceleration(self.pull, disk, wall)
        return way + lag * (velocity + 0.5 * lag * pull), velocity + lag * pull
