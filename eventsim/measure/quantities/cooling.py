"""Cooling: how the energy falls with the number of contacts, Haff's law in its own variable."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from eventsim.measure import sums, theory
from eventsim.measure.blocking import block_average
from eventsim.measure.entries import Expected, beside
from eventsim.measure.measures import Measure
from eventsim.measure.records import Records

PARTS = 16
"""Stretches of equal numbers of contacts whose slopes are averaged."""

CHANGED = 3.5
"""Standard errors between the two halves of the run that chance hardly explains: 1 in 2000."""

UNIT = "1 / contact of a disk"


def measures(records: Records) -> Iterator[Measure]:
    """Yield -d ln T / d (contacts of a disk), where contacts alone change the energy."""
    ensemble = records.ensemble
    if not ensemble.n or ensemble.elastic or ensemble.kicked or ensemble.pushed or ensemble.scene.gravity is not None:
        return
    count, stride = int(records.sums.counts[sums.POINTS]), int(records.sums.counts[sums.STRIDE])
    energy = np.concatenate([[ensemble.start_energy], records.sums.points[:count, sums.POINT_ENERGY]])
    warm = np.array([ensemble.temperature(float(e)) for e in energy])
    whole = count // PARTS * PARTS
    if whole < PARTS or not (warm[: whole + 1] > 0.0).all():
        return
    step = whole // PARTS
    slopes = -np.diff(np.log(warm[: whole + 1 : step])) / (2.0 * step * stride / ensemble.n)
    bar = block_average(slopes)
    first, second = slopes[: PARTS // 2], slopes[PARTS // 2 :]
    spread = math.sqrt((first.var(ddof=1) + second.var(ddof=1)) / (PARTS // 2))
    note = None
    restitution = ensemble.scene.restitution
    assert restitution is not None
    expected = None
    if abs(first.mean() - second.mean()) > CHANGED * spread:
        note = f"it is {first.mean():.3g} in the first half of the run and {second.mean():.3g} in the second: see the series"
    elif ensemble.torus and ensemble.alone:
        expected = Expected(theory.cooling_exponent(restitution.pair), 0.0, "Haff 1983, homogeneous")
    error = bar.error if bar.error > 0.0 else math.nan
    yield beside(Measure(bar.mean, error, unit=UNIT, doubt=note, name="cooling_exponent", blocks=bar.blocks), expected)
