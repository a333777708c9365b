"""Rest on straight walls: the end of a series of bounces, sliding, leaving over an end; and where there is no answer."""

from __future__ import annotations

import math
from collections.abc import Sequence
from decimal import Decimal

import numpy as np

from tests.oracle.digits import UNIT, exact
from tests.oracle.doubt import leave_map, rest_map
from tests.oracle.order import lateness, predict
from tests.oracle.search import REST, Flight, Meeting, wall_key
from tests.oracle.state import State
from tests.oracle.story import WALL, BeyondError, CollapseError
from tests.oracle.table import Line, Tip, across

FLOOR = 1.0
"""The oracle ends a series of bounces where the next flight is this part of the one that rounding keeps up."""

ENDED = 30.0
"""An engine may end a series where the next flight is so many times the one that rounding keeps up: the error of its
end is that here.
"""


def settle(run: State, m: Meeting, e: Decimal, others: Sequence[Meeting] = ()) -> bool:
    """Whether a bounce was the last that floats can tell; then the disk comes to rest at the end of the series.

    others: what it met at the same time, and got nothing from; it does not rest where it would be pressed onto that.
    """
    one, i = run.table.shapes[m.shape], m.a
    f = run.flights[i]
    if e >= 1 or run.table.contact_duration is not None or m.image != (0, 0):
        return False
    nx, ny = run.normal(m)
    for other in others:
        ox, oy = run.normal(other)
        if other.image != (0, 0) or (f.ax * ny - f.ay * nx) * (ox * ny - oy * nx) < 0:
            return False
    rate, slip = nx * f.u + ny * f.w, nx * f.w - ny * f.u
    fall = nx * f.ax + ny * f.ay
    if not isinstance(one, Line):  # what slips along a round wall leaves it, or is pressed onto it from inside
        fall += slip * slip * exact(run.bend(m))
    if fall >= 0 or rate < 0:
        return False
    flight = 2 * rate / -fall
    loss = float(1 - e)
    place = max(
        abs(float(f.x - run.table.corner[0])), abs(float(f.y - run.table.corner[1])), float(run.table.radius[i])
    )
    place = max(place, run.terms_of(m))
    floor = math.sqrt(2.0 * 2.0**-52 * place / (float(-fall) * loss))
    run.rows[-1].flight, run.rows[-1].floor = float(flight), floor
    if float(flight) > ENDED * floor:
        run.series.pop(i, None)
    elif rate == 0:  # e = 0: the one contact is the series
        run.series[i] = run.rows[-1].time_error
    elif i not in run.series:
        run.series[i] = end_error(run, i, (float(nx), float(ny)), float(rate), float(-fall), float(e))
    if float(flight) > FLOOR * floor:
        return False
    if not isinstance(one, Line):
        run.now += flight / (1 - e)
        raise CollapseError("bounces on something round that end in rest")
    for (k, *_, side), along_it in f.touch.items():
        if along_it and k not in (-1, m.shape) and isinstance(run.table.shapes[k], Line):
            demand_single(run, i, m, (k, side), run.now + flight / (1 - e))
    lie(run, i, m.shape, m.side, run.now + (flight / (1 - e)))
    return True


def end_error(run: State, i: int, normal: tuple[float, float], rate: float, fall: float, e: float) -> float:
    """How far the end of a series of bounces may be off: of the gap g and the rate r, (1 + e)/(1 - e) dg / r +
    2/(1 - e) dr / fall.
    """
    row = 4 * i
    gap, closing = (1 + e) / ((1 - e) * rate), 2 / ((1 - e) * fall)
    h = np.array([gap * normal[0], gap * normal[1], closing * normal[0], closing * normal[1]])
    return math.sqrt(max(0.0, h @ run.doubt.p[row : row + 4, row : row + 4] @ h))


