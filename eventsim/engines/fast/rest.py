"""Coming to rest on straight walls, and corners that hold a disk; compiled only for scenes where that can be.

Kernels predict it; what then happens is rare, and left to the reference engine's rules.
"""

from __future__ import annotations

import math

from eventsim.engines.fast.advance import place, pulls, speed
from eventsim.engines.fast.compiled import inline, part, real, word
from eventsim.engines.fast.last_contact import side_met
from eventsim.engines.fast.layout import (
    CONTACT_TIME,
    FLAGS,
    MET,
    MET_KX,
    MET_KY,
    NOBODY,
    OWN_OF_WALL,
    RADIUS,
    REALS,
    RESTING,
    SERIES,
    SEVERAL,
    SUPPORT,
    SUPPORT_FACE,
    SUPPORT_HIGH,
    SUPPORT_LINE,
    SUPPORT_LOW,
    VX,
    VY,
    WALL,
    WORDS,
    T,
    X,
    Y,
)
from eventsim.engines.fast.shapes import (
    CENTER,
    WIDTH,
    beside,
    face_at,
    is_passed,
    is_post,
    is_straight,
    lies_on,
    wall_normal,
)
from eventsim.formulas.corner import kept_up_energy, passes_sliding, slides_into
from eventsim.formulas.crossing import crossing_delay
from eventsim.formulas.real import NEVER
from eventsim.formulas.rest import (
    AS_AT_START,
    LEFT,
    NOT_LAST,
    STRUCK,
    SUPPORTED,
    border_size,
    free_border_contact,
    hop_on_face_delay,
    launch,
    rest_on_face_delay,
)
from eventsim.formulas.slide import end_delay, slide_delay
from eventsim.formulas.walls.face import flight_side


@inline
def is_support(m, place):
    """Whether a wall supports disks."""
    return real(m.supports, SUPPORT * place + SUPPORT_LOW) < real(m.supports, SUPPORT * place + SUPPORT_HIGH)


@inline
def support_face(m, place):
    """The face of a wall that supports disks."""
    return face_at(m.supports, SUPPORT * place + SUPPORT_FACE)


@inline
def _share_of_series(m, rules, place):
    """The usual restitution of bounces that follow each other ever faster."""
    return rules.series_restitution if m.shares is None else real(m.shares, OWN_OF_WALL * place + SERIES)


@inline
def are_in_line(m, one, other):
    """Whether two walls support disks, and are in line."""
    same = real(m.supports, SUPPORT * one + SUPPORT_LINE) == real(m.supports, SUPPORT * other + SUPPORT_LINE)
    return same and is_support(m, one) and is_support(m, other)


WIDER = 2.0
"""How much more energy than the rule of corners the screen lets pass."""


@part
def _is_cornered(m, rules, i, wall, side, x, y):
    """Whether disk i, at rest on a wall at (x, y), would be pressed onto another one that it met last."""
    w = i * WORDS
    met = word(m.disks, w + MET)
    if NOBODY < met < 0:
        return _makes_corner(m, rules, i, wall, side, x, y, met, word(m.disks, w + MET_KX), word(m.disks, w + MET_KY))
    if met == SEVERAL:
        row = word(m.disks, w + MET_KX)
        while row >= 0:
            other, from_side, how = word(m.several, 4 * row), word(m.several, 4 * row + 1), word(m.several, 4 * row + 2)
            if NOBODY < other < 0 and _makes_corner(m, rules, i, wall, side, x, y, other, from_side, how):
                return True
            row = word(m.several, 4 * row + 3)
    return False


@inline
def _makes_corner(m, rules, i, wall, side, x, y, other, from_side, how):
    if other == -1 - wall or how == LEFT or are_in_line(m, wall, -1 - other):
        return False
    bx, by = wall_normal(m, rules, wall, side, x, y)
    ax, ay = wall_normal(m, rules, -1 - other, from_side, x, y)
    return slides_into(bx, by, ax, ay, rules.gx, rules.gy)


@part
def may_be_spent(m, rules, i, time):
    """Whether disk i, which meets a wall, may be at the end of its bounces in a corner: the reference engine's rules decide."""
    x, y = place(m, rules, i, time)
    u, w = speed(m, rules, i, time)
    size = abs(x) + abs(y) + real(m.disks, i * REALS + RADIUS)
    little = kept_up_energy(rules.gx, rules.gy, size, rules.wall_restitution)
    met = word(m.disks, i * WORDS + MET)
    return met < 0 and met != NOBODY and 0.5 * (u * u + w * w) < WIDER * little


