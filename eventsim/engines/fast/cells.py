"""The cells: a grid of slots that tells which disks can meet before one of them crosses into another cell.

Around the grid lies a ring of ghost cells, copies of the cells at the other side of a period, so that no index wraps.  Cells
only decide which pairs are looked at; they change no bit of any flight.
"""

from __future__ import annotations

from eventsim.engines.fast.compiled import inline
from eventsim.engines.fast.layout import (
    COLUMN,
    EDGE,
    FLAGS,
    ROW,
    USUAL_DEPTH,
    WORDS,
)
from eventsim.engines.fast.memory import store, word


@inline
def depth_of(grid, deep):
    """The number of slots of a cell: a constant where it is the usual one."""
    if deep is None:
        return USUAL_DEPTH
    return grid.depth


@inline
def slot_of(grid, column, row):
    """The first slot of a cell; columns and rows count from 1."""
    return _behind(grid.first, depth_of(grid, grid.deep) * (column + (grid.columns + 2) * row))


@inline
def _behind(first, slot):
    return slot if first is None else first + slot


@inline
def enter(m, grid, rules, i, column, row):
    """Put disk i into a free slot of a cell; False if there is none."""
    store(m.disks, i * WORDS + COLUMN, column)
    store(m.disks, i * WORDS + ROW, row)
    edge = column == 1 or row == 1 or column == grid.columns or row == grid.rows
    flags = word(m.disks, i * WORDS + FLAGS) & ~EDGE
    store(m.disks, i * WORDS + FLAGS, flags | EDGE if edge else flags)
    return _occupy(m, grid, rules, i, column, row, edge, m.slots)


@inline
def _occupy(m, grid, rules, i, column, row, edge, slots):
    if slots is None:
        return True
    depth = depth_of(grid, grid.deep)
    start = slot_of(grid, column, row)
    k = 0
    while k < depth and word(slots, start + k) != grid.n:
        k += 1
    if k == depth:
        return False
    store(slots, start + k, i)
    if edge:
        _copy_to_ghosts(m, grid, column, row, rules.length_x is not None, rules.length_y is not None)
    return True


@inline
def leave(m, grid, rules, i):
    """Take disk i out of its cell."""
    column, row = word(m.disks, i * WORDS + COLUMN), word(m.disks, i * WORDS + ROW)
    depth = depth_of(grid, grid.deep)
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
    depth = depth_of(grid, grid.deep)
    start = slot_of(grid, column, row)
    for k in range(depth):
        disk = word(m.slots, start + k)
        if ghost_column >= 0:
            store(m.slots, slot_of(grid, ghost_column, row) + k, disk)
        if ghost_row >= 0:
            store(m.slots, slot_of(grid, column, ghost_row) + k, disk)
        if ghost_column >= 0 and ghost_row >= 0:
            store(m.slots, slot_of(grid, ghost_column, ghost_row) + k, disk)
