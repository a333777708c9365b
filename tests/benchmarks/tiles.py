"""An experiment: a gas in tiles, each with its own calendar, through windows of time; the rows are those of the ordinary loop.

    python -m tests.benchmarks.tiles [--n 100000] [--eta 0.5] [--side 128] [--halo 12] [--near 4] [--window 1.0] [--windows 8]

The cells of the fast engine are dealt out among rectangular tiles.  The records of all disks lie in memory tile by tile, cell by
cell, so what a tile needs is read in a few long streams.  In a window of time each tile is done once, in any order:

1. It copies its own disks and those of a halo of cells around it, as they are at the beginning of the window.  It has memory of
   its own that the caches hold, with slots, a calendar and room for a list.  Scheduled events come along.
2. It lets all of them live until the end of the window, by the fast engine's own laws, as if nothing else existed.  In the
   halo that goes wrong: first in the outermost cells, then further in, no faster than contacts follow each other.  So a disk
   in the halo is followed the shorter, the further out it is: behind its limit nothing that it does can matter.
3. It logs the contacts whose first disk it owns.  It writes the disks that are in its cells at the end of the window to the
   second copy of all records, again cell by cell.
4. It tells those of its neighbours that are still to be done each flight of its disks near the border.  They load no more of it
   than a strip, whose disks fly as they are told.  So a border costs a halo on one side only.

What a tile says of disks of neighbours that are not done yet is a guess.  It is checked, not believed.  Each disk within `near`
cells of the border between two tiles has a seal: a number made of its last flight, its last contact and its count of flights.
The first tile that sees the disk writes the seal, others compare.  If all seals agree, each tile saw right what its own disks can
have met: then all tiles together are one motion that keeps all laws from the same beginning, and there is only one.  `near` has
to be so wide that nothing comes as far: twice the way of the fastest disk and a diameter.  That is checked, too, with the speeds
that there were.  So there is no zone to keep, no cone, no chain to follow, and no event is held back.

That a halo is too narrow, a tile mostly notices itself: disks that met wrong ones are marked, and where a mark comes near, the
tile is done once more, with a wider halo, before anything is written.  Where seals differ, the beginning of the window is still
there: it is done once more with wider halos.  Where a tie comes up, the ordinary loop does it.

Rows of a window are put in order of time, (a, b) at equal times, by a counting sort, and numbered.  Windows end where the clock
turns over.

Only ratios within one run of this program mean anything: CPU time, both loops in turn, medians.

What it gave with one core of an AVX-512 processor, the log kept, best settings, ordinary loop / tiles:

    disks       eta .2                  eta .5                  eta .7
    1e5         1.36 (150, 18, 8)       1.21 (128, 12, 4)       1.10 (128, 10, 3)
    1e6         1.76 (160, 20, 9)       1.65 (128, 12, 4)       1.73 (128, 10, 3)

In brackets: side, halo, near.  A halo that is too narrow costs more than a wide one: windows are done once more.  At 1e5 the
ordinary loop takes but 2.2 times as long for a contact as with 4000 disks (530 and 240 ns at eta .7), since much of 1e5 disks is
in the caches anyway.  Of that tiles give back 20 % for contacts of halos, 90 to 110 ns for loading, 50 for writing, 35 for rows
and what neighbours are told.  So 1.3 is out of reach there, and the product has no tiles.
"""

from __future__ import annotations

import math
import statistics
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction
from time import process_time
from typing import Any, NamedTuple

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from eventsim.engines.base import Stop
from eventsim.engines.fast import FastOptions, layout
from eventsim.engines.fast.advance import anchor, place, speed, wrap
from eventsim.engines.fast.calendar import NO_DAY, bucket, first, is_mutual, is_stale, is_tied, push, take, unsettled
from eventsim.engines.fast.cells import place_in
from eventsim.engines.fast.columns import aligned
from eventsim.engines.fast.compiled import (
    either,
    gather_disks,
    inline,
    kernel,
    part,
    pointer,
    prefetch,
    real,
    store,
    word,
)
from eventsim.engines.fast.layout import (
    AT_ONCE,
    COLUMN,
    CONTACT_TIME,
    COUNT,
    COUNTS,
    DOWN,
    DUE,
    EDGE,
    FLAGS,
    LABEL,
    LEFT,
    LINK,
    MET,
    MET_KX,
    MET_KY,
    NEXT,
    NOBODY,
    NOTHING,
    PARTNER,
    PARTNER_COUNT,
    REALS,
    RIGHT,
    ROW,
    UP,
    VX,
    VY,
    WAITING,
    WORDS,
    WRAP_LEFT,
    WRAP_RIGHT,
    WRAP_UP,
    Arrays,
    T,
    X,
    Y,
)
from eventsim.engines.fast.numba_memory import F64, I64, call
from eventsim.engines.fast.numba_memory import place as place_of
from eventsim.engines.fast.predict import _earliest_of_list, _or_with_nearest, _partner_to_skip
from eventsim.engines.fast.resolve import resolve_pair
from eventsim.engines.fast.session import FastSession
from eventsim.engines.fast.single_disk_events import border_events, crossing
from eventsim.engines.turnover import Anchors, exponent_after
from eventsim.formulas.clock import window_length
from eventsim.formulas.doubt import screen_in
from eventsim.formulas.real import NEVER
from eventsim.record.events import ROW as ROW_TYPE
from eventsim.scene.stage import stage_of
from tests.benchmarks.rates import lattice_gas
from tests.benchmarks.table import arguments, whole

ID = 24
"""A free word of a record: the place of the disk in the ordinary loop's memory, its name here.  MET and PARTNER hold such names
between windows, and local places within one."""

ABSENT = -3
"""MET of a disk whose last partner its tile does not see: ABSENT - its name."""

MARKED, OWNED, NEAR, TOLD, STRIP = 16, 32, 64, 128, 256
"""Flags of a disk in a tile: may be wrong; in its cells at the beginning of the window; near them; of a tile that is done, which
tells its flights; owned, and near the border."""

KINDS = MARKED | OWNED | NEAR | TOLD | STRIP

AFRESH = -1.0
"""DUE of a disk that has to be predicted."""

DEPTH = 4

MARGIN = 3
"""So many cells behind the near ones disks are followed to the end."""

DONE, TIE, FULL, STUCK, MARK, NO_ROOM, ENDLESS = range(7)
"""Why a tile comes to an end."""

DISKS, CURSOR, MISSES, PREDICTED, STEPS, CONTACTS, OUT, SAID, PUT_RIGHT = range(9)
"""Places in `counts`: disks in the tile; rows of the window; seals that differ; all predictions, steps, contacts; disks written;
flights told; flights that a tile was told and had not found."""

FASTEST, OVERLAP = range(2)
"""Places in `most`: the largest square of a speed, the deepest overlap."""


class Frame(NamedTuple):
    """Where a tile lies, in cells, and from when to when; columns and rows count its halo, first_* are where that begins."""

    first_column: int
    first_row: int
    columns: int
    rows: int
    halo: int
    near: int
    begin: float
    end: float


