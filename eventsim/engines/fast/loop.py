"""The loop: take the earliest event, advance, resolve, predict; a kernel that returns whenever Python is needed."""

from __future__ import annotations

from eventsim.engines.fast.advance import anchor, place, pulls, speed, wrap
from eventsim.engines.fast.calendar import (
    NO_DAY,
    bucket,
    earliest_floor,
    empty_room,
    first,
    is_mutual,
    is_stale,
    is_tied,
    push,
    push_later,
    take,
    unsettled,
)
from eventsim.engines.fast.cells import enter, home_of, leave, level_of, place_in
from eventsim.engines.fast.compiled import inline, kernel, pointer, real, store, word
from eventsim.engines.fast.layout import (
    AT_ONCE,
    COLUMN,
    CONTACT_TIME,
    COUNTS,
    CROSSINGS,
    DAY,
    DEEPEST,
    DISK,
    DOWN,
    DUE,
    EPOCH,
    EPOCH_BEGIN,
    EPOCH_ERROR,
    EVENTS,
    LEFT,
    LOOK,
    NOBODY,
    NOW,
    PAIRS,
    PARTNER,
    PARTNER_COUNT,
    REALS,
    RIGHT,
    ROOM,
    ROW,
    ROW_COUNT,
    STALE,
    STATUS_BUDGET,
    STATUS_EVENTS,
    STATUS_FULL,
    STATUS_IDLE,
    STATUS_LIMIT,
    STATUS_ROWS,
    STATUS_STUCK,
    STATUS_TIE,
    STEPS,
    UP,
    WAITING,
    WALL,
    WALLS,
    WINDOW_ROWS,
    WORDS,
    WRAP_LEFT,
    WRAP_RIGHT,
    WRAP_UP,
    WRAPS,
    Arrays,
)
from eventsim.engines.fast.predict import predict, predict_both, predict_post
from eventsim.engines.fast.resolve import is_unlawful, resolve_pair, resolve_wall
from eventsim.engines.fast.sides import NOWHERE, keep_sides
from eventsim.engines.fast.sunk import may_be_astray, pair_may_be_sunk, wall_may_be_sunk


@inline
def pointers(a):
    """The pointers of the arrays."""
    return Arrays(
        pointer(a.disks),
        pointer(a.slots),
        pointer(a.near),
        pointer(a.several),
        pointer(a.mass),
        pointer(a.low),
        pointer(a.features),
        pointer(a.levels),
        pointer(a.supports),
        pointer(a.sides),
        pointer(a.images),
        pointer(a.shares),
        pointer(a.species),
        pointer(a.pairs),
        pointer(a.contacts),
        pointer(a.rows),
        pointer(a.spin),
        pointer(a.spin_rows),
        pointer(a.near_walls),
    )


@inline
def move(m, grid, rules, i, code):
    """Move disk i, which is at the edge of its cell, into the next one; False if that is full."""
    if m.slots is None:
        return True
    if grid.levels is not None and code == LOOK:
        return True
    home = home_of(m, grid, i)
    column, row = word(m.disks, i * WORDS + COLUMN), word(m.disks, i * WORDS + ROW)
    leave(m, home, rules, i)
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
        column = home.columns
    elif code == WRAP_UP:
        row = 1
    else:
        row = home.rows
    return enter(m, home, rules, i, column, row)


