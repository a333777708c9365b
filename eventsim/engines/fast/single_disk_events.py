"""What a disk can do alone: cross into another cell, wrap, meet a wall or come to rest on it."""

from __future__ import annotations

from eventsim.engines.fast.advance import pulls, speed
from eventsim.engines.fast.calendar import earlier
from eventsim.engines.fast.cells import home_of
from eventsim.engines.fast.compiled import inline, part, real, word
from eventsim.engines.fast.layout import (
    COLUMN,
    DOWN,
    LEFT,
    NOTHING,
    RADIUS,
    REALS,
    RIGHT,
    ROW,
    UP,
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
from eventsim.engines.fast.rest import border_contact, shape_rest, slides_past
from eventsim.engines.fast.shapes import is_clear, shape_delay
from eventsim.formulas.crossing import crossing_delay
from eventsim.formulas.doubt import latest_tie
from eventsim.formulas.real import NEVER
from eventsim.formulas.rest import STRUCK

SLACK = 2.0**-22


@inline
def slack(side, g):
    """How far a disk may leave its cell: a parabola whose apex lies on the edge would else cross it to and fro for ever.

    A quarter of the margin by which cells are wider than the longest reach.
    """
    return 0.0 if g is None else SLACK * side


@inline
def crossing(m, grid, rules, i, now, x, y, u, w):
    """The next passage into another cell, far from the border of the grid."""
    low_x = grid.low_x + (word(m.disks, i * WORDS + COLUMN) - 1) * grid.side_x
    low_y = grid.low_y + (word(m.disks, i * WORDS + ROW) - 1) * grid.side_y
    if rules.gx is None:
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
def border_events(m, grid, rules, i, now, floor, x, y, u, w):
    """(time, code, shared) of what disk i, in a cell at the border of the grid, can do alone: cross, wrap, meet a wall."""
    f = i * REALS
    x0, vx, y0, vy = real(m.disks, f + X), real(m.disks, f + VX), real(m.disks, f + Y), real(m.disks, f + VY)
    ax, ay = pulls(m, rules, i)
    found = NEVER, NOTHING, 0
    k = word(m.disks, i * WORDS + COLUMN)
    low, side = grid.low_x + (k - 1) * grid.side_x, grid.side_x
    length, wall = rules.length_x, rules.wall_x
    to_cell, to_wrap = (k > 1, x, u, low, LEFT), (0.0, length, wall, WRAP_LEFT, 0)
    found = _towards(m, rules, i, now, floor, to_cell, to_wrap, side, 1.0, x0, vx, ax, found)
    to_cell, to_wrap = (k < grid.columns, x, u, low + side, RIGHT), (rules.width, length, wall, WRAP_RIGHT, 1)
    found = _towards(m, rules, i, now, floor, to_cell, to_wrap, side, -1.0, x0, vx, ax, found)
    k = word(m.disks, i * WORDS + ROW)
    low, side = grid.low_y + (k - 1) * grid.side_y, grid.side_y
    length, wall = rules.length_y, rules.wall_y
    to_cell, to_wrap = (k > 1, y, w, low, DOWN), (0.0, length, wall, WRAP_DOWN, 0)
    found = _towards(m, rules, i, now, floor, to_cell, to_wrap, side, 1.0, y0, vy, ay, found)
    to_cell, to_wrap = (k < grid.rows, y, w, low + side, UP), (rules.height, length, wall, WRAP_UP, 1)
    return _towards(m, rules, i, now, floor, to_cell, to_wrap, side, -1.0, y0, vy, ay, found)


@inline
def _towards(m, rules, i, now, floor, to_cell, to_wrap, size, side, anchor, v0, g, found):
    """The earlier of the event found so far and what lies at one end of a cell: the next cell, or a border of the domain.

    side: 1 at the low end, -1 at the high one, as the normal of a wall there.
    """
    time, code, shared = found
    inside, x, v, edge, code_there = to_cell
    if inside:
        new = now + crossing_delay(x, v, g, edge - side * slack(size, rules.gx), side)
        return earlier(time, code, shared, new, code_there, rules.tie_screen)
    border, length, wall, wrap_code, second = to_wrap
    new, what = _border_event(m, rules, i, anchor, v0, g, border, side, length, wall, wrap_code, second)
    if not new < floor:
        time, code, shared = earlier(time, code, shared, new, what, rules.tie_screen)
    return time, code, shared


@inline
def _border_event(m, rules, i, x, v, g, border, side, length, wall, wrap_code, second):
    """(time, code) of the wrap through a border of the domain, or of the contact with the hard wall there."""
    f = i * REALS
    t = real(m.disks, f + T)
    if length is None:
        if wall is None:
            return NEVER, NOTHING
        r = real(m.disks, f + RADIUS)
        if m.supports is not None:
            time, _ = border_contact(m, rules, i, wall + second, side, border + side * r, x, v, g)
            return time, WALL - 2 * (wall + second) - second
        return t + crossing_delay(x, v, g, border + side * r, side), WALL - 2 * (wall + second) - second
    return t + crossing_delay(x, v, g, border, side), wrap_code


@inline
def earliest_at_shapes(m, grid, rules, i, now, floor, x, y, time, code, shared):
    """The earliest contact with a wall shape, if that is before the given event; (x, y): where the disk is now."""
    u, w = speed(m, rules, i, now)
    begin, end = shapes_near(m, home_of(m, grid, i), rules, i)
    for item in range(begin, end):
        k = shape_near(m, item)
        if rules.gx is not None and _is_clear_until(m, rules, i, k, now, x, y, u, w, time):
            continue
        new, side, _ = shape_time(m, rules, i, k)
        if new >= floor:
            wall = WALL - 2 * (rules.first_feature + k) - (1 if side < 0 else 0)
            time, code, shared = earlier(time, code, shared, new, wall, rules.tie_screen)
    return time, code, shared


@inline
def _is_clear_until(m, rules, i, k, now, x, y, u, w, time):
    """Whether a falling disk surely does not meet the k-th shape before a time, nor with it."""
    delay = latest_tie(time, rules.tie_screen) - now
    return is_clear(m, rules, k, x, y, u, w, pulls(m, rules, i), real(m.disks, i * REALS + RADIUS), delay)


@inline
def shapes_near(m, grid, rules, i):
    """Where the list of the shapes that disk i can meet in its cell begins and ends."""
    if m.near_walls is None:
        return 0, rules.features
    cell = word(m.disks, i * WORDS + COLUMN) - 1 + grid.columns * (word(m.disks, i * WORDS + ROW) - 1)
    return word(m.near_walls, cell), word(m.near_walls, cell + 1)


@inline
def shape_near(m, item):
    """The shape at a place of such a list."""
    return item if m.near_walls is None else word(m.near_walls, item)


@part
def shape_time(m, rules, i, k):
    """(time, side, how) of the next event of disk i at the k-th wall shape."""
    f = i * REALS
    if m.supports is not None:
        delay, side, how = shape_rest(m, rules, i, k)
        if how != STRUCK or delay < NEVER:
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
    if m.supports is not None and slides_past(m, rules, i, rules.first_feature + k, side, delay):
        return NEVER, side, STRUCK
    return real(m.disks, f + T) + delay, side, STRUCK