@intrinsic
def copy_record(typing, target, i, source, j):
    """Copy record j of `source` to record i of `target`: two lines."""

    def codegen(context, builder, signature, args):
        vector = ir.VectorType(F64, 8)
        to = place_of(context, builder, signature, (args[0], builder.mul(args[1], I64(REALS))), F64)
        origin = place_of(context, builder, signature, (args[2], builder.mul(args[3], I64(REALS))), F64)
        for line in (0, 8):
            there = builder.bitcast(builder.gep(origin, [I64(line)]), vector.as_pointer())
            here = builder.bitcast(builder.gep(to, [I64(line)]), vector.as_pointer())
            builder.store(builder.load(there, align=16), here, align=16)
        return context.get_dummy_value()

    return types.void(target, types.int64, source, types.int64), codegen


@intrinsic
def bits(typing, data, index):
    """The 64 bits at an index of float64, as a whole number."""
    return types.int64(data, index), lambda c, b, s, a: b.load(place_of(c, b, s, a, I64))


del call


@inline
def pointers(a):
    return Arrays(
        pointer(a.disks), pointer(a.slots), pointer(a.near), None, None, None, None, None, None, None, None, None, None, None,
        None, pointer(a.rows), None, None, None,
    )  # fmt: skip


@inline
def local_column(grid, frame, column):
    """The column in the tile, from 1, of one that counts from 1 in the box; beyond the tile more than it has."""
    k = column - 1 - frame.first_column
    return (k + grid.columns if k < 0 else k) + 1


@inline
def local_row(grid, frame, row):
    k = row - 1 - frame.first_row
    return (k + grid.rows if k < 0 else k) + 1


@inline
def slot_at(frame, column, row):
    return DEPTH * (column + (frame.columns + 2) * row)


@inline
def outside(frame, column, row):
    """How many cells a place of the tile is outside of what it owns; 0 or less: inside, so far from the border."""
    across = max(frame.halo + 1 - column, column - (frame.columns - frame.halo))
    along = max(frame.halo + 1 - row, row - (frame.rows - frame.halo))
    return max(across, along)


@inline
def limit_of(m, grid, frame, limits, i):
    """Until when a disk is followed where it is."""
    if flags_of(m, i) & (OWNED | TOLD):
        return frame.end
    column = local_column(grid, frame, word(m.disks, i * WORDS + COLUMN))
    row = local_row(grid, frame, word(m.disks, i * WORDS + ROW))
    return real(limits, max(0, outside(frame, column, row)))


@inline
def push_in_time(m, grid, frame, limits, i, day):
    """Put disk i into the calendar if its event is due before its limit; else on a list of its own."""
    if real(m.disks, i * REALS + DUE) < limit_of(m, grid, frame, limits, i):
        push(m, grid, i, day)
    else:
        nowhere = (grid.n + 1) * WORDS + grid.days
        store(m.disks, i * WORDS + LINK, nowhere)
        store(m.disks, i * WORDS + NEXT, grid.n)


@inline
def corner(m, grid, frame, i):
    """The first slot of the lower left one of the nine cells around disk i."""
    column = local_column(grid, frame, word(m.disks, i * WORDS + COLUMN))
    row = local_row(grid, frame, word(m.disks, i * WORDS + ROW))
    return slot_at(frame, column - 1, row - 1)


@inline
def contacts_in_lanes(m, grid, frame, rules, i, now, floor, x, y, time, code, shared):
    edge = word(m.disks, i * WORDS + FLAGS) & EDGE
    skip = _partner_to_skip(m, rules, i, now, x, y, edge)
    start, width = corner(m, grid, frame, i), DEPTH * (frame.columns + 2)
    count = gather_disks(m.slots, start, 3 * DEPTH, m.near, 0, grid.n, i, skip)
    count = gather_disks(m.slots, start + width, 3 * DEPTH, m.near, count, grid.n, i, skip)
    count = gather_disks(m.slots, start + 2 * width, 3 * DEPTH, m.near, count, grid.n, i, skip)
    return _earliest_of_list(m, rules, i, now, floor, x, y, time, code, shared, count, edge)


@part
def contacts_one_by_one(m, grid, frame, rules, i, now, floor, x, y, time, code, shared):
    start, width = corner(m, grid, frame, i), DEPTH * (frame.columns + 2)
    edge = word(m.disks, i * WORDS + FLAGS) & EDGE
    for _ in range(3):
        for k in range(3 * DEPTH):
            j = word(m.slots, start + k)
            if j != grid.n and j != i:
                time, code, shared = _or_with_nearest(m, rules, i, j, now, floor, x, y, edge, time, code, shared)
        start += width
    return time, code, shared


@inline
def predict_in_tile(m, grid, frame, rules, i, now, floor):
    """As `predict.predict`, with the cells of the tile."""
    x, y = place(m, rules, i, now)
    u, w = speed(m, rules, i, now)
    if word(m.disks, i * WORDS + FLAGS) & EDGE:
        time, code, shared = border_events(m, grid, rules, i, now, floor, x, y, u, w)
    else:
        time, code = crossing(m, grid, rules, i, now, x, y, u, w, rules.gx)
        shared = 0
    contacts = either(grid.lanes, contacts_in_lanes, contacts_one_by_one)
    time, code, shared = contacts(m, grid, frame, rules, i, now, floor, x, y, time, code, shared)
    count = word(m.disks, (code if code >= 0 else grid.n) * WORDS + COUNT)  # of the sentinel: 0
    store(m.disks, i * REALS + DUE, time)
    store(m.disks, i * WORDS + PARTNER, code)
    store(m.disks, i * WORDS + PARTNER_COUNT, count + COUNTS * shared)


@inline
def enter_cell(m, grid, frame, i, column, row):
    """Put disk i into a cell of the tile, which counts in the box; False if it is full."""
    store(m.disks, i * WORDS + COLUMN, column)
    store(m.disks, i * WORDS + ROW, row)
    edge = column == 1 or row == 1 or column == grid.columns or row == grid.rows
    flags = word(m.disks, i * WORDS + FLAGS) & ~EDGE
    store(m.disks, i * WORDS + FLAGS, flags | EDGE if edge else flags)
    start = slot_at(frame, local_column(grid, frame, column), local_row(grid, frame, row))
    k = 0
    while k < DEPTH and word(m.slots, start + k) != grid.n:
        k += 1
    if k == DEPTH:
        return False
    store(m.slots, start + k, i)
    return True


@inline
def leave_cell(m, grid, frame, i):
    column = local_column(grid, frame, word(m.disks, i * WORDS + COLUMN))
    row = local_row(grid, frame, word(m.disks, i * WORDS + ROW))
    start = slot_at(frame, column, row)
    for k in range(DEPTH):
        disk = word(m.slots, start + k)
        store(m.slots, start + k, grid.n if disk == i else disk)


