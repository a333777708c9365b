"""The plan of a session: the order of disks in memory, which cells it works with, how long a day of the calendar is."""

from __future__ import annotations

import math
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from eventsim.engines.base import Motion
from eventsim.engines.fast.cells import WIDTH
from eventsim.engines.fast.columns import Integers, aligned
from eventsim.engines.fast.layout import REGISTER, USUAL_DEPTH, Grid
from eventsim.engines.fast.wall_cells import MANY_SHAPES, shapes_in_cells
from eventsim.engines.reference.cells import MARGIN
from eventsim.record.events import Floats
from eventsim.scene.stage import Stage

Pair: TypeAlias = tuple[float, float]

FEWEST_COLUMNS = 5
"""Along a period: disks in neighbouring cells are then nearer than half a period, so their image is the nearest one."""

WIDEST = 1.41
"""In reaches: four centres of equal disks at most fit into a square cell that is narrower than sqrt 2 reaches."""

DILUTE, VERY_DILUTE = 1.6, 2.4
"""Mean distance of disks, in reaches, from which on wide cells, and cells with room for several disks, pay."""

DEEP = 8
"""Slots of a cell with room for several disks, to begin with."""

FIVE, ROOMY, SMALL = 5, 0.555, 0.1
"""Slots of a cell that a fifth disk may enter: three such cells still fit into a register.  It may where this part of the disks,
the smallest ones, are so much smaller than their cell is wide: five of them cover half of the ground that they reach from there.
"""

CROWDED = 3.0
"""In mean distances of disks: a largest diameter from which on cells as wide as that would hold too many."""

CLASS, MOST = 4.0, 0.9
"""How much wider the largest disk of a class of radii is than the smallest, at most; so many disks, if they are not far wider
than half of them, make up the smallest class.
"""

FEW, AROUND, SMALL_PART = 0.002, 0.25, 0.25
"""In a box: such a part of the disks may be outside of the cells on each side; the room around the others, in parts of their
extent; the part of the box up to which it is worth while.
"""

CROWD, MOST_CELLS = 4.0, 8.0
"""So many disks in a disk's own cell, on the average, make cells narrower, up to so many cells for each disk."""

FEWEST_SEEN = 3
"""Along a period: with fewer columns, cells on both sides of one would be the same."""

ORDERED_DISKS = 200
"""From here on neighbours are put near each other in memory."""

MANY_DISKS = 50_000
"""From here on the records outgrow the caches: memory is prefetched, and days are shorter."""

LOOK_AHEAD = 32
"""Days at which the prefetch begins."""

SHARE, SHARE_OF_MANY = 1.4, 0.7
"""The length of a day, in mean times between two scheduled events (the two disks of a contact have one each)."""

LEAST_DAYS = 64


class Sizes(NamedTuple):
    """A grid of cells: its corner, how many columns and rows, how wide, how many slots each, the largest radius in it."""

    low: tuple[float, float]
    columns: int
    rows: int
    side: tuple[float, float]
    depth: int
    radius: float = math.inf


def cell_sizes(
    stage: Stage, x: Floats, y: Floats, classes: tuple[float, ...], depths: dict[int, int]
) -> tuple[Sizes, ...] | None:
    """The cells for disks at (x, y), finest level first; depths: slots of a cell on levels where they are told.

    classes: the largest radius on each level.  None where a period is too short for cells: everyone looks at everyone.  On the
    open plane the grids cover three times the extent of the disks, and their outer cells all the rest.
    """
    low, size = _ground(stage, x, y)
    level = levels_of(stage, classes)
    grids: list[Sizes] = []
    for k in range(len(classes)):
        radius = stage.radius[level == k]
        if k == 0:
            shapes = len(stage.features) if len(classes) == 1 else 0
            places = x[level == 0], y[level == 0]
            grids.append(_finest(low, size, radius, depths.get(k, USUAL_DEPTH), shapes, places))
        else:
            grids.append(_coarser(low, size, stage.period, radius, grids, depths.get(k, FIVE)))
    return tuple(grids) if _images_are_clear(stage, grids) else None


