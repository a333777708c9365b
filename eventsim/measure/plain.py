"""Arrays as plain data, for JSON: None where there is no number."""

from __future__ import annotations

import math

from eventsim.record.events import Floats


def plain(array: Floats) -> list[float | None]:
    """Return the numbers of an array (K,)."""
    return [number if math.isfinite(number) else None for number in array.tolist()]