@inline
def next_cell(m, grid, i, code):
    """The cell of the box behind a crossing or wrap."""
    column, row = word(m.disks, i * WORDS + COLUMN), word(m.disks, i * WORDS + ROW)
    if code == RIGHT:
        column += 1
    elif code == LEFT:
        column -= 1
    elif code == UP:
        row += 1
    elif code == DOWN:
        row -= 1
    elif code == WRAP_RIGHT:
        column = 1
    elif code == WRAP_LEFT:
        column = grid.columns
    elif code == WRAP_UP:
        row = 1
    else:
        row = grid.rows
    return column, row


@inline
def flags_of(m, i):
    return word(m.disks, i * WORDS + FLAGS)


@inline
def matters(m, i):
    """Whether a disk is one that the tile has to see right."""
    return flags_of(m, i) & (OWNED | NEAR) != 0


@inline
def mark(m, i):
    store(m.disks, i * WORDS + FLAGS, flags_of(m, i) | MARKED)


@inline
def square_of_speed(m, i):
    u, w = real(m.disks, i * REALS + VX), real(m.disks, i * REALS + VY)
    return u * u + w * w


@inline
def day_at(grid, time):
    return int(time * grid.days_per_time)


@inline
def is_done(grid, frame, tiles, done, per_row, column, row):
    """Whether the tile of a cell, given by its place in this tile, is done; no cell beyond this tile counts as another one's."""
    column, row = min(max(column, 1), frame.columns), min(max(row, 1), frame.rows)
    across = tiles[3 * ((frame.first_column + column - 1) % grid.columns)]
    along = tiles[3 * (grid.columns + (frame.first_row + row - 1) % grid.rows)]
    return done[along * per_row + across] != 0


@inline
def is_close(grid, frame, tiles, done, per_row, column, row):
    """Whether a cell of a tile that is done is close to one of a tile that is not."""
    near = frame.near
    return not (
        is_done(grid, frame, tiles, done, per_row, column - near, row - near)
        and is_done(grid, frame, tiles, done, per_row, column + near, row - near)
        and is_done(grid, frame, tiles, done, per_row, column - near, row + near)
        and is_done(grid, frame, tiles, done, per_row, column + near, row + near)
    )


@kernel
def load_tile(arrays, grid, frame, rules, limits, old, start, tiles, done, seat, origin, counts, afresh):
    """Copy the disks of a tile and of its halo, put them into its slots and calendar; the status.

    tiles: for each column, then for each row of the box: the number of its tile along the axis, where that begins, where it ends;
    then for each tile the number of its first cell.  done: which tiles are done; of these only what is close to others is loaded.
    """
    m = pointers(arrays)
    source, room = pointer(old), grid.n
    across, names, back = frame.columns, pointer(seat), pointer(origin)
    limit = pointer(limits)
    per_row = tiles[3 * (grid.columns - 1)] + 1  # tiles in a row
    cells = 3 * (grid.columns + grid.rows)
    for k in range(slot_at(frame, 0, frame.rows + 2)):
        store(m.slots, k, room)
    for k in range(bucket(grid, 0), bucket(grid, 0) + grid.days + WAITING):
        store(m.disks, k, room)
    n = 0
    for local in range(1, frame.rows + 1):
        row = (frame.first_row + local - 1) % grid.rows
        at = 3 * (grid.columns + row)
        tile_row, row_begin = tiles[at], tiles[at + 1]
        column = 1
        while column <= across:
            in_box = (frame.first_column + column - 1) % grid.columns
            tile, begin, end = tiles[3 * in_box], tiles[3 * in_box + 1], tiles[3 * in_box + 2]
            last = min(across, column + end - in_box - 1)
            cell = tiles[cells + tile_row * per_row + tile] + (row - row_begin) * (end - begin) + in_box - begin
            if n + start[cell + last - column + 1] - start[cell] > room:
                return NO_ROOM
            told = done[tile_row * per_row + tile] != 0
            while column <= last:
                out = outside(frame, column, local)
                kind = OWNED if out <= 0 else (NEAR if out <= frame.near else 0)
                if told:
                    if out > frame.near and not is_close(grid, frame, tiles, done, per_row, column, local):
                        column += 1
                        cell += 1
                        continue
                    kind |= TOLD
                elif out == frame.halo:
                    kind |= MARKED
                elif -frame.near < out <= 0:
                    kind |= STRIP
                slot = slot_at(frame, column, local)
                if start[cell + 1] - start[cell] > DEPTH:
                    return FULL
                for k in range(start[cell], start[cell + 1]):
                    copy_record(m.disks, n, source, k)
                    flags = flags_of(m, n) & ~KINDS
                    store(m.disks, n * WORDS + FLAGS, flags | kind)
                    store(names, word(m.disks, n * WORDS + ID), n)
                    store(back, n, k)
                    store(m.slots, slot, n)
                    slot += 1
                    n += 1
                column += 1
                cell += 1
    counts[DISKS] = n
    day = day_at(grid, frame.begin)
    for i in range(n):
        met = word(m.disks, i * WORDS + MET)
        if met >= 0:
            k = word(names, met)
            there = k < n and word(m.disks, k * WORDS + ID) == met
            store(m.disks, i * WORDS + MET, k if there else ABSENT - met)
        partner = word(m.disks, i * WORDS + PARTNER)
        if partner >= 0 and real(m.disks, i * REALS + DUE) >= 0.0:
            k = word(names, partner)
            there = k < n and word(m.disks, k * WORDS + ID) == partner
            store(m.disks, i * WORDS + PARTNER, k if there else NOTHING)
            if not there:
                store(m.disks, i * REALS + DUE, AFRESH)
    for i in range(n):
        if (afresh or real(m.disks, i * REALS + DUE) < 0.0) and frame.begin < limit_of(m, grid, frame, limit, i):
            predict_in_tile(m, grid, frame, rules, i, frame.begin, frame.begin)
            counts[PREDICTED] += 1
        elif real(m.disks, i * REALS + DUE) < 0.0:
            store(m.disks, i * REALS + DUE, NEVER)
            store(m.disks, i * WORDS + PARTNER, NOTHING)
        push_in_time(m, grid, frame, limit, i, day)
    return DONE


@kernel
def collect_told(arrays, said_by, said_at, begin, end, seat, counts, count, times, told):
    """List the flights that a neighbour told, from `begin` to `end`, and that concern this tile, behind the first `count`."""
    m, names = pointers(arrays), pointer(seat)
    n = counts[DISKS]
    for k in range(begin, end):
        name = said_by[k]
        i = word(names, name)
        if i < n and word(m.disks, i * WORDS + ID) == name and flags_of(m, i) & TOLD:
            times[count] = said_at[k]
            told[count] = k
            count += 1
    return count


@inline
def tell(m, said, place_, i):
    """Write down the flight of disk i that has just begun."""
    copy_record(said, place_, m.disks, i)
    store(said, place_ * WORDS + MET, name_of(m, word(m.disks, i * WORDS + MET)))


@inline
def is_known(m, i, source, k):
    """Whether disk i flies as it is told to."""
    same = True
    for number in range(5):
        same &= bits(m.disks, i * REALS + number) == bits(source, k * REALS + number)
    return same


