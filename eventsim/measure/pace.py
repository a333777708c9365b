"""Measuring at a pace: very fast and very slow runs in another unit of time, and their measures told in the scene's own."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from eventsim.measure.correlation import Correlations
from eventsim.measure.measures import Measure, Measures
from eventsim.measure.profile import Profile
from eventsim.measure.series import TimeSeries
from eventsim.measure.speeds import SpeedHistogram
from eventsim.record.events import Rows
from eventsim.scene.pace import as_float

RATES = {
    "1": 0,
    "length": 0,
    "1 / contact of a disk": 0,
    "time": -1,
    "1 / time": 1,
    "length / time": 1,
    "length^2 / time": 1,
    "mass length / time^2": 2,
    "energy": 2,
    "energy / length^2": 2,
}
"""Unit -> the power of 1 / time in it."""


def slowed_rows(rows: Rows, pace: int) -> Rows:
    """Rows with velocities and impulses times 2**-pace, and remainders times 2**pace."""
    slow = rows.copy()
    for name in ("vxa", "vya", "vxb", "vyb", "impulse"):
        slow[name] = np.ldexp(rows[name], -pace)
    slow["remainder"] = np.ldexp(rows["remainder"], pace)
    return slow


def at_full_pace(measures: Measures, pace: int) -> Measures:
    """Measures of a run that was measured at a pace, in the scene's units."""
    quantities = tuple(_quantity(quantity, pace) for quantity in measures.quantities)
    return replace(
        measures,
        duration=math.ldexp(measures.duration, -pace),
        discarded=math.ldexp(measures.discarded, -pace),
        quantities=quantities,
        speeds=tuple(_histogram(histogram, pace) for histogram in measures.speeds),
        correlations=_correlations(measures.correlations, pace),
        series=_series(measures.series, pace),
        profile=None if measures.profile is None else _profile(measures.profile, pace),
        by_name={quantity.name: quantity for quantity in quantities},
    )


def _quantity(quantity: Measure, pace: int) -> Measure:
    """One quantity; where it is no float in the scene's unit, the unit is a power of two of that."""
    power = RATES[quantity.unit] * pace
    numbers = quantity.value, quantity.error, quantity.theory, quantity.accuracy
    told = [None if number is None else as_float(number, power) for number in numbers]
    block_length = math.ldexp(quantity.block_length, -pace)
    if any(new is None and old is not None for new, old in zip(told, numbers, strict=True)):
        return replace(quantity, unit=f"2^{power} {quantity.unit}", block_length=block_length)
    value, error, theory, accuracy = told
    assert value is not None
    assert error is not None
    assert accuracy is not None
    return replace(quantity, value=value, error=error, theory=theory, accuracy=accuracy, block_length=block_length)


def _histogram(histogram: SpeedHistogram, pace: int) -> SpeedHistogram:
    return replace(
        histogram,
        edges=np.ldexp(histogram.edges, pace),
        density=np.ldexp(histogram.density, -pace),
        error=np.ldexp(histogram.error, -pace),
        theory=None if histogram.theory is None else np.ldexp(histogram.theory, -pace),
    )


def _correlations(correlations: Correlations, pace: int) -> Correlations:
    """Products of velocities may be no floats in the scene's unit: inf or 0."""
    with np.errstate(over="ignore", under="ignore"):
        return correlations._replace(
            lag=np.ldexp(correlations.lag, -pace),
            vacf=np.ldexp(correlations.vacf, 2 * pace),
            vacf_error=np.ldexp(correlations.vacf_error, 2 * pace),
        )


def _series(series: TimeSeries, pace: int) -> TimeSeries:
    """Energies may be no floats in the scene's unit: inf or 0."""
    with np.errstate(over="ignore", under="ignore"):
        return TimeSeries(
            time=np.ldexp(series.time, -pace),
            contacts=series.contacts,
            energy=np.ldexp(series.energy, 2 * pace),
            temperature=np.ldexp(series.temperature, 2 * pace),
            pressure=np.ldexp(series.pressure, 2 * pace),
            collision_rate=np.ldexp(series.collision_rate, pace),
        )


def _profile(profile: Profile, pace: int) -> Profile:
    with np.errstate(over="ignore", under="ignore"):
        return replace(
            profile,
            species=tuple(
                replace(
                    one,
                    velocity=np.ldexp(one.velocity, pace),
                    velocity_error=np.ldexp(one.velocity_error, pace),
                    temperature=np.ldexp(one.temperature, 2 * pace),
                    temperature_error=np.ldexp(one.temperature_error, 2 * pace),
                )
                for one in profile.species
            ),
        )
