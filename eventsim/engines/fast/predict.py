"""Predictions: the earliest event that the present flight of a disk can lead to becomes its scheduled event."""

from __future__ import annotations

from eventsim.engines.fast.advance import place, pulls, speed
from eventsim.engines.fast.cells import depth_of, slot_of
from eventsim.engines.fast.compiled import inline, part
from eventsim.engines.fast.lanes import contact_of_eight, gather_disks
from eventsim.engines.fast.layout import (
    CLASSES,
    COLUMN,
    COUNT,
    COUNTS,
    DOWN,
    DUE,
    EDGE,
    FLAGS,
    IMMOVABLE,
    LEFT,
    LOOK,
    MET,
    NOBODY,
    NOTHING,
    PARTNER,
    PARTNER_COUNT,
    RADIUS,
    REALS,
    RIGHT,
    ROW,
    SEVERAL,
    UP,
    USUAL_DEPTH,
    VX,
    VY,
    WALL,
    WORDS,
    WRAP_DOWN,
    WRAP_LEFT,
    WRAP_RIGHT,
    WRAP_UP,
    T,
    X,
    Y,
)
from eventsim.engines.fast.levels import gather_near, home_of, look_delay
from eventsim.engines.fast.memory import either, real, store, word
from eventsim.engines.fast.met import just_met, partner_just_met
from eventsim.engines.fast.rest import border_contact, is_for_rules, shape_rest
from eventsim.engines.fast.shapes import shape_delay
from eventsim.formulas.contact import screened_pair_delay
from eventsim.formulas.crossing import crossing_delay
from eventsim.formulas.digits import careful_pair_delay
from eventsim.formulas.motion import position, velocity
from eventsim.formulas.parabola import circle_delays
from eventsim.formulas.real import NEVER
from eventsim.formulas.rest import STRUCK

SLACK = 2.0**-22


@inline
def predict(m, grid, rules, i, now, floor):
    """Schedule the earliest event of disk i that is not before `floor`: a contact, a wrap, or the next cell crossing."""
    x, y = place(m, rules, i, now)
    u, w = speed(m, rules, i, now)
    home = home_of(m, grid, i)
    if word(m.disks, i * WORDS + FLAGS) & EDGE:
        time, code, shared = _border_events(m, home, rules, i, now, floor, x, y, u, w)
    else:
        time, code = _crossing(m, home, rules, i, now, x, y, u, w, rules.gx)
        shared = 0
    time, code, shared = _look(m, grid, rules, i, now, u, w, time, code, shared, grid.levels)
    time, code, shared = _shapes(m, rules, i, floor, time, code, shared, rules.features)
    contacts = either(m.slots, _contacts_in_cells, _contacts_of_everyone)
    time, code, shared = contacts(m, grid, rules, i, now, floor, x, y, time, code, shared)
    shared = _or_for_rules(m, rules, i, code, time, shared, m.supports)
    count = word(m.disks, (code if code >= 0 else grid.n) * WORDS + COUNT)  # of the sentinel: 0
    store(m.disks, i * REALS + DUE, time)
    store(m.disks, i * WORDS + PARTNER, code)
    store(m.disks, i * WORDS + PARTNER_COUNT, count + COUNTS * shared)


@inline
def _or_for_rules(m, rules, i, code, time, shared, supports):
    """Whether an event is to be left to the reference engine's rules: because of rest, as if another one shared its time."""
    if supports is None:
        return shared
    return 1 if is_for_rules(m, rules, i, code, time) else shared


@inline
def _is_contact(code):
    return code >= 0 or code <= WALL


@inline
def _earlier(time, code, shared, new_time, new_code):
    """The earlier of two events; at one time wraps and crossings come first, and two contacts are noted as `shared`."""
    if new_time < time:
        return new_time, new_code, 0
    if new_time == time and new_time < NEVER and _is_contact(code):
        if _is_contact(new_code):
            return time, code, 1
        return new_time, new_code, 0
    return time, code, shared


@inline
def _look(m, grid, rules, i, now, u, w, time, code, shared, levels):
    """The time to look for smaller disks again, if that is before the given event."""
    if levels is None:
        return time, code, shared
    return _earlier(time, code, shared, now + look_delay(m, grid, rules, i, u, w), LOOK)


@inline
def slack(side, g):
    """How far a disk may leave its cell: a parabola whose apex lies on the edge would else cross it to and fro for ever.

    A quarter of the margin by which cells are wider than the longest reach.
    """
    return 0.0 if g is None else SLACK * side