@inline
def fly_as_told(m, i, source, k, names, n):
    for number in range(5):
        store(m.disks, i * REALS + number, real(source, k * REALS + number))
    store(m.disks, i * REALS + CONTACT_TIME, real(source, k * REALS + CONTACT_TIME))
    store(m.disks, i * WORDS + COUNT, word(source, k * WORDS + COUNT))
    store(m.disks, i * WORDS + AT_ONCE, word(source, k * WORDS + AT_ONCE))
    store(m.disks, i * WORDS + MET_KX, word(source, k * WORDS + MET_KX))
    store(m.disks, i * WORDS + MET_KY, word(source, k * WORDS + MET_KY))
    met = word(source, k * WORDS + MET)
    if met >= 0:
        j = word(names, met)
        met = j if j < n and word(m.disks, j * WORDS + ID) == met else ABSENT - met
    store(m.disks, i * WORDS + MET, met)


@kernel
def run_tile(
    arrays, grid, frame, rules, limits, clock, keys, sums, counts, most, budget, said, said_by, said_at, seat, told,
    number_told,
):
    """Let the disks of a tile live until the end of the window; the status.

    said: flights that tiles tell others; told: places there of those that this one is told, in the order of time.
    """
    m = pointers(arrays)
    limit, source, names = pointer(limits), pointer(said), pointer(seat)
    heard, right, saying, room_to_say = 0, 0, counts[SAID], len(said) // REALS - 2
    day = day_at(grid, frame.begin)
    cursor, steps, contacts, predicted = counts[CURSOR], 0, 0, 0
    fastest, deepest = most[FASTEST], most[OVERLAP]
    room = len(keys)
    status = ENDLESS
    while steps < budget:
        i, day, others, _ = first(m, grid, day, frame.end, NO_DAY, rules.tie_screen)
        now = real(m.disks, i * REALS + DUE) if i >= 0 else frame.end
        if heard < number_told:
            k = told[heard]
            since = real(source, k * REALS + T)
            if since < now:
                heard += 1
                i = word(names, word(source, k * WORDS + ID))
                if not is_known(m, i, source, k):
                    take(m, i)
                    fly_as_told(m, i, source, k, names, counts[DISKS])
                    predict_in_tile(m, grid, frame, rules, i, since, since)
                    push_in_time(m, grid, frame, limit, i, day)
                    predicted += 1
                    right += 1
                continue
        if not now < frame.end:
            status = DONE
            break
        if others > 0 and not (others == 1 and is_mutual(m, i)):
            k = unsettled(m, grid, i, day, rules.tie_screen)
            if k == grid.n and is_tied(m, grid, i, day, rules.tie_screen):
                j = word(m.disks, i * WORDS + PARTNER)
                if matters(m, i) or matters(m, j if j >= 0 else i):
                    status = TIE
                    break
            i = i if k == grid.n else k
        steps += 1
        take(m, i)
        code = word(m.disks, i * WORDS + PARTNER)
        if code >= 0:
            if not is_stale(m, i):
                take(m, code)
                here = matters(m, i) or matters(m, code)
                if word(m.disks, i * WORDS + PARTNER_COUNT) & COUNTS and here:
                    status = TIE
                    break
                if (
                    (flags_of(m, i) | flags_of(m, code)) & MARKED
                    or not now < limit_of(m, grid, frame, limit, i)
                    or not now < limit_of(m, grid, frame, limit, code)
                ):
                    if here:
                        status = MARK
                        break
                    mark(m, i)
                    mark(m, code)
                if cursor >= room:
                    status = NO_ROOM
                    break
                a = code if word(m.disks, code * WORDS + LABEL) < word(m.disks, i * WORDS + LABEL) else i
                keys[cursor] = now
                overlap = resolve_pair(m, rules, sums, i, code, now, clock, 0, cursor, None)
                if flags_of(m, a) & OWNED:
                    cursor += 1
                    deepest = overlap if overlap > deepest else deepest
                contacts += 1
                for disk in (i, code):
                    if flags_of(m, disk) & STRIP:
                        said_by[saying], said_at[saying] = word(m.disks, disk * WORDS + ID), now
                        tell(m, source, saying, disk)
                        saying += 1
                if saying >= room_to_say:
                    status = NO_ROOM
                    break
                fastest = max(fastest, max(square_of_speed(m, i), square_of_speed(m, code)))
                predict_in_tile(m, grid, frame, rules, code, now, now)
                push_in_time(m, grid, frame, limit, code, day)
                predicted += 1
        else:
            column, row = next_cell(m, grid, i, code)
            if local_column(grid, frame, column) > frame.columns or local_row(grid, frame, row) > frame.rows:
                mark(m, i)  # it leaves the tile
                store(m.disks, i * REALS + DUE, NEVER)
                store(m.disks, i * WORDS + PARTNER, NOTHING)
                push_in_time(m, grid, frame, limit, i, day)
                continue
            if code <= WRAP_RIGHT:
                met = word(m.disks, i * WORDS + MET)
                wrap(m, rules, i, code, now)
                store(m.disks, i * WORDS + MET, met)  # a partner who is absent looks like a wall
            leave_cell(m, grid, frame, i)
            if not enter_cell(m, grid, frame, i, column, row):
                if matters(m, i):
                    status = FULL
                    break
                mark(m, i)
        predict_in_tile(m, grid, frame, rules, i, now, now)
        push_in_time(m, grid, frame, limit, i, day)
        predicted += 1
        if word(m.disks, i * WORDS + AT_ONCE) >= rules.at_once_limit and matters(m, i):
            status = STUCK
            break
    counts[STEPS] += steps
    counts[CONTACTS] += contacts
    counts[PREDICTED] += predicted
    if status == DONE:
        counts[CURSOR], counts[SAID] = cursor, saying
        counts[PUT_RIGHT] += right
        most[FASTEST], most[OVERLAP] = fastest, deepest
    return status


@inline
def mixed(seal, number):
    """Two numbers made one, so that nearly all differences show."""
    seal = (seal ^ number) * 0x2545F4914F6CDD1D
    return seal ^ (seal >> 29)


@inline
def seal_of(m, i):
    """A number for all that disk i did in the window: its last flight, its last contact, how many flights; never 0."""
    f = i * REALS
    seal = mixed(word(m.disks, i * WORDS + COUNT), bits(m.disks, f + X))
    seal = mixed(mixed(seal, bits(m.disks, f + Y)), bits(m.disks, f + T))
    seal = mixed(mixed(seal, bits(m.disks, f + VX)), bits(m.disks, f + VY))
    seal = mixed(mixed(seal, bits(m.disks, f + CONTACT_TIME)), name_of(m, word(m.disks, i * WORDS + MET)))
    return seal | 1


@inline
def name_of(m, met):
    """The name of whom a disk met last, from a local place."""
    if met >= 0:
        return word(m.disks, met * WORDS + ID)
    return met if met <= NOBODY else ABSENT - met


