"""How speeds are distributed, against Maxwell at fixed energy."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from eventsim.measure.ensemble import Ensemble
from eventsim.measure.plain import plain
from eventsim.measure.records import Records
from eventsim.measure.sums import SCALE, SPEED_BINS, first_speed
from eventsim.measure.theory import survival
from eventsim.record.events import Floats

WELL_KNOWN = 0.2
"""Relative error below which a bin says something about the fit: rare speeds have no reliable error bars."""

FASTEST = 8.0
"""Thermal speeds sqrt(kT / m) up to which speeds have bins at first; no disk of a gas is ever as fast."""

FEWEST_FREEDOMS = 4
"""With fewer the energy fixes the speeds."""


@dataclass(frozen=True, slots=True)
class SpeedHistogram:
    """The share of time that disks of one species spend at speeds between edges (bins + 1,).

    density: per speed, (bins,), with its error; NaN where too little was seen.  theory: the same of Maxwell's distribution (at
    fixed energy), or None.
    """

    species: int
    edges: Floats
    density: Floats
    error: Floats
    theory: Floats | None

    @property
    def misfit(self) -> float | None:
        """Root mean square of (measured - theory) / error; about 1 where theory holds; None without theory."""
        good = (self.error > 0.0) & (self.error < WELL_KNOWN * self.density)
        if self.theory is None or not good.any():
            return None
        return float(np.sqrt((((self.density - self.theory)[good] / self.error[good]) ** 2).mean()))

    def to_dict(self) -> dict[str, Any]:
        """As plain data."""
        return {
            "species": self.species,
            "edges": self.edges.tolist(),
            "density": self.density.tolist(),
            "error": plain(self.error),
            "theory": None if self.theory is None else self.theory.tolist(),
            "misfit": self.misfit,
        }


def speed_histograms(records: Records) -> tuple[SpeedHistogram, ...]:
    """One histogram for each species that moves."""
    ensemble, plan = records.ensemble, records.plan
    result = []
    kt = records.found.get("temperature", math.nan)
    for kind, species in enumerate(ensemble.species):
        if not math.isfinite(species.mass):
            continue
        scale = float(records.sums.disks[ensemble.species_of == kind, SCALE][0])
        edges = np.linspace(0.0, SPEED_BINS / scale, SPEED_BINS + 1)
        first = first_speed(plan) + SPEED_BINS * kind
        flown = species.number * records.time
        bars = [records.ratio(records.channel(first + k), flown, remembered=True) for k in range(SPEED_BINS)]
        width = edges[1]
        theory = None
        holds = ensemble.simple and ensemble.at_rest and not ensemble.turns and ensemble.freedoms >= FEWEST_FREEDOMS
        if kind < ensemble.kinds and holds and records.mixed and kt > 0.0:
            above = [_above(ensemble, speed, kt, species.mass) for speed in edges.tolist()]
            theory = -np.diff(above) / width
        density = np.array([bar.mean for bar in bars]) / width
        error = np.array([bar.error for bar in bars]) / width
        result.append(SpeedHistogram(kind, edges, density, error, theory))
    return tuple(result)


def _above(ensemble: Ensemble, speed: float, kt: float, mass: float) -> float:
    return survival(speed, kt, mass, ensemble.thermal_share(mass), 0.5 * ensemble.freedoms - 1.0)


def maxwell_survival(speed: Floats, kt: float, mass: float) -> Floats:
    """The share of disks that are faster, exp(-m v^2 / 2 kT), by Maxwell's law; the shape of `speed`.

    Source: J. C. Maxwell, Philosophical Magazine 19, 19 (1860).
    """
    share: Floats = np.exp(-mass * speed**2 / (2.0 * kt))
    return share
