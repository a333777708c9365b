"""Free flights from blocks of rows: each disk followed from contact to contact, many at a time, in memory O(disks + block).

A block's rows are sorted by disk; a flight then goes from one entry of a disk to its next, and the first from where the
last block left the disk.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eventsim.record.events import Column, Floats, Rows
from eventsim.scene.scene import Scene


@dataclass(frozen=True, slots=True)
class Flights:
    """Free flights (F,), disk by disk.

    row: the row that ends it, or -1 where none does.  end: time since the start.  duration: time.  before: (F, 2) velocity at
    its end.  begun: (F, 2) velocity at its beginning.  after: (F, 2) velocity after the row.  way: (F, 2) displacement.
    """

    disk: Column
    row: Column
    end: Floats
    duration: Floats
    begun: Floats
    before: Floats
    after: Floats
    way: Floats


class Follower:
    """Where every disk's present flight began: time, velocity (N, 2), and how far it had come by then (N, 2)."""

    def __init__(self, scene: Scene) -> None:
        n = len(scene.disks)
        self.time = np.zeros(n)
        self.velocity = scene.disks.velocity.copy()
        self.way = np.zeros((n, 2))
        self.pull: Floats | None = None
        if scene.gravity is not None:
            falls = np.isfinite(scene.disks.mass)
            self.pull = falls[:, None] * np.array(scene.gravity)

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
        flights = self._flights(disk, row, end, after, first)
        # displacement at the end of each flight, counted from the start
        gone = np.cumsum(flights.way, axis=0)
        heads = np.flatnonzero(first)
        sizes = np.diff(np.append(heads, len(keys)))
        base = self.way[disk[heads]] - (gone[heads] - flights.way[heads])
        gone += np.repeat(base, sizes, axis=0)
        seen = self._sampled(keys, width, time, end, after, gone, samples, watched)
        tails = heads + sizes - 1
        last = disk[tails]
        self.time[last], self.velocity[last], self.way[last] = end[tails], after[tails], gone[tails]
        return flights, *seen

    def rest(self, until: float, samples: Floats, watched: Column) -> tuple[Flights, Floats, Floats]:
        """The flights that are under way at the end of the run, all disks; and the samples of `follow`."""
        n = len(self.time)
        end = np.maximum(self.time, until)
        everyone = np.arange(n)
        none = np.full(n, -1)
        seen = self._sampled(
            np.empty(0, np.int64), 1, np.empty(0), np.empty(0), np.empty((0, 2)), np.empty((0, 2)), samples, watched
        )
        flights = self._flights(everyone, none, end, self.velocity, np.ones(n, dtype=np.bool_))
        self.way += flights.way
        self.time = end
        return flights, *seen

    def _flights(self, disk: Column, row: Column, end: Floats, after: Floats, first: Column) -> Flights:
        start = np.empty_like(end)
        start[1:] = end[:-1]
        begun = np.empty_like(after)
        begun[1:] = after[:-1]
        start[first], begun[first] = self.time[disk[first]], self.velocity[disk[first]]
        duration = np.maximum(end - start, 0.0)
        lag = duration[:, None]
        if self.pull is None:
            before, way = begun, begun * lag
        else:
            pull = self.pull[disk]
            before, way = begun + pull * lag, lag * (begun + 0.5 * lag * pull)
        return Flights(disk, row, end, duration, begun, before, after, way)

    def _sampled(
        self,
        keys: Column,
        width: int,
        time: Floats,
        end: Floats,
        after: Floats,
        gone: Floats,
        samples: Floats,
        watched: Column,
    ) -> tuple[Floats, Floats]:
        """Displacement and velocity (S, W, 2) at sample times, from the entry of each disk that is the last before it."""
        reached = np.searchsorted(time, samples, side="right")
        query = watched * width + reached[:, None]
        place = np.searchsorted(keys, query, side="right") - 1
        disk = np.broadcast_to(watched, query.shape)
        if len(keys):
            inside = (place >= 0) & (keys[place] >= disk * width)
            anchor = np.where(inside, end[place], self.time[disk])
            velocity = np.where(inside[..., None], after[place], self.velocity[disk])
            way = np.where(inside[..., None], gone[place], self.way[disk])
        else:
            anchor, velocity, way = self.time[disk], self.velocity[disk], self.way[disk]
        lag = (samples[:, None] - anchor)[..., None]
        if self.pull is None:
            return way + velocity * lag, velocity
        pull = self.pull[disk]
        return way + lag * (velocity + 0.5 * lag * pull), velocity + lag * pull
