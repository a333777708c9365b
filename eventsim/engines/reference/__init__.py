"""The reference engine: plain Python that reads like the textbook; the oracle of the others."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from eventsim.engines.options import Options, option


@dataclass(frozen=True, slots=True)
class AutoOptions(Options):
    """What `auto` can be told: then it stays with the reference engine.

    check: recompute every invariant by brute force after each event (slow; for tests).
    """

    check: bool = option(False, "true or false")


@dataclass(frozen=True, slots=True)
class ReferenceOptions(AutoOptions):
    """What the reference engine can be told.

    grid: the cells, None for all pairs; left out, the engine chooses.
    """

    grid: Any = "auto"
