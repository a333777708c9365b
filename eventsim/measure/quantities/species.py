"""Species: temperature, speed and rates of each kind of disks that carry energy, where there are several."""

from __future__ import annotations

import math
from collections.abc import Iterator

from eventsim.measure import sums, theory
from eventsim.measure.entries import Expected, average
from eventsim.measure.expected import MIXTURE, mixture_of
from eventsim.measure.measures import Measure
from eventsim.measure.quantities.speeds import expected_speed, with_drift
from eventsim.measure.records import Records
from eventsim.scene.names import plural


def measures(records: Records) -> Iterator[Measure]:
    """Yield temperature_I, mean_speed_I, collision_rate_I and collision_rate_I_J: contacts of a disk of I with disks of J.

    I, J: what species are called.
    """
    ensemble = records.ensemble
    if ensemble.kinds < 2:
        return
    for kind, species in enumerate(ensemble.species[: ensemble.kinds]):
        flown, called = species.number * records.time, ensemble.called[kind]
        share = ensemble.thermal_share(species.mass)
        if share > 0.0 and records.no_temperature is None and ensemble.angular_momentum is None:
            common = 2.0 * ensemble.drift_energy / ensemble.total_mass
            heat = 0.5 * species.mass * (records.species(kind, sums.SPEED2) - common * flown) / share
            even = None
            if records.mixed and ensemble.simple:
                even = Expected(records.found["temperature"], 0.0, "equipartition")
            yield average(records, f"temperature_{called}", heat, flown, "energy", even, remembered=True)
        path = records.species(kind, sums.PATH)
        speed = expected_speed(records, kind)
        drift = with_drift(records)
        yield average(records, f"mean_speed_{called}", path, flown, "length / time", speed, drift, remembered=True)
        expected = _rates(records, kind)
        met = records.contacts(kind) / species.number
        total = sum(expected.values()) if expected else math.nan
        yield average(records, f"collision_rate_{called}", met, records.time, "1 / time", _expected(total))
        for other in range(ensemble.kinds):
            if other == kind and species.number == 1:
                continue
            met = records.met(kind, other) / species.number
            name = f"collision_rate_{called}_{ensemble.called[other]}"
            yield average(records, name, met, records.time, "1 / time", _expected(expected.get(other, math.nan)))


def legend(records: Records) -> Iterator[str]:
    """Yield who each species is, where quantities are told of several."""
    ensemble = records.ensemble
    if ensemble.kinds < 2:
        return
    for called, one in zip(ensemble.called, ensemble.species, strict=False):
        yield f"species {called}: {plural(one.number, 'disk')}, r {one.radius:.6g}, m {one.mass:.6g}"
    first, second = ensemble.called[:2]
    yield f"collision_rate_{first}_{second}: contacts of a disk of species {first} with disks of species {second}"


def _expected(rate: float) -> Expected | None:
    return Expected(rate, theory.MIXTURE_ACCURACY * rate, MIXTURE) if math.isfinite(rate) else None


def _rates(records: Records, kind: int) -> dict[int, float]:
    """What kinetic theory says of the contacts of a species with each: periodic, not too dense, in equilibrium."""
    ensemble, parts = records.ensemble, mixture_of(records.ensemble)
    eta = ensemble.packing_fraction
    if (
        not (records.mixed and ensemble.torus and ensemble.simple)
        or parts is None
        or eta is None
        or eta > theory.MIXTURE_UP_TO
    ):
        return {}
    rates = {}
    for other in range(ensemble.kinds):
        number = ensemble.species[other].number
        rate = theory.mixture_rate(parts, kind, other, records.found["temperature"])
        rates[other] = rate * (number - (kind == other)) / number
    return rates
