"""The fast engine: the reference engine's algorithm, compiled; the same log, bit for bit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from eventsim.engines.options import Options


@dataclass(frozen=True, slots=True)
class FastOptions(Options):
    """What the fast engine can be told; the log is the same.

    lanes: predict eight pairs at a time; None: where the processor can.  sizes: the cells, None for none; left out, the engine
    chooses.
    """

    lanes: bool | None = None
    sizes: Any = "auto"