@inline
def rests(m, i):
    """Whether disk i rests on a wall."""
    return word(m.disks, i * WORDS + FLAGS) & RESTING != 0


@inline
def _has_struck(m, i, place):
    """Whether disk i struck a wall last, or one in line with it."""
    if side_met(m, i, place) != 0:
        return True
    met = word(m.disks, i * WORDS + MET)
    if not NOBODY < met < 0 or word(m.disks, i * WORDS + MET_KY) != STRUCK:
        return False
    return are_in_line(m, place, -1 - met)


@inline
def _since_met(m, i, place):
    """How long before its flight began disk i struck a wall, or one in line with it; else NOT_LAST, or AS_AT_START."""
    if real(m.disks, i * REALS + CONTACT_TIME) == -math.inf:
        return AS_AT_START
    if not _has_struck(m, i, place):
        return NOT_LAST
    return real(m.disks, i * REALS + T) - real(m.disks, i * REALS + CONTACT_TIME)


@part
def border_contact(m, rules, i, place, side, target, x, v, g):
    """(time, how) of the next event of disk i at a wall of the domain, which keeps its coordinate x at `target`."""
    delay, how = _border_delay(m, rules, i, place, side, target, x, v, g)
    if how == STRUCK and slides_past(m, rules, i, place, side, delay):
        return NEVER, STRUCK
    return real(m.disks, i * REALS + T) + delay, how


@part
def _border_delay(m, rules, i, place, side, target, x, v, g):
    """(delay, how) of the same, whatever else the disk comes to rest on."""
    f = i * REALS
    if rests(m, i) and word(m.disks, i * WORDS + MET) == -1 - place:
        return NEVER, STRUCK
    both = abs(real(m.disks, f + X)) + abs(real(m.disks, f + Y))
    size = border_size(x, both, target, real(m.disks, f + CONTACT_TIME) == -math.inf)
    restitution, since = _share_of_series(m, rules, place), _since_met(m, i, place)
    delay, how = free_border_contact(side, target, x, v, g, size, restitution, real(m.disks, f + T), since)
    x0, y0 = real(m.disks, f + X), real(m.disks, f + Y)
    if rules.still is not None and how == SUPPORTED and _is_cornered(m, rules, i, place, side, x0, y0):
        return crossing_delay(x, v, g, target, side), STRUCK
    return delay, how


@inline
def slides_past(m, rules, i, wall, side, delay):
    """Whether disk i is about to rest on the wall that it met last, and to slide there, but not into this one."""
    if rules.still is None:
        return False
    met = word(m.disks, i * WORDS + MET)
    if not NOBODY < met < 0 or met == -1 - wall or not delay < NEVER:
        return False
    return _slides_past(m, rules, i, wall, side, delay, -1 - met)


@part
def _slides_past(m, rules, i, wall, side, delay, last):
    f, w = i * REALS, i * WORDS
    if word(m.disks, w + MET_KY) != STRUCK or not is_support(m, last):
        return False
    x, y = place(m, rules, i, real(m.disks, f + T) + delay)
    side_there = word(m.disks, w + MET_KX)
    ax, ay = wall_normal(m, rules, last, side_there, x, y)
    bx, by = wall_normal(m, rules, wall, side, x, y)
    gx, gy = pulls(m, rules, i)
    if not passes_sliding(ax, ay, bx, by, real(m.disks, f + VX), real(m.disks, f + VY), gx, gy):
        return False
    rest, how = _next_on(m, rules, i, last, side_there)
    return how == SUPPORTED and delay <= rest


@part
def _next_on(m, rules, i, wall, side):
    """(delay, how) of the next event of disk i at a wall that it met from a side; a later rest counts alone."""
    f = i * REALS
    if wall >= rules.first_feature:
        delay, _, how = shape_rest(m, rules, i, wall - rules.first_feature)
        return delay, how
    ax, ay = pulls(m, rules, i)
    sign, r = float(side), real(m.disks, f + RADIUS)
    if rules.wall_x is not None and wall < 2 and rules.wall_x == 0:
        target = rules.width - r if sign < 0.0 else r
        return _border_delay(m, rules, i, wall, sign, target, real(m.disks, f + X), real(m.disks, f + VX), ax)
    target = rules.height - r if sign < 0.0 else r
    return _border_delay(m, rules, i, wall, sign, target, real(m.disks, f + Y), real(m.disks, f + VY), ay)


