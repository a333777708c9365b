"""How a quantity becomes an entry: an average with its bar and what is expected, or a dash with its reason."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

from eventsim.measure.blocking import ErrorBar
from eventsim.measure.ensemble import Ensemble
from eventsim.measure.measures import Measure
from eventsim.measure.records import Records
from eventsim.record.events import Floats

UNSURE = "the run is too short to be sure of the bar"


class Expected(NamedTuple):
    """What theory says; accuracy: absolute."""

    value: float
    accuracy: float
    source: str


def average(
    records: Records,
    name: str,
    above: Floats,
    below: Floats,
    unit: str,
    theory: Expected | None = None,
    note: str | None = None,
    remembered: bool = False,
) -> Measure:
    """Return sum(above) / sum(below) with its bar; above and below: (bins,) of what is kept.

    note: what the number does not say.  Where it has no bar, the reason goes before.  remembered: as in `Records.ratio`.
    """
    bar, why = records.barred(above, below, remembered)
    if not above.any():
        entry = Measure(0.0, unit=unit, doubt="none in this run", name=name)
    else:
        doubts = [text for text in (why, note) if text]
        entry = Measure(
            bar.mean,
            bar.error,
            unit=unit,
            doubt="; ".join(doubts) or None,
            name=name,
            blocks=bar.blocks,
            block_length=bar.length * records.width,
        )
    records.found[name] = entry.value
    return beside(entry, theory)


def averaged(name: str, bar: ErrorBar, unit: str, note: str | None = None) -> Measure:
    """Return a mean with its bar; NaN where it has none."""
    error = bar.error if bar.error > 0.0 else math.nan
    return Measure(bar.mean, error, unit=unit, doubt=note, name=name, blocks=bar.blocks)


def unsteady_note(ensemble: Ensemble) -> str | None:
    """Return what averages over a run do not say, where it has no steady state."""
    why = ensemble.unsteady
    return None if why is None else f"an average over this run, which has no steady state: {why}"


def beside(entry: Measure, theory: Expected | None) -> Measure:
    """Return an entry with theory beside it."""
    if theory is None:
        return entry
    return replace(entry, theory=theory.value, accuracy=theory.accuracy, source=theory.source)


def dash(name: str, unit: str, why: str) -> Measure:
    """Return the entry of a quantity that has no meaning here."""
    return Measure(math.nan, unit=unit, doubt=why, name=name)