@kernel
def run(arrays, grid, rules, counts, sums, limit, target, budget):
    """Handle events before `limit` (a time) until `target` rows in all, `budget` steps, or no room for a row; the status."""
    m = pointers(arrays)
    day, now, deepest = counts[DAY], sums[NOW], sums[DEEPEST]
    clock = counts[EPOCH], sums[EPOCH_BEGIN], sums[EPOCH_ERROR]
    begun = counts[EVENTS]
    events, walls, wraps, stale = begun, 0, 0, 0
    first_slot = counts[ROW_COUNT] - begun
    bound = min(target, counts[ROOM] - first_slot)
    status = STATUS_BUDGET
    steps = room = 0
    deadline = NO_DAY
    while steps < budget:
        if events >= bound:
            status = STATUS_EVENTS if events >= target else STATUS_ROWS
            break
        i, day, others, deadline = first(m, grid, day, limit, deadline, rules.tie_screen)
        if i < 0:
            status = STATUS_LIMIT if i == -1 else STATUS_IDLE
            break
        due = real(m.disks, i * REALS + DUE)
        if not due < limit:
            status = STATUS_LIMIT
            break
        now = due
        if others > 0 and not (others == 1 and is_mutual(m, i)):
            k = unsettled(m, grid, i, day, rules.tie_screen)
            if k == grid.n and is_tied(m, grid, i, day, rules.tie_screen):
                status = STATUS_TIE
                break
            i = i if k == grid.n else k
        steps += 1
        floor, partner = now, NOBODY
        code = word(m.disks, i * WORDS + PARTNER)
        if code >= 0:
            if is_stale(m, i):
                stale += 1
                take(m, i)
                floor = earliest_floor(grid, now, rules.tie_screen)
            elif (
                word(m.disks, i * WORDS + PARTNER_COUNT) & COUNTS
                or (rules.sinks is not None and pair_may_be_sunk(m, rules, i, code, now))
                or (rules.own is not None and is_unlawful(m, rules, i, code, now))
                or (arrays.sides is not None and (may_be_astray(m, i, clock[0]) or may_be_astray(m, code, clock[0])))
            ):
                status = STATUS_TIE
                break
            else:
                take(m, i)
                if grid.posts is None:
                    take(m, code)
                overlap = resolve_pair(m, rules, sums, i, code, now, clock, events, first_slot + events, grid.posts)
                deepest = overlap if overlap > deepest else deepest
                events += 1
                partner = code
        elif code <= WALL:
            if (
                word(m.disks, i * WORDS + PARTNER_COUNT) & COUNTS
                or (rules.sinks is not None and wall_may_be_sunk(m, rules, i, code, now))
                or (rules.own is not None and is_unlawful(m, rules, i, code, now))
                or (arrays.sides is not None and may_be_astray(m, i, clock[0]))
            ):
                status = STATUS_TIE
                break
            take(m, i)
            resolve_wall(m, rules, sums, i, code, now, clock, events, first_slot + events)
            walls += 1
            events += 1
        else:
            take(m, i)
            floor = earliest_floor(grid, now, rules.tie_screen)
            if code <= WRAP_RIGHT:
                wraps += 1
                wrap(m, rules, i, code, now)
            if not move(m, grid, rules, i, code):
                counts[DISK] = i
                status = STATUS_FULL
                break
        if partner < 0:
            predict(m, grid, rules, i, now, floor)
        elif grid.posts is None:
            predict_both(m, grid, rules, i, partner, now)
            room, deadline = push_later(m, grid, partner, day, room, deadline)
        else:  # a post stays in the calendar, with nothing ahead
            predict(m, grid, rules, i, now, now)
        room, deadline = push_later(m, grid, i, day, room, deadline)
        if word(m.disks, i * WORDS + AT_ONCE) >= rules.at_once_limit:
            counts[DISK] = i
            status = STATUS_STUCK
            break
    empty_room(m, grid, day)
    counts[DAY], sums[NOW], sums[DEEPEST] = day, now, deepest
    counts[EVENTS] = events
    counts[PAIRS] += events - begun - walls
    counts[WALLS] += walls
    counts[WINDOW_ROWS] += events - begun
    counts[ROW_COUNT] += events - begun
    counts[STALE] += stale
    counts[WRAPS] += wraps
    counts[STEPS] += steps
    counts[CROSSINGS] += steps - (events - begun) - stale - wraps
    return status


@kernel
def fill(arrays, grid, rules, now):
    """Put every disk into the cell where it is; the level of one that finds a cell full, or -1."""
    m = pointers(arrays)
    for i in range(grid.n):
        x, y = place(m, rules, i, now)
        home = home_of(m, grid, i)
        column = place_in(x, home.low_x, home.side_x, home.columns)
        row = place_in(y, home.low_y, home.side_y, home.rows)
        if not enter(m, home, rules, i, column, row):
            return level_of(m, i)
    return -1


@kernel
def predict_some(arrays, grid, rules, counts, begin, end, now, floor):
    """Predict the disks in places begin, ..., end - 1, which are in the calendar, anew; events before `floor` do not count."""
    m = pointers(arrays)
    for i in range(begin, end):
        take(m, i)
        if grid.posts is None or i >= grid.posts:
            predict(m, grid, rules, i, now, floor)
        else:
            predict_post(m, i)
        push(m, grid, i, counts[DAY])


@kernel
def schedule(arrays, grid, counts, now):
    """Put every disk into an emptied calendar."""
    m = pointers(arrays)
    for place_ in range(bucket(grid, 0), bucket(grid, 0) + grid.days + WAITING):
        store(m.disks, place_, grid.n)
    day = int(now * grid.days_per_time)
    counts[DAY] = day
    for i in range(grid.n):
        push(m, grid, i, day)


@kernel
def turn_over(arrays, grid, rules, end, shift):
    """Advance every disk to a time in the window; its clock goes on from `shift`, which becomes time 0."""
    m = pointers(arrays)
    for i in range(grid.n):
        x, y = place(m, rules, i, end)
        vx, vy = speed(m, rules, i, end)
        if arrays.sides is not None:
            keep_sides(m, rules, i, end, pulls(m, rules, i), x, y, vx, vy, NOWHERE, 0)
        anchor(m, i, end - shift, x, y, vx, vy)
        store(m.disks, i * REALS + CONTACT_TIME, real(m.disks, i * REALS + CONTACT_TIME) - shift)
