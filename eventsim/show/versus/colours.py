"""Which engine has which colour and mark: the same in every figure."""

from __future__ import annotations

from typing import NamedTuple

from eventsim.show.palette import KINDS


class Look(NamedTuple):
    """How the points of an engine are drawn."""

    colour: str
    marker: str
    line: str


LOOKS = {
    "fast": Look("#000000", "*", "-"),
    "reference": Look("#6b6b6b", "P", "-"),
    "event-driven": Look("#000000", "*", "-"),
    "certified": Look("#0b6623", "D", ":"),
    "frames": Look(KINDS[5], "s", "-"),
    "frames-forget": Look(KINDS[5], "s", ":"),
    "stepped": Look(KINDS[0], "o", "-"),
    "stepped-located": Look(KINDS[4], "o", "--"),
    "penalty": Look(KINDS[2], "^", "-"),
    "pymunk": Look(KINDS[3], "v", "-"),
}

NAMES = {
    "fast": "event-driven, fast engine (compiled)",
    "reference": "event-driven, reference engine (Python)",
    "certified": "event-driven, balls of 64 to 1024 bits",
    "frames": "frames (memory until apart)",
    "frames-forget": "frames (memory emptied each frame)",
    "stepped": "stepped",
    "stepped-located": "stepped, impact located in the step",
    "penalty": "penalty (springs)",
    "pymunk": "pymunk (Chipmunk)",
}


def look(label: str) -> Look:
    """How an engine is drawn; labels with a parameter behind a comma look like the engine."""
    return LOOKS.get(label.split(",")[0], Look(KINDS[6], ".", "-"))
