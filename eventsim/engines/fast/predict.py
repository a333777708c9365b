"""Predictions: the earliest event that the present flight of a disk can lead to becomes its scheduled event.

Contacts are looked for among those around: one by one, eight at a time, on levels of grids.
"""

from __future__ import annotations

from eventsim.engines.fast.advance import place, speed
from eventsim.engines.fast.calendar import earlier
from eventsim.engines.fast.cells import depth_of, gather_near, home_of, look_delay, slot_of
from eventsim.engines.fast.compiled import contact_of_eight, either, gather_disks, inline, part, real, store, word
from eventsim.engines.fast.last_contact import partner_just_met
from eventsim.engines.fast.layout import (
    COLUMN,
    COUNT,
    COUNTS,
    DUE,
    EDGE,
    FLAGS,
    LOOK,
    MET,
    NOBODY,
    NOTHING,
    PARTNER,
    PARTNER_COUNT,
    RADIUS,
    REALS,
    REGISTER,
    ROW,
    SEVERAL,
    USUAL_DEPTH,
    VX,
    VY,
    WALL,
    WORDS,
    T,
    X,
    Y,
)
from eventsim.engines.fast.pairs import images, pair_is_due
from eventsim.engines.fast.rest import is_for_rules, may_be_spent
from eventsim.engines.fast.single_disk_events import border_events, crossing, earliest_at_shapes
from eventsim.formulas.doubt import may_tie
from eventsim.formulas.real import NEVER

BEYOND = 2.0**-20
"""How far beyond a boundary, as a part of the period, nothing is met before a wrap."""


@inline
def predict_post(m, i):
    """Schedule nothing for disk i, which others foresee contacts with."""
    store(m.disks, i * REALS + DUE, NEVER)
    store(m.disks, i * WORDS + PARTNER, NOTHING)
    store(m.disks, i * WORDS + PARTNER_COUNT, 0)


@inline
def predict(m, grid, rules, i, now, floor):
    """Schedule the earliest event of disk i that is not before `floor`: a contact, a wrap, or the next cell crossing."""
    x, y, time, code, shared = _alone(m, grid, rules, i, now, floor)
    contacts = either(m.slots, contacts_in_cells, contacts_of_everyone)
    time, code, shared = contacts(m, grid, rules, i, now, floor, x, y, time, code, shared)
    _schedule(m, grid, rules, i, now, floor, x, y, time, code, shared)


@inline
def predict_both(m, grid, rules, i, j, now):
    """Schedule the earliest events of two disks that have just met."""
    in_one_grid = either(grid.levels, _one_after_the_other, either(grid.lanes, _side_by_side, _one_after_the_other))
    both = either(m.slots, in_one_grid, _one_after_the_other)
    both(m, grid, rules, i, j, now)


@inline
def _one_after_the_other(m, grid, rules, i, j, now):
    predict(m, grid, rules, i, now, now)
    predict(m, grid, rules, j, now, now)


@inline
def _side_by_side(m, grid, rules, i, j, now):
    """The same in lanes: neither disk waits for what is found for the other one, so the processor does both at once."""
    x, y, time, code, shared = _alone(m, grid, rules, i, now, now)
    other_x, other_y, other_time, other_code, other_shared = _alone(m, grid, rules, j, now, now)
    edge, other_edge = word(m.disks, i * WORDS + FLAGS) & EDGE, word(m.disks, j * WORDS + FLAGS) & EDGE
    begin = 9 * depth_of(grid) + REGISTER  # room for a list, with the register that is written behind its end
    end = _gather_around(m, grid, rules, i, now, x, y, edge, 0)
    other_end = _gather_around(m, grid, rules, j, now, other_x, other_y, other_edge, begin)
    edge |= other_edge
    found = _eight(m, rules, i, now, now, x, y, edge, 0)
    other_found = _eight(m, rules, j, now, now, other_x, other_y, edge, begin)
    time, code, shared = _or_among(m, rules, i, now, now, x, y, edge, 0, end, found, time, code, shared)
    _schedule(m, grid, rules, i, now, now, x, y, time, code, shared)
    x, y, end, found, time, code, shared = other_x, other_y, other_end, other_found, other_time, other_code, other_shared
    time, code, shared = _or_among(m, rules, j, now, now, x, y, edge, begin, end, found, time, code, shared)
    _schedule(m, grid, rules, j, now, now, x, y, time, code, shared)


