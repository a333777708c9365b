"""Palettes: what is drawn in which colour, on light paper and on dark; all safe for the colour-blind.

Source: M. Okabe, K. Ito, Color universal design (2008), for kinds;
plasma of S. van der Walt, N. Smith (matplotlib 1.5, 2015) for amounts.
"""

from __future__ import annotations

from dataclasses import dataclass

KINDS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#999999", "#F0E442")
"""Colours that tell kinds apart; there are no more kinds than these in one picture."""

AMOUNTS, AMOUNTS_FROM, AMOUNTS_TO = "plasma", 0.08, 0.93
"""The colour map of speeds, masses and counts, and the part of it that stands out on light and on dark."""


@dataclass(frozen=True, slots=True)
class Palette:
    """The colours of everything that is not a disk.

    paper: outside the domain. inside: within it. ink: text. faint: less important text. wall: hard lines. edge:
    around disks. glow: a disk at its contact. trail: where disks have been. arrow: velocities.
    """

    paper: str
    inside: str
    ink: str
    faint: str
    wall: str
    edge: str
    glow: str
    trail: str
    arrow: str


LIGHT = Palette(
    paper="#ffffff",
    inside="#f6f7f9",
    ink="#1b1f24",
    faint="#5b6570",
    wall="#39424e",
    edge="#1b1f24",
    glow="#00a9d6",
    trail="#55606e",
    arrow="#c0183a",
)
DARK = Palette(
    paper="#0d1117",
    inside="#151b23",
    ink="#e6edf3",
    faint="#97a3b0",
    wall="#aab4c0",
    edge="#0d1117",
    glow="#ffffff",
    trail="#9fb0c3",
    arrow="#ff7b72",
)
