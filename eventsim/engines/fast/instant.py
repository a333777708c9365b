"""Contacts of one time, or nearly so: found here, all of them, for the reference engine's law of simultaneous contacts."""

from __future__ import annotations

from eventsim.engines.fast.advance import place, pulls
from eventsim.engines.fast.calendar import bucket, day_of
from eventsim.engines.fast.cells import depth_of, gather_near, home_of
from eventsim.engines.fast.compiled import inline, kernel, real, word
from eventsim.engines.fast.layout import (
    COLUMN,
    DAY,
    DUE,
    NEXT,
    RADIUS,
    REALS,
    ROW,
    VX,
    VY,
    WORDS,
    T,
    X,
    Y,
)
from eventsim.engines.fast.loop import pointers
from eventsim.engines.fast.pairs import images, pair_is_due
from eventsim.engines.fast.predict import corner_slot, number_sought
from eventsim.engines.fast.rest import border_contact
from eventsim.engines.fast.single_disk_events import shape_near, shape_time, shapes_near
from eventsim.formulas.crossing import crossing_delay
from eventsim.formulas.rest import STRUCK


@kernel
def contacts_between(arrays, grid, rules, counts, first, latest, found, times):
    """Write all contacts due at first, ..., latest to `found` (M, 4), their times to `times` (M,).

    found: disk, partner (walls: -1 - place), image or (side, how).  Returns how many there are, also where there is no room
    for them.  A contact of two disks may come twice.
    """
    m = pointers(arrays)
    span = first, latest
    count = 0
    last = min(day_of(grid, latest, counts[DAY]) + 1, counts[DAY] + grid.days - 1)  # one more, since a day is rounded
    for day in range(counts[DAY], last + 1):
        i = word(m.disks, bucket(grid, day))
        while i != grid.n:
            if first <= real(m.disks, i * REALS + DUE) <= latest:
                count = _pairs_between(m, grid, rules, i, span, found, times, count)
                if rules.features is not None:
                    count = _shapes_between(m, grid, rules, i, span, found, times, count)
                count = _walls_between(m, grid, rules, i, span, found, times, count)
            i = word(m.disks, i * WORDS + NEXT)
    return count


@kernel
def due_at(arrays, grid, counts, now, found):
    """Write the disks that are scheduled at `now` to found[:, 0]; how many there are, also where it is too short."""
    m = pointers(arrays)
    count = 0
    i = word(m.disks, bucket(grid, counts[DAY]))
    while i != grid.n:
        if real(m.disks, i * REALS + DUE) == now:
            if count < len(found):
                found[count, 0] = i
            count += 1
        i = word(m.disks, i * WORDS + NEXT)
    return count


@inline
def _add(span, found, times, count, time, i, partner, kx, ky):
    """Note a contact if its time is within the span; how many there are."""
    if not span[0] <= time <= span[1]:
        return count
    if count < len(found):
        found[count, 0], found[count, 1], found[count, 2], found[count, 3] = i, partner, kx, ky
        times[count] = time
    return count + 1


@inline
def _pairs_between(m, grid, rules, i, span, found, times, count):
    if m.slots is None:
        return _pairs_of_everyone(m, grid, rules, i, span, found, times, count)
    x, y = place(m, rules, i, span[0])
    if grid.levels is not None:
        for k in range(gather_near(m, grid, rules, i, x, y, -1)):
            count = _pair_between(m, rules, i, word(m.near, k), span, x, y, found, times, count)
        return count
    start, depth = corner_slot(m, grid, i), depth_of(grid)
    for _ in range(3):
        for k in range(3 * depth):
            j = word(m.slots, start + k)
            if j != grid.n and j != i:
                count = _pair_between(m, rules, i, j, span, x, y, found, times, count)
        start += depth * (grid.columns + 2)
    return count


@inline
def _pair_between(m, rules, i, j, span, x, y, found, times, count):
    kx, ky = images(m, rules, i, j, span[0], x, y)
    return _add(span, found, times, count, pair_is_due(m, rules, i, j, kx, ky), i, j, kx, ky)


@inline
def _pairs_of_everyone(m, grid, rules, i, span, found, times, count):
    span_x = 0 if rules.length_x is None else 1
    span_y = 0 if rules.length_y is None else 1
    for j in range(number_sought(grid)):
        for kx in range(-span_x, span_x + 1):
            for ky in range(-span_y, span_y + 1):
                if j != i:
                    count = _add(span, found, times, count, pair_is_due(m, rules, i, j, kx, ky), i, j, kx, ky)
    return count


@inline
def _shapes_between(m, grid, rules, i, span, found, times, count):
    begin, end = shapes_near(m, home_of(m, grid, i), rules, i)
    for item in range(begin, end):
        k = shape_near(m, item)
        time, side, how = shape_time(m, rules, i, k)
        count = _add(span, found, times, count, time, i, -1 - (rules.first_feature + k), side, how)
    return count


@inline
def _walls_between(m, grid, rules, i, span, found, times, count):
    f = i * REALS
    t, r = real(m.disks, f + T), real(m.disks, f + RADIUS)
    gx, gy = pulls(m, rules, i)
    x, u, y, w = real(m.disks, f + X), real(m.disks, f + VX), real(m.disks, f + Y), real(m.disks, f + VY)
    column, row = word(m.disks, i * WORDS + COLUMN), word(m.disks, i * WORDS + ROW)
    home = home_of(m, grid, i)
    across = m, rules, i, span, found, times
    count = _walls_across(*across, x, u, t, r, gx, rules.width, column, home.columns, rules.wall_x, count)
    return _walls_across(*across, y, w, t, r, gy, rules.height, row, home.rows, rules.wall_y, count)


@inline
def _walls_across(m, rules, i, span, found, times, x, v, t, r, g, length, k, last, wall, count):
    if wall is None:
        return count
    if k == 1:
        time, how = _wall_time(m, rules, i, wall, 1.0, 0.0, r, x, v, t, g)
        count = _add(span, found, times, count, time, i, -1 - wall, 1, how)
    if k == last:
        time, how = _wall_time(m, rules, i, wall + 1, -1.0, length, r, x, v, t, g)
        count = _add(span, found, times, count, time, i, -2 - wall, -1, how)
    return count


@inline
def _wall_time(m, rules, i, place, side, border, r, x, v, t, g):
    if m.supports is None:
        return t + crossing_delay(x, v, g, border + side * r, side), STRUCK
    return border_contact(m, rules, i, place, side, border + side * r, x, v, g)
