"""The cells: a grid of slots that tells which disks can meet before one of them crosses into another cell.

Around the grid lies a ring of ghost cells, copies of the cells at the other side of a period, so that no index wraps.  Cells
only decide which pairs are looked at; they change no bit of any flight.

Levels: a grid for each class of radii, so that a large disk among many small ones costs no more than it meets.  A pair is tried
when either of its disks is predicted.  A disk looks for those of its own class and of larger ones in the nine cells of their
level around it.  For smaller ones it looks at the cells that its rim can reach while it flies no further than the width of the
finest cells; then it looks again.  So the work for a contact of a disk grows like its rim, and so does the rate of its contacts.
"""

from __future__ import annotations

import math

from eventsim.engines.fast.advance import pulls
from eventsim.engines.fast.compiled import gather_disks, inline, part, real, store, word
from eventsim.engines.fast.layout import (
    COLUMN,
    EDGE,
    FIRST_LEVEL,
    FLAGS,
    RADIUS,
    REALS,
    ROW,
    USUAL_DEPTH,
    WORDS,
    Grid,
)
from eventsim.formulas.crossing import crossing_delay
from eventsim.formulas.real import NEVER, sqrt


@inline
def depth_of(grid):
    """The number of slots of a cell: a constant where it is the usual one."""
    return USUAL_DEPTH if grid.deep is None else grid.depth


@inline
def slot_of(grid, column, row):
    """The first slot of a cell; columns and rows count from 1."""
    slot = depth_of(grid) * (column + (grid.columns + 2) * row)
    return slot if grid.first is None else grid.first + slot


@inline
def enter(m, grid, rules, i, column, row):
    """Put disk i into a free slot of a cell; False if there is none."""
    store(m.disks, i * WORDS + COLUMN, column)
    store(m.disks, i * WORDS + ROW, row)
    edge = column == 1 or row == 1 or column == grid.columns or row == grid.rows
    flags = word(m.disks, i * WORDS + FLAGS) & ~EDGE
    store(m.disks, i * WORDS + FLAGS, flags | EDGE if edge else flags)
    if m.slots is None:
        return True
    if grid.posts is not None and i >= grid.posts:  # where nothing but posts can be met, only these are in the slots
        return True
    depth = depth_of(grid)
    start = slot_of(grid, column, row)
    k = 0
    while k < depth and word(m.slots, start + k) != grid.n:
        k += 1
    if k == depth:
        return False
    store(m.slots, start + k, i)
    if edge:
        _copy_to_ghosts(m, grid, column, row, rules.length_x is not None, rules.length_y is not None)
    return True


@inline
def leave(m, grid, rules, i):
    """Take disk i out of its cell."""
    if grid.posts is not None and i >= grid.posts:
        return
    column, row = word(m.disks, i * WORDS + COLUMN), word(m.disks, i * WORDS + ROW)
    depth = depth_of(grid)
    start = slot_of(grid, column, row)
    for k in range(depth):
        disk = word(m.slots, start + k)
        store(m.slots, start + k, grid.n if disk == i else disk)
    if word(m.disks, i * WORDS + FLAGS) & EDGE:
        _copy_to_ghosts(m, grid, column, row, rules.length_x is not None, rules.length_y is not None)


@inline
def _copy_to_ghosts(m, grid, column, row, along_x, along_y):
    """Copy a cell at the border of the grid to where it is seen from beyond a periodic boundary; a single one is seen anyway."""
    ghost_column, ghost_row = -1, -1
    if along_x and grid.columns > 1:
        ghost_column = grid.columns + 1 if column == 1 else (0 if column == grid.columns else -1)
    if along_y and grid.rows > 1:
        ghost_row = grid.rows + 1 if row == 1 else (0 if row == grid.rows else -1)
    depth = depth_of(grid)
    start = slot_of(grid, column, row)
    for k in range(depth):
        disk = word(m.slots, start + k)
        if ghost_column >= 0:
            store(m.slots, slot_of(grid, ghost_column, row) + k, disk)
        if ghost_row >= 0:
            store(m.slots, slot_of(grid, column, ghost_row) + k, disk)
        if ghost_column >= 0 and ghost_row >= 0:
            store(m.slots, slot_of(grid, ghost_column, ghost_row) + k, disk)


COLUMNS, ROWS, DEPTH, FIRST, LOW_X, LOW_Y, SIDE_X, SIDE_Y, REACH = range(9)
"""Places in a row of the table of levels; REACH: the largest radius of the class."""

WIDTH = 9
"""Numbers in a row."""

MARGIN = 2.0**-18
"""What is added to the distance at which a rim looks, in parts of it: far more than a disk strays from its cell by rounding."""


@inline
def level_of(m, i):
    """The level of disk i; 0 is the finest."""
    return word(m.disks, i * WORDS + FLAGS) // FIRST_LEVEL


@inline
def home_of(m, grid, i):
    """The grid that disk i is in."""
    if grid.levels is None:
        return grid
    return grid_of(m, grid, level_of(m, i))


@inline
def grid_of(m, grid, level):
    """The grid of a level."""
    k = WIDTH * level
    return Grid(
        grid.n,
        int(real(m.levels, k + COLUMNS)),
        int(real(m.levels, k + ROWS)),
        int(real(m.levels, k + DEPTH)),
        1,
        real(m.levels, k + LOW_X),
        real(m.levels, k + LOW_Y),
        real(m.levels, k + SIDE_X),
        real(m.levels, k + SIDE_Y),
        grid.days,
        grid.day_length,
        grid.days_per_time,
        grid.lanes,
        grid.look_ahead,
        grid.levels,
        int(real(m.levels, k + FIRST)),
        grid.posts,
    )