@inline
def _alone(m, grid, rules, i, now, floor):
    """(x, y, time, code, shared): where disk i is, and its earliest event without another disk or a wall shape."""
    x, y = place(m, rules, i, now)
    u, w = speed(m, rules, i, now)
    home = home_of(m, grid, i)
    if word(m.disks, i * WORDS + FLAGS) & EDGE:
        time, code, shared = border_events(m, home, rules, i, now, floor, x, y, u, w)
    else:
        time, code = crossing(m, home, rules, i, now, x, y, u, w)
        shared = 0
    if grid.levels is not None:
        look = now + look_delay(m, grid, rules, i, u, w)
        time, code, shared = earlier(time, code, shared, look, LOOK, rules.tie_screen)
    return x, y, time, code, shared


@inline
def _schedule(m, grid, rules, i, now, floor, x, y, time, code, shared):
    """Schedule the given event of disk i, or a contact with a wall shape that is before it."""
    if rules.features is not None:
        time, code, shared = earliest_at_shapes(m, grid, rules, i, now, floor, x, y, time, code, shared)
    if rules.still is not None and code <= WALL and may_be_spent(m, rules, i, time):
        shared = 1  # rests are left to the reference engine's rules, as if another contact shared their time
    if m.supports is not None and is_for_rules(m, rules, i, code, time):
        shared = 1
    count = word(m.disks, (code if code >= 0 else grid.n) * WORDS + COUNT)  # of the sentinel: 0
    store(m.disks, i * REALS + DUE, time)
    store(m.disks, i * WORDS + PARTNER, code)
    store(m.disks, i * WORDS + PARTNER_COUNT, count + COUNTS * shared)


@inline
def contacts_in_cells(m, grid, rules, i, now, floor, x, y, time, code, shared):
    """The earliest contact with another disk in the cells around, if that is before the given event."""
    in_one_grid = either(grid.lanes, _contacts_in_lanes, _contacts_one_by_one)
    on_levels = either(grid.lanes, _contacts_on_levels_in_lanes, _contacts_on_levels_one_by_one)
    contacts = either(grid.levels, on_levels, in_one_grid)
    return contacts(m, grid, rules, i, now, floor, x, y, time, code, shared)


@part
def contacts_of_everyone(m, grid, rules, i, now, floor, x, y, time, code, shared):
    """The same where there are no cells: all disks, in all images."""
    span_x = 0 if rules.length_x is None else 1
    span_y = 0 if rules.length_y is None else 1
    for j in range(number_sought(grid)):
        if j == i:
            continue
        for kx in range(-span_x, span_x + 1):
            for ky in range(-span_y, span_y + 1):
                if grid.posts is None or _is_in_reach(m, rules, i, j, kx, ky):
                    time, code, shared = _or_with(m, rules, i, j, kx, ky, floor, time, code, shared)
    return time, code, shared


@inline
def number_sought(grid):
    """The disks in the first so many places can be met."""
    return grid.n if grid.posts is None else grid.posts


@inline
def _is_in_reach(m, rules, i, j, kx, ky):
    """Whether an image of disk j, a post, may be met before disk i leaves the domain."""
    f, g = i * REALS, j * REALS
    reach = real(m.disks, f + RADIUS) + real(m.disks, g + RADIUS)
    beyond_x = _beyond(real(m.disks, g + X), kx, rules.length_x, reach)
    return not beyond_x and not _beyond(real(m.disks, g + Y), ky, rules.length_y, reach)


