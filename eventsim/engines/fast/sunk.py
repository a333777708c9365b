"""Contacts that may close a gap below the digits, or be those of points that rounding has led astray: screens, behind which the
reference engine's rules decide."""

from __future__ import annotations

import math

from eventsim.engines.fast.advance import place, speed
from eventsim.engines.fast.compiled import inline, part, real, word
from eventsim.engines.fast.layout import CONTACT_TIME, RADIUS, REALS, WALL, WORDS, WRAPS_X, WRAPS_Y, T
from eventsim.engines.fast.pairs import images, shifts
from eventsim.engines.fast.shapes import is_hollow, wall_normal
from eventsim.formulas.doubt import is_sunk, is_too_small

WIDER = 2.0
"""How much wider the screen is than the rule, whose numbers it has but for their last bits."""


@inline
def pair_may_be_sunk(m, rules, i, j, now, sinks):
    """Whether two disks that meet now were as good as in contact when the later of their flights began."""
    return False if sinks is None else _pair_may_be_sunk(m, rules, i, j, now, sinks)


@inline
def wall_may_be_sunk(m, rules, i, code, now, gx, sinks):
    """The same of a disk and the wall that the code of its event stands for; under gravity only of one that is round."""
    return False if sinks is None else _wall_may_be_sunk(m, rules, i, code, now, gx, sinks)


@inline
def may_be_astray(m, i, epoch, sides):
    """Whether disk i, in a scene with points, has met nothing since the start, but was written anew by a wrap or a turnover."""
    return False if sides is None else _has_met_nothing(m, i, epoch)


@part
def _has_met_nothing(m, i, epoch):
    if real(m.disks, i * REALS + CONTACT_TIME) != -math.inf:
        return False
    return epoch > 0 or word(m.disks, i * WORDS + WRAPS_X) != 0 or word(m.disks, i * WORDS + WRAPS_Y) != 0


@part
def _pair_may_be_sunk(m, rules, i, j, now, sinks):
    t, other = real(m.disks, i * REALS + T), real(m.disks, j * REALS + T)
    xi, yi = place(m, rules, i, now)
    xj, yj = place(m, rules, j, now)
    ui, wi = speed(m, rules, i, now)
    uj, wj = speed(m, rules, j, now)
    shift_x, shift_y = shifts(rules, *images(m, rules, i, j, now, xi, yi))
    dx, dy = (xi - xj) - shift_x, (yi - yj) - shift_y
    reach = real(m.disks, i * REALS + RADIUS) + real(m.disks, j * REALS + RADIUS)
    far_x, far_y = max(abs(xi), abs(xj)), max(abs(yi), abs(yj))
    if is_too_small(reach, WIDER * max(far_x, far_y)):
        return True
    size = abs(dx) * far_x + abs(dy) * far_y + reach * reach
    return is_sunk(-(dx * (ui - uj) + dy * (wi - wj)), now - max(t, other), WIDER * size, sinks, 0.0)


@part
def _wall_may_be_sunk(m, rules, i, code, now, gx, sinks):
    wall, side = (WALL - code) // 2, -1 if (WALL - code) % 2 else 1
    if gx is not None and (wall < rules.first_feature or not is_hollow(m, wall - rules.first_feature)):
        return False
    x, y = place(m, rules, i, now)
    u, w = speed(m, rules, i, now)
    nx, ny = wall_normal(m, rules, wall, side, x, y, rules.wall_x, rules.wall_y, m.features)
    size = abs(nx * x) + abs(ny * y) + max(abs(nx), abs(ny)) * real(m.disks, i * REALS + RADIUS)
    return is_sunk(-(nx * u + ny * w), now - real(m.disks, i * REALS + T), WIDER * size, sinks, 0.0)