def lie(run: State, i: int, k: int, side: int, due: Decimal) -> None:
    """Let a disk slide on a line from here on; the row comes at `due`."""
    one = run.table.shapes[k]
    assert isinstance(one, Line)
    f = run.flights[i]
    x, y, u, w = f.at(run.now)
    (ex, ey), (nx, ny), norm2 = one.along, one.normal, one.norm * one.norm
    gap = (side * across(one, (x, y)) - run.table.radius[i] * one.norm) / norm2
    x, y = x - gap * side * nx, y - gap * side * ny
    share = (u * ex + w * ey) / norm2
    pull = (f.ax * ex + f.ay * ey) / norm2
    if run.now > f.time:
        raise AssertionError("only a flight that begins can end on a line")
    run.doubt.map([i], rest_map((float(ex / one.norm), float(ey / one.norm))))
    run.flights[i] = Flight(
        run.now,
        x,
        y,
        share * ex,
        share * ey,
        pull * ex,
        pull * ey,
        skip=run.lines_and_ends(k),
        held=(k, side),
        count=f.count + 1,
    )
    run.rest_due[i] = Meeting(due, i, -1, k, side=side, how=REST)


def press(run: State, m: Meeting) -> None:
    """What touches and is pressed on without a velocity: at rest on a line, else there is no answer."""
    if m.b >= 0 or not isinstance(run.table.shapes[m.shape], Line) or m.image != (0, 0):
        raise CollapseError("pressed onto something round")
    i = m.a
    held = run.flights[i].held
    if held is not None and held[0] != m.shape:
        demand_single(run, i, m, held, run.now)
    place, velocity = run.fly_to_now(i, run.tick())
    run.begin_flight(i, place, velocity, {})
    lie(run, i, m.shape, m.side, run.now)
    predict(run, [i])


def demand_single(run: State, i: int, m: Meeting, held: tuple[int, int], time: Decimal) -> None:
    """Stop where a disk that rests on one wall would, at that time, rest on another one as well."""
    old, new = run.table.shapes[held[0]], run.table.shapes[m.shape]
    assert isinstance(old, Line)
    assert isinstance(new, Line)
    gx, gy = run.table.pull[i]
    share = gx * new.along[0] + gy * new.along[1]
    if held[1] * share * (old.normal[0] * new.along[0] + old.normal[1] * new.along[1]) < 0:
        run.now = time
        raise CollapseError("rest on two walls")


def come_to_rest(run: State, m: Meeting) -> None:
    """The row of a disk that has come to rest."""
    i = m.a
    clock = run.tick()
    place, velocity = run.fly_to_now(i, clock)
    f = run.flights[i]
    run.begin_flight(i, place, velocity, {}, (f.ax, f.ay), f.held)
    run.flights[i].skip = f.skip
    del run.rest_due[i]
    run.group += 1
    run.add_row(REST, (i,), run.line_names(m.shape), UNIT * clock + run.series.pop(i, 0.0))
    run.last = run.now
    predict(run, [i])


def leave(run: State, m: Meeting) -> None:
    """A disk slides over the end of what it rests on."""
    i = m.a
    one = run.table.shapes[m.shape]
    assert isinstance(one, Line)
    f = run.flights[i]
    clock = run.tick()
    late = lateness(run, m) + UNIT * clock
    place, velocity = run.fly_to_now(i, clock)
    ex, ey = float(one.along[0] / one.norm), float(one.along[1] / one.norm)
    speed = ex * float(velocity[0]) + ey * float(velocity[1])
    pull = run.table.pull[i]
    if speed == 0.0:
        raise BeyondError("a slide that ends at the very end of a wall")
    run.doubt.map([i], leave_map((ex, ey), speed, (float(f.ax - pull[0]), float(f.ay - pull[1]))))
    ends = {
        j: True
        for j in run.lines_and_ends(m.shape)
        if isinstance(tip := run.table.shapes[j], Tip)
        and math.hypot(float(tip.place[0] - place[0]), float(tip.place[1] - place[1]))
        <= float(run.table.radius[i]) * (1 + 1e-9)
    }
    touch: dict[tuple[int, ...], bool] = {wall_key(j, (0, 0), 1): True for j in ends} if run.table.radius[i] > 0 else {}
    run.begin_flight(i, place, velocity, touch)
    run.flights[i].skip = frozenset(run.table.supports[m.shape])
    run.group += 1
    run.add_row(WALL, (i,), run.line_names(m.shape), late)
    run.last = run.now
    predict(run, [i])


def glide(run: State, i: int, k: int) -> None:
    """Let a disk pass what is in line with a line, as long as nothing changes its flight."""
    f = run.flights[i]
    f.skip = f.skip | run.lines_and_ends(k)
