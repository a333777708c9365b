"""The grids of a session: which cells it works with, and the memory that they take."""

from __future__ import annotations

import numpy as np

from eventsim.engines.base import Motion
from eventsim.engines.fast import levels
from eventsim.engines.fast.columns import Integers
from eventsim.engines.fast.layout import USUAL_DEPTH, Grid
from eventsim.engines.fast.plan import LOOK_AHEAD, MANY_DISKS, Sizes, cell_sizes, classes_of, days_of, levels_of
from eventsim.engines.fast.state import aligned
from eventsim.record.events import Floats
from eventsim.scene.stage import Stage

FEW_DISKS = 24
"""Below it, looking at all disks is as fast as cells."""

REGISTER = 16
"""Slots that are read at once, also past the end of what is wanted."""


class Grids:
    """The cells of one session, chosen anew whenever they do not fit any more.

    wanted: the sizes to be used, one grid or several, finest first; None for none; "auto": those that suit.
    """

    def __init__(self, stage: Stage, wanted: Sizes | tuple[Sizes, ...] | str | None) -> None:
        self._stage = stage
        self._depths: dict[int, int] = {}
        self._given: tuple[Sizes, ...] | None = None
        self._chooses = isinstance(wanted, str) and stage.n >= FEW_DISKS
        if not (wanted is None or isinstance(wanted, str)):
            self._given = (wanted,) if isinstance(wanted, Sizes) else wanted
        self._classes = classes_of(stage) if self._chooses else (float(stage.radius.max()),)
        self.sizes: tuple[Sizes, ...] | None = None

    def choose(self, motion: Motion) -> None:
        """Choose the cells for the disks where they are."""
        if self._given is not None:
            self.sizes = self._given
        elif self._chooses:
            self.sizes = cell_sizes(self._stage, motion.x, motion.y, self._classes, self._depths)
            if self.sizes is None and len(self._classes) > 1:
                self._classes = self._classes[-1:]
                self.sizes = cell_sizes(self._stage, motion.x, motion.y, self._classes, self._depths)

    def deepen(self, level: int) -> None:
        """Give the cells of a level twice as many slots, now and whenever they are chosen anew."""
        assert self.sizes is not None
        sizes = list(self.sizes)
        self._depths[level] = 2 * sizes[level].depth
        sizes[level] = sizes[level]._replace(depth=self._depths[level])
        self.sizes = tuple(sizes)

    @property
    def level(self) -> Integers:
        """(n,) the level of each disk."""
        radii = (np.inf,) if self.sizes is None else tuple(size.radius for size in self.sizes)
        return levels_of(self._stage, radii).astype(np.int32)

    def slots(self) -> Integers | None:
        """Empty slots for the cells of all levels; None without cells."""
        if self.sizes is None:
            return None
        slots = aligned(sum(map(_slots, self.sizes)) + REGISTER, np.int32)
        slots[:] = self._stage.n
        return slots

    def near(self) -> Integers:
        """Room for the neighbours of one disk."""
        if self.sizes is None:
            return aligned(REGISTER, np.int32)
        few = 9 * self.sizes[0].depth
        return aligned((few if len(self.sizes) == 1 else self._stage.n) + 2 * REGISTER, np.int32)

    def table(self) -> Floats | None:
        """The levels as a table of numbers, in one row of memory; None where there is only one."""
        if self.sizes is None or len(self.sizes) == 1:
            return None
        table = np.zeros((len(self.sizes), levels.WIDTH))
        first = 0
        for row, size in zip(table, self.sizes, strict=True):
            row[:] = size.columns, size.rows, size.depth, first, *size.low, *size.side, size.radius
            first += _slots(size)
        return table.reshape(-1)

    def grid(self, lanes: int | None) -> Grid:
        """The finest grid, and what a kernel needs to know of it; the length of a day is left open."""
        n = self._stage.n
        size = Sizes((0.0, 0.0), 1, 1, self._stage.size or (1.0, 1.0), 0) if self.sizes is None else self.sizes[0]
        several = self.sizes is not None and len(self.sizes) > 1
        return Grid(
            n,
            size.columns,
            size.rows,
            size.depth,
            1 if several or size.depth != USUAL_DEPTH else None,
            *size.low,
            *size.side,
            days_of(n),
            1.0,
            1.0,
            lanes,
            LOOK_AHEAD if n >= MANY_DISKS and self.sizes is not None else None,
            len(self.sizes) if self.sizes is not None and several else None,
            0 if several else None,
        )


def _slots(size: Sizes) -> int:
    return size.depth * (size.columns + 2) * (size.rows + 2)
