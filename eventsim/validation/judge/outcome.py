"""What a contact did: the restitution, the masses and the momentum that its turns tell, whatever the positions were."""

from __future__ import annotations

import math
from typing import NamedTuple

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


def outcome_of(met: Met, mass: Floats, least: float) -> Outcome | None:
    """What a contact did; None where its turns are not its own, or do not tell it to a part of CLEAR.

    Args:
        met: the contact.
        mass: (n,), inf for immovable disks.
        least: the smallest change of velocity that is seen.
    """
    one, other = met.turns
    if not met.alone or one is None or (other is None and met.key[0] == Kind.PAIR):
        return None  # a disk that does not turn may move, and leaves it open
    along = one.change if other is None else one.change - other.change
    closing = one.before if other is None else one.before - other.before
    size = math.hypot(*along)
    if size == 0.0:
        return None
    approach = -float(closing @ along) / size
    if approach <= BLUR * least / CLEAR:
        return None
    restitution = size / approach - 1.0
    if other is None:
        return Outcome(approach, restitution, 0.0, math.nan)
    given_a, given_b = mass[one.disk] * one.change, mass[other.disk] * other.change
    whole = math.hypot(*given_a) + math.hypot(*given_b)
    unbalanced = abs(math.hypot(*given_a) - math.hypot(*given_b)) / whole if 0.0 < whole < math.inf else 0.0
    moved = math.hypot(*one.change)
    return Outcome(approach, restitution, unbalanced, math.hypot(*other.change) / moved if moved > 0.0 else math.nan)


def restitutions(met: Met, found: Outcome, stage: Stage, since: float = 0.0) -> tuple[float, ...] | None:
    """What the law of the scene may have given a contact, so long after the one before; None: nobody knows."""
    kind, a, other = met.key
    usual = stage.usual(a, other) if kind == Kind.PAIR else stage.law.of_wall(other)
    return stage.law.possible(usual, found.approach, since)


def wrong_outcome(met: Met, found: Outcome, stage: Stage, mass: Floats, since: float) -> str | None:
    """What is wrong with what a contact did, in words; None where nothing is, or the law does not say.

    Args:
        met: the contact.
        found: what it did.
        stage: the scene.
        mass: (n,), inf for immovable disks.
        since: the least time since the contact before of one of its disks.
    """
    who, possible = named(met.key, stage), restitutions(met, found, stage, since)
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


def named(key: Key, stage: Stage) -> str:
    """Who meets, in words."""
    kind, a, other = key
    if kind == Kind.PAIR:
        return f"disks {a} and {other}"
    wall = stage.wall_names[other] if other >= 0 else "a wall"
    return f"disk {a} with {wall}"