def _finest(
    low: Pair, size: Pair, radius: Floats, depth: int, shapes: int, places: tuple[Floats, Floats]
) -> Sizes:
    """The grid for most of the disks: as narrow as two of them reach, or as wide as they, or many shapes, are apart."""
    largest = float(radius.max())
    least = 2.0 * largest * MARGIN
    number = max(len(radius), shapes) if shapes >= MANY_SHAPES else len(radius)
    spacing = math.sqrt(size[0]) * math.sqrt(size[1]) / math.sqrt(number)
    if not spacing > 0.0:
        spacing = least or 1.0
    wide = max(least, 1e-6 * max(size))
    if spacing < DILUTE * least:
        side, most = wide, False
        if 2.0 * float(np.quantile(radius, SMALL)) < ROOMY * wide:
            depth = max(depth, FIVE)
    elif spacing < VERY_DILUTE * least and np.ptp(radius) == 0.0:
        side, most = WIDEST * least, True
    else:
        side, depth, most = max(wide, _uncrowded(spacing, wide, low, size, places)), max(depth, DEEP), False
    columns, rows = (_number(length, side, wide, most) for length in size)
    return Sizes(low, columns, rows, (size[0] / columns, size[1] / rows), depth, largest)


def _uncrowded(side: float, wide: float, low: Pair, size: Pair, places: tuple[Floats, Floats]) -> float:
    """The width of cells, halved as long as most disks share theirs with many, where they stand together in a large domain."""
    while side > wide:
        rows = int(size[1] / side) + 1
        cell = ((places[0] - low[0]) // side) * rows + (places[1] - low[1]) // side
        _, numbers = np.unique(cell, return_counts=True)
        crowd = float(np.sum(numbers * numbers)) / len(cell)  # in a disk's own cell, on the average
        most = (size[0] / side) * (size[1] / side) > MOST_CELLS * len(cell)
        if crowd <= CROWD or most:
            break
        side *= 0.5
    return side


def _coarser(
    low: Pair, size: Pair, period: tuple[float | None, float | None], radius: Floats, finer: list[Sizes], depth: int
) -> Sizes:
    """The grid of a class of larger disks.

    So wide that a disk of a finer grid, wherever it is in its own cell, reaches no further than the next cell of this one.
    """
    largest = float(radius.max())
    wide = max([2.0 * largest, *(largest + grid.radius + max(grid.side) for grid in finer)]) * MARGIN
    columns, rows = (max(1, int(length / wide)) for length in size)
    columns, rows = (
        1 if length is not None and count < FEWEST_SEEN else count
        for count, length in zip((columns, rows), period, strict=True)
    )
    return Sizes(low, columns, rows, (size[0] / columns, size[1] / rows), depth, largest)


def _images_are_clear(stage: Stage, grids: list[Sizes]) -> bool:
    """Whether a pair that can meet before it is predicted again is always nearest in the image in which it meets.

    On a single level neighbouring cells hold them.  On several a disk flies no further along an axis, until it is predicted
    again, than the finest cells are wide.
    """
    finest, longest = grids[0], float(np.sort(stage.radius)[-2:].sum()) * MARGIN
    for count, side, length in zip((finest.columns, finest.rows), finest.side, stage.period, strict=True):
        if length is not None and count < FEWEST_COLUMNS:
            return False
        if length is not None and len(grids) > 1 and not longest + 2.0 * side < 0.5 * length:
            return False
    return True


def classes_of(stage: Stage) -> tuple[float, ...]:
    """The largest radius of each class of radii, in rising order: one class where a single grid does."""
    radius = np.unique(stage.radius)
    size = stage.size if stage.size is not None else (float(np.ptp(stage.x)), float(np.ptp(stage.y)))
    spacing = math.sqrt(size[0]) * math.sqrt(size[1]) / math.sqrt(stage.n)
    largest = float(radius[-1])
    if 2.0 * largest <= CROWDED * spacing:
        return (largest,)
    half, most = np.quantile(stage.radius, (0.5, MOST))
    bounds = [max(min(float(most), 2.0 * float(half)), spacing / CLASS)]
    if not bounds[0] > 0.0:
        return (largest,)
    while bounds[-1] < largest:
        bounds.append(bounds[-1] * CLASS)
    last = np.searchsorted(radius, bounds, side="right") - 1  # the largest radius that a bound lets in
    return tuple(np.unique(radius[last[last >= 0]]).tolist())


def levels_of(stage: Stage, classes: tuple[float, ...]) -> NDArray[np.int64]:
    """(n,) the level of each disk, by the largest radii on each level."""
    return np.searchsorted(classes, stage.radius)


def _ground(stage: Stage, x: Floats, y: Floats) -> tuple[Pair, Pair]:
    """Corner and size of what cells for centres at (x, y) cover; with many shapes their own ground, on the open plane.

    In a box that is where nearly all disks are, if that is a small part of it: outer cells have what is beyond them.
    """
    if stage.size is not None:
        crowded = stage.period == (None, None) and not stage.features and _crowd(stage.size, x, y)
        return crowded or ((0.0, 0.0), stage.size)
    if len(stage.features) >= MANY_SHAPES:
        x = np.append(x, [one.shape.x for one in stage.features])
        y = np.append(y, [one.shape.y for one in stage.features])
        low = float(x.min()), float(y.min())
        return low, (float(np.ptp(x)) or 1.0, float(np.ptp(y)) or 1.0)
    return _around(x, y)


def _crowd(size: Pair, x: Floats, y: Floats) -> tuple[Pair, Pair] | None:
    """Corner and size of the part of a box that holds nearly all centres, with some room around; None where it is not small."""
    low, sides = [], []
    for places, length in zip((x, y), size, strict=True):
        first, last = np.quantile(places, (FEW, 1.0 - FEW)).tolist()
        room = AROUND * (last - first)
        low.append(max(0.0, first - room))
        sides.append(min(length, last + room) - low[-1])
    if not 0.0 < sides[0] * sides[1] < SMALL_PART * size[0] * size[1]:
        return None
    return (low[0], low[1]), (sides[0], sides[1])


def _around(x: Floats, y: Floats) -> tuple[Pair, Pair]:
    """Corner and size of a rectangle around all centres, with as much room again on each side as they fill."""
    low = float(x.min()), float(y.min())
    size = [float(np.ptp(x)), float(np.ptp(y))]
    room = max(*size) or 1.0
    return (low[0] - room, low[1] - room), (size[0] + 2.0 * room, size[1] + 2.0 * room)


def _number(length: float, side: float, least: float, most: bool) -> int:
    """How many cells along a length: as wide as `side` at most, or at least; never narrower than `least`."""
    count = math.ceil(length / side) if most else int(length / side)
    return max(1, min(count, int(length / least) if least > 0.0 else count))


def days_of(n: int) -> int:
    """The number of days in the calendar, a power of two."""
    return 1 << max(LEAST_DAYS, (8 if n >= MANY_DISKS else 4) * n).bit_length() - 1


def shortest_day(end: float) -> float:
    """Days of a window that ends at `end` are so long at least that their numbers stay exact."""
    return max(math.ldexp(end, -40), 1e-300)


def day_length(due: Floats, now: float, end: float, n: int) -> float:
    """A day that has less than one event: from how soon the next events of the disks are."""
    ahead = due[np.isfinite(due)] - now
    least = shortest_day(end)
    if not len(ahead):
        return max(end, least)
    k = max(1, len(ahead) // 8)
    share = np.partition(ahead, k - 1)[k - 1] / k
    return float(max((SHARE_OF_MANY if n >= MANY_DISKS else SHARE) * share, least))


def posts_of(stage: Stage) -> NDArray[np.bool_] | None:
    """(n,) which disks are immovable, where nothing else can be met: tracers and points do not meet each other; None elsewhere.

    Not under gravity: whether a falling disk grazes a post is not exact, so it may depend on when the post was met last.  Not
    where a post reaches half a period, so that two of its images can be equally near.
    """
    posts = np.full(stage.n, False) if stage.mass is None else np.isinf(stage.mass)
    alone = ~posts
    tracers = stage.mass is not None and not np.any(stage.mass[alone])
    if stage.gravity is not None or not (tracers or alone.sum() <= 1 or not stage.radius[alone].any()):
        return None
    reach = float(stage.radius[posts].max(initial=0.0) + stage.radius[alone].max(initial=0.0)) * MARGIN
    clear = all(length is None or reach < 0.5 * length for length in stage.period)
    return posts if clear else None


def in_memory(stage: Stage) -> NDArray[np.int64]:
    """The disks in the order in which memory holds them: neighbours near each other, and posts before what meets only them."""
    order = along_a_curve(stage.x, stage.y) if stage.n >= ORDERED_DISKS else np.arange(stage.n)
    posts = posts_of(stage)
    return order if posts is None else order[np.argsort(~posts[order], kind="stable")]


def cells_of_posts(stage: Stage, x: Floats, y: Floats, posts: NDArray[np.bool_]) -> tuple[Sizes, ...] | None:
    """The cells for posts at (x, y), which alone are in the slots; None where there are few, or a period is too short."""
    number = max(int(posts.sum()), len(stage.features))
    if number < FEW_DISKS:
        return None
    low, size = _ground(stage, x[posts], y[posts])
    reach = float(stage.radius[posts].max(initial=0.0) + stage.radius[~posts].max(initial=0.0)) * MARGIN
    wide = max(reach, 1e-6 * max(size), math.sqrt(size[0]) * math.sqrt(size[1]) / math.sqrt(number))
    columns, rows = (max(1, int(length / wide)) for length in size)
    sizes = (Sizes(low, columns, rows, (size[0] / columns, size[1] / rows), DEEP),)
    return sizes if _images_are_clear(stage, list(sizes)) else None


FEW_DISKS = 24
"""Below it, looking at all disks is as fast as cells."""


class Grids:
    """The cells of one session, chosen anew whenever they do not fit any more.

    wanted: the sizes to be used, one grid or several, finest first; None for none; "auto": those that suit.
    """

    def __init__(self, stage: Stage, wanted: Sizes | tuple[Sizes, ...] | str | None) -> None:
        self._stage = stage
        self._depths: dict[int, int] = {}
        self._given: tuple[Sizes, ...] | None = None
        self._chooses = isinstance(wanted, str) and (stage.n >= FEW_DISKS or len(stage.features) >= MANY_SHAPES)
        self._still = posts_of(stage)
        self.posts: int | None = None
        self._many_shapes = len(stage.features) >= MANY_SHAPES
        self._listed: tuple[Sizes, Integers] | None = None
        if not (wanted is None or isinstance(wanted, str)):
            self._given = (wanted,) if isinstance(wanted, Sizes) else wanted
        self._classes = classes_of(stage) if self._chooses else (float(stage.radius.max()),)
        self.sizes: tuple[Sizes, ...] | None = None

    def choose(self, motion: Motion) -> None:
        """Choose the cells for the disks where they are."""
        still = self._still
        self.posts = None
        if still is not None and not (motion.vx[still].any() or motion.vy[still].any()):
            self.posts = int(still.sum())
        if self._given is not None:
            self.sizes = self._given
        elif still is not None and self.posts is not None:
            self.sizes = cells_of_posts(self._stage, motion.x, motion.y, still) if self._chooses else None
        elif self._chooses:
            self.sizes = cell_sizes(self._stage, motion.x, motion.y, self._classes, self._depths)
            if self.sizes is None and len(self._classes) > 1:
                self._classes = self._classes[-1:]
                self.sizes = cell_sizes(self._stage, motion.x, motion.y, self._classes, self._depths)

    def deepen(self, level: int) -> None:
        """Give the cells of a level more slots, now and whenever they are chosen anew."""
        assert self.sizes is not None
        sizes = list(self.sizes)
        self._depths[level] = FIVE if sizes[level].depth < FIVE else 2 * sizes[level].depth
        sizes[level] = sizes[level]._replace(depth=self._depths[level])
        self.sizes = tuple(sizes)

    def near_walls(self) -> Integers | None:
        """The table of `wall_cells`; None with few shapes, without cells, and on several levels."""
        if not self._many_shapes or self.sizes is None or len(self.sizes) > 1:
            return None
        size = self.sizes[0]._replace(depth=0)
        if self._listed is None or self._listed[0] != size:
            self._listed = size, shapes_in_cells(self._stage, size)
        return self._listed[1]

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
        """Room for the neighbours of two disks; on several levels for those of one, which may be all others."""
        if self.sizes is None:
            return aligned(REGISTER, np.int32)
        if len(self.sizes) > 1:
            return aligned(self._stage.n + 2 * REGISTER, np.int32)
        return aligned(2 * (9 * self.sizes[0].depth + REGISTER), np.int32)

    def table(self) -> Floats | None:
        """The levels as a table of numbers, in one row of memory; None where there is only one."""
        if self.sizes is None or len(self.sizes) == 1:
            return None
        table = np.zeros((len(self.sizes), WIDTH))
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
            self.posts,
        )


def _slots(size: Sizes) -> int:
    return size.depth * (size.columns + 2) * (size.rows + 2)


LEVELS = 12
"""4**12 squares along the curve."""


def along_a_curve(x: Floats, y: Floats) -> NDArray[np.int64]:
    """The disks in the order of a Hilbert curve over the rectangle that holds them."""
    half = 1 << (LEVELS - 1)
    column, row = _squares(x, 2 * half), _squares(y, 2 * half)
    along = np.zeros(len(x), np.int64)
    while half:
        right, upper = (column & half) > 0, (row & half) > 0
        along += half * half * ((3 * right) ^ upper)
        flip = right & ~upper
        column[flip], row[flip] = ~column[flip], ~row[flip]
        column[~upper], row[~upper] = row[~upper], column[~upper]
        half //= 2
    return np.argsort(along, kind="stable")


def _squares(x: Floats, count: int) -> NDArray[np.int64]:
    low, extent = float(x.min()), float(np.ptp(x))
    if not extent > 0.0:
        return np.zeros(len(x), np.int64)
    return np.minimum((x - low) / extent * count, count - 1).astype(np.int64)
