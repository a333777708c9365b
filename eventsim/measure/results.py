"""Quantities with error bars, and theory beside each."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from eventsim.measure import tally
from eventsim.measure.blocking import ErrorBar, block_average, ratio_average
from eventsim.measure.cooling import Cooling
from eventsim.measure.correlation import Correlations, diffusion
from eventsim.measure.ensemble import Ensemble
from eventsim.measure.equilibration import doubts, strangers, transient
from eventsim.measure.expected import Expected, expected_of
from eventsim.measure.speeds import SpeedHistogram, speed_histograms
from eventsim.measure.tally import Tally
from eventsim.record.events import Floats


class Records(NamedTuple):
    """What a meter has gathered when the run is over; see `Meter`."""

    ensemble: Ensemble
    tally: Tally
    wall_names: tuple[str, ...]
    duration: float
    discarded: float
    discard_given: bool
    width: float
    bins: Floats
    correlations: Correlations
    cooling: Cooling
    moved: float

    def channel(self, place: int) -> Floats:
        """One channel of the series (bins,)."""
        return self.bins[:, place]

    def species(self, kind: int, place: int) -> Floats:
        """One channel of a species."""
        return self.bins[:, self.tally.first_species + tally.PER_SPECIES * kind + place]


@dataclass(frozen=True, slots=True)
class Quantity:
    """A measured number, its standard error, and what theory says.

    name: unique.  unit: in the scene's units, or a power of two of these ("2^1800 energy") where the value is no float in
    them.  error: NaN where none can be given.  blocks: how many were averaged.
    block_length: time.  theory: None where there is none; accuracy: of the theory, absolute; NaN: a guide, not a prediction.
    source: of the theory.
    """

    name: str
    value: float
    error: float
    unit: str
    blocks: int = 0
    block_length: float = math.nan
    theory: float | None = None
    accuracy: float = 0.0
    source: str | None = None

    @property
    def plain(self) -> bool:
        """Whether the unit is one of the scene's, not a power of two of it."""
        return not self.unit.startswith("2^")

    @property
    def deviation(self) -> float | None:
        """Measured less theory, in standard errors (the theory's own accuracy included); None without either."""
        if self.theory is None or math.isnan(self.accuracy) or not math.isfinite(self.error):
            return None
        spread = math.hypot(self.error, self.accuracy)
        off = self.value - self.theory
        if spread <= 1e-12 * abs(self.theory):  # exact but for rounding
            return 0.0 if abs(off) <= 1e-9 * abs(self.theory) else math.copysign(math.inf, off)
        return off / spread


@dataclass(frozen=True, slots=True)
class Measures:
    """What was measured in a run.

    duration: of the run; discarded: at its beginning, time.  steady: whether the scene can have a steady state at all.
    doubts: reasons why it cannot be, or may not have been, reached.  quantities: in order.  speeds: histograms, one a species.
    correlations: mean squared displacement and velocity autocorrelation.
    """

    disks: int
    packing_fraction: float | None
    duration: float
    discarded: float
    discard_given: bool
    steady: bool
    doubts: tuple[str, ...]
    quantities: tuple[Quantity, ...]
    speeds: tuple[SpeedHistogram, ...]
    correlations: Correlations
    by_name: dict[str, Quantity] = field(repr=False)

    @property
    def equilibrated(self) -> bool:
        """Whether nothing speaks against a steady state."""
        return self.steady and not self.doubts

    def __getitem__(self, name: str) -> Quantity:
        """A quantity by its name; KeyError names those there are."""
        if name not in self.by_name:
            raise KeyError(f"{name}; there are {', '.join(self.by_name)}")
        return self.by_name[name]

    def __contains__(self, name: object) -> bool:
        return name in self.by_name

    def to_dict(self) -> dict[str, Any]:
        """All of it as plain data: what `eventsim measure --json` prints."""
        names = ("name", "value", "error", "unit", "blocks", "block_length", "theory", "accuracy", "deviation", "source")
        return {
            "disks": self.disks,
            "packing_fraction": self.packing_fraction,
            "duration": self.duration,
            "discarded": self.discarded,
            "discard_given": self.discard_given,
            "steady": self.steady,
            "equilibrated": self.equilibrated,
            "doubts": list(self.doubts),
            "quantities": {q.name: {key: getattr(q, key) for key in names[1:]} for q in self.quantities},
            "speeds": [histogram.to_dict() for histogram in self.speeds],
            "correlations": {key: getattr(self.correlations, key).tolist() for key in Correlations._fields},
        }


