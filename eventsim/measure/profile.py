"""Profiles along an axis: density, velocity and temperature in slices, species by species, with error bars.

Source of the barometric curve: hydrostatics, dP = -rho m g dy, with the pressure of the fluid at the local density.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from eventsim.errors import EventsimError
from eventsim.measure.blocking import FEWEST_BLOCKS, ErrorBar, ratio_average
from eventsim.measure.ensemble import Ensemble
from eventsim.measure.theory import KOLAFA_ROTTNER_UP_TO, fluid
from eventsim.record.events import Floats
from eventsim.scene.scene import Scene

AXES = ("x", "y")
SLICES = 32
BLOCKS = 128
"""Stretches of time whose scatter gives the error bars; at least half of these once the run is long enough."""

COUNT, VX, VY, V2 = range(4)

STEEP = 5.0
"""Diameters over which the density must fall by less than a factor e, that each slice has a pressure of its own."""

LAYERED = 2.0
"""Diameters beside a wall in which disks form layers."""

FINE = 16
"""Steps of hydrostatics in a slice."""

FEWEST = 16
"""Disks below which the energy that falls and rises changes the temperature on the way."""


@dataclass(frozen=True, slots=True)
class SpeciesProfile:
    """Columns (slices,) of one species.

    Attributes:
        species: its number, as in the names of quantities.
        density: disks per area, with its error.
        velocity: (slices, 2) mean, with its error.
        temperature: m (<v^2> - <v>^2) / 2, with its error; NaN for tracers and where there was nobody.
        theory: of the density; NaN in slices where it does not hold; None where there is none.
    """

    species: int
    density: Floats
    density_error: Floats
    velocity: Floats
    velocity_error: Floats
    temperature: Floats
    temperature_error: Floats
    theory: Floats | None

    def to_dict(self) -> dict[str, Any]:
        """As plain data."""
        return {
            name: value.tolist() if isinstance(value, np.ndarray) else value
            for name in self.__slots__
            for value in (getattr(self, name),)
        }


@dataclass(frozen=True, slots=True)
class Profile:
    """Profiles along an axis; edges (slices + 1,) on the scene's axes; why there are no temperatures, None where there are."""

    axis: str
    edges: Floats
    species: tuple[SpeciesProfile, ...]
    no_temperature: str | None = None

    def without_temperature(self, why: str | None) -> Profile:
        """Return the same profiles without temperatures, for a reason; as they are without one."""
        if why is None:
            return self
        none = np.full(SLICES, np.nan)
        species = (replace(one, temperature=none, temperature_error=none, theory=None) for one in self.species)
        return replace(self, species=tuple(species), no_temperature=why)

    def to_dict(self) -> dict[str, Any]:
        """As plain data."""
        return {"axis": self.axis, "edges": self.edges.tolist(), "species": [one.to_dict() for one in self.species]}


