"""What a contact did: the restitution, the masses and the momentum that its turns tell, whatever the positions were."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from eventsim.record.contacts import Key
from eventsim.record.events import Floats, Kind
from eventsim.scene.stage import Stage
from eventsim.validation.judge.told import Met

CLEAR = 0.02
"""A restitution, or a share of momentum, that is off by less is right."""

ACROSS = 0.05
"""Of what a contact gives: a part across the normal that is less is rounding, of contacts that come a little late."""

BLUR = 4.0
"""A contact whose approach is slower than so many of the least turns, over CLEAR, says nothing."""


class Outcome(NamedTuple):
    """What the turns of a contact tell.

    approach: normal speed before.  restitution: normal speed after over before.  unbalanced: the momentum that both were given
    together, as a share of what each was given; 0 at a wall.  ratio: mass of a over mass of b that would balance it.
    """

    approach: float
    restitution: float
    unbalanced: float
    ratio: float


def outcome_of(met: Met, mass: Floats) -> Outcome | None:
    """What a contact did; None where its turns are not its own."""
    one, other = met.turns
    if not met.alone or (one is None and other is None):
        return None
    zero = np.zeros(2)
    change_a, change_b = (zero if turn is None else turn.change for turn in (one, other))
    along = change_a - change_b
    size = math.hypot(*along)
    if size == 0.0:
        return None
    normal = along / size
    approach = _approach(met, normal)
    if approach <= 0.0:
        return Outcome(approach, math.inf, 0.0, math.nan)
    restitution = size / approach - 1.0
    if one is None or other is None:
        return Outcome(approach, restitution, 0.0, math.nan)
    given_a, given_b = mass[one.disk] * change_a, mass[other.disk] * change_b
    whole = math.hypot(*given_a) + math.hypot(*given_b)
    unbalanced = abs(math.hypot(*given_a) - math.hypot(*given_b)) / whole if 0.0 < whole < math.inf else 0.0
    moved = math.hypot(*change_a)
    return Outcome(approach, restitution, unbalanced, math.hypot(*change_b) / moved if moved > 0.0 else math.nan)


def _approach(met: Met, normal: Floats) -> float:
    """The speed before along the normal, at which a and b (or the wall) come nearer.

    What does not turn has no velocity here but the one that its partner's turn cannot tell: it counts as at rest.
    """
    one, other = met.turns
    before_a = np.zeros(2) if one is None else one.before
    before_b = np.zeros(2) if other is None else other.before
    return -float((before_a - before_b) @ normal)


def wrong_outcome(met: Met, stage: Stage, mass: Floats, least: float, since: float) -> str | None:
    """What is wrong with what a contact did, in words; None where nothing is, or it cannot be told.

    Args:
        met: the contact.
        stage: the scene.
        mass: (n,), inf for immovable disks.
        least: the smallest change of velocity that is seen.
        since: the least time since the contact before of one of its disks.
    """
    found = outcome_of(met, mass)
    if found is None or not _is_clear(met, found, least):
        return None
    who = named(met.key, stage)
    usual = _usual(met.key, stage)
    possible = stage.law.possible(usual, found.approach, since)
    right = math.nan if possible is None else possible[0]
    if met.across > ACROSS:
        return f"friction: the contact of {who} gives {met.across:.2g} of its impulse across the normal: disks are smooth here"
    if found.unbalanced > CLEAR:
        a, b = met.key[1:]
        true = mass[a] / mass[b]
        return f"masses: after the contact of {who} they move as if m{a}/m{b} were {found.ratio:.4g}, not {true:.4g}"
    if possible is None or any(abs(found.restitution - one) <= CLEAR for one in possible):
        return None
    twice = 1.0 + 2.0 * right
    if abs(found.restitution - twice) <= CLEAR * (1.0 + twice):
        return f"double impulse: the contact of {who} gives twice the impulse"
    return f"restitution: the contact of {who} has {found.restitution:.4g}, not {right:.4g}"


def is_told(met: Met, stage: Stage, mass: Floats, least: float) -> bool:
    """Whether the turns of a contact tell what it did, and the law what it should have done."""
    found = outcome_of(met, mass)
    if found is None or not _is_clear(met, found, least):
        return False
    return stage.law.possible(_usual(met.key, stage), found.approach) is not None


def _is_clear(met: Met, found: Outcome, least: float) -> bool:
    """Whether the outcome is known to a part of CLEAR; disks that move and do not turn leave it open."""
    still = [disk for disk, turn in zip(met.key[1:], met.turns, strict=True) if turn is None]
    if met.key[0] == Kind.PAIR and still:
        return False
    return found.approach > BLUR * least / CLEAR


def _usual(key: Key, stage: Stage) -> float:
    kind, a, other = key
    return stage.usual(a, other) if kind == Kind.PAIR else stage.law.of_wall(other)


def named(key: Key, stage: Stage) -> str:
    """Who meets, in words."""
    kind, a, other = key
    if kind == Kind.PAIR:
        return f"disks {a} and {other}"
    wall = stage.wall_names[other] if other >= 0 else "a wall"
    return f"disk {a} with {wall}"
