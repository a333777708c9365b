"""Which engine has which colour and mark: the same in every figure."""

from __future__ import annotations

from typing import Any, NamedTuple

from eventsim.show.palette import KINDS


class Look(NamedTuple):
    """How the points of an engine are drawn."""

    colour: str
    marker: str
    line: str
    hollow: bool = False

    def drawn(self, size: float) -> dict[str, Any]:
        """What matplotlib's `plot` wants to know."""
        face = "white" if self.hollow else self.colour
        return {"color": self.colour, "marker": self.marker, "ls": self.line, "ms": size, "mfc": face, "mec": self.colour}


PURPLE = "#6A3D9A"
"""Not of the palette: dark enough to be told from its pink, and no stepped engine has it."""

LOOKS = {
    "fast": Look("#000000", "*", "-"),
    "reference": Look("#6b6b6b", "P", "-"),
    "plain": Look("#6b6b6b", "X", "-", hollow=True),
    "event-driven": Look("#000000", "*", "-"),
    "certified": Look(PURPLE, "D", ":"),
    "frames": Look(KINDS[5], "s", "-"),
    "frames-forget": Look(KINDS[5], "s", ":", hollow=True),
    "stepped": Look(KINDS[0], "o", "-"),
    "stepped-located": Look(KINDS[3], "o", "--", hollow=True),
    "penalty": Look(KINDS[2], "^", "-"),
    "pymunk": Look(KINDS[1], "v", "-"),
    "pymunk-1": Look(KINDS[1], "v", ":", hollow=True),
    "pymunk-30": Look(KINDS[1], "^", "--", hollow=True),
}

NAMES = {
    "fast": "event-driven: fast, filtered formula",
    "reference": "event-driven: reference, filtered formula",
    "plain": "event-driven: reference, plain formula",
    "certified": "event-driven: certified, 64 to 1024 bits",
    "frames": "frames (memory until apart)",
    "frames-forget": "frames-forget (memory of one frame)",
    "stepped": "stepped (fixed step)",
    "stepped-located": "stepped-located (impact found in the step)",
    "penalty": "penalty (springs)",
    "pymunk": "pymunk (Chipmunk, 10 iterations)",
    "pymunk-1": "pymunk-1 (1 iteration)",
    "pymunk-30": "pymunk-30 (30 iterations)",
}


def look(label: str) -> Look:
    """How an engine is drawn; labels with a parameter behind a comma look like the engine."""
    return LOOKS.get(label.split(",")[0], Look(KINDS[6], ".", "-"))
