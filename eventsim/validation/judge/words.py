"""A judgement in sentences: the first wrong event first."""

from __future__ import annotations

import math

import numpy as np

from eventsim.validation.judge.judgement import ASTRAY, Judgement
from eventsim.validation.truth import BELIEVED

COUNTS = ("found", "missed", "doubled", "false", "elsewhere", "unseen", "untold")
"""Of contacts."""


def judged_in_words(judgement: Judgement) -> list[str]:
    """What a judgement comes to: the verdict, what it does not rest on, the numbers."""
    lines = [_first(judgement), *judgement.remarks, _contacts(judgement), _positions(judgement), _conserved(judgement)]
    return [line for line in lines if line]


def contacts_in_short(judgement: Judgement) -> str:
    """The counts of contacts in one line."""
    return ", ".join(f"{name} {getattr(judgement.charge, name)}" for name in COUNTS)


def _first(judgement: Judgement) -> str:
    """The first wrong event, or that there is none."""
    fault = judgement.first_fault
    if fault is None and judgement.blind is not None:
        return f"Whether an event is wrong cannot be told: {judgement.blind}."
    if fault is not None:
        seen, unchecked = _seen(judgement, fault.time), _unchecked(judgement, fault.time)
        return f"First wrong event{seen}: {fault.sentence}.{unchecked}{_further(judgement)}"
    if not judgement.compared:
        last = min(judgement.lost, float(judgement.times[-1]))
        return f"Nothing was compared: no disk that was still in its place met anything until t = {last:.4g}.{_rest(judgement)}"
    return f"No wrong event{_right(judgement)}.{_rest(judgement)}"


def _right(judgement: Judgement) -> str:
    """How many contacts are right, until when; and of how many nobody knows what they did."""
    charge, every = judgement.charge, len(judgement.charge.all_at)
    until = f"until t = {judgement.times[-1]:.4g}" if charge.ahead == every else f"the last at t = {max(charge.compared_at):.4g}"
    if not charge.untold:
        return f": {charge.found} of {charge.ahead} contacts compared are right, {until}"
    return (
        f": {charge.found} of {charge.ahead} contacts compared are found, {until}. Of those found "
        f"{charge.found - charge.untold} have the right impulse, the others are too slow, or too close to others, to tell"
    )


def _rest(judgement: Judgement) -> str:
    """How many contacts could not be compared, and why."""
    charge, parting = judgement.charge, judgement.charge.parting
    rest = len(charge.all_at) - charge.ahead
    if not rest:
        return ""
    many = "The only one" if rest == 1 and not charge.ahead else "The other one" if rest == 1 else f"The other {rest}"
    if math.isfinite(judgement.lost):
        why = f"from t = {judgement.lost:.4g} on its disks are off by more than {ASTRAY:g} diameters, as every error grows"
        if parting is not None:
            why += f", and {parting[1]}"
    elif parting is not None:
        why = f"it parts from the truth by the errors of its times: {parting[1]}"
    elif math.isfinite(judgement.believed):
        why = f"float64 itself can be believed until t = {judgement.believed:.4g} alone"
    else:
        why = "too weak, too close to others, or too close to the end"
    return f" {many} cannot be compared: {why}. Of them only what each contact does is looked at."


def _seen(judgement: Judgement, time: float) -> str:
    """Whether the first one is only the first that can be seen."""
    return " that can be seen" if judgement.charge.unchecked(time) else ""


def _unchecked(judgement: Judgement, time: float) -> str:
    """How many contacts before it could not be checked, and why."""
    whole = judgement.charge.unchecked(time)
    unseen = sum(at < time for at in judgement.charge.unseen_at)
    why = [
        *([f"{unseen} too weak, or too close to others"] if unseen else []),
        *([f"{whole - unseen} of disks out of their places by then"] if whole > unseen else []),
    ]
    return f" {whole} earlier {'contact' if whole == 1 else 'contacts'} could not be checked ({', '.join(why)})." if whole else ""


def _further(judgement: Judgement) -> str:
    """How many others of the same kind follow."""
    kinds: dict[str, int] = {}
    for fault in judgement.faults[1:]:
        kinds[fault.kind] = kinds.get(fault.kind, 0) + 1
    if not kinds:
        return ""
    return f" After it: {', '.join(f'{kind} {count}' for kind, count in kinds.items())}."


def _contacts(judgement: Judgement) -> str:
    """Found, missed, doubled, false, and times."""
    charge = judgement.charge
    if judgement.blind is not None:
        return ""
    if not charge.ahead and not charge.doubled and not charge.false:
        return "No contact could be charged: no disk that was still in its place met anything."
    sentences = [
        f"Of {charge.ahead} contacts of disks that were in their places it finds {charge.found} and misses {charge.missed}; "
        f"{charge.doubled} are doubled, {charge.false} false."
    ]
    if charge.unseen:
        more = "1 more is" if charge.unseen == 1 else f"{charge.unseen} more are"
        sentences.append(f"{more} too weak, or too close to others, to be seen in the samples.")
    if charge.found:
        late = charge.errors[:, 1]
        worst = int(np.argmax(np.abs(late)))
        sentences += [
            f"Times are late by {late.mean():+.2g} on average.",
            f"Their root mean square is {np.sqrt(np.mean(late**2)):.2g}.",
            f"The worst is {late[worst]:+.2g}, at t = {charge.errors[worst, 0]:.5g}.",
        ]
    return " ".join([*sentences, f"Contacts are matched within {judgement.tolerance:.2g}."])


def _positions(judgement: Judgement) -> str:
    """How far they can be followed, by whom."""
    errors, looks = judgement.errors, judgement.looks
    free = judgement.truth.mean_free_time
    early = int(np.searchsorted(looks, judgement.truth.scene.start_time + free))
    early = min(early, len(looks) - 1)
    text = f"Positions are off by {errors[early]:.2g} diameters after a contact a disk, at t = {looks[early]:.4g}."
    if math.isfinite(judgement.lost):
        text += f" They are off by more than {ASTRAY:g} from t = {judgement.lost:.4g} on."
    else:
        text += f" They are never off by more than {errors.max():.2g}."
    if math.isfinite(judgement.believed):
        text += f" Float64 itself can be believed, to {BELIEVED:g}, until t = {judgement.believed:.4g}."
    return text


def _conserved(judgement: Judgement) -> str:
    """Energy, momentum, overlaps."""
    sentences = []
    if judgement.energy is not None and np.isfinite(judgement.energy[1:]).any():
        change = judgement.energy[np.isfinite(judgement.energy)]
        worst = int(np.argmax(np.abs(change)))
        of = "" if judgement.truth.stage.gravity is None else " of the kinetic one at the start"
        how = ", estimated from differences of positions (contacts between two of them blur it)," if judgement.differences else ""
        sentences.append(f"The energy{how} changes by {change[-1]:+.2e}{of} in all, and by {change[worst]:+.2e} at most.")
        if judgement.lawful is not None:
            sentences.append(f"That of the event-driven run changes by {judgement.lawful:+.2e} in all.")
    if judgement.momentum is not None:
        sentences.append(f"The momentum changes by {judgement.momentum:.1e}.")
    depth, a, b, time = judgement.deepest
    if depth > 0.0:
        sentences.append(f"The deepest overlap is {depth:.2%} of the reach, of disks {a} and {b} at t = {time:.5g}.")
    else:
        sentences.append("No disks overlap at the times that were looked at.")
    return " ".join(sentences)
