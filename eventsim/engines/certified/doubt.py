"""What a proof could not decide, in words: the disks and walls of the comparison, and when it comes."""

from __future__ import annotations

from eventsim.engines.certified.ball import Irrational, Undecided
from eventsim.engines.collapse import named
from eventsim.engines.reference.calendar import CONTACT, CROSSING, Event
from eventsim.formulas.clock import clock_time
from eventsim.scene.stage import Stage

TIE = "more bits do not help: it is taken for an exact tie of irrational numbers, which a start moved a little does not have"
CLUSTER = "more bits do not help; what comes before is proven"


def in_words(undecided: Undecided, stage: Stage, clock: tuple[int, float]) -> str:
    """What is not decided; clock: (epoch, remainder) where the proof stands."""
    epoch, remainder = clock
    if undecided.events:
        first, other = (_named(event, stage) for event in undecided.events)
        what = f"whether {first} or {other} comes first is not decided"
        remainder = float(undecided.events[0].time)
    elif isinstance(undecided, Irrational):
        what = (
            f"the contacts of {named(list(undecided.disks))} at one instant depend on numbers that are not known to be rational, "
            "so their joint impulses cannot be proven"
        )
    elif undecided.disks:
        what = f"a comparison for {named(list(undecided.disks))} is not decided"
    else:
        what = "a comparison is not decided"
    return f"at t = {clock_time(epoch, remainder, stage.epoch_length, stage.start_time):.9g} {what}"


def cause(undecided: Undecided, most_bits: int | None) -> str:
    """Why it is not decided, and what to do; most_bits: where these were the limit."""
    if most_bits is not None:
        return f"{most_bits} bits are the most allowed: allow more (--most-bits)"
    return CLUSTER if isinstance(undecided, Irrational) else TIE


def _named(event: Event, stage: Stage) -> str:
    """An event in words."""
    if event.rank != CONTACT:
        what = "a cell" if event.rank == CROSSING else "the border"
        return f"the passage of disk {event.a} over {what}"
    if event.b >= 0:
        return f"the contact of disks {event.a} and {event.b}"
    wall = stage.wall_names[stage.surfaces[-1 - event.b].wall]
    return f"the contact of disk {event.a} with {wall}"
