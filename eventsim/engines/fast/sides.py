"""The sides of walls that points are on, as in `scene.sides`; compiled only for scenes that have such."""

from __future__ import annotations

from eventsim.engines.fast.compiled import inline, part, real, store, word
from eventsim.engines.fast.last_contact import side_met
from eventsim.engines.fast.layout import (
    FLAGS,
    MET,
    MET_KX,
    RADIUS,
    REALS,
    RESTING,
    SUPPORT,
    SUPPORT_FACE,
    VX,
    VY,
    WORDS,
    WRAP_DOWN,
    WRAP_LEFT,
    WRAP_RIGHT,
    T,
    X,
    Y,
)
from eventsim.engines.fast.shapes import (
    ARC,
    CENTER,
    CORNERS,
    END_X,
    END_Y,
    ENDS,
    FACE,
    POST,
    SIZE,
    WIDTH,
    arc_at,
    face_at,
    is_closed,
    lies_on,
    side_of_closed,
)
from eventsim.formulas.motion import velocity
from eventsim.formulas.walls.arc import arc_distance, arc_rate, arc_side, arc_side_after
from eventsim.formulas.walls.face import face_distance, face_rate, face_side, face_side_after, side_in_line
from eventsim.formulas.walls.point import CORNER, closeness, end_of, is_near, is_point

NOWHERE = -1
"""The place of no wall."""

KEPT = 8
"""More than twice the largest number that is remembered of a side."""


@part
def keep_sides(m, rules, i, t, pull, x, y, u, w, wall, side):
    """Before the flight of disk i ends at (x, y), to go on with (u, w): keep on which sides of walls it is, if it is a point.

    pull: its acceleration.  wall: the place of the one that it meets there, from that side; or NOWHERE.
    """
    f = i * REALS
    lag = t - real(m.disks, f + T)
    gx, gy = pull
    flight = real(m.disks, f + X), real(m.disks, f + Y), real(m.disks, f + VX), real(m.disks, f + VY), gx, gy
    came_u, came_w = velocity(flight[2], lag, gx), velocity(flight[3], lag, gy)
    radius = real(m.disks, f + RADIUS)
    for k in range(rules.features):
        found = 0
        s = WIDTH * k
        kind = real(m.features, s)
        if kind in (FACE, ARC) and is_point(radius, real(m.features, s + SIZE)):
            close = closeness(real(m.features, s + SIZE), x, y, came_u, came_w, t)
            distance = _distance(m, s, kind, x, y)
            if distance <= CORNER * close:
                remembered = word(m.sides, i * rules.features + k)
                found = _side(m, s, kind, x, y, came_u, came_w)
                if distance <= close:
                    found = _side_after(m, rules, i, k, kind, remembered, flight, radius, x, y, came_u, came_w)
                if wall == rules.first_feature + k:
                    found = 2 * side if _in_corner(m, s, side, x, y, CORNER * close) else side
                elif wall == NOWHERE:  # a corner is not left on the spot
                    found = 2 * found if abs(remembered) == 2 else found
                else:
                    found = _next_to(m, rules, k, kind, found, wall, side, x, y, u, w, CORNER * close)
        elif is_closed(kind):
            found = word(m.sides, i * rules.features + k)
            if found == 0:
                found = side_of_closed(m, s, flight[0], flight[1], flight[2], flight[3])
        store(m.sides, i * rules.features + k, found)


@inline
def _side_after(m, rules, i, k, kind, remembered, flight, radius, x, y, u, w):
    """The side of the k-th shape, to which disk i is close, after its flight."""
    x0, y0, vx, vy, gx, gy = flight
    s = WIDTH * k
    before = side_met(m, i, rules.first_feature + k)
    if before == 0:
        before = remembered
    if before != 0:
        before = 1 if before > 0 else -1
    else:
        before = _side_on_line(m, i, k, kind, m.supports)
        if before == 0:  # from afar: it comes from behind
            before = -_moved_to(m, s, kind, -_side(m, s, kind, x0, y0, vx, vy), x, y, u, w)
    if kind == FACE:
        return face_side_after(
            face_at(m.features, s + 2), before, remembered, x0, y0, vx, vy, gx, gy, radius, x, y, u, w
        )
    return arc_side_after(arc_at(m.features, s + 2), before, remembered, x0, y0, vx, vy, gx, gy, radius, x, y, u, w)


@inline
def _side_on_line(m, i, k, kind, supports):
    """The side of a face in line with the wall that disk i rests on; 0 of others."""
    if supports is None:
        return 0
    return _side_on_support(m, i, k, kind)


