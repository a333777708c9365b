"""What kind of gas a scene is: who is in it, whom they meet, what is conserved, and which theory speaks about it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from eventsim.formulas.laws import Law
from eventsim.measure.billiard_table import Table, sides_of_table, table_of
from eventsim.measure.sides import Side
from eventsim.record.events import Floats
from eventsim.scene.contact_law import law_of_scene
from eventsim.scene.disks import species_among
from eventsim.scene.domain import Box, Channel, Open, Periodic
from eventsim.scene.scene import Scene
from eventsim.scene.walls import Circle

MOST_SPECIES = 8
"""More kinds of disks than this are measured together only."""

LAST_DIGITS = 2.0**-40
"""A share of the energy that is mostly rounding: sums of squares over a long run are good to some 2**-45."""

KEPT_DIGITS = 2.0**-94
"""Of the energy at the start: momenta are kept to some 2**-52 of what they were then, so a gas that has cooled below this
share, by many times the square, may owe its energy to rounding."""

CHANCE = 4.0
"""Times kT that one freedom has by chance in one case of 200."""

LOOKED_FROM = 32
"""Disks from whose places the table is explored, evenly picked where there are more."""


class Species(NamedTuple):
    """Disks of one radius, one mass and one name; NaN where several kinds are measured together."""

    radius: float
    mass: float
    number: int
    name: str = ""


@dataclass(frozen=True)
class Ensemble:
    """The disks of a scene as statistical mechanics sees them.

    scene: what was simulated.  kicked: whether velocities are set from outside.  counted: (N,) which disks carry energy: those
    of finite positive mass.  species: the kinds of these; then tracers, if there are any; then immovable disks, if there are
    any.  species_of: (N,) index into `species`.
    """

    scene: Scene
    kicked: bool
    counted: NDArray[np.bool_]
    species: tuple[Species, ...]
    species_of: NDArray[np.int64]

    @cached_property
    def n(self) -> int:
        """Number of disks that carry energy."""
        return int(self.counted.sum())

    @cached_property
    def kinds(self) -> int:
        """How many species carry energy; they come first."""
        return len(self.species) - (self.tracers is not None) - (self.posts is not None)

    @cached_property
    def tracers(self) -> int | None:
        """The species of tracers."""
        return next((k for k, one in enumerate(self.species) if one.mass == 0.0), None)

    @cached_property
    def posts(self) -> int | None:
        """The species of immovable disks."""
        return next((k for k, one in enumerate(self.species) if one.mass == math.inf), None)

    @property
    def partners(self) -> list[int]:
        """Species that deflect whom they meet: those that carry energy, and immovable disks."""
        return [k for k in range(len(self.species)) if k != self.tracers]

    @cached_property
    def circle(self) -> Circle | None:
        """The round container, where there is nothing else that holds disks."""
        walls = self.scene.walls
        lone = len(walls) == 1 and isinstance(walls[0], Circle) and isinstance(self.scene.domain, Open)
        return walls[0] if lone and isinstance(walls[0], Circle) else None

    @property
    def alone(self) -> bool:
        """Whether there is nothing to meet but these disks and the domain, or one round container."""
        return self.posts is None and (not self.scene.walls or self.circle is not None)

    @property
    def law(self) -> Law:
        """The law of its contacts."""
        return law_of_scene(self.scene)

    @property
    def elastic(self) -> bool:
        """Whether contacts keep the energy of flights: those that there can be."""
        return self.law.keeps_energy(len(self.scene.disks) > 1, self._walled) and not any(self.law.grips)

    @property
    def walls_take(self) -> bool:
        """Whether walls take energy."""
        return not self.law.keeps_energy(False, self._walled)

    @property
    def _walled(self) -> bool:
        """Whether there are walls, or sides of the domain."""
        domain = self.scene.domain
        return bool(self.scene.walls) or not (isinstance(domain, Open) or all(domain.periodic))

    @property
    def pushed(self) -> bool:
        """Whether moving obstacles change the energy."""
        disks = self.scene.disks
        return bool((np.isinf(disks.mass) & (disks.velocity != 0.0).any(axis=1)).any())

    @property
    def conserved(self) -> bool:
        """Whether the kinetic energy of the motion never changes."""
        return self.elastic and not self.kicked and not self.pushed and self.scene.gravity is None

    @cached_property
    def no_equilibrium(self) -> str | None:
        """Why no equilibrium can be reached, a clause; None where it can: elastic, not driven, and held together."""
        if self.kicked:
            return "kicks change the energy"
        if self.law.drives:
            return "walls heat, shake or slide"
        if not self.elastic:
            return "contacts turn disks, and spins take energy and give it" if any(self.law.grips) else "contacts take energy"
        if self.pushed:
            return "moving obstacles change the energy"
        if not self.held:
            return "on the open plane disks fly apart"
        return "along the period disks fall for ever" if self.falls else None

    @cached_property
    def called(self) -> tuple[str, ...]:
        """What the species that carry energy are called: by their names where each has one of its own, else by number."""
        names = tuple(one.name for one in self.species[: self.kinds])
        alone = all(names) and len(set(names)) == len(names)
        return names if alone else tuple(map(str, range(self.kinds)))

    @cached_property
    def driven(self) -> bool:
        """Whether walls give and take energy for ever, so that the gas comes to a steady state that is no equilibrium."""
        sinks = self.law.heats or self.law.loses_energy()
        return self.law.drives and sinks and not self.kicked and not self.pushed and self.held and not self.falls

    @property
    def unsteady(self) -> str | None:
        """Why no steady state can be reached, a clause; None where one can."""
        return None if self.driven else self.no_equilibrium

    @property
    def falls(self) -> bool:
        """Whether nothing ends the fall of disks."""
        gravity = self.scene.gravity
        if gravity is None:
            return False
        along = any(g != 0.0 and p for g, p in zip(gravity, self.scene.domain.periodic, strict=True))
        return along or not self.held

    @cached_property
    def no_temperature(self) -> str | None:
        """Why no run of the scene has a temperature, a clause; None where one may."""
        return (self.no_equilibrium if self.n else None) or self.no_sharing

    @cached_property
    def no_sharing(self) -> str | None:
        """Why in no run of the scene disks share out their energy, a clause; None where they may."""
        if not self.n:
            return "tracers carry no energy"
        if self.n == 1:
            return "one disk shares its energy with nobody"
        if self.drowned:
            return "the energy of the common motion leaves no digits of the thermal energy"
        if not self.scene.disks.radius[self.counted].any():
            return "points never meet: each keeps its energy"
        return None

    @cached_property
    def no_pressure(self) -> str | None:
        """Why no run of the scene has a pressure of its gas, a clause; None where one may."""
        return self.no_temperature or self.no_common_pressure

    @cached_property
    def no_common_pressure(self) -> str | None:
        """Why a gas that has a temperature has no pressure that is its own, a clause; None where it has one."""
        if self.scene.gravity is not None:
            return "under gravity it falls with the height"
        if not self.alone:
            return "walls and posts inside make it a matter of place"
        if self.turns:
            return "the gas turns as a whole, and it grows outwards"
        return None if self.area is not None else "nothing bounds the gas"

    @property
    def steady(self) -> bool:
        """Whether a steady state can be reached at all."""
        return self.unsteady is None

    @cached_property
    def held(self) -> bool:
        """Whether disks cannot get away: the domain has a size, or walls enclose all who move."""
        if not isinstance(self.scene.domain, Open) or self.circle is not None:
            return True
        return bool(self.scene.walls) and self._table(self._smallest) is not None

    @property
    def simple(self) -> bool:
        """Whether theory for a homogeneous gas applies: alone, elastic, without gravity, held."""
        return self.alone and self.no_equilibrium is None and self.scene.gravity is None

    @property
    def billiard(self) -> bool:
        """Whether those who move never meet: tracers alone, or one disk, flying straight among what stands still."""
        movers = self.n if self.n else 0 if self.tracers is None else self.species[self.tracers].number
        alone = (self.n == 0 or movers == 1) and movers > 0
        return alone and self.no_equilibrium is None and self.scene.gravity is None

    @cached_property
    def integrable(self) -> bool:
        """Whether a billiard's flights keep what they begin with: no post and no arc scatters them."""
        return self.posts is None and not any(wall.scatters for wall in self.scene.walls)

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
        """Whether all disks that carry energy are of one kind."""
        return self.kinds == 1 and math.isfinite(self.species[0].mass)

    @property
    def movers(self) -> NDArray[np.bool_]:
        """(N,) those that carry energy; tracers where there are none."""
        return self.counted if self.n else self.scene.disks.mass == 0.0

    @cached_property
    def table(self) -> Table | None:
        """What the centre of a mover sees; None for movers of several radii, on the open plane, and behind too many walls."""
        radii = np.unique(self.scene.disks.radius[self.movers])
        return self._table(float(radii[0])) if len(radii) == 1 else None

    @property
    def sides(self) -> list[Side]:
        """The sides of that table, see `sides_of_table`; none where there is no table, or it is an ellipse."""
        return [] if self.table is None else sides_of_table(self.scene, self._smallest, self._places) or []

    @cached_property
    def area(self) -> float | None:
        """Area that disks can cover, length^2: posts and what walls shut off left out; None where nothing bounds it."""
        size = self.scene.domain.size
        if size is not None and not self.scene.walls and self.posts is None:
            return size[0] * size[1]
        if self.circle is not None and self.posts is None:
            return math.pi * self.circle.radius**2
        table = self._table(0.0) if self.held else None
        return None if table is None else table.area

    @cached_property
    def width(self) -> float:
        """How far apart walls are, length: twice the area over the perimeter, which is an inscribed radius, or the shorter side.

        inf in periodic domains, where displacements have no end.
        """
        if self.torus:
            return math.inf
        size = self.scene.domain.size
        shorter = math.inf if size is None else min(size)
        if not self.scene.walls and self.posts is None:
            return shorter
        table = self._table(0.0) if self.held else None
        return shorter if table is None else min(shorter, 2.0 * table.area / table.perimeter)

    @property
    def _smallest(self) -> float:
        return float(self.scene.disks.radius[self.movers].min())

    @property
    def _places(self) -> Floats:
        """(K, 2) of movers, from where the table is explored."""
        places = self.scene.disks.position[self.movers]
        if not len(places):
            return places
        return places[np.unique(np.linspace(0, len(places) - 1, LOOKED_FROM).astype(np.int64))]

    def _table(self, radius: float) -> Table | None:
        return table_of(self.scene, radius, self._places)

    @cached_property
    def packing_fraction(self) -> float | None:
        """Share of the area that the disks cover; None where nothing bounds it."""
        if self.area is None or not self.n:
            return None
        return float(math.pi * (self.scene.disks.radius[self.counted] ** 2).sum() / self.area)

    @cached_property
    def diameter(self) -> float:
        """Mean diameter of the disks, length."""
        return 2.0 * float(self.scene.disks.radius[self.counted].mean()) if self.n else 0.0

    @property
    def kept_momenta(self) -> int:
        """How many components of the total momentum are conserved; of one it is that along x."""
        gravity, domain = self.scene.gravity, self.scene.domain
        if not self.alone or self.circle is not None or isinstance(domain, Box):
            return 0
        if gravity is not None:
            return 1 if gravity[0] == 0.0 else 0
        return 1 if isinstance(domain, Channel) else 2

    @property
    def middle(self) -> tuple[float, float] | None:
        """Of a lone round container, where the angular momentum about it is conserved."""
        free = self.posts is None and self.scene.gravity is None and not any(self.law.grips)
        return self.circle.center if self.circle is not None and free else None

    @cached_property
    def angular_momentum(self) -> float | None:
        """About the middle of a lone round container, where it is conserved: mass length^2 / time."""
        if self.middle is None:
            return None
        disks = self.scene.disks
        arm, velocity = (disks.position - np.array(self.middle))[self.counted], disks.velocity[self.counted]
        return float((disks.mass[self.counted] * (arm[:, 0] * velocity[:, 1] - arm[:, 1] * velocity[:, 0])).sum())

    @property
    def freedoms(self) -> int:
        """Degrees of freedom that share the thermal energy: 2 N less what is conserved of the momenta."""
        return 2 * self.n - self.kept_momenta - (self.angular_momentum is not None)

    @cached_property
    def total_mass(self) -> float:
        """Of the disks that carry energy."""
        return float(self.scene.disks.mass[self.counted].sum())

    @cached_property
    def _kept_momentum(self) -> Floats:
        """(2,) of the total momentum, what is conserved; 0 in other directions."""
        disks, momentum = self.scene.disks, np.zeros(2)
        kept = self.kept_momenta if self.n else 0
        momentum[:kept] = (disks.mass[self.counted, None] * disks.velocity[self.counted]).sum(axis=0)[:kept]
        return momentum

    @cached_property
    def drift(self) -> Floats:
        """(2,) velocity of the common motion that never changes."""
        return self._kept_momentum / (self.total_mass or 1.0)

    @cached_property
    def drift_energy(self) -> float:
        """Kinetic energy of the common motion that never changes."""
        # not p^2 / 2 M: the square of a momentum of very light or very heavy disks is no float
        return float((0.5 * self._kept_momentum * self.drift).sum())

    @property
    def at_rest(self) -> bool:
        """Whether the common motion is nothing but rounding."""
        return self.drift_energy <= 1e-20 * self.start_energy

    @property
    def turns(self) -> bool:
        """Whether the gas turns as a whole in its round container, by more than chance has it: one freedom has kT / 2."""
        if self.angular_momentum is None or not self.n:
            return False
        disks = self.scene.disks
        arm2 = ((disks.position - np.array(self.middle))[self.counted] ** 2).sum(axis=1)
        inertia = float((disks.mass[self.counted] * arm2).sum())
        rotation = 0.5 * self.angular_momentum**2
        return rotation > CHANCE * self.start_energy / self.n * inertia

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
        """KT of a kinetic energy: shared evenly by the degrees of freedom; NaN where rounding leaves no digits of it."""
        thermal = energy - self.drift_energy
        known = thermal >= KEPT_DIGITS * self.start_energy and thermal >= LAST_DIGITS * energy
        return 2.0 * thermal / self.freedoms if self.freedoms > 0 and known else math.nan

    def thermal_share(self, mass: float) -> float:
        """Mean thermal energy of a disk over kT: 1, less its share in the momentum that is kept at zero."""
        return 1.0 - 0.5 * self.kept_momenta * mass / self.total_mass


def ensemble_of(scene: Scene, kicked: bool = False) -> Ensemble:
    """The ensemble of a scene; kicked: velocities are set from outside."""
    disks = scene.disks
    counted = np.isfinite(disks.mass) & (disks.mass > 0.0)
    found = species_among(disks.select(np.flatnonzero(counted)))
    species_of = np.full(len(disks), -1, dtype=np.int64)
    if len(found.count) <= MOST_SPECIES:
        species = list(map(Species, found.radius.tolist(), found.mass.tolist(), found.count.tolist(), found.name.tolist()))
        species_of[counted] = found.of
    else:
        species = [Species(math.nan, math.nan, int(counted.sum()))]
        species_of[counted] = 0
    for mass in (0.0, math.inf):
        others = disks.mass == mass
        if others.any():
            radii = np.unique(disks.radius[others])
            species_of[others] = len(species)
            species.append(Species(float(radii[0]) if len(radii) == 1 else math.nan, mass, int(others.sum())))
    return Ensemble(scene, kicked, counted, tuple(species), species_of)
