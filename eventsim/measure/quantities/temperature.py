"""Temperature: the energy that each degree of freedom has, less what conserved momenta keep for themselves."""

from __future__ import annotations

import math
from collections.abc import Iterator

from eventsim.measure import sums
from eventsim.measure.entries import average, dash
from eventsim.measure.measures import Measure
from eventsim.measure.records import Records


def measures(records: Records) -> Iterator[Measure]:
    """Yield kT = 2 (E - E of the conserved motion) / degrees of freedom; where it changes for good, the energies instead."""
    ensemble = records.ensemble
    if ensemble.n and not ensemble.conserved and ensemble.scene.gravity is None:
        ends = {"energy_start": ensemble.start_energy, "energy_end": float(records.sums.numbers[sums.HEAT])}
        for name, energy in ends.items():
            yield Measure(energy, unit="energy", name=name, fixed=True)
    why = records.no_temperature
    if ensemble.n and why is not None and (ensemble.driven or ensemble.scene.gravity is not None):
        yield average(records, "kinetic_energy", records.channel(sums.ENERGY), records.time, "energy", remembered=True)
    if why is not None:
        yield dash("temperature", "energy", why)
        return
    if ensemble.angular_momentum is not None:
        turning = records.channel(sums.ROTATION)
        samples = records.channel(sums.SAMPLES)
        heat = 2.0 * (ensemble.start_energy * samples - turning) / ensemble.freedoms
        yield average(records, "temperature", heat, samples, "energy", remembered=True)
        return
    if ensemble.conserved:
        value = ensemble.temperature(ensemble.start_energy)
        records.found["temperature"] = value
        yield Measure(value, math.nan, unit="energy", name="temperature", fixed=True)
        return
    heat = 2.0 * records.channel(sums.ENERGY) / ensemble.freedoms
    yield average(records, "temperature", heat, records.time, "energy", remembered=True)