@kernel
def write_tile(arrays, grid, frame, rules, new, start, first_cell, seals, origin, cell_of, sizes, counts, most):
    """Compare or write the seals of disks near the border; write the disks that are in the tile now, cell by cell."""
    m = pointers(arrays)
    target, back, cells, size = pointer(new), pointer(origin), pointer(cell_of), pointer(sizes)
    sealed = pointer(seals)
    n, end, halo = counts[DISKS], frame.end, frame.halo
    width, height = frame.columns - 2 * halo, frame.rows - 2 * halo
    fastest = most[FASTEST]
    for k in range(width * height + 1):
        store(size, k, 0)
    misses = 0
    for i in range(n):
        store(cells, i, -1)
        flags = flags_of(m, i)
        if not flags & (OWNED | NEAR):
            continue
        x, y = place(m, rules, i, end)
        column = place_in(x, grid.low_x, grid.side_x, grid.columns)
        row = place_in(y, grid.low_y, grid.side_y, grid.rows)
        local_x, local_y = local_column(grid, frame, column), local_row(grid, frame, row)
        out = outside(frame, local_x, local_y)
        if out <= 0:
            cell = (local_y - halo - 1) * width + local_x - halo - 1
            store(cells, i, cell)
            store(size, cell + 1, word(size, cell + 1) + 1)
            if column != word(m.disks, i * WORDS + COLUMN) or row != word(m.disks, i * WORDS + ROW):
                store(m.disks, i * WORDS + COLUMN, column)  # it is at the very edge
                store(m.disks, i * WORDS + ROW, row)
                edge = column == 1 or row == 1 or column == grid.columns or row == grid.rows
                store(m.disks, i * WORDS + FLAGS, flags & ~EDGE | EDGE if edge else flags & ~EDGE)
                store(m.disks, i * REALS + DUE, AFRESH)
            fastest = max(fastest, square_of_speed(m, i))
        if flags & (NEAR | STRIP) and not flags & TOLD:
            misses += sealed_otherwise(m, i, sealed, word(back, i))
    total = counts[OUT]
    for cell in range(width * height):
        start[first_cell + cell] = total
        number = word(size, cell + 1)
        store(size, cell, total)
        total += number
    start[first_cell + width * height] = total
    for i in range(n):
        cell = word(cells, i)
        if cell < 0:
            continue
        k = word(size, cell)
        store(size, cell, k + 1)
        met, partner = word(m.disks, i * WORDS + MET), word(m.disks, i * WORDS + PARTNER)
        copy_record(target, k, m.disks, i)
        store(target, k * WORDS + MET, name_of(m, met))
        if partner >= 0:
            store(target, k * WORDS + PARTNER, word(m.disks, partner * WORDS + ID))
        elif partner == NOTHING:
            store(target, k * REALS + DUE, AFRESH)
    counts[OUT] = total
    counts[MISSES] += misses
    most[FASTEST] = fastest


@inline
def sealed_otherwise(m, i, sealed, k):
    """1 if another tile saw disk i do something else; else its seal is written."""
    seal, other = seal_of(m, i), bits(sealed, k)
    store_bits(sealed, k, seal)
    return 1 if other != 0 and other != seal else 0


@intrinsic
def store_bits(typing, data, index, value):
    """Store 64 bits."""

    def codegen(context, builder, signature, args):
        value = context.cast(builder, args[2], signature.args[2], types.int64)
        builder.store(value, place_of(context, builder, signature, args, I64))
        return context.get_dummy_value()

    return types.void(data, index, value), codegen


@kernel
def order_rows(keys, count, begin, end, order, heads):
    """Put the places of rows in the order of their times; whether two times are equal."""
    heads[: count + 1] = 0
    scale = count / (end - begin)
    for k in range(count):
        heads[min(int((keys[k] - begin) * scale), count - 1) + 1] += 1
    for k in range(count):
        heads[k + 1] += heads[k]
    for k in range(count):
        b = min(int((keys[k] - begin) * scale), count - 1)
        order[heads[b]] = k
        heads[b] += 1
    ties = 0
    for k in range(1, count):
        j, one = k, order[k]
        time = keys[one]
        while j > 0 and keys[order[j - 1]] > time:
            order[j] = order[j - 1]
            j -= 1
        order[j] = one
        if j > 0 and keys[order[j - 1]] == time:
            ties += 1
    return ties


@kernel
def copy_rows(rows, order, begin, end, number, out):
    """Write rows in order, with their numbers."""
    source, target = pointer(rows), pointer(out)
    for k in range(begin, end):
        ahead = order[min(k + 12, end - 1)] * REALS
        prefetch(source, ahead)
        prefetch(source, ahead + 8)
        copy_record(target, k - begin, source, order[k])
        store_bits(target, (k - begin) * REALS, number + k)


@kernel
def turn_over_records(arrays, rules, n, end, shift):
    """As `loop.turn_over`; all disks are to be predicted."""
    m = pointers(arrays)
    for i in range(n):
        x, y = place(m, rules, i, end)
        vx, vy = speed(m, rules, i, end)
        anchor(m, i, end - shift, x, y, vx, vy)
        store(m.disks, i * REALS + CONTACT_TIME, real(m.disks, i * REALS + CONTACT_TIME) - shift)
        store(m.disks, i * REALS + DUE, AFRESH)


EVENT_DAYS = 1.4
"""Days of the calendar for each event."""

LARGE = 1 << 23
"""Bytes from which on the system gives large pages."""

BLOCK = 1 << 13
"""Rows that are handed out at once, as the ordinary loop does."""