class Profiler:
    """Sums states of all movers by slice and by stretch of time, in constant memory.

    A sample counts for the time up to the next one: they become half as many where a run slows down.
    """

    def __init__(self, scene: Scene, ensemble: Ensemble, axis: str) -> None:
        """Begin profiles along "x" or "y".

        Raises:
            EventsimError: for another axis, and where nothing bounds the disks along it.
        """
        if axis not in AXES:
            raise EventsimError(f"profile = {axis!r}: must be 'x' or 'y'")
        self.axis, self._scene, self._ensemble = axis, scene, ensemble
        along = AXES.index(axis)
        size, circle = scene.domain.size, ensemble.circle
        if size is not None:
            low, length = scene.domain.origin[along], size[along]
        elif circle is not None:
            low, length = circle.center[along] - circle.radius, 2.0 * circle.radius
        else:
            raise EventsimError(f"profile along {axis}: this domain has no size, so slices have no area")
        self.edges = low + length * np.linspace(0.0, 1.0, SLICES + 1)
        self._low, self._length, self._wraps = low, length, scene.domain.periodic[along]
        self._movers = np.flatnonzero(ensemble.movers)
        self._kind = ensemble.species_of[self._movers]
        self._kinds = [int(k) for k in np.unique(self._kind)]
        self._sums = np.zeros((BLOCKS, len(ensemble.species), SLICES, 4))
        self._samples = np.zeros(BLOCKS)
        self._width = 0.0

    def add(self, times: Floats, interval: float, way: Floats, velocity: Floats) -> None:
        """Add samples (S, W, 2) of all movers at times (S,) since what is discarded, each for the time up to the next one."""
        along = AXES.index(self.axis)
        if not self._width:
            self._width = float(times[-1] - times[0]) / (BLOCKS // 2) or 1.0
        while times[-1] >= self._width * BLOCKS:
            for array in (self._sums, self._samples):
                array[: BLOCKS // 2] = array[::2] + array[1::2]
                array[BLOCKS // 2 :] = 0.0
            self._width *= 2.0
        place = self._scene.disks.position[self._movers, along] + way[..., along]
        share = (place - self._low) / self._length
        if self._wraps:
            share -= np.floor(share)
        slices = np.clip((share * SLICES).astype(np.int64), 0, SLICES - 1)
        block = np.minimum((times / self._width).astype(np.int64), BLOCKS - 1)
        np.add.at(self._samples, block, interval)
        flat = (block[:, None] * len(self._ensemble.species) + self._kind) * SLICES + slices
        vx, vy = velocity[..., 0], velocity[..., 1]
        for column, amount in ((COUNT, None), (VX, vx), (VY, vy), (V2, vx * vx + vy * vy)):
            weights = None if amount is None else amount.ravel()
            found = interval * np.bincount(flat.ravel(), weights, self._sums[..., column].size)
            self._sums[..., column] += found.reshape(self._sums.shape[:3])

    def result(self) -> Profile:
        """Return the profiles."""
        used = self._samples > 0.0
        sums, samples = self._sums[used], self._samples[used]
        species = tuple(self._species(kind, sums[:, kind], samples) for kind in self._kinds)
        return Profile(self.axis, self.edges, species)

    def _species(self, kind: int, sums: Floats, samples: Floats) -> SpeciesProfile:
        one = self._ensemble.species[kind]
        heavy = one.mass > 0.0 and math.isfinite(one.mass)
        share = self._ensemble.thermal_share(one.mass) if heavy else 1.0
        density = [ratio_average(sums[:, k, COUNT], samples) for k in range(SLICES)]
        areas = self._areas()
        velocity = np.full((SLICES, 2), np.nan)
        velocity_error = velocity.copy()
        temperature, temperature_error = np.full(SLICES, np.nan), np.full(SLICES, np.nan)
        for k in range(SLICES):
            here = sums[:, k]
            if not here[:, COUNT].any():
                continue
            for axis, column in enumerate((VX, VY)):
                bar = _average(here[:, column], here[:, COUNT])
                velocity[k, axis], velocity_error[k, axis] = bar.mean, bar.error
            if heavy:
                vx, vy = velocity[k]
                square = (
                    here[:, V2] - 2.0 * (vx * here[:, VX] + vy * here[:, VY]) + (vx * vx + vy * vy) * here[:, COUNT]
                )
                bar = _average(0.5 * one.mass / share * square, here[:, COUNT])
                temperature[k], temperature_error[k] = bar.mean, bar.error
        mean = np.array([bar.mean for bar in density]) / areas
        error = np.array([bar.error if bar.error > 0.0 else math.nan for bar in density]) / areas
        heat = float(np.nansum(temperature * mean * areas) / max(float((mean * areas).sum()), 1e-300))
        return SpeciesProfile(
            kind, mean, error, velocity, velocity_error, temperature, temperature_error, self._barometric(kind, heat, mean)
        )

    def _areas(self) -> Floats:
        """Return the area of each slice, what stands in it included."""
        size, circle = self._scene.domain.size, self._ensemble.circle
        if size is not None:
            return np.full(SLICES, self._length / SLICES * size[1 - AXES.index(self.axis)])
        assert circle is not None
        share = np.clip(np.linspace(-1.0, 1.0, SLICES + 1), -1.0, 1.0)
        below = circle.radius**2 * (share * np.sqrt(1.0 - share**2) + np.arcsin(share))
        areas: Floats = np.diff(below)
        return areas

    def _barometric(self, kind: int, kt: float, density: Floats) -> Floats | None:
        """Return the density that hydrostatics expects in each slice; None where it does not hold.

        Beside walls disks stand in layers, which take up a number of their own.  So hydrostatics speaks of slices between,
        and of as many disks as were seen there.
        """
        ensemble, scene = self._ensemble, self._scene
        gravity, size, along = scene.gravity, scene.domain.size, AXES.index(self.axis)
        if gravity is None or size is None or not ensemble.alone or not ensemble.equal or ensemble.no_equilibrium:
            return None
        if self._wraps or gravity[1 - along] != 0.0 or gravity[along] == 0.0 or ensemble.n < FEWEST or not kt > 0.0:
            return None
        one = ensemble.species[kind]
        radius = one.radius
        wide = size[1 - along] - (0.0 if scene.domain.periodic[1 - along] else 2.0 * radius)
        scale = kt / (one.mass * gravity[along])  # height over which a dilute gas falls by e, upwards where positive
        if abs(scale) < STEEP * 2.0 * radius:
            return None
        beside = radius + LAYERED * 2.0 * radius
        free = (self.edges[:-1] >= self._low + beside) & (self.edges[1:] <= self._low + self._length - beside)
        if not free.any():
            return None
        share = size[1 - along] / wide
        height = float(np.diff(self.edges)[free].sum())
        number = float((density * np.diff(self.edges))[free].sum()) * share
        found = barometric_density(number, height, radius, scale, FINE * int(free.sum()))
        if found is None:
            return None
        theory = np.full(SLICES, np.nan)
        theory[free] = found.reshape(-1, FINE).mean(axis=1) / share
        return theory


def _average(above: Floats, count: Floats) -> ErrorBar:
    """A mean over disks by blocks of time, without a bar where a few passages are all that was seen."""
    bar = ratio_average(above, count)
    return bar if np.count_nonzero(count) >= FEWEST_BLOCKS else bar._replace(error=math.nan)


def barometric_density(number: float, height: float, radius: float, scale: float, count: int) -> Floats | None:
    """Return the number density in `count` even steps over a height, with the fluid's pressure at each.

    number: disks per width.  scale: kT / (m g), length, g along the axis.  None where it is denser than the equation of state
    knows.  (rho Z)' = rho / scale, so rho' = rho / (scale (Z + eta Z')): Heun's steps from the light end, whose density is
    found by bisection.
    """
    cover = math.pi * radius * radius
    step = height / count
    pull = step / abs(scale)

    def slope(rho: float) -> float:
        eta = min(cover * rho, KOLAFA_ROTTNER_UP_TO)
        z, first, _ = fluid(eta)
        return rho * pull / (z + eta * first)

    def grown(light: float) -> Floats:
        rho = np.empty(count)
        here = light
        for k in range(count):
            first = slope(here)
            second = slope(here + first)
            there = here + 0.5 * (first + second)
            rho[k] = 0.5 * (here + there)
            here = there
        return rho

    low, high = 0.0, number / height
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if float(grown(middle).sum()) * step < number else (low, middle)
    rho = grown(0.5 * (low + high))
    if cover * float(rho.max()) > KOLAFA_ROTTNER_UP_TO:
        return None
    return rho if scale > 0.0 else rho[::-1]