@part
def shape_rest(m, rules, i, k):
    """(delay, side, how) of the next event of disk i at the k-th shape; NEVER with STRUCK where the shape itself is to tell.

    NEVER with another `how`: a disk on the line of the shape, or at its end, passes it.
    """
    f, w = i * REALS, i * WORDS
    t, r = real(m.disks, f + T), real(m.disks, f + RADIUS)
    x, y, vx, vy = real(m.disks, f + X), real(m.disks, f + Y), real(m.disks, f + VX), real(m.disks, f + VY)
    ax, ay = pulls(m, rules, i)
    place = rules.first_feature + k
    met = word(m.disks, w + MET)
    if NOBODY < met < 0 and word(m.disks, w + MET_KY) != STRUCK:
        how, on = word(m.disks, w + MET_KY), SUPPORT * (-1 - met)
        line = face_at(m.supports, on + SUPPORT_FACE)
        if met == -1 - place and how == SUPPORTED:
            low, high = real(m.supports, on + SUPPORT_LOW), real(m.supports, on + SUPPORT_HIGH)
            return slide_delay(line, low, high, x, y, vx, vy, ax, ay), word(m.disks, w + MET_KX), LEFT
        if (how == SUPPORTED or is_straight(m, k)) and lies_on(m, k, line):
            return NEVER, 0, LEFT
        if how == SUPPORTED and is_passed(m, k, line, word(m.disks, w + MET_KX)):
            return NEVER, 0, LEFT
        if how != SUPPORTED and r > 0.0 and is_post(m, k) and lies_on(m, k, line):
            px, py = real(m.features, WIDTH * k + CENTER), real(m.features, WIDTH * k + CENTER + 1)
            delay = end_delay(px, py, x, y, vx, vy, ax, ay, r, t - real(m.disks, f + CONTACT_TIME))
            if not delay < 0.0:
                return (delay, 1, STRUCK) if delay < NEVER else (NEVER, 0, LEFT)
    if not is_support(m, place):
        return NEVER, 0, STRUCK
    low, high = real(m.supports, SUPPORT * place + SUPPORT_LOW), real(m.supports, SUPPORT * place + SUPPORT_HIGH)
    face = support_face(m, place)
    before = side_met(m, i, place)
    close = beside(m, rules, i, k)
    side = flight_side(face, before, close, x, y, vx, vy, r)
    restitution, since = _share_of_series(m, rules, place), _since_met(m, i, place)
    if before != 0 and side != before:  # it has come round an end since
        since = NOT_LAST
    delay = rest_on_face_delay(face, side, low, high, x, y, vx, vy, ax, ay, r, restitution, t, since)
    if delay < NEVER:
        if rules.still is not None and _is_cornered(m, rules, i, place, side, x, y):
            return NEVER, 0, STRUCK
        return delay, side, SUPPORTED
    return NEVER if since < 0.0 else hop_on_face_delay(face, side, x, y, vx, vy, ax, ay, since, r, close), side, STRUCK


@part
def launched(m, rules, i, place, side, nx, ny):
    """The speed, in terms of the normal, at which disk i left the straight wall that it now falls back to; else 0."""
    if not _has_struck(m, i, place) or rests(m, i):
        return 0.0
    ax, ay = pulls(m, rules, i)
    fall = nx * ax + ny * ay
    if not fall < 0.0:
        return 0.0
    f = i * REALS
    return launch(nx * real(m.disks, f + VX) + ny * real(m.disks, f + VY), fall, _since_met(m, i, place))


@part
def is_for_rules(m, rules, i, code, time):
    """Whether the reference engine's rules are to resolve an event: a disk of it rests, or comes to rest, or leaves a wall."""
    if code >= 0:
        return rests(m, i) or rests(m, code)
    if code > WALL:
        return False
    if rests(m, i):
        return True
    wall_code = WALL - code
    return _next_on(m, rules, i, wall_code // 2, -1 if wall_code % 2 else 1)[1] != STRUCK