@inline
def _crossing(m, grid, rules, i, now, x, y, u, w, gx):
    """The next passage into another cell, far from the border of the grid."""
    low_x = grid.low_x + (word(m.disks, i * WORDS + COLUMN) - 1) * grid.side_x
    low_y = grid.low_y + (word(m.disks, i * WORDS + ROW) - 1) * grid.side_y
    if gx is None:
        delay_x = (low_x + (grid.side_x if u > 0.0 else 0.0) - x) / u
        delay_y = (low_y + (grid.side_y if w > 0.0 else 0.0) - y) / w
        delay_x = delay_x if u != 0.0 else NEVER
        delay_y = delay_y if w != 0.0 else NEVER
        code_x = RIGHT if u > 0.0 else LEFT
        code_y = UP if w > 0.0 else DOWN
        delay = delay_x if delay_x < delay_y else delay_y
        code = code_x if delay_x < delay_y else code_y
        return now + (delay if delay > 0.0 else 0.0), code
    return _falling_crossing(m, grid, rules, i, now, x, y, u, w, low_x, low_y)


@part
def _falling_crossing(m, grid, rules, i, now, x, y, u, w, low_x, low_y):
    """The same along a parabola."""
    ax, ay = pulls(m, rules, i)
    slack_x, slack_y = slack(grid.side_x, rules.gx), slack(grid.side_y, rules.gx)
    delay, code = crossing_delay(x, u, ax, low_x + grid.side_x + slack_x, -1.0), RIGHT
    other = crossing_delay(x, u, ax, low_x - slack_x, 1.0)
    delay, code = (other, LEFT) if other < delay else (delay, code)
    other = crossing_delay(y, w, ay, low_y + grid.side_y + slack_y, -1.0)
    delay, code = (other, UP) if other < delay else (delay, code)
    other = crossing_delay(y, w, ay, low_y - slack_y, 1.0)
    delay, code = (other, DOWN) if other < delay else (delay, code)
    return now + delay, code


@part
def _border_events(m, grid, rules, i, now, floor, x, y, u, w):
    """(time, code, shared) of what disk i, in a cell at the border of the grid, can do alone: cross, wrap, meet a wall."""
    f = i * REALS
    t, r = real(m.disks, f + T), real(m.disks, f + RADIUS)
    ax, ay = pulls(m, rules, i)
    time, code, shared = NEVER, NOTHING, 0
    k = word(m.disks, i * WORDS + COLUMN)
    low = grid.low_x + (k - 1) * grid.side_x
    if k > 1:
        new = now + crossing_delay(x, u, ax, low - slack(grid.side_x, rules.gx), 1.0)
        time, code, shared = _earlier(time, code, shared, new, LEFT)
    else:
        new, what = _border_event(
            m,
            rules,
            i,
            real(m.disks, f + X),
            real(m.disks, f + VX),
            t,
            r,
            ax,
            0.0,
            1.0,
            rules.length_x,
            rules.wall_x,
            WRAP_LEFT,
            0,
            m.supports,
        )
        if not new < floor:
            time, code, shared = _earlier(time, code, shared, new, what)
    if k < grid.columns:
        new = now + crossing_delay(x, u, ax, low + grid.side_x + slack(grid.side_x, rules.gx), -1.0)
        time, code, shared = _earlier(time, code, shared, new, RIGHT)
    else:
        new, what = _border_event(
            m,
            rules,
            i,
            real(m.disks, f + X),
            real(m.disks, f + VX),
            t,
            r,
            ax,
            rules.width,
            -1.0,
            rules.length_x,
            rules.wall_x,
            WRAP_RIGHT,
            1,
            m.supports,
        )
        if not new < floor:
            time, code, shared = _earlier(time, code, shared, new, what)
    k = word(m.disks, i * WORDS + ROW)
    low = grid.low_y + (k - 1) * grid.side_y
    if k > 1:
        new = now + crossing_delay(y, w, ay, low - slack(grid.side_y, rules.gx), 1.0)
        time, code, shared = _earlier(time, code, shared, new, DOWN)
    else:
        new, what = _border_event(
            m,
            rules,
            i,
            real(m.disks, f + Y),
            real(m.disks, f + VY),
            t,
            r,
            ay,
            0.0,
            1.0,
            rules.length_y,
            rules.wall_y,
            WRAP_DOWN,
            0,
            m.supports,
        )
        if not new < floor:
            time, code, shared = _earlier(time, code, shared, new, what)
    if k < grid.rows:
        new = now + crossing_delay(y, w, ay, low + grid.side_y + slack(grid.side_y, rules.gx), -1.0)
        time, code, shared = _earlier(time, code, shared, new, UP)
    else:
        new, what = _border_event(
            m,
            rules,
            i,
            real(m.disks, f + Y),
            real(m.disks, f + VY),
            t,
            r,
            ay,
            rules.height,
            -1.0,
            rules.length_y,
            rules.wall_y,
            WRAP_UP,
            1,
            m.supports,
        )
        if not new < floor:
            time, code, shared = _earlier(time, code, shared, new, what)
    return time, code, shared


