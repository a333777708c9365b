"""Contacts that may close a gap below the digits, or be those of points that rounding has led astray: screens, behind which the
reference engine's rules decide."""

from __future__ import annotations

import math

from eventsim.engines.fast.advance import place, speed
from eventsim.engines.fast.compiled import part, real, word
from eventsim.engines.fast.layout import CONTACT_TIME, RADIUS, REALS, WALL, WORDS, WRAPS_X, WRAPS_Y, T
from eventsim.engines.fast.pairs import images, shifts
from eventsim.engines.fast.shapes import is_hollow, wall_normal
from eventsim.formulas.doubt import is_sunk, is_too_small

WIDER = 2.0
"""How much wider the screen is than the rule, whose numbers it has but for their last bits."""


@part
def may_be_astray(m, i, epoch):
    """Whether disk i, in a scene with points, has met nothing since the start, but was written anew by a wrap or a turnover."""
    if real(m.disks, i * REALS + CONTACT_TIME) != -math.inf:
        return False
    return epoch > 0 or word(m.disks, i * WORDS + WRAPS_X) != 0 or word(m.disks, i * WORDS + WRAPS_Y) != 0


@part
def pair_may_be_sunk(m, rules, i, j, now):
    """Whether two disks that meet now were as good as in contact when the later of their flights began."""
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
    return is_sunk(-(dx * (ui - uj) + dy * (wi - wj)), now - max(t, other), WIDER * size, rules.sinks, 0.0)


@part
def wall_may_be_sunk(m, rules, i, code, now):
    """The same of a disk and the wall that the code of its event stands for; under gravity only of one that is round."""
    wall, side = (WALL - code) // 2, -1 if (WALL - code) % 2 else 1
    if rules.gx is not None and (wall < rules.first_feature or not is_hollow(m, wall - rules.first_feature)):
        return False
    x, y = place(m, rules, i, now)
    u, w = speed(m, rules, i, now)
    nx, ny = wall_normal(m, rules, wall, side, x, y)
    size = abs(nx * x) + abs(ny * y) + max(abs(nx), abs(ny)) * real(m.disks, i * REALS + RADIUS)
    return is_sunk(-(nx * u + ny * w), now - real(m.disks, i * REALS + T), WIDER * size, rules.sinks, 0.0)