@part
def _side_on_support(m, i, k, kind):
    if kind != FACE or not word(m.disks, i * WORDS + FLAGS) & RESTING:
        return 0
    line = face_at(m.supports, SUPPORT * (-1 - word(m.disks, i * WORDS + MET)) + SUPPORT_FACE)
    if not lies_on(m, k, line):
        return 0
    return side_in_line(face_at(m.features, WIDTH * k + 2), line, word(m.disks, i * WORDS + MET_KX))


@part
def _in_corner(m, s, side, x, y, close):
    """Whether a point at a shape, on a side of it, is where another one makes a corner with it."""
    row, at = m.features, s + CORNERS + (1 if side < 0 else 0)
    first = real(row, at) != 0.0 and is_near(real(row, s + CENTER), real(row, s + CENTER + 1), x, y, close)
    return first or (real(row, at + 2) != 0.0 and is_near(real(row, s + END_X), real(row, s + END_Y), x, y, close))


@part
def _next_to(m, rules, k, kind, side, wall, from_side, x, y, u, w, close):
    """The side of the k-th shape, where the point meets another wall, maybe at an end that both share."""
    row, s = m.features, WIDTH * k
    o = WIDTH * (wall - rules.first_feature)
    other = real(row, o) if wall >= rules.first_feature else -1.0
    thin = other in (FACE, ARC)
    if other == POST:
        if _ends_at(m, s, real(row, o + CENTER), real(row, o + CENTER + 1)):
            return _moved_to(m, s, kind, side, x, y, u, w)
        return side
    if kind == FACE and other == FACE:
        line = face_at(row, o + 2)
        if lies_on(m, k, line):
            return side_in_line(face_at(row, s + 2), line, from_side)
    if thin:
        for second in range(2):
            at = o + (END_X if second == 1 else CENTER)
            px, py = real(row, at), real(row, at + 1)
            if is_near(px, py, x, y, close) and _ends_at(m, s, px, py):
                corner = int(real(row, o + CORNERS + 2 * second + (1 if from_side < 0 else 0)))
                if abs(corner) == k + 1:
                    return 2 if corner > 0 else -2
                return _moved_to(m, s, kind, side, x, y, u, w)
    for second in range(2):
        at, far = (s + END_X, s + CENTER) if second == 1 else (s + CENTER, s + END_X)
        _, sealed = end_of(real(row, s + ENDS), second == 1, 1)
        if sealed and is_near(real(row, at), real(row, at + 1), x, y, close):
            if thin and _side(m, o, other, real(row, far), real(row, far + 1), 0.0, 0.0) != from_side:
                return _moved_to(m, s, kind, side, x, y, u, w)
            return 2 * side
    return side


@inline
def _ends_at(m, s, x, y):
    row = m.features
    first = real(row, s + CENTER) == x and real(row, s + CENTER + 1) == y
    return first or (real(row, s + END_X) == x and real(row, s + END_Y) == y)


@part
def _moved_to(m, s, kind, side, x, y, u, w):
    """The side of a shape that a velocity leads to; the given one along it."""
    rate = _rate(m, s, kind, x, y, u, w)
    return 1 if rate > 0.0 else -1 if rate < 0.0 else side


@part
def _rate(m, s, kind, x, y, u, w):
    if kind == FACE:
        return face_rate(face_at(m.features, s + 2), x, y, u, w)
    return arc_rate(arc_at(m.features, s + 2), x, y, u, w)


@part
def _side(m, s, kind, x, y, u, w):
    if kind == FACE:
        return face_side(face_at(m.features, s + 2), x, y, u, w)
    return arc_side(arc_at(m.features, s + 2), x, y, u, w)


@part
def _distance(m, s, kind, x, y):
    if kind == FACE:
        return face_distance(face_at(m.features, s + 2), x, y)
    return arc_distance(arc_at(m.features, s + 2), x, y)


@part
def keep_sides_behind(m, rules, i, code):
    """Keep the sides of disk i, if it is a point, when it has passed a periodic boundary: those of the images there."""
    begin, row = i * rules.features, 1 if code == WRAP_LEFT else 0
    if code != WRAP_RIGHT and code != WRAP_LEFT:
        row = 3 if code == WRAP_DOWN else 2
    for k in range(rules.features):
        image = word(m.images, row * rules.features + k)
        new = 0 if image < 0 else (word(m.sides, begin + image) + KEPT) % KEPT
        store(m.sides, begin + k, (word(m.sides, begin + k) + KEPT) % KEPT + KEPT * new)
    for k in range(rules.features):
        new = word(m.sides, begin + k) // KEPT
        store(m.sides, begin + k, new - KEPT if new > 2 else new)