@inline
def _border_event(m, rules, i, x, v, t, r, g, border, side, length, wall, wrap_code, second, supports):
    """(time, code) of the wrap through a border of the domain, or of the contact with the hard wall there."""
    if length is None:
        if wall is None:
            return NEVER, NOTHING
        if supports is not None:
            time, _ = border_contact(m, rules, i, wall + second, side, border + side * r, x, v, g)
            return time, WALL - 2 * (wall + second) - second
        return t + crossing_delay(x, v, g, border + side * r, side), WALL - 2 * (wall + second) - second
    return t + crossing_delay(x, v, g, border, side), wrap_code


@inline
def _shapes(m, rules, i, floor, time, code, shared, features):
    """The earliest contact with a wall shape, if that is before the given event."""
    if features is None:
        return time, code, shared
    for k in range(features):
        new, side, _ = shape_time(m, rules, i, k, m.supports)
        if new >= floor:
            wall = WALL - 2 * (rules.first_feature + k) - (1 if side < 0 else 0)
            time, code, shared = _earlier(time, code, shared, new, wall)
    return time, code, shared


@part
def shape_time(m, rules, i, k, supports):
    """(time, side, how) of the next event of disk i at the k-th wall shape."""
    f = i * REALS
    if supports is not None:
        delay, side, how = shape_rest(m, rules, i, k)
        if how != STRUCK:
            return real(m.disks, f + T) + delay, side, how
    gx, gy = pulls(m, rules, i)
    delay, side = shape_delay(
        m,
        rules,
        i,
        k,
        rules.first_feature + k,
        real(m.disks, f + X),
        real(m.disks, f + Y),
        real(m.disks, f + VX),
        real(m.disks, f + VY),
        gx,
        gy,
        real(m.disks, f + RADIUS),
    )
    return real(m.disks, f + T) + delay, side, STRUCK


@inline
def image(d, length):
    """-1, 0 or 1: the image that brings a distance along a period below half of it."""
    if length is None:
        return 0
    if d > 0.5 * length:
        return 1
    return -1 if d < -(0.5 * length) else 0


@inline
def shift(k, length):
    """The distance of an image; 0 without a period."""
    return 0.0 if length is None else k * length


@inline
def images(m, rules, i, j, now, x, y):
    """The image (kx, ky) of disk j that is nearest to disk i, which is at (x, y)."""
    if rules.length_x is None and rules.length_y is None:
        return 0, 0
    other_x, other_y = place(m, rules, j, now)
    return image(x - other_x, rules.length_x), image(y - other_y, rules.length_y)


@inline
def pair_time(m, rules, i, j, kx, ky):
    """The contact time of two disks; symmetric under their exchange, bit for bit."""
    f, g = i * REALS, j * REALS
    ti, tj = real(m.disks, f + T), real(m.disks, g + T)
    begin = ti if ti > tj else tj
    ax, ay = pulls(m, rules, i)
    bx, by = pulls(m, rules, j)
    lag, other_lag = begin - ti, begin - tj
    ui, wi, uj, wj = real(m.disks, f + VX), real(m.disks, f + VY), real(m.disks, g + VX), real(m.disks, g + VY)
    dx = position(real(m.disks, f + X), ui, lag, ax) - position(real(m.disks, g + X), uj, other_lag, bx)
    dy = position(real(m.disks, f + Y), wi, lag, ay) - position(real(m.disks, g + Y), wj, other_lag, by)
    dx, dy = dx - shift(kx, rules.length_x), dy - shift(ky, rules.length_y)
    du = velocity(ui, lag, ax) - velocity(uj, other_lag, bx)
    dw = velocity(wi, lag, ay) - velocity(wj, other_lag, by)
    return begin + _pair_delay(m, rules, i, j, kx, ky, dx, dy, du, dw, ax, ay, bx, by, _or(rules.classes, m.supports))


@inline
def _or(classes, supports):
    """None where all disks of the scene fall alike."""
    if classes is None and supports is None:
        return None
    return 1


