"""A judgement in sentences: the first wrong event first."""

from __future__ import annotations

import math

import numpy as np

from eventsim.validation.judge.judgement import ASTRAY, Judgement
from eventsim.validation.truth import BELIEVED

ENOUGH = 0.5
"""Of all contacts: where fewer could be compared, that none was wrong says little of an engine."""


def judged_in_words(judgement: Judgement) -> list[str]:
    """What a judgement comes to."""
    lines = [_first(judgement), _contacts(judgement), _positions(judgement), _conserved(judgement)]
    return [line for line in [*lines, *judgement.remarks] if line]


def contacts_in_short(judgement: Judgement) -> str:
    """The counts of contacts in one line."""
    names = ("found", "missed", "doubled", "false", "elsewhere", "unseen")
    return ", ".join(f"{name} {getattr(judgement.charge, name)}" for name in names)


def _first(judgement: Judgement) -> str:
    """The first wrong event, or that there is none."""
    fault, parting = judgement.first_fault, judgement.charge.parting
    if fault is None and judgement.blind is not None:
        return f"Whether an event is wrong cannot be told: {judgement.blind}."
    if fault is not None:
        seen, unchecked = _seen(judgement, fault.time), _unchecked(judgement, fault.time)
        return f"First wrong event{seen}: {fault.sentence}.{unchecked}{_further(judgement)}"
    compared, every = judgement.charge.ahead, len(judgement.charge.all_at)
    if compared < ENOUGH * every:
        last = min(judgement.lost, max(judgement.charge.compared_at, default=judgement.truth.scene.start_time))
        text = f"Cannot tell after t = {last:.4g} ({compared} of {every} contacts compared): no wrong event until then"
        if parting is not None:
            return f"{text}; it parts from the truth by the errors of its times: {parting[1]}."
        return f"{text}; later, only what each contact does is looked at."
    if parting is not None:
        return f"No wrong event. It parts from the truth by the errors of its times: {parting[1]}."
    if math.isfinite(judgement.lost):
        how = f"contacts can be compared until its late ones have shifted its disks, about t = {judgement.lost:.4g}"
        return f"No wrong event: {how}; later, only what each contact does is looked at."
    return f"No wrong event until t = {judgement.times[-1]:g}."


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
    text = (
        f"Of {charge.ahead} contacts of disks that were in their places it finds {charge.found} and misses {charge.missed}; "
        f"{charge.doubled} are doubled, {charge.false} false"
    )
    if charge.unseen:
        text += f"; {charge.unseen} more are too weak, or too close to others, to be seen in the samples"
    if charge.found:
        late = charge.errors[:, 1]
        worst = int(np.argmax(np.abs(late)))
        text += (
            f". Times are late by {late.mean():+.2g} (mean), {np.sqrt(np.mean(late**2)):.2g} (root mean square), "
            f"{late[worst]:+.2g} (the worst, at t = {charge.errors[worst, 0]:.5g})"
        )
    return f"{text}. Contacts are matched within {judgement.tolerance:.2g}."


def _positions(judgement: Judgement) -> str:
    """How far they can be followed, by whom."""
    errors, looks = judgement.errors, judgement.looks
    free = judgement.truth.mean_free_time
    early = int(np.searchsorted(looks, judgement.truth.scene.start_time + free))
    early = min(early, len(looks) - 1)
    text = f"Positions are off by {errors[early]:.2g} diameters at t = {looks[early]:.4g} (a contact a disk)"
    if math.isfinite(judgement.lost):
        text += f", by more than {ASTRAY:g} from t = {judgement.lost:.4g} on"
    else:
        text += f", never by more than {errors.max():.2g}"
    if math.isfinite(judgement.believed):
        text += f"; float64 itself can be believed (to {BELIEVED:g}) until t = {judgement.believed:.4g}"
    return f"{text}."


def _conserved(judgement: Judgement) -> str:
    """Energy, momentum, overlaps."""
    parts = []
    if judgement.energy is not None and np.isfinite(judgement.energy[1:]).any():
        change = judgement.energy[np.isfinite(judgement.energy)]
        worst = int(np.argmax(np.abs(change)))
        parts.append(f"the energy changes by {change[-1]:+.2e} in all, by {change[worst]:+.2e} at most")
    if judgement.momentum is not None:
        parts.append(f"the momentum by {judgement.momentum:.1e}")
    depth, a, b, time = judgement.deepest
    if depth > 0.0:
        parts.append(f"the deepest overlap is {depth:.2%} of the reach (disks {a} and {b}, t = {time:.5g})")
    else:
        parts.append("no disks overlap at the times that were looked at")
    text = ", ".join(parts)
    return f"{text[0].upper()}{text[1:]}."