@inline
def _beyond(x, k, length, reach):
    """Whether all that is within reach of an image of x is beyond a period, and not only by rounding."""
    if length is None:
        return False
    there, room = x + k * length, reach + BEYOND * length
    return there + room < 0.0 or there - room > length


@inline
def _or_with(m, rules, i, j, kx, ky, floor, time, code, shared):
    """The contact with an image of disk j, if that is before the given event."""
    new = pair_is_due(m, rules, i, j, kx, ky)
    if new >= floor:
        time, code, shared = earlier(time, code, shared, new, j, rules.tie_screen)
    return time, code, shared


@inline
def _or_with_nearest(m, rules, i, j, now, floor, x, y, edge, time, code, shared):
    """The same with the nearest image; edge: disks may be seen across a boundary."""
    kx, ky = 0, 0
    if edge:
        kx, ky = images(m, rules, i, j, now, x, y)
    return _or_with(m, rules, i, j, kx, ky, floor, time, code, shared)


@part
def _contacts_one_by_one(m, grid, rules, i, now, floor, x, y, time, code, shared):
    """The earliest contact with another disk in the nine cells around, if that is before the given event."""
    depth = depth_of(grid)
    start, width = corner_slot(m, grid, i), depth * (grid.columns + 2)
    edge = word(m.disks, i * WORDS + FLAGS) & EDGE
    for _ in range(3):
        for k in range(3 * depth):
            j = word(m.slots, start + k)
            if j != grid.n and j != i:
                time, code, shared = _or_with_nearest(m, rules, i, j, now, floor, x, y, edge, time, code, shared)
        start += width
    return time, code, shared


@inline
def corner_slot(m, grid, i):
    """The first slot of the lower left one of the nine cells around disk i."""
    column, row = word(m.disks, i * WORDS + COLUMN), word(m.disks, i * WORDS + ROW)
    return slot_of(grid, column - 1, row - 1)


@inline
def _contacts_in_lanes(m, grid, rules, i, now, floor, x, y, time, code, shared):
    """The same as one by one, eight at a time."""
    edge = word(m.disks, i * WORDS + FLAGS) & EDGE
    end = _gather_around(m, grid, rules, i, now, x, y, edge, 0)
    return _earliest_of_list(m, rules, i, now, floor, x, y, edge, end, time, code, shared)


@inline
def _gather_around(m, grid, rules, i, now, x, y, edge, begin):
    """List in `near`, from `begin` on, the disks in the nine cells around disk i, less the one that it has just met; the end."""
    skip = _partner_to_skip(m, rules, i, now, x, y, edge)
    start, width = corner_slot(m, grid, i), depth_of(grid) * (grid.columns + 2)
    end = _gather(m, grid, start, begin, i, skip)
    end = _gather(m, grid, start + width, end, i, skip)
    return _gather(m, grid, start + 2 * width, end, i, skip)


@inline
def _contacts_on_levels_in_lanes(m, grid, rules, i, now, floor, x, y, time, code, shared):
    """The same where each class of radii has a grid of its own; what is far in its own class may be near in another."""
    skip = _partner_to_skip(m, rules, i, now, x, y, True)
    count = gather_near(m, grid, rules, i, x, y, skip)
    return _earliest_of_list(m, rules, i, now, floor, x, y, True, count, time, code, shared)


@inline
def _contacts_on_levels_one_by_one(m, grid, rules, i, now, floor, x, y, time, code, shared):
    count = gather_near(m, grid, rules, i, x, y, NOBODY)
    return _contacts_of_list(m, rules, i, now, floor, x, y, True, 0, count, time, code, shared)


@inline
def _partner_to_skip(m, rules, i, now, x, y, edge):
    """The disk that disk i has just met; SEVERAL, or another number that is no disk."""
    skip = word(m.disks, i * WORDS + MET)
    if skip >= 0:
        kx, ky = 0, 0
        if edge:
            kx, ky = images(m, rules, i, skip, now, x, y)
        skip = partner_just_met(m, rules, i, kx, ky)
    return skip


