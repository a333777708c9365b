"""Why contacts of an instant cannot be resolved, in words: they do not end, or nothing moves what they press on."""

from __future__ import annotations

import numpy as np

from eventsim.engines.collapse import LIES_STILL, named
from eventsim.engines.exact_state import ExactState
from eventsim.engines.reference.calendar import Event
from eventsim.engines.reference.generation import disks_of
from eventsim.engines.reference.rests import TwoSupportsError
from eventsim.formulas.doubt import outruns_clock
from eventsim.formulas.laws import Own, wrong_share
from eventsim.formulas.real import Real
from eventsim.formulas.simultaneous import SqueezedError
from eventsim.scene.own_law import FAILS, told
from eventsim.scene.settling import remedy_of
from eventsim.scene.stage import Stage


def endless(state: ExactState, stage: Stage, i: int) -> tuple[str, str]:
    """An instant that does not end: why a run stops there, and a sentence on disk i, those around it and what is known."""
    inelastic = stage.law.loses_energy()
    what = "collapse" if inelastic or stage.gravity is not None else "digits"
    pile = _pile(state, i)
    if what == "digits":
        cause = "at this instant do not end"
    elif all(state.vx[j] == state.vy[j] == 0.0 for j in pile):
        cause = f"have no bounce: {LIES_STILL}"
    else:
        cause = (
            "follow one another faster than the clock can tell (inelastic collapse, or rest on another disk, on several walls or "
            f"on a round one); {remedy_of(stage)}"
        )
    x, y = (float(at) for at in state.place(pile[0], state.now))  # engines come to the pile by different disks
    x, y = x + stage.corner[0], y + stage.corner[1]
    return what, f"the contacts of {named(pile)} at ({x:g}, {y:g}) {cause}"


def _pile(state: ExactState, i: int) -> list[int]:
    """Disk i, and those that it is piled up with: one of two met the other one last, just now and over and over."""
    again = [j for j in range(state.n) if state.at_once[j] > 1 and state.contact_time[j] == state.contact_time[i]]
    pile, added = {i}, {i}
    while added:
        near = {j for j in again for one in added if any(met[0] == one for met in state.met[j])}
        near |= {met[0] for one in added for met in state.met[one] if met[0] in again}
        added = near - pile
        pile |= added
    return sorted(pile)


class UnlawfulError(Exception):
    """The law of the scene does not say what becomes of contacts."""


class GrazesError(UnlawfulError):
    """Contacts of one instant that rounding may have made."""


class OutrunError(UnlawfulError):
    """Disks have become too fast for the clock."""


def grazed_at_once(disks: list[int]) -> GrazesError:
    """Contacts of one instant that share disks, all with round things and all along them."""
    graze = "grazes" if len(disks) == 1 else "graze"
    return GrazesError(
        f"{named(disks)} {graze} round things at one instant: whether they meet, and are squeezed, or pass each other, float64 "
        "cannot tell; a start that differs by more than the last bits can be told"
    )


def joint_under(law: str, disks: list[int]) -> UnlawfulError:
    """Contacts of one instant that share disks, under a law that says nothing of such."""
    have = "has" if len(disks) == 1 else "have"
    return UnlawfulError(
        f"{named(disks)} {have} contacts at one instant: {law} says what single ones do, and those at right angles on walls; a "
        "start that differs by a last bit parts them"
    )


def rough_joint(disks: list[int]) -> UnlawfulError:
    """Contacts of one instant that share disks, where these turn each other."""
    have = "has" if len(disks) == 1 else "have"
    return UnlawfulError(
        f"{named(disks)} {have} contacts at one instant: the law of rough disks says what single ones do; a start that differs "
        "by a last bit parts them"
    )


def lawful(stage: Stage, law: Own, event: Event, since_a: Real, since_b: Real, approach: Real, mass: Real) -> Real:
    """The restitution of a contact under a law of the user's own.

    Raises UnlawfulError where that fails, or returns what no contact can have; OutrunError where it leaves disks too fast.
    """
    who = named(disks_of(event)) if event.b >= 0 else f"disk {event.a} and a wall"
    at = f"{law.name()}, at the contact of {who} with the approach {float(approach):.6g},"
    try:
        share = law.restitution(stage.usual(event.a, event.b), since_a, since_b, approach, mass)
        wrong = wrong_share(share)
        come = 0.0 if wrong else share * approach
    except FAILS as error:
        raise UnlawfulError(f"{at} fails: {told(error, law.own.file)}") from None
    if wrong is not None:
        raise UnlawfulError(f"{at} returns {share!r}: that {wrong}")
    if outruns_clock(come, event.time, stage.extent):
        begun = np.hypot(stage.vx, stage.vy).max()
        raise OutrunError(
            f"{at} returns {share!r}: speeds, at the start up to {begun:.3g}, come to {come:.3g}, for which the clock of this "
            "scene is too coarse (see whether the law gives energy); a scene that begins from this state has a finer one"
        )
    return share


def refused(error: SqueezedError | TwoSupportsError | UnlawfulError, component: list[Event]) -> tuple[str, str]:
    """A cluster that no impulses part, a disk on two walls, or what no law tells: why a run stops, and a sentence on it."""
    if isinstance(error, UnlawfulError):
        return "digits" if isinstance(error, GrazesError | OutrunError) else "law", str(error)
    if isinstance(error, TwoSupportsError):
        return "collapse", str(error)
    disks = sorted({i for event in component for i in (event.a, event.b) if i >= 0})
    names = ", ".join(map(str, disks))
    return "collapse", f"of disks {names} one is squeezed between others, or walls, that it cannot deflect"