@inline
def _pair_delay(m, rules, i, j, kx, ky, dx, dy, du, dw, ax, ay, bx, by, unlike):
    ri, rj = real(m.disks, i * REALS + RADIUS), real(m.disks, j * REALS + RADIUS)
    if ax is not None and unlike is not None and (ax != bx or ay != by):
        return circle_delays(dx, dy, du, dw, ax - bx, ay - by, ri + rj, 1.0)[0]
    delay = screened_pair_delay(dx, dy, du, dw, ri + rj)
    if delay == delay:
        return delay
    if ax is not None:
        return careful_pair_delay(dx, dy, du, dw, 0.0, ri, 0.0, 0.0, 0.0, 0.0, 0.0, rj, 0.0, 0.0)
    return _careful_delay(m, rules, i, j, kx, ky)


@part
def _careful_delay(m, rules, i, j, kx, ky):
    """The delay of a pair in straight flight from the two flights themselves, right to the last bit."""
    f, g = i * REALS, j * REALS
    return careful_pair_delay(
        real(m.disks, f + X),
        real(m.disks, f + Y),
        real(m.disks, f + VX),
        real(m.disks, f + VY),
        real(m.disks, f + T),
        real(m.disks, f + RADIUS),
        real(m.disks, g + X),
        real(m.disks, g + Y),
        real(m.disks, g + VX),
        real(m.disks, g + VY),
        real(m.disks, g + T),
        real(m.disks, g + RADIUS),
        shift(kx, rules.length_x),
        shift(ky, rules.length_y),
    )


@inline
def can_meet(m, i, j, classes):
    """Two immovable disks, or two tracers, do not meet."""
    if classes is None:
        return True
    return word(m.disks, i * WORDS + FLAGS) & word(m.disks, j * WORDS + FLAGS) & CLASSES == 0


@inline
def flies_alike(m, rules, i, j, gx, classes, supports):
    """Whether the relative flight of two disks is straight."""
    if gx is None or (classes is None and supports is None):
        return True
    if supports is not None:
        ax, ay = pulls(m, rules, i)
        bx, by = pulls(m, rules, j)
        return not (ax != bx or ay != by)
    return (word(m.disks, i * WORDS + FLAGS) ^ word(m.disks, j * WORDS + FLAGS)) & IMMOVABLE == 0


@inline
def pair_is_due(m, rules, i, j, kx, ky):
    """The contact time of a pair, NEVER if it has just met or never meets."""
    if not can_meet(m, i, j, rules.classes):
        return NEVER
    time = pair_time(m, rules, i, j, kx, ky)
    if time < NEVER and flies_alike(m, rules, i, j, rules.gx, rules.classes, m.supports) and just_met(m, i, j, kx, ky):
        return NEVER
    return time


@part
def _contacts_one_by_one(m, grid, rules, i, now, floor, x, y, time, code, shared):
    """The earliest contact with another disk in the nine cells around, if that is before the given event."""
    depth = depth_of(grid, grid.deep)
    start, width = corner_slot(m, grid, i), depth * (grid.columns + 2)
    edge = word(m.disks, i * WORDS + FLAGS) & EDGE
    for _ in range(3):
        for k in range(3 * depth):
            j = word(m.slots, start + k)
            if j == grid.n or j == i:
                continue
            kx, ky = 0, 0
            if edge:
                kx, ky = images(m, rules, i, j, now, x, y)
            new = pair_is_due(m, rules, i, j, kx, ky)
            if new >= floor:
                time, code, shared = _earlier(time, code, shared, new, j)
        start += width
    return time, code, shared


@part
def _contacts_of_everyone(m, grid, rules, i, now, floor, x, y, time, code, shared):
    """The same where there are no cells: all disks, in all images."""
    span_x = 0 if rules.length_x is None else 1
    span_y = 0 if rules.length_y is None else 1
    for j in range(grid.n):
        if j == i:
            continue
        for kx in range(-span_x, span_x + 1):
            for ky in range(-span_y, span_y + 1):
                new = pair_is_due(m, rules, i, j, kx, ky)
                if new >= floor:
                    time, code, shared = _earlier(time, code, shared, new, j)
    return time, code, shared


@inline
def corner_slot(m, grid, i):
    """The first slot of the lower left one of the nine cells around disk i."""
    column, row = word(m.disks, i * WORDS + COLUMN), word(m.disks, i * WORDS + ROW)
    return slot_of(grid, column - 1, row - 1)


@inline
def _contacts_in_cells(m, grid, rules, i, now, floor, x, y, time, code, shared):
    """The earliest contact with another disk in the cells around, if that is before the given event."""
    in_one_grid = either(grid.lanes, _contacts_in_lanes, _contacts_one_by_one)
    on_levels = either(grid.lanes, _contacts_on_levels_in_lanes, _contacts_on_levels_one_by_one)
    contacts = either(grid.levels, on_levels, in_one_grid)
    return contacts(m, grid, rules, i, now, floor, x, y, time, code, shared)