@inline
def _earliest_of_list(m, rules, i, now, floor, x, y, edge, end, time, code, shared):
    """The earliest contact with a disk of the list; where two of them may be seen across a boundary, `edge` says so."""
    found = _eight(m, rules, i, now, floor, x, y, edge, 0)
    return _or_among(m, rules, i, now, floor, x, y, edge, 0, end, found, time, code, shared)


@inline
def _eight(m, rules, i, now, floor, x, y, edge, first):
    """(time, disk, many, doubted) of the disks near[first:first+8], as `contact_of_eight` tells them."""
    f = i * REALS
    x0, y0, u, w = real(m.disks, f + X), real(m.disks, f + Y), real(m.disks, f + VX), real(m.disks, f + VY)
    t, r = real(m.disks, f + T), real(m.disks, f + RADIUS)
    length_x = NEVER if rules.length_x is None else rules.length_x
    length_y = NEVER if rules.length_y is None else rules.length_y
    flight = x0, y0, u, w, t, r, now, floor, x, y, length_x, length_y, rules.tie_screen
    if (rules.length_x is not None or rules.length_y is not None) and edge:
        return contact_of_eight(m.disks, m.near, first, *flight, 1.0, rules.gx, rules.gy)
    return contact_of_eight(m.disks, m.near, first, *flight, 0, rules.gx, rules.gy)


@inline
def _or_among(m, rules, i, now, floor, x, y, edge, first, end, found, time, code, shared):
    """The earliest of the given event and those with the disks of a list; found: what there is among the first eight."""
    new, j, many, doubted = found
    if (word(m.disks, i * WORDS + MET) == SEVERAL) | (first + 8 < end) | (doubted != 0):
        return _or_among_many(m, rules, i, now, floor, x, y, edge, first, end, *found, time, code, shared)
    return _or_sooner(rules, new, j, many, time, code, shared)


@inline
def _or_sooner(rules, new, j, many, time, code, shared):
    """The earlier of two events; without branches, which could not be foreseen."""
    sooner = new < time
    also = may_tie(new, time, rules.tie_screen)
    shared = (many if sooner else shared) | also
    return new if sooner else time, j if sooner else code, shared


@part
def _or_among_many(m, rules, i, now, floor, x, y, edge, first, end, new, j, many, doubted, time, code, shared):
    """The same where there are more than eight, or some that lanes cannot tell about, or where it has just met several."""
    if word(m.disks, i * WORDS + MET) == SEVERAL:
        return _contacts_of_list(m, rules, i, now, floor, x, y, edge, first, end, time, code, shared)
    doubts = 0
    while True:
        time, code, shared = _or_sooner(rules, new, j, many, time, code, shared)
        for lane in range(8):
            if doubted >> lane & 1:
                store(m.near, doubts, word(m.near, first + lane))
                doubts += 1
        first += 8
        if first >= end:
            break
        new, j, many, doubted = _eight(m, rules, i, now, floor, x, y, edge, first)
    if doubts:
        return _contacts_of_list(m, rules, i, now, floor, x, y, edge, 0, doubts, time, code, shared)
    return time, code, shared


@part
def _contacts_of_list(m, rules, i, now, floor, x, y, edge, begin, end, time, code, shared):
    """The same one by one: for pairs about which the lanes cannot tell, and where there are no lanes."""
    for k in range(begin, end):
        j = word(m.near, k)
        time, code, shared = _or_with_nearest(m, rules, i, j, now, floor, x, y, edge, time, code, shared)
    return time, code, shared


@inline
def _gather(m, grid, start, count, i, skip):
    """Append the disks of three cells side by side to the list of neighbours; the new count."""
    if grid.deep is None:
        return gather_disks(m.slots, start, 3 * USUAL_DEPTH, m.near, count, grid.n, i, skip)
    for k in range(0, 3 * grid.depth, 16):
        count = gather_disks(m.slots, start + k, 3 * grid.depth - k, m.near, count, grid.n, i, skip)
    return count