def results_of(records: Records) -> Measures:
    """The measures that records amount to."""
    ensemble = records.ensemble
    # what nothing was seen of has no mean, and is left out
    series = {name: measured for name, measured in _bars(records) if math.isfinite(measured[0].mean)}
    temperature = series["temperature"][0].mean if "temperature" in series else math.nan
    expected = expected_of(ensemble, temperature, {name: bar.mean for name, (bar, _) in series.items()})
    quantities = [_quantity(name, bar, unit, records, expected) for name, (bar, unit) in series.items()]
    quantities += _fitted(records, expected, series)
    virial = records.channel(tally.VIRIAL)
    late = not records.discard_given and transient(records.discarded, records.duration)
    if ensemble.unsteady is not None:
        found = [ensemble.unsteady]
    elif not records.channel(tally.ENERGY).any():
        found = ["nothing moves"]
    else:
        found = doubts(ensemble, virial, block_average(virial), late, records.moved)
        found += strangers((quantity.name, quantity.deviation, quantity.source) for quantity in quantities)
    return Measures(
        disks=ensemble.n,
        packing_fraction=ensemble.packing_fraction,
        duration=records.duration,
        discarded=records.discarded,
        discard_given=records.discard_given,
        steady=ensemble.steady,
        doubts=tuple(found),
        quantities=tuple(quantities),
        speeds=speed_histograms(records.ensemble, records.tally, records.bins, temperature),
        correlations=records.correlations,
        by_name={quantity.name: quantity for quantity in quantities},
    )


Measured = tuple[str, tuple[ErrorBar, str]]


def _bars(records: Records) -> Iterator[Measured]:
    """(name, (mean and error, unit)) of all that is a ratio of sums."""
    ensemble, n = records.ensemble, records.ensemble.n
    time = np.full(len(records.bins), records.width)
    energy, pairs = records.channel(tally.ENERGY), records.channel(tally.PAIRS)
    virial, walls = records.channel(tally.VIRIAL), records.channel(tally.WALL_CONTACTS)
    freedoms = max(ensemble.freedoms, 1)
    heat = 2.0 * (energy - ensemble.drift_energy * time) / freedoms  # kT x time
    if not ensemble.drowned:
        yield "temperature", (ratio_average(heat, time), "energy")
    if ensemble.area is not None and ensemble.scene.gravity is None and ensemble.alone and not ensemble.drowned:
        yield from _pressures(records, time, heat, virial)
    yield "collision_rate", (ratio_average(2.0 * pairs / n, time), "1 / time")
    if walls.any():
        yield "wall_contact_rate", (ratio_average(walls, time), "1 / time")
    for kind in range(records.tally.walls):
        impulse = records.channel(tally.GENERAL + kind)
        yield f"force_{records.wall_names[kind]}", (ratio_average(impulse, time), "mass length / time^2")
    everyone = range(records.tally.kinds)
    path = sum((records.species(kind, tally.PATH) for kind in everyone), np.zeros_like(time))
    flown = sum((records.species(kind, tally.DISK_TIME) for kind in everyone), np.zeros_like(time))
    if pairs.any():
        yield "mean_free_time", (ratio_average(n * time, 2.0 * pairs), "time")
        contacts = sum((records.species(kind, tally.CONTACTS) for kind in everyone), np.zeros_like(time))
        yield "mean_free_path", (ratio_average(path, contacts), "length")
    yield "mean_speed", (ratio_average(path, flown), "length / time")
    if records.tally.kinds > 1:
        yield from _by_species(records, time)