@inline
def _contacts_in_lanes(m, grid, rules, i, now, floor, x, y, time, code, shared):
    """The same as one by one, eight at a time."""
    edge = word(m.disks, i * WORDS + FLAGS) & EDGE
    if word(m.disks, i * WORDS + MET) == SEVERAL:
        return _contacts_one_by_one(m, grid, rules, i, now, floor, x, y, time, code, shared)
    skip = _partner_to_skip(m, rules, i, now, x, y, edge)
    start, width = corner_slot(m, grid, i), depth_of(grid, grid.deep) * (grid.columns + 2)
    count = _gather(m, grid, start, 0, i, skip, grid.deep)
    count = _gather(m, grid, start + width, count, i, skip, grid.deep)
    count = _gather(m, grid, start + 2 * width, count, i, skip, grid.deep)
    return _earliest_of_list(m, rules, i, now, floor, x, y, time, code, shared, count, edge)


@inline
def _contacts_on_levels_in_lanes(m, grid, rules, i, now, floor, x, y, time, code, shared):
    """The same where each class of radii has a grid of its own; what is far in its own class may be near in another."""
    skip = _partner_to_skip(m, rules, i, now, x, y, True)
    count = gather_near(m, grid, rules, i, x, y, skip)
    if word(m.disks, i * WORDS + MET) == SEVERAL:
        return _contacts_of_list(m, rules, i, now, floor, x, y, True, count, time, code, shared)
    return _earliest_of_list(m, rules, i, now, floor, x, y, time, code, shared, count, True)


@inline
def _contacts_on_levels_one_by_one(m, grid, rules, i, now, floor, x, y, time, code, shared):
    count = gather_near(m, grid, rules, i, x, y, NOBODY)
    return _contacts_of_list(m, rules, i, now, floor, x, y, True, count, time, code, shared)


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
def _earliest_of_list(m, rules, i, now, floor, x, y, time, code, shared, count, edge):
    """The earliest contact with a disk of the list; where two of them may be seen across a boundary, `edge` says so."""
    f = i * REALS
    x0, y0, u, w = real(m.disks, f + X), real(m.disks, f + Y), real(m.disks, f + VX), real(m.disks, f + VY)
    t, r = real(m.disks, f + T), real(m.disks, f + RADIUS)
    length_x, length_y = _or_never(rules.length_x), _or_never(rules.length_y)
    periodic = rules.length_x is not None or rules.length_y is not None
    first = doubts = 0
    while True:
        if periodic and edge:
            new, j, many, doubted = contact_of_eight(
                m.disks, m.near, first, x0, y0, u, w, t, r, now, floor, x, y, length_x, length_y, 1.0
            )
        else:
            new, j, many, doubted = contact_of_eight(
                m.disks, m.near, first, x0, y0, u, w, t, r, now, floor, x, y, length_x, length_y, 0
            )
        sooner = new < time  # no branches: they could not be foreseen
        also = (new == time) & ((code >= 0) | (code <= WALL))
        shared = many if sooner else shared | also
        code = j if sooner else code
        time = new if sooner else time
        lane = first
        while doubted:  # rare; a call here would cost the registers
            if doubted & 1:
                store(m.near, doubts, word(m.near, lane))
                doubts += 1
            doubted >>= 1
            lane += 1
        first += 8
        if first >= count:
            break
    if doubts:
        return _contacts_of_list(m, rules, i, now, floor, x, y, edge, doubts, time, code, shared)
    return time, code, shared


@part
def _contacts_of_list(m, rules, i, now, floor, x, y, edge, count, time, code, shared):
    """The same one by one: for pairs about which the lanes cannot tell, and where there are no lanes."""
    for k in range(count):
        j = word(m.near, k)
        kx, ky = 0, 0
        if edge:
            kx, ky = images(m, rules, i, j, now, x, y)
        new = pair_is_due(m, rules, i, j, kx, ky)
        if new >= floor:
            time, code, shared = _earlier(time, code, shared, new, j)
    return time, code, shared


@inline
def _gather(m, grid, start, count, i, skip, deep):
    """Append the disks of three cells side by side to the list of neighbours; the new count."""
    if deep is None:
        return gather_disks(m.slots, start, 3 * USUAL_DEPTH, m.near, count, grid.n, i, skip)
    for k in range(0, 3 * grid.depth, 16):
        count = gather_disks(m.slots, start + k, 3 * grid.depth - k, m.near, count, grid.n, i, skip)
    return count


@inline
def _or_never(length):
    return NEVER if length is None else length
