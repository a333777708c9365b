"""What changes, as arrays: the records of all disks, seen from Python by their numbers in the scene."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from eventsim.engines.base import Snapshot
from eventsim.engines.exact_state import ExactState, Met
from eventsim.engines.fast.columns import (
    AccelerationColumn,
    Column,
    CountColumn,
    Integers,
    MetColumn,
    SidesColumn,
    aligned,
)
from eventsim.engines.fast.layout import (
    AT_ONCE,
    CONTACT_TIME,
    COUNT,
    FIRST_LEVEL,
    FLAGS,
    IMMOVABLE,
    LABEL,
    MET,
    MOST_DISKS,
    NOBODY,
    RADIUS,
    REALS,
    RESTING,
    SEVERAL,
    TRACER,
    VX,
    VY,
    WAITING,
    WINDOW_ROWS,
    WORDS,
    WRAPS_X,
    WRAPS_Y,
    T,
    X,
    Y,
)
from eventsim.engines.fast.plan import days_of
from eventsim.engines.turnover import Anchors
from eventsim.errors import EventsimError
from eventsim.formulas.clock import FIRST_WINDOW
from eventsim.record.events import Floats
from eventsim.scene.sides import Sides
from eventsim.scene.stage import Stage

COLUMNS = ("t", "x", "y", "vx", "vy", "wraps_x", "wraps_y", "contact_time", "at_once")
"""What a snapshot has one number of for every disk."""

LOW_COLUMNS = ("low_vx", "low_vy")
"""The same, where velocities have low parts."""


class FastState(ExactState):
    """The flights of n disks in records, with the reference engine's names for what is in them.

    memory: the records, and the calendar's buckets behind them.
    disks: (n + 1, REALS), the last one a sentinel.  words: the same memory as int32.  place_of: where a disk is in memory;
    labels: which disk is at a place.  several: chains of whom disks met in joint contacts.  low: low parts of velocities, (n, 2),
    or (0, 2) where there are none.  turning: spins and moments, (n, 2) by place; None where disks have no spin.
    """

    x: Any
    y: Any
    vx: Any
    vy: Any
    t: Any
    contact_time: Any
    wraps_x: Any
    wraps_y: Any
    at_once: Any
    low_vx: Any
    low_vy: Any
    count: Any
    met: Any
    gravity_x: Any
    gravity_y: Any
    turning: Any

    def __init__(self, stage: Stage, order: NDArray[np.int64], counts: NDArray[np.int64]) -> None:
        n = stage.n
        if n > MOST_DISKS:
            raise EventsimError(f"{n} disks: the fast engine has room for {MOST_DISKS}")
        self.n = n
        self.number = float
        self._counts = counts
        self.memory: Floats = aligned((n + 1) * REALS + (days_of(n) + WAITING) // 2, np.float64)
        self.disks: Floats = self.memory[: (n + 1) * REALS].reshape(n + 1, REALS)
        self.words: Integers = self.disks.view(np.int32).reshape(n + 1, WORDS)
        self.place_of: Integers = np.empty(n, np.int32)
        self.place_of[order] = np.arange(n, dtype=np.int32)
        self.words[:n, LABEL] = order
        self.disks[n, X : RADIUS + 1] = np.nan
        self.words[n, MET] = NOBODY
        self.disks[self.place_of, RADIUS] = stage.radius
        if stage.mass is not None:
            self.words[self.place_of, FLAGS] = np.where(
                np.isinf(stage.mass), IMMOVABLE, np.where(stage.mass == 0.0, TRACER, 0)
            )
        self.several: Integers = np.empty((64, 4), np.int32)
        self.several_used = 0
        self.x, self.y = self._reals(X), self._reals(Y)
        self.vx, self.vy = self._reals(VX), self._reals(VY)
        self.t, self.contact_time = self._reals(T), self._reals(CONTACT_TIME)
        self.wraps_x, self.wraps_y = self._integers(WRAPS_X), self._integers(WRAPS_Y)
        self.at_once = self._integers(AT_ONCE)
        self.count = CountColumn(self.words[:n, COUNT], self.place_of)
        self.met = MetColumn(self)
        self.low_parts = stage.low_parts
        self.low: Floats = np.zeros((n if stage.low_parts else 0, 2))
        self.low_vx, self.low_vy = Column(self.low[:, 0], self.place_of), Column(self.low[:, 1], self.place_of)
        self.contacts = self.contacts_in_memory = None
        if stage.seed is not None:
            self.contacts_in_memory = np.zeros(n, np.int32)
            self.contacts = Column(self.contacts_in_memory, self.place_of)
        counted = () if self.contacts is None else ("contacts",)
        self._columns = (*COLUMNS, *(LOW_COLUMNS if stage.low_parts else ()), *counted)
        self.spin = self.turning = None
        if stage.spin is not None and stage.moment is not None:
            self.turning = np.ascontiguousarray(np.stack([stage.spin, stage.moment], axis=1)[order])
            self.spin = Column(self.turning[:, 0], self.place_of)
            self._columns = (*self._columns, "spin")
        self.supports = stage.supports
        self._radius = stage.radius.tolist()
        self.sides = self.sides_in_memory = None
        if stage.points:
            self._walls = Sides(stage)
            self.sides_in_memory = np.zeros(n * len(self._walls), np.int32)
            self.sides = SidesColumn(self.sides_in_memory.reshape(n, -1), self.place_of)
        self.gravity_x, self.gravity_y = AccelerationColumn(self, 0, stage), AccelerationColumn(self, 1, stage)
        self.epoch_length = stage.epoch_length

    @property
    def labels(self) -> Integers:
        """(n,) the number in the scene of the disk at each place."""
        return self.words[: self.n, LABEL]

    @property
    def window_rows(self) -> int:
        """Rows logged in the present window."""
        return int(self._counts[WINDOW_ROWS])

    @window_rows.setter
    def window_rows(self, rows: int) -> None:
        self._counts[WINDOW_ROWS] = rows

    @property
    def last_begun(self) -> float:
        """When the last of all flights began."""
        return float(self.t.every().max())

    def anchors(self) -> Anchors:
        """Where all flights begin."""
        columns = (self.t, self.x, self.y, self.vx, self.vy, self.gravity_x, self.gravity_y)
        return Anchors(*(column.every() for column in columns))

    def meet(self, i: int, met: Met) -> None:
        """Let disk i remember whom it met; its record says as well whether it rests."""
        self.met[i] = met

    def snapshot(self) -> Snapshot:
        """A copy of all that the future depends on."""
        return Snapshot(
            epoch=self.epoch,
            window=self.window,
            window_rows=self.window_rows,
            now=self.now,
            met=tuple(self.met[i] for i in range(self.n)),
            sides=self.sides_of_all(),
            **{name: tuple(getattr(self, name).every().tolist()) for name in self._columns},
        )

    def restore(self, saved: Snapshot) -> None:
        """Fly on, and count the rows of the window, as a snapshot says."""
        self.window_rows = saved.window_rows
        self.begin_window(saved.window)
        for name in self._columns:
            getattr(self, name).set_all(getattr(saved, name))
        self.forget_all()
        for i, met in enumerate(saved.met):
            if met:
                self.met[i] = met
        self.set_sides(saved.sides)
        self.close()

    def begin(self, stage: Stage) -> None:
        """Fly as at the beginning, where all but the flights is zero."""
        self.window_rows = 0
        self.begin_window(FIRST_WINDOW)
        for name in ("x", "y", "vx", "vy", *(() if self.spin is None else ("spin",))):
            getattr(self, name).set_all(getattr(stage, name))
        self.contact_time.set_all(-np.inf)
        if self.contacts is not None:
            self.contacts.set_all(0)
        self.forget_all()
        self.set_sides(())

    def forget_all(self) -> None:
        """Let all disks forget whom they met."""
        self.words[:, MET] = NOBODY
        self.words[: self.n, FLAGS] &= ~RESTING
        self.several_used = 0

    def resting(self) -> list[int]:
        """The disks that rest on walls."""
        found: list[int] = self.labels[(self.words[: self.n, FLAGS] & RESTING) != 0].tolist()
        return found

    def _reals(self, place: int) -> Column:
        return Column(self.disks[: self.n, place], self.place_of)

    def _integers(self, place: int) -> Column:
        return Column(self.words[: self.n, place], self.place_of)

    def set_levels(self, level: Integers) -> None:
        """Note the level of cells of each disk of the scene, (n,)."""
        flags = self.words[self.place_of, FLAGS]
        self.words[self.place_of, FLAGS] = flags % FIRST_LEVEL + FIRST_LEVEL * level

    def room_for(self, count: int) -> int:
        """The first of `count` free rows of the table `several`, which is cleared of forgotten ones, or grows, if it is full."""
        if self.several_used + count > len(self.several):
            places = np.flatnonzero(self.words[: self.n, MET] == SEVERAL)
            kept = [(int(self.labels[k]), self.met[int(self.labels[k])]) for k in places]
            needed = count + sum(len(met) for _, met in kept)
            if 2 * needed > len(self.several):
                self.several = np.empty((4 * needed, 4), np.int32)
            self.several_used = 0
            for i, met in kept:
                self.met[i] = met
        first = self.several_used
        self.several_used += count
        return first