def _pressures(records: Records, time: Floats, heat: Floats, virial: Floats) -> Iterator[Measured]:
    """Pressure and Z, from contacts of pairs (the virial) and from walls."""
    ensemble, n = records.ensemble, records.ensemble.n
    area, size = ensemble.area, ensemble.scene.domain.size
    assert area is not None
    assert size is not None
    excess = ratio_average(virial / (2.0 * n), heat)
    yield "Z", (excess._replace(mean=1.0 + excess.mean), "1")
    if ensemble.torus:
        yield "pressure", (ratio_average((n * heat + 0.5 * virial) / area, time), "energy / length^2")
    if ensemble.box:
        lever = records.channel(tally.WALL_VIRIAL)
        yield "Z_walls", (ratio_average(lever / (2.0 * n), heat), "1")


def _by_species(records: Records, time: Floats) -> Iterator[Measured]:
    """Temperature, rates and speed of each species."""
    ensemble, t = records.ensemble, records.tally
    for kind, species in enumerate(ensemble.species):
        flown = records.species(kind, tally.DISK_TIME)
        share = ensemble.thermal_share(species.mass)
        square = records.species(kind, tally.SPEED2)
        drift = 2.0 * ensemble.drift_energy / ensemble.total_mass
        if share > 0.0 and not ensemble.drowned:
            heat = 0.5 * species.mass * (square - drift * flown) / share
            yield f"temperature_{kind}", (ratio_average(heat, flown), "energy")
        yield f"mean_speed_{kind}", (ratio_average(records.species(kind, tally.PATH), flown), "length / time")
        contacts = records.species(kind, tally.CONTACTS)
        yield f"collision_rate_{kind}", (ratio_average(contacts / species.number, time), "1 / time")
        for other in range(t.kinds):
            pair = records.channel(t.first_pair + t.kinds * kind + other)
            yield f"collision_rate_{kind}_{other}", (ratio_average(pair / species.number, time), "1 / time")


def _quantity(name: str, bar: ErrorBar, unit: str, records: Records, expected: dict[str, Expected]) -> Quantity:
    theory = expected.get(name)
    return Quantity(
        name,
        bar.mean,
        bar.error,
        unit,
        bar.blocks,
        bar.length * records.width,
        *(() if theory is None else (theory.value, theory.accuracy, theory.source)),
    )


def _fitted(
    records: Records, expected: dict[str, Expected], series: dict[str, tuple[ErrorBar, str]]
) -> Iterator[Quantity]:
    """Quantities that are read off curves: diffusion, cooling."""
    free_time = series.get("mean_free_time")
    if free_time is not None:
        slope = diffusion(records.correlations, free_time[0].mean, _widest(records.ensemble))
        if slope is not None:
            bar = ErrorBar(*slope, 0, 0, independent=True)
            yield _quantity("diffusion", bar, "length^2 / time", records, expected)
    if not records.ensemble.elastic and records.ensemble.scene.gravity is None:
        fall = cooling_exponent(records)
        if fall is not None:
            yield _quantity("cooling_exponent", fall, "1 / contact of a disk", records, expected)


BOUNDED = 0.1
"""Between walls displacements end somewhere: the fit stays below this share of the width, root mean square."""


def _widest(ensemble: Ensemble) -> float:
    """The displacement up to which diffusion is free of walls."""
    size = ensemble.scene.domain.size
    return math.inf if size is None or ensemble.torus else BOUNDED * min(size)


COOLING_PARTS = 16


def cooling_exponent(records: Records) -> ErrorBar | None:
    """-d ln T / d (contacts of a disk), from the slopes of parts of the run; None where there are too few contacts."""
    contacts, energy = records.cooling.points()
    warm = np.array([records.ensemble.temperature(float(e)) for e in energy])
    whole = (len(warm) - 1) // COOLING_PARTS * COOLING_PARTS
    if whole < COOLING_PARTS or not (warm[: whole + 1] > 0.0).all():
        return None
    cut = slice(0, whole + 1, whole // COOLING_PARTS)
    slopes = -np.diff(np.log(warm[cut])) / np.diff(2.0 * contacts[cut] / records.ensemble.n)
    return block_average(slopes)
