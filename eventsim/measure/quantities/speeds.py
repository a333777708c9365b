"""Speeds: the mean over disks and time, against Maxwell at fixed energy."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from eventsim.measure import theory
from eventsim.measure.entries import Expected, average
from eventsim.measure.measures import Measure
from eventsim.measure.records import Records

FIXED_ENERGY = "Maxwell at fixed energy"


def measures(records: Records) -> Iterator[Measure]:
    """Yield the mean speed of all disks that carry energy."""
    ensemble = records.ensemble
    if ensemble.n:
        expected = expected_speed(records, 0) if ensemble.kinds == 1 else None
        entry = average(
            records, "mean_speed", records.path, ensemble.n * records.time, "length / time", expected,
            note=with_drift(records), remembered=True,
        )  # fmt: skip
        yield as_fixed(entry) if ensemble.n == 1 and ensemble.conserved else entry


def with_drift(records: Records) -> str | None:
    """What to say of speeds and ways where all drift together."""
    if records.ensemble.at_rest or records.ensemble.no_equilibrium is not None:
        return None
    x, y = records.ensemble.drift.tolist()
    return f"the common drift ({x:.4g}, {y:.4g}) included"


def as_fixed(entry: Measure) -> Measure:
    """Return the entry of a number that never changes."""
    return replace(entry, error=math.nan, doubt=None, fixed=True)


def expected_speed(records: Records, kind: int) -> Expected | None:
    """Maxwell's mean speed of a species, the same at every density; None where it does not hold."""
    ensemble, species = records.ensemble, records.ensemble.species[kind]
    if not (records.mixed and ensemble.simple and ensemble.at_rest) or ensemble.turns or not species.mass > 0.0:
        return None
    kt = records.found["temperature"]
    speed = theory.mean_speed(kt, species.mass, ensemble.thermal_share(species.mass), 0.5 * ensemble.freedoms - 1.0)
    # in a round container the momentum that is kept depends on places, which is left out here
    return Expected(speed, 0.0 if ensemble.circle is None else speed / ensemble.n, FIXED_ENERGY)
