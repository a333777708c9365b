"""The certified engine: the reference loop on ball arithmetic, where a comparison is answered or the precision is doubled."""

from __future__ import annotations

from dataclasses import dataclass

from eventsim.engines.options import Options, option

LEAST_BITS = 64
"""Fewer prove next to nothing."""

FIRST_BITS, MOST_BITS = 1024, 2**17
"""The precision of the first attempt; one beyond which no attempt is made."""


@dataclass(frozen=True, slots=True)
class CertifiedOptions(Options):
    """What the certified engine can be told.

    bits: of the first attempt.  most_bits: of the last one.
    """

    bits: int = option(FIRST_BITS, "a number of bits")
    most_bits: int = option(MOST_BITS, "a number of bits")