@inline
def place_in(coordinate, low, side, count):
    """The column or row of a coordinate, counted from 1; beyond the grid the outermost."""
    return min(max(int((coordinate - low) / side), 0), count - 1) + 1


@part
def look_delay(m, grid, rules, i, u, w):
    """How long disk i flies until it is the width of the finest cells away, along x or y; NEVER on the finest level itself."""
    if level_of(m, i) == 0:
        return NEVER
    side = real(m.levels, SIDE_X), real(m.levels, SIDE_Y)
    ax, ay = pulls(m, rules, i)
    delay = crossing_delay(0.0, u, ax, side[0], -1.0)
    delay = min(delay, crossing_delay(0.0, u, ax, -side[0], 1.0))
    delay = min(delay, crossing_delay(0.0, w, ay, side[1], -1.0))
    return min(delay, crossing_delay(0.0, w, ay, -side[1], 1.0))


@part
def gather_near(m, grid, rules, i, x, y, skip):
    """List in `near` all disks but `skip` that disk i, at (x, y), can meet before one of them is predicted again; how many."""
    own, count = level_of(m, i), 0
    for level in range(grid.levels):
        cells = grid_of(m, grid, level)
        if level < own:
            count = _along_rim(m, grid, rules, cells, real(m.levels, WIDTH * level + REACH), i, x, y, skip, count)
            continue
        if level == own:
            column, row = word(m.disks, i * WORDS + COLUMN), word(m.disks, i * WORDS + ROW)
        else:
            column = place_in(x, cells.low_x, cells.side_x, cells.columns)
            row = place_in(y, cells.low_y, cells.side_y, cells.rows)
        for k in range(-1, 2):
            count = _list(m, cells, slot_of(cells, column - 1, row + k), 3, i, skip, count, grid.lanes)
    return count


@inline
def _along_rim(m, grid, rules, cells, radius, i, x, y, skip, count):
    """List the disks in the cells that the rim of disk i can reach before it looks again, but not those well inside it."""
    own = real(m.disks, i * REALS + RADIUS)
    stray_x, stray_y = real(m.levels, SIDE_X), real(m.levels, SIDE_Y)
    outer = (own + radius) * (1.0 + MARGIN) + MARGIN * cells.side_x
    inner = own * (1.0 - MARGIN)
    first, last = _span(y, outer + stray_y, cells.low_y, cells.side_y, cells.rows, rules.length_y)
    for row in range(first, last + 1):
        below, above = cells.low_y + row * cells.side_y - y, cells.low_y + (row + 1) * cells.side_y - y
        if rules.length_y is None:  # outer cells reach to infinity
            below = -NEVER if row == 0 else below
            above = NEVER if row == cells.rows - 1 else above
        least = max(max(below, -above) - stray_y, 0.0)
        most = max(-below, above) + stray_y
        if least > outer:
            continue
        half = sqrt(outer * outer - least * least) + stray_x
        begin, end = _span(x, half, cells.low_x, cells.side_x, cells.columns, rules.length_x)
        hole_begin, hole_end = end + 1, end  # the columns of cells well inside the disk
        if most < inner:
            half = sqrt(inner * inner - most * most) - stray_x
            hole_begin = math.ceil((x - half - cells.low_x) / cells.side_x)
            hole_end = math.floor((x + half - cells.low_x) / cells.side_x) - 1
            if rules.length_x is None:
                hole_begin, hole_end = max(hole_begin, 1), min(hole_end, cells.columns - 2)
        if hole_begin > hole_end:
            count = _along_row(m, grid, rules, cells, row, begin, end, i, skip, count)
        else:
            count = _along_row(m, grid, rules, cells, row, begin, hole_begin - 1, i, skip, count)
            count = _along_row(m, grid, rules, cells, row, hole_end + 1, end, i, skip, count)
    return count


@inline
def _span(middle, half, low, side, count, length):
    """The first and the last of the columns or rows that hold middle - half and middle + half, counted from 0.

    Along a period these are in line, not folded, and no more than there are; else what is beyond the grid belongs to the outer
    ones.
    """
    first, last = math.floor((middle - half - low) / side), math.floor((middle + half - low) / side)
    if length is None:
        return min(max(first, 0), count - 1), min(max(last, 0), count - 1)
    return first, min(last, first + count - 1)


@part
def _along_row(m, grid, rules, cells, row, begin, end, i, skip, count):
    """List the disks of the cells begin, ..., end of a row, counted from 0; beyond a period they are those at the other side."""
    if rules.length_y is not None:
        row = row % cells.rows
    if rules.length_x is None:
        return _list(m, cells, slot_of(cells, begin + 1, row + 1), end - begin + 1, i, skip, count, grid.lanes)
    while begin <= end:
        column = begin % cells.columns
        number = min(end - begin + 1, cells.columns - column)
        count = _list(m, cells, slot_of(cells, column + 1, row + 1), number, i, skip, count, grid.lanes)
        begin += number
    return count


@inline
def _list(m, cells, slot, number, i, skip, count, lanes):
    """Append the disks of cells side by side, but not i and `skip`; the new count."""
    slots = number * depth_of(cells)
    if lanes is None:
        for k in range(slot, slot + slots):
            j = word(m.slots, k)
            if j != cells.n and j != i and j != skip:
                store(m.near, count, j)
                count += 1
        return count
    for k in range(0, slots, 16):
        count = gather_disks(m.slots, slot + k, slots - k, m.near, count, cells.n, i, skip)
    return count
