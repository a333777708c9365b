"""Rotation: the energy of spins, and how it goes with that of flights."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from eventsim.measure import sums
from eventsim.measure.blocking import block_average, errors_apart, plain_average
from eventsim.measure.ensemble import Ensemble
from eventsim.measure.entries import Expected, average, beside, dash
from eventsim.measure.measures import Measure
from eventsim.measure.quantities.cooling import CHANGED, MOST_FLOWING, ROUGH_ACCURACY, SETTLED, flowing, rough_gas
from eventsim.measure.records import FEWEST_CONTACTS, Records

PARTS = 16
"""Stretches of equal numbers of contacts, of the second half of a run, whose means are averaged."""


def measures(records: Records) -> Iterator[Measure]:
    """Yield what there is to say of spins; nothing where disks have none."""
    ensemble, spun = records.ensemble, records.sums.spins
    if not len(spun) or not ensemble.n:
        return
    disks = ensemble.scene.disks
    inertia = disks.moments() * np.where(ensemble.counted, disks.mass, 0.0) * disks.radius**2
    start = 0.5 * float((inertia * disks.spins() ** 2).sum())
    ends = {"rotational_energy_start": start, "rotational_energy_end": float(records.sums.numbers[sums.SPUN])}
    for name, energy in ends.items():
        yield Measure(energy, unit="energy", name=name, fixed=True)
    if ensemble.law.keeps_energy():
        heat = 2.0 * records.channel(sums.TURNING) / ensemble.n
        yield average(records, "rotational_temperature", heat, records.time, "energy", remembered=True)
    if not ensemble.law.grips[0]:
        return
    if any(wall.velocity for wall in ensemble.law.treatments or ()):
        yield dash("rotation_ratio", "1", "walls that slide make the disks flow: the energy of flights is not heat alone")
    else:
        yield _ratio(records)


def _ratio(records: Records) -> Measure:
    """kT of spins over kT of flights, averaged over the second half of the contacts."""
    ensemble, count = records.ensemble, int(records.sums.counts[sums.POINTS])
    points = records.sums.points[count - count // 2 : count]
    whole = len(points) // PARTS * PARTS
    if whole < PARTS:
        return dash("rotation_ratio", "1", f"it is told from {2 * PARTS} stretches of contacts on")
    flights = np.array([ensemble.temperature(float(e)) for e in points[-whole:, sums.POINT_ENERGY]])
    if not (flights > 0.0).all():
        return dash("rotation_ratio", "1", "rounding leaves no digits of the energy of flights")
    ratios = 2.0 * points[-whole:, sums.POINT_TURNING] / ensemble.n / flights
    parts = ratios.reshape(PARTS, -1).mean(axis=1)
    bar = block_average(parts)
    contacts = 2.0 * (count - whole) * int(records.sums.counts[sums.STRIDE]) / ensemble.n
    expected, decays = _expected(ensemble, contacts)
    note = None
    if decays < SETTLED:
        needed = SETTLED * contacts / decays if decays > 0.0 else math.inf
        note = f"it has not settled: {contacts:.2g} contacts of a disk before it is averaged, where it takes {needed:.2g}"
    elif math.isinf(decays) and contacts < FEWEST_CONTACTS:
        note = f"it may not have settled: {contacts:.2g} contacts of a disk before (at least {FEWEST_CONTACTS:g})"
    elif expected is None and errors_apart(*map(plain_average, np.split(parts, 2))) > CHANGED:
        note = "it still changes in the second half of the run"
    error = bar.error if bar.error > 0.0 and note is None else math.nan
    entry = Measure(bar.mean, error, unit="1", doubt=note, name="rotation_ratio", blocks=bar.blocks)
    return beside(entry, expected)


def _expected(ensemble: Ensemble, contacts: float) -> tuple[Expected | None, float]:
    """(the ratio in a homogeneous gas, how often what it begins with has decayed) after so many contacts of a disk.

    None where theory does not speak of it, or not yet; inf decays where nobody knows.
    """
    told = rough_gas(ensemble)
    if told is None:
        return None, math.inf
    ratio, decay, loss = told
    if decay * contacts < SETTLED or flowing(ensemble, 2.0 * contacts, loss) > MOST_FLOWING:
        return None, decay * contacts
    return Expected(ratio, ROUGH_ACCURACY * ratio, "Luding et al. 1998, homogeneous"), decay * contacts