class Spent:
    """CPU time by what it was spent on."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}

    @contextmanager
    def on(self, what: str) -> Iterator[None]:
        began = process_time()
        yield
        self.seconds[what] = self.seconds.get(what, 0.0) + process_time() - began


class Tiles:
    """A gas that goes on from where a session of the fast engine stands, in tiles.

    side: of a tile, cells, about.  halo, near: cells.  afresh: predict all disks in each window, as if no event were scheduled.
    """

    def __init__(self, session: FastSession, side: int, halo: int, near: int, afresh: bool = False) -> None:
        machine, state = session._machine, session.state
        self.stage, self.rules = session.stage, machine.rules
        self.n = n = state.n
        assert machine.grid.depth == DEPTH
        assert machine.grid.levels is None
        assert self.rules.sinks is None
        assert self.stage.mass is None
        self.grid = machine.grid._replace(n=0, look_ahead=None)
        self.halo, self.near, self.afresh = halo, near, afresh
        self.epoch, self.now = state.epoch, state.now
        self.window, self.window_end, self.window_rows = state.window, float(state.window_end), state.window_rows
        self.events = int(machine.counts[layout.EVENTS])
        self.radius = float(self.stage.radius[0])
        self.chosen_events = 0.8 / pace(session)  # of a disk in a time, about
        columns, rows = self.grid.columns, self.grid.rows
        self.x_edges, self.y_edges = _edges(columns, side), _edges(rows, side)
        widest = max(np.diff(self.x_edges).max(), np.diff(self.y_edges).max())
        assert widest + 2 * halo + 2 <= min(columns, rows), "the box is too small for such tiles"
        self.most_halo = min(4 * halo, (min(columns, rows) - int(widest)) // 2 - 1)
        self._lay_out(state, widest)
        self.sums, self.most = np.zeros(6), np.zeros(2)
        self.counts = np.zeros(9, np.int64)
        self.most[0] = float((state.disks[:n, VX] ** 2 + state.disks[:n, VY] ** 2).max())
        self.spent = Spent()
        self.ordinary: FastSession | None = None
        self.redone = {"tiles": 0, "windows": 0, "near": 0, "rows": 0, "ordinary": 0}

    def _lay_out(self, state: Any, widest: int) -> None:
        """Order all records by tile and cell."""
        n, columns, rows = self.n, self.grid.columns, self.grid.rows
        table = []
        for edges, count in ((self.x_edges, columns), (self.y_edges, rows)):
            tile = np.searchsorted(edges, np.arange(count), side="right") - 1
            table.append(np.stack([tile, edges[tile], edges[tile + 1]], axis=1).reshape(-1))
        sizes = np.outer(np.diff(self.y_edges), np.diff(self.x_edges)).reshape(-1)
        self.first_cells = np.concatenate([[0], np.cumsum(sizes)])
        self.tiles = np.concatenate([*table, self.first_cells]).astype(np.int64)
        self.old, self.new = aligned((n + 1) * REALS, np.float64), aligned((n + 1) * REALS, np.float64)
        self.seat, self.seals = np.zeros(n, np.int32), np.zeros(n, np.int64).view(np.float64)
        self.new_start = np.zeros(columns * rows + 1, np.int32)
        self._sort_in(state)
        cells = columns * rows
        largest = (int(widest) + 2 * self.most_halo) ** 2
        room = min(n, int(1.1 * n * largest / cells + 6.0 * math.sqrt(largest)) + 64)
        days = 1 << max(6, (2 * room).bit_length())
        self.grid = self.grid._replace(n=room, days=days)
        numbers = (room + 1) * REALS + (days + WAITING) // 2
        self.local = aligned(max(numbers, LARGE // 8), np.float64)  # so it has large pages
        self.local[room * REALS : room * REALS + 6] = np.nan
        self.local[: (room + 1) * REALS].view(np.int32).reshape(-1, WORDS)[room, MET] = NOBODY
        self.per_cell = n / cells
        self.slots = aligned(DEPTH * (int(widest) + 2 * self.most_halo + 2) ** 2 + 16, np.int32)
        self.origin, self.cell_of = np.zeros(room, np.int32), np.zeros(room, np.int32)
        self.sizes = np.zeros(int(widest) ** 2 + 1, np.int32)
        self.near_list = aligned(9 * DEPTH + 32, np.int32)
        self.done = np.zeros(len(self.first_cells) - 1, np.int64)
        self.ranges: dict[int, tuple[int, int]] = {}
        strips = min(1.0, 4.4 * self.near / float(widest))
        self._make_room(n // 2 + 1024, int(strips * n) + 1024)
        self.out = aligned(BLOCK * REALS, np.float64)

    def _sort_in(self, state: Any) -> None:
        """Take over the records of the ordinary loop, tile by tile, cell by cell."""
        n, columns, rows = self.n, self.grid.columns, self.grid.rows
        of_x, of_y = (self.tiles[k : k + 3 * count].reshape(-1, 3) for k, count in ((0, columns), (3 * columns, rows)))
        words = state.words[:n]
        column, row = words[:, layout.COLUMN] - 1, words[:, layout.ROW] - 1
        in_x, in_y = of_x[column], of_y[row]
        cell = self.first_cells[in_y[:, 0] * (len(self.x_edges) - 1) + in_x[:, 0]]
        cell = cell + (row - in_y[:, 1]) * (in_x[:, 2] - in_x[:, 1]) + column - in_x[:, 1]
        order = np.argsort(cell, kind="stable")
        records = self.old[: n * REALS].reshape(n, REALS)
        records[:] = state.disks[order]
        records.view(np.int32).reshape(n, WORDS)[:, ID] = order
        self.start = np.searchsorted(cell[order], np.arange(columns * rows + 1)).astype(np.int32)

    def _ordinarily(self, end: float) -> list[Any]:
        """Take a window back, and let the ordinary loop do it; its rows."""
        if self.ordinary is None:
            self.ordinary = FastSession(self.stage, keep_rows=True, options=FastOptions(lanes=self.grid.lanes is not None))
        session = self.ordinary
        machine, state = session._machine, session.state
        machine.set_epoch(self.epoch)
        state.disks[: self.n] = self.records()
        state.words[: self.n, FLAGS] &= ~KINDS
        state.begin_window(self.window)
        state.window_rows = self.window_rows
        machine.set_now(self.now)
        machine.counts[layout.EVENTS] = session.counters.events = self.events
        machine.predict_afresh()
        blocks = advance_ordinary(session, self.epoch, math.nextafter(end, 0.0), True)
        self._sort_in(state)
        records = self.old[: self.n * REALS].reshape(self.n, REALS)
        records[:, DUE] = AFRESH
        self.most[FASTEST] = float((records[:, VX] ** 2 + records[:, VY] ** 2).max())
        count = sum(map(len, blocks))
        self.events += count
        self.window_rows += count
        return blocks

    def _make_room(self, rows: int, flights: int) -> None:
        """Room for so many rows, and for so many flights that are told."""
        self.said = aligned(flights * REALS, np.float64)
        self.said_at, self.said_by = np.zeros(flights), np.zeros(flights, np.int32)
        few = max(1024, flights // 4)
        self.told_times, self.told = np.zeros(few), np.zeros(few, np.int32)
        self.rows, self.keys = aligned(rows * REALS, np.float64), np.zeros(rows)
        self.order, self.heads = np.zeros(rows, np.int32), np.zeros(rows + 1, np.int32)
        self.arrays = Arrays(self.local, self.slots, self.near_list, *[None] * 12, self.rows, None, None, None)

    @property
    def memory(self) -> int:
        """Bytes of all arrays."""
        return sum(array.nbytes for array in vars(self).values() if isinstance(array, np.ndarray))

    def advance(self, until: float, keep: bool) -> list[Any]:
        """Go on to a time of the clock's window, or through its turnover; blocks of rows if they are to be kept."""
        end = min(until, self.window_end)
        blocks = self._window(end, keep)
        self.now = end
        if end == self.window_end:
            with self.spent.on("turnover"):
                self._turn_over()
        return blocks

    def _window(self, end: float, keep: bool) -> list[Any]:
        halo = self.halo
        while not (told := self._try(end, halo)):
            if told is None or halo == self.most_halo:
                self.redone["ordinary"] += 1
                return self._ordinarily(end)
            halo = min(max(halo + 3, self.halo), self.most_halo)
            self.redone["windows"] += 1
        self.old, self.new = self.new, self.old
        self.start, self.new_start = self.new_start, self.start
        with self.spent.on("rows"):
            return self._merged(end, keep)

    def _try(self, end: float, halo: int) -> bool | None:
        """Do all tiles; whether all seals agree and nothing was too fast; None where it is for the ordinary loop."""
        counts, fastest = self.counts, float(self.most[FASTEST])
        counts[[CURSOR, MISSES, OUT, SAID]] = 0
        self.done[:] = 0
        self.ranges.clear()
        clock = self._clock()
        with self.spent.on("seals"):
            self.seals[:] = 0.0
        per_row = len(self.x_edges) - 1
        limits = self._limits(end, halo)
        for tile in range(len(self.first_cells) - 1):
            q, p = divmod(tile, per_row)
            wider, said = halo, int(counts[SAID])
            while (status := self._tile(p, q, end, wider, limits, clock)) not in (DONE, NO_ROOM):
                self.redone["tiles"] += 1
                if wider == self.most_halo or (status != MARK and wider > halo):  # no wider halo helps
                    self.most[FASTEST] = fastest
                    return None
                wider = min(wider + max(2, halo // 2), self.most_halo)
                limits = self._limits(end, wider)
            if wider != halo:
                limits = self._limits(end, halo)
            if status == NO_ROOM and counts[CURSOR] >= 0 and len(self.keys) < self.n * 8:
                self._make_room(len(self.keys) * 5 // 4, len(self.said_by) * 5 // 4)
                self.redone["rows"] += 1
                self.most[FASTEST] = fastest
                return self._try(end, halo)
            if status != DONE:
                return None
            self.ranges[tile], self.done[tile] = (said, int(counts[SAID])), 1
            with self.spent.on("write"):
                write_tile(
                    self.arrays, self.grid, self.frame, self.rules, self.new, self.new_start,
                    int(self.first_cells[tile]), self.seals, self.origin, self.cell_of, self.sizes, counts, self.most,
                )  # fmt: skip
        way = 2.0 * math.sqrt(float(self.most[FASTEST])) * (end - self.now) + 2.0 * self.radius
        if way > self.near * min(self.grid.side_x, self.grid.side_y):
            self.redone["near"] += 1
            self.near += 1
            self.halo = max(self.halo, self.near + 2)
            return False
        return bool(counts[MISSES] == 0 and counts[OUT] == self.n)

    def _limits(self, end: float, halo: int) -> Any:
        """Until when disks are followed, by how many cells they are outside of what the tile owns."""
        out = np.arange(halo + 2)
        share = np.clip((out - self.near - MARGIN) / max(1, halo - self.near - MARGIN + 1), 0.0, 1.0)
        return end - (end - self.now) * share

    def _clock(self) -> tuple[int, float, float]:
        from eventsim.formulas.expansion import two_sum

        return (self.epoch, *two_sum(self.epoch * self.stage.epoch_length, self.stage.start_time))

    def _tile(self, p: int, q: int, end: float, halo: int, limits: Any, clock: tuple[int, float, float]) -> int:
        x, y = self.x_edges, self.y_edges
        grid, counts = self.grid, self.counts
        self.frame = Frame(
            (int(x[p]) - halo) % grid.columns,
            (int(y[q]) - halo) % grid.rows,
            int(x[p + 1] - x[p]) + 2 * halo,
            int(y[q + 1] - y[q]) + 2 * halo,
            halo,
            self.near,
            self.now,
            end,
        )
        events = self.per_cell * self.frame.columns * self.frame.rows * self.chosen_events * (end - self.now)
        days = 1 << max(6, int(EVENT_DAYS * events)).bit_length()
        day = (end - self.now) / (EVENT_DAYS * events)
        self.grid = grid = grid._replace(days=days, day_length=day, days_per_time=1.0 / day)
        with self.spent.on("load"):
            status = load_tile(
                self.arrays, grid, self.frame, self.rules, limits, self.old, self.start, self.tiles, self.done, self.seat,
                self.origin, counts, self.afresh,
            )  # fmt: skip
        if status == DONE:
            with self.spent.on("told"):
                told = self._told(p, q)
            with self.spent.on("run"):
                status = run_tile(
                    self.arrays, grid, self.frame, self.rules, limits, clock, self.keys, self.sums, counts, self.most,
                    100 * int(counts[DISKS]) + 1000, self.said, self.said_by, self.said_at, self.seat, told, len(told),
                )  # fmt: skip
        return int(status)

    def _told(self, p: int, q: int) -> Any:
        """Places of the flights that the neighbours of a tile tell it, in the order of time."""
        across, along = len(self.x_edges) - 1, len(self.y_edges) - 1
        around = {((q + j) % along) * across + (p + i) % across for i in (-1, 0, 1) for j in (-1, 0, 1)}
        count = 0
        for tile in sorted(around & self.ranges.keys()):
            begin, end = self.ranges[tile]
            if count + end - begin > len(self.told):
                room = 2 * (count + end)
                self.told_times, self.told = np.resize(self.told_times, room), np.resize(self.told, room)
            count = collect_told(
                self.arrays, self.said_by, self.said_at, begin, end, self.seat, self.counts, count, self.told_times, self.told
            )
        return self.told[:count][np.argsort(self.told_times[:count], kind="stable")]

    def _merged(self, end: float, keep: bool) -> list[Any]:
        """The rows of the window, in order."""
        count = int(self.counts[CURSOR])
        blocks = []
        if count:
            ties = order_rows(self.keys, count, self.now, end, self.order, self.heads)
            assert ties == 0
            for begin in range(0, count, BLOCK):
                last = min(begin + BLOCK, count)
                copy_rows(self.rows, self.order, begin, last, self.events, self.out)
                if keep:
                    blocks.append(self.out[: (last - begin) * REALS].view(ROW_TYPE).copy())
        self.events += count
        self.window_rows += count
        return blocks

    def _turn_over(self) -> None:
        """Let the clock turn over at the end of its window."""
        end, length = self.window_end, self.stage.epoch_length
        epochs = int(end / length)
        exponent = exponent_after(self.stage, self.window, self.window_rows, self._anchors)
        turn_over_records(self.arrays._replace(disks=self.old), self.rules, self.n, end, epochs * length)
        self.epoch += epochs
        self.now = end - epochs * length
        self.window, self.window_rows = exponent, 0
        self.window_end = window_length(exponent, length)
        screen = screen_in(self.stage.tie_screen, self.window_end, length)
        self.rules = self.rules._replace(tie_screen=screen)

    def _anchors(self) -> Anchors:
        records = self.old[: self.n * REALS].reshape(self.n, REALS)
        return Anchors(*(records[:, k] for k in (T, X, Y, VX, VY)), None, None)

    def records(self) -> Any:
        """The records in the order of the ordinary loop's memory."""
        records = self.old[: self.n * REALS].reshape(self.n, REALS)
        names = records.view(np.int32).reshape(self.n, WORDS)[:, ID]
        ordered = np.empty_like(records)
        ordered[names] = records
        return ordered


def _edges(count: int, side: int) -> Any:
    """Where tiles of about that side begin and end."""
    return np.round(np.linspace(0, count, max(1, round(count / side)) + 1)).astype(np.int64)


def advance_ordinary(session: FastSession, epoch: int, now: float, keep: bool) -> list[Any]:
    """Let the ordinary loop go on to a time of its clock."""
    until = Fraction(session.stage.start_time) + epoch * Fraction(session.stage.epoch_length) + Fraction(now)
    blocks = []
    while session.advance(Stop(until=until), 1 << 20) is None:
        rows = session.take_rows()
        if keep:
            blocks.append(rows.copy())
    rows = session.take_rows()
    if keep:
        blocks.append(rows.copy())
    return blocks


COMPARED = (X, Y, VX, VY, T, CONTACT_TIME)
COMPARED_WORDS = (MET, COUNT, LABEL, AT_ONCE, layout.WRAPS_X, layout.WRAPS_Y, layout.MET_KX, layout.MET_KY)


def compare(tiles: Tiles, session: FastSession, mine: list[Any], theirs: list[Any]) -> int:
    """Demand that rows and records are the same, bit for bit; how many rows."""
    ours, other = (np.concatenate([np.empty(0, ROW_TYPE), *blocks]) for blocks in (mine, theirs))
    counts = [np.bincount(np.concatenate([rows["a"], rows["b"]]), minlength=tiles.n) for rows in (ours, other)]
    assert np.array_equal(*counts), f"contacts of disks differ: {np.flatnonzero(counts[0] != counts[1])}"
    assert ours.tobytes() == other.tobytes(), "rows differ"
    assert (tiles.epoch, tiles.now) == (session.state.epoch, session.state.now)
    records, reference = tiles.records(), session.state.disks[: tiles.n]
    for k in COMPARED:
        assert np.array_equal(records[:, k].view(np.int64), reference[:, k].view(np.int64)), f"number {k} of records differs"
    words, others = (array.view(np.int32).reshape(tiles.n, WORDS) for array in (records, np.ascontiguousarray(reference)))
    for k in COMPARED_WORDS:
        assert np.array_equal(words[:, k], others[:, k]), f"word {k} of records differs"
    return len(ours)


def warm_session(n: int, eta: float, contacts: float, lanes: bool | None = None) -> FastSession:
    """A session of the fast engine, so many contacts per disk old."""
    session = FastSession(stage_of(lattice_gas(n, eta)), keep_rows=True, options=FastOptions(lanes=lanes))
    while session.advance(Stop(events=int(contacts * n / 2.0)), 1 << 20) is None:
        session.take_rows()
    session.take_rows()
    return session


LANES = {"auto": None, "on": True, "off": False}
SMALL_CONTACTS = 100_000


def pace(session: FastSession) -> float:
    """The mean time of a disk from contact to contact."""
    state, counts = session.state, session._machine.counts
    time = state.epoch * state.epoch_length + float(state.now)
    return time * state.n / (2.0 * float(counts[layout.EVENTS]))


def check(tiles: Tiles, session: FastSession, step: float, windows: int) -> int:
    """Compare so many windows; how many rows."""
    rows = 0
    for _ in range(windows):
        mine = tiles.advance(tiles.now + step, True)
        rows += compare(tiles, session, mine, advance_ordinary(session, tiles.epoch, tiles.now, True))
    return rows


def main() -> None:
    parser = arguments(__doc__)
    parser.add_argument("--n", type=whole, default=100_000)
    parser.add_argument("--eta", type=float, default=0.5)
    parser.add_argument("--side", type=int, default=128)
    parser.add_argument("--halo", type=int, default=12)
    parser.add_argument("--near", type=int, default=4)
    parser.add_argument("--window", type=float, default=1.0, help="contacts of a disk in a window, on the average")
    parser.add_argument("--windows", type=int, default=8, help="windows that are compared")
    parser.add_argument("--repeats", type=int, default=0, help="how often rates are measured")
    parser.add_argument("--per-repeat", type=int, default=4, help="windows in each of them")
    parser.add_argument("--warm-up", type=float, default=10.0, help="contacts per disk before anything is looked at")
    parser.add_argument("--lanes", choices=("auto", "on", "off"), default="auto", help="eight pairs at a time, in both loops")
    parser.add_argument("--afresh", action="store_true", help="predict all disks in each window")
    chosen = parser.parse_args()
    session = warm_session(chosen.n, chosen.eta, chosen.warm_up, LANES[chosen.lanes])
    step = chosen.window * pace(session)
    tiles = Tiles(session, chosen.side, chosen.halo, chosen.near, chosen.afresh)
    print(f"n {tiles.n}, eta {chosen.eta}, cells {tiles.grid.columns} x {tiles.grid.rows}, tiles "
          f"{len(tiles.x_edges) - 1} x {len(tiles.y_edges) - 1}, bytes per disk {tiles.memory / tiles.n:.0f}")
    rows = check(tiles, session, step, chosen.windows)
    print(f"{chosen.windows} windows, {rows} rows: the same, bit for bit; done once more: {tiles.redone}; near {tiles.near}")
    if chosen.repeats:
        rates(tiles, session, step, chosen)


def rates(tiles: Tiles, session: FastSession, step: float, chosen: Any) -> None:
    """Time both loops in turn, and the ordinary one with a system that the caches hold."""
    ratios, in_caches, contacts = [], [], 0
    small = warm_session(4000, chosen.eta, 10.0, LANES[chosen.lanes])
    tiles.spent = Spent()
    tiles.counts[[PREDICTED, STEPS, CONTACTS]] = 0
    total = 0.0
    for _ in range(chosen.repeats):
        begun, events = process_time(), tiles.events
        for _ in range(chosen.per_repeat):
            tiles.advance(tiles.now + step, False)
        between = process_time()
        advance_ordinary(session, tiles.epoch, tiles.now, False)
        ended = process_time()
        done = tiles.events - events
        small_stop = Stop(events=small.counters.events + SMALL_CONTACTS)
        while small.advance(small_stop, 1 << 20) is None:
            small.take_rows()
        small.take_rows()
        in_caches.append((process_time() - ended) / SMALL_CONTACTS)
        assert int(session._machine.counts[layout.EVENTS]) == tiles.events
        contacts += done
        total += between - begun
        ratios.append((ended - between) / (between - begun))
        print(f"  ns per contact: tiles {1e9 * (between - begun) / done:.0f}, ordinary {1e9 * (ended - between) / done:.0f}, "
              f"with 4000 disks {1e9 * in_caches[-1]:.0f}, ratio {ratios[-1]:.2f}", flush=True)
    parts = ", ".join(f"{what} {1e9 * seconds / contacts:.0f}" for what, seconds in tiles.spent.seconds.items())
    counts = tiles.counts
    print(f"ratio, median of {chosen.repeats}: {statistics.median(ratios):.2f} (CPU time)")
    print(f"ns per contact: {parts}; all {1e9 * total / contacts:.0f}")
    print(f"contacts done / logged {counts[CONTACTS] / contacts:.3f}, steps {counts[STEPS] / contacts:.2f}, predictions "
          f"{counts[PREDICTED] / contacts:.2f} per logged contact; done once more: {tiles.redone}")


if __name__ == "__main__":
    sys.exit(main())
