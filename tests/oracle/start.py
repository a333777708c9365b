"""The start: what overlaps within rounding touches; what touches and moves along glides or rests."""

from __future__ import annotations

from decimal import Decimal

from tests.oracle.digits import root, sign
from tests.oracle.rest import glide, lie
from tests.oracle.search import pair_key, wall_key
from tests.oracle.state import State
from tests.oracle.table import TOUCHING, Bow, Line, Oval, Ring, Tip, across, along

STILL = Decimal(2) ** -46
"""A velocity across a touched wall, as a part of the speed, that is rounding."""


def touch_at_start(run: State) -> None:
    """What overlaps at the start, within rounding, touches; what touches and moves along glides or rests."""
    table = run.table
    for a in range(run.n):
        for b in range(a + 1, run.n):
            touch_pair(run, a, b)
    for i in range(run.n):
        for k, shape in enumerate(table.shapes):
            if isinstance(shape, Line):
                touch_line(run, i, k, shape)
            elif not isinstance(shape, Oval) and not (isinstance(shape, Tip) and table.radius[i] == 0):
                touch_round(run, i, k, shape)


def touch_pair(run: State, a: int, b: int) -> None:
    """Disks that overlap touch."""
    fa, fb, reach = run.flights[a], run.flights[b], run.table.radius[a] + run.table.radius[b]
    for image in run.images_around():
        px, py = run.search.shift(image)
        dx, dy = fa.x - fb.x - px, fa.y - fb.y - py
        c = dx * dx + dy * dy - reach * reach
        if reach > 0 and c <= 0 and sign(c, dx * dx + dy * dy + reach * reach) <= 0:
            fa.touch[pair_key(a, b, image)] = False
            fb.touch[pair_key(b, a, (-image[0], -image[1]))] = False


def touch_line(run: State, i: int, k: int, one: Line) -> None:
    """A disk at a line: it rests, glides, or touches."""
    table, f = run.table, run.flights[i]
    for image in run.images_around():
        px, py = run.search.shift(image)
        place = f.x - px, f.y - py
        s = across(one, place)
        side = 1 if s > 0 or len(one.sides) == 1 else -1
        gap = side * s - table.radius[i] * one.norm
        slack = (
            TOUCHING * one.norm * max(abs(f.x), abs(f.y), *(abs(c) for c in (*one.start, *one.end)), table.radius[i])
        )
        foot = along(one, place)
        if abs(gap) > slack or (one.length2 is not None and not -slack <= foot <= one.length2 + slack):
            continue
        if table.radius[i] == 0 and s == 0:
            rate0 = one.normal[0] * f.u + one.normal[1] * f.w
            pull0 = one.normal[0] * f.ax + one.normal[1] * f.ay
            side = one.sides[0] if len(one.sides) == 1 else 1 if (rate0 or pull0) > 0 else -1
        rate = side * (one.normal[0] * f.u + one.normal[1] * f.w)
        fall = side * (one.normal[0] * f.ax + one.normal[1] * f.ay)
        speed = root(f.u * f.u + f.w * f.w)
        is_along = abs(rate) <= STILL * one.norm * speed
        if fall < 0 and is_along and image == (0, 0):
            if k not in f.skip:
                lie(run, i, k, side, run.now)
        elif is_along and fall == 0 and speed > 0:
            glide(run, i, k)
        elif gap <= 0:
            f.touch[wall_key(k, image, side)] = False


def touch_round(run: State, i: int, k: int, shape: Ring | Bow | Tip) -> None:
    """A disk that reaches into something round touches it."""
    f, r = run.flights[i], run.table.radius[i]
    centre = shape.place if isinstance(shape, Tip) else shape.centre
    for image in run.images_around():
        px, py = run.search.shift(image)
        d2 = (f.x - px - centre[0]) ** 2 + (f.y - py - centre[1]) ** 2
        if isinstance(shape, Tip):
            cases = [(1, r)]
        elif isinstance(shape, Ring):
            cases = [(-1, shape.radius - r)]
        else:
            cases = [(1 if d2 > shape.radius**2 else -1, shape.radius + (r if d2 > shape.radius**2 else -r))]
        for side, reach in cases:
            slack = TOUCHING * max(abs(f.x), abs(f.y), reach, *(abs(c) for c in centre))
            gap = side * (d2 - reach * reach)
            if gap <= 0 and -gap <= 2 * slack * (reach + slack) and sign(gap, d2 + reach * reach) <= 0:
                f.touch[wall_key(k, image, side)] = False
                forget(run, i, float(-gap) / float(2 * reach) if reach > 0 else 0.0)


def forget(run: State, i: int, overlap: float) -> None:
    """An overlap that is rounding is none: floats may count with it as well."""
    run.doubt.round(i, (overlap, overlap, 0.0, 0.0))
