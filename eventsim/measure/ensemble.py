"""What kind of gas a scene is: its species, degrees of freedom and densities, and which theory speaks about it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from eventsim.scene.disks import species_among
from eventsim.scene.domain import Box, Channel, Periodic
from eventsim.scene.scene import Scene

MOST_SPECIES = 8
"""More kinds of disks than this are measured together only."""

LAST_DIGITS = 2.0**-40
"""A share of the energy that is mostly rounding: sums of squares over a long run are good to some 2**-45."""


class Species(NamedTuple):
    """Disks of one radius and one mass."""

    radius: float
    mass: float
    number: int


@dataclass(frozen=True)
class Ensemble:
    """The disks of a scene that carry energy (finite positive mass), as statistical mechanics sees them.

    scene: what was simulated.  counted: (N,) which disks carry energy.  species: the kinds of these, or one entry with NaN
    for radius and mass where there are too many kinds.  species_of: (N,) index into `species`, -1 for the others.
    """

    scene: Scene
    counted: NDArray[np.bool_]
    species: tuple[Species, ...]
    species_of: NDArray[np.int64]

    @property
    def n(self) -> int:
        """Number of disks that carry energy."""
        return int(self.counted.sum())

    @property
    def alone(self) -> bool:
        """Whether there is nothing but these disks and the domain: no posts, tracers or inner walls."""
        return bool(self.counted.all()) and not self.scene.walls

    @property
    def elastic(self) -> bool:
        """Whether contacts keep the energy."""
        return self.scene.restitution is None

    @property
    def unsteady(self) -> str | None:
        """Why no equilibrium can be reached, a clause; None where it can: elastic, not driven, and held together."""
        moved = np.isinf(self.scene.disks.mass) & (self.scene.disks.velocity != 0.0).any(axis=1)
        if not self.elastic or moved.any():
            return "contacts or moving obstacles change the energy"
        if self.area is None and not self.scene.walls:
            return "on the open plane disks fly apart"
        return None

    @property
    def steady(self) -> bool:
        """Whether an equilibrium can be reached at all."""
        return self.unsteady is None

    @property
    def simple(self) -> bool:
        """Whether theory for a homogeneous gas applies: alone, elastic, without gravity."""
        return self.alone and self.steady and self.scene.gravity is None and self.area is not None

    @property
    def torus(self) -> bool:
        """Whether the domain is periodic in both directions."""
        return isinstance(self.scene.domain, Periodic)

    @property
    def box(self) -> bool:
        """Whether the domain is a rectangle of hard walls."""
        return isinstance(self.scene.domain, Box)

    @property
    def equal(self) -> bool:
        """Whether all disks are of one kind."""
        return len(self.species) == 1 and math.isfinite(self.species[0].mass)

    @property
    def area(self) -> float | None:
        """Of the domain, length^2; None for the open plane."""
        size = self.scene.domain.size
        return None if size is None else size[0] * size[1]

    @cached_property
    def packing_fraction(self) -> float | None:
        """Share of the area that the disks cover; None for the open plane."""
        if self.area is None:
            return None
        return float(math.pi * (self.scene.disks.radius[self.counted] ** 2).sum() / self.area)

    @cached_property
    def diameter(self) -> float:
        """Mean diameter of the disks, length."""
        return 2.0 * float(self.scene.disks.radius[self.counted].mean()) if self.n else 0.0

    @property
    def kept_momenta(self) -> int:
        """How many components of the total momentum are conserved."""
        if not self.alone or self.scene.gravity is not None:
            return 0
        return 2 if self.area is None or self.torus else 1 if isinstance(self.scene.domain, Channel) else 0

    @property
    def freedoms(self) -> int:
        """Degrees of freedom that share the thermal energy: 2 N less the conserved momenta."""
        return 2 * self.n - self.kept_momenta

    @cached_property
    def total_mass(self) -> float:
        """Of the disks that carry energy."""
        return float(self.scene.disks.mass[self.counted].sum())

    @cached_property
    def drift_energy(self) -> float:
        """Kinetic energy of the common motion that never changes."""
        disks = self.scene.disks
        momentum = (disks.mass[self.counted, None] * disks.velocity[self.counted]).sum(axis=0)
        kept = momentum[: self.kept_momenta]
        # not p^2 / 2 M: the square of a momentum of very light or very heavy disks is no float
        return float((0.5 * kept * (kept / self.total_mass)).sum()) if self.n else 0.0

    @property
    def at_rest(self) -> bool:
        """Whether the common motion is nothing but rounding."""
        return self.drift_energy <= 1e-20 * self.start_energy

    @property
    def drowned(self) -> bool:
        """Whether the common motion has so much of the energy that rounding leaves nothing of the thermal one."""
        return self.drift_energy > (1.0 - LAST_DIGITS) * self.start_energy

    @cached_property
    def start_energy(self) -> float:
        """Kinetic energy at the start."""
        disks = self.scene.disks
        speed2 = (disks.velocity[self.counted] ** 2).sum(axis=1)
        return 0.5 * float((disks.mass[self.counted] * speed2).sum())

    def temperature(self, energy: float) -> float:
        """KT of a kinetic energy: shared evenly by the degrees of freedom."""
        return 2.0 * (energy - self.drift_energy) / self.freedoms if self.freedoms > 0 else math.nan

    def thermal_share(self, mass: float) -> float:
        """Mean thermal energy of a disk over kT: 1, less its share in the momentum that is kept at zero."""
        return 1.0 - 0.5 * self.kept_momenta * mass / self.total_mass


def ensemble_of(scene: Scene) -> Ensemble:
    """The ensemble of a scene."""
    disks = scene.disks
    counted = np.isfinite(disks.mass) & (disks.mass > 0.0)
    found = species_among(disks.select(np.flatnonzero(counted)))
    species_of = np.full(len(disks), -1, dtype=np.int64)
    if len(found.count) <= MOST_SPECIES:
        species = tuple(map(Species, found.radius.tolist(), found.mass.tolist(), found.count.tolist()))
        species_of[counted] = found.of
    else:
        species = (Species(math.nan, math.nan, int(counted.sum())),)
        species_of[counted] = 0
    return Ensemble(scene, counted, species, species_of)
