"""Corners of two walls that hold a disk, as in `scene.corners`; compiled only for scenes where disks settle."""

from __future__ import annotations

from eventsim.engines.fast.advance import place, speed
from eventsim.engines.fast.compiled import inline, part
from eventsim.engines.fast.layout import MET, MET_KX, MET_KY, NOBODY, RADIUS, REALS, SEVERAL, WALL, WORDS
from eventsim.engines.fast.memory import real, word
from eventsim.engines.fast.shapes import wall_normal
from eventsim.engines.fast.supports import are_in_line
from eventsim.formulas.corner import holds, kept_up_energy
from eventsim.formulas.rest import LEFT

WIDER = 2.0
"""How much more energy than the rule of corners the screen lets pass."""


@inline
def is_cornered(m, rules, i, wall, side, x, y, still):
    """Whether a wall makes a corner that holds disk i, at (x, y), with another one that it met last."""
    if still is None:
        return False
    return _is_cornered(m, rules, i, wall, side, x, y)


@part
def _is_cornered(m, rules, i, wall, side, x, y):
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
    if other == -1 - wall or how == LEFT:
        return False
    if _is_one_line(m, wall, -1 - other, m.supports):
        return False
    bx, by = wall_normal(m, rules, wall, side, x, y, rules.wall_x, rules.wall_y, m.features)
    ax, ay = wall_normal(m, rules, -1 - other, from_side, x, y, rules.wall_x, rules.wall_y, m.features)
    return holds(ax, ay, bx, by, rules.gx, rules.gy)


@inline
def _is_one_line(m, wall, other, supports):
    if supports is None:
        return False
    return are_in_line(m, wall, other)


@inline
def may_be_spent(m, rules, i, code, time, still):
    """Whether disk i, which meets a wall, may be at the end of its bounces in a corner: the reference engine's rules decide."""
    if still is None:
        return False
    return code <= WALL and _may_be_spent(m, rules, i, time)


@part
def _may_be_spent(m, rules, i, time):
    x, y = place(m, rules, i, time)
    u, w = speed(m, rules, i, time)
    size = abs(x) + abs(y) + real(m.disks, i * REALS + RADIUS)
    little = kept_up_energy(rules.gx, rules.gy, size, rules.wall_restitution)
    met = word(m.disks, i * WORDS + MET)
    return met < 0 and met != NOBODY and 0.5 * (u * u + w * w) < WIDER * little
