"""Quantities in words: aligned lines with measured value, theory, difference, source and doubt."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from eventsim.measure.measures import Measure

HEADS = ("quantity", "measured", "theory", "difference", "")


def table_text(quantities: Sequence[Measure]) -> str:
    """Return the quantities as aligned lines; those that have no meaning for one reason share a line.

    The force on a wall is left out where the pressure on it is told.
    """
    pressures = {one.name for one in quantities}
    quantities = [one for one in quantities if one.name.replace("force_", "pressure_", 1) not in pressures - {one.name}]
    shared = _shared_doubts(quantities)
    rows = [HEADS] + [_row(one, shared) for one in quantities if not math.isnan(one.value)]
    widths = [max(len(row[k]) for row in rows) for k in range(4)]
    lines = ["  " + "  ".join(f"{row[k]:<{w}}" for k, w in enumerate(widths)) + f"  {row[4]}" for row in rows]
    lines = lines if len(rows) > 1 else []
    for why, names in _dashes(quantities).items():
        lines.append(f"  {', '.join(names)}: \N{EM DASH} ({why})")
    lines += [f"  [{k}] {why}" for why, k in shared.items()]
    return "\n".join(line.rstrip() for line in lines)


def _dashes(quantities: Sequence[Measure]) -> dict[str, list[str]]:
    """Reason -> the names of quantities that have no meaning because of it."""
    found: dict[str, list[str]] = {}
    for one in quantities:
        if math.isnan(one.value):
            found.setdefault(one.doubt or "", []).append(one.name)
    return found


def _shared_doubts(quantities: Sequence[Measure]) -> dict[str, int]:
    """Doubts that several lines have -> the number that these lines refer to."""
    doubts = [one.doubt for one in quantities if one.doubt and not math.isnan(one.value) and one.doubt != NONE_SEEN]
    several = [why for why in dict.fromkeys(doubts) if doubts.count(why) > 1]
    return {why: k for k, why in enumerate(several, 1)}


NO_ACCURACY = 1e-9
"""Share of a theory below which it is exact but for rounding."""

NONE_SEEN, EXACT = "none in this run", "(exact)"


OF = {"collision_rate": "per disk", "wall_contact_rate": "of all disks"}
"""Whose contacts a rate counts."""


def _row(one: Measure, shared: dict[str, int]) -> tuple[str, str, str, str, str]:
    digits = _digits(one.value, one.error)
    theory = "" if one.theory is None else f"{one.theory:.{digits}g}{_accuracy(one)}"
    words = "  ".join(text for text in (OF.get(one.name), one.source, _remark(one, shared)) if text)
    return one.name, value_with_error(one), theory, _difference(one), words


def _accuracy(one: Measure) -> str:
    """How far the theory may be off, which the difference in sigma takes into account, where that is not nothing."""
    assert one.theory is not None
    seen = math.isfinite(one.accuracy) and one.accuracy > NO_ACCURACY * abs(one.theory)
    return f" \N{PLUS-MINUS SIGN} {one.accuracy:.2g}" if seen else ""


def _remark(one: Measure, shared: dict[str, int]) -> str | None:
    """What a number does not say, or the number of the line that says it."""
    if one.doubt is None:
        return EXACT if one.fixed else None
    return f"[{shared[one.doubt]}]" if one.doubt in shared else f"({one.doubt})"


def value_with_error(one: Measure) -> str:
    """Return a value to the digits that its error leaves: "2.0625 +- 0.0008"; a dash where it has no meaning."""
    if math.isnan(one.value):
        return "\N{EM DASH}"
    if not math.isfinite(one.error):
        return f"{one.value:.7g}" if one.fixed else f"{one.value:.4g}"
    digits = _digits(one.value, one.error)
    return f"{one.value:.{digits}g} \N{PLUS-MINUS SIGN} {one.error:.2g}"


def _digits(value: float, error: float) -> int:
    """Return how many digits of a value there are down to the second digit of its error."""
    if not (math.isfinite(error) and error > 0.0 and value != 0.0):
        return 7
    return min(max(2 + math.floor(math.log10(abs(value))) - math.floor(math.log10(error)), 2), 10)


def _difference(one: Measure) -> str:
    if one.theory is None:
        return ""
    if one.deviation is None:
        return f"{one.value / one.theory - 1.0:+.1%}" if one.theory else ""
    return f"{one.deviation:+.1f} sigma"
