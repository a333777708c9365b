"""Placing the disks of a gas among the disks and walls that are already there."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from eventsim.errors import SceneError
from eventsim.scene.cells import Cells
from eventsim.scene.disks import Disks, Floats
from eventsim.scene.domain import Domain
from eventsim.scene.gas import Gas, Region, disk_radius, most_disks, region_of, start_velocity, too_many, with_radii
from eventsim.scene.insertion import insert_at_random, insert_sizes
from eventsim.scene.lattice import Lattice
from eventsim.scene.overlaps import period_of, touching_depth, wall_overlaps
from eventsim.scene.sizes import Sizes
from eventsim.scene.walls import Wall, parts_of

# Random insertion jams at a packing fraction of .547; above this, many disks need not try.
HOPELESS = 0.54
MANY = 1000
# A few disks may find themselves stuck just short of their number, and may try again from the start.
ROUNDS = 10
# A lattice so much finer than the gas needs, and still too few sites are free: the region is walled off.
BLOCKED_SHARE = 64
MOST_SITES = 100_000


def place_gas(
    gas: Gas,
    domain: Domain,
    walls: Sequence[Wall],
    present: Disks,
    rng: np.random.Generator,
    where: str = "gas",
) -> Disks:
    """The disks of a gas that keeps the rules, clear of walls and of the disks `present`.

    Random numbers are drawn in this order: velocities (none at rest), radii that follow a law, then the places of a random
    arrangement.
    So the velocities do not depend on where the disks are. 1e6 disks at a packing fraction of .3 take seconds.

    Raises:
        SceneError: if the disks do not fit; `where` is how to call the gas.
    """
    region = region_of(gas, domain)
    if isinstance(gas.radius, Sizes):
        velocity = start_velocity(gas, rng)
        gas = gas if gas.radii is not None else with_radii(gas, rng)
        place = _Place(gas, domain, walls, present, region, where)
    else:
        place = _Place(gas, domain, walls, present, region, where)
        velocity = start_velocity(gas, rng)
    position = place.at_random(rng) if gas.arrangement == "random" else place.on_lattice()
    radius = place.radius if gas.radii is None else gas.radii
    return Disks(position, velocity, radius, gas.mass, gas.species, gas.spin, gas.moment)


def clear_of(
    domain: Domain, walls: Sequence[Wall], present: Disks, position: Floats, radius: float, gas: Gas, where: str
) -> bool:
    """Whether disks of a gas at `position` (N, 2) are clear of walls and of the disks `present`."""
    region = region_of(gas, domain)
    place = _Place(replace(gas, radius=radius, packing_fraction=None), domain, walls, present, region, where)
    return bool(place.is_free(position, gas.radii).all())


class _Place:
    """The region of one gas, and what is in the way there."""

    def __init__(
        self, gas: Gas, domain: Domain, walls: Sequence[Wall], present: Disks, region: Region, where: str
    ) -> None:
        self.gas = gas
        self.where = where
        self.region = region
        self.radius = disk_radius(gas, region)
        # An immovable disk keeps clear of its like as well; tracers may lie on each other.
        self.mass = 1.0 if math.isinf(gas.mass) else gas.mass
        self.origin = domain.origin
        self.period = period_of(domain)
        width, height = region[2] - region[0], region[3] - region[1]
        self.wraps = (width >= self.period[0], height >= self.period[1])
        if min(width, height) < 2.0 * self.radius:
            raise SceneError(
                f"{where}: a disk of radius {self.radius:.6g} is wider than the region {self._extent()}"
            )
        self.parts = parts_of(walls)
        masses = np.where(np.isinf(present.mass), 1.0, present.mass)
        self.others = Cells(present.position - np.array(self.origin), present.radius, masses, self.period)
        lengths = [abs(length) for length in (*region, width, height, self.radius)]
        lengths += [part.scale(self.origin) for part in self.parts]
        if len(present):
            lengths += [float(np.abs(present.position).max()), float(present.radius.max())]
        self.rounding = float(touching_depth(np.array(max(lengths))))

    def at_random(self, rng: np.random.Generator) -> Floats:
        """Centres (count, 2) by random insertion."""
        count = self.gas.count
        if (why := too_many(self.gas, self.region, self.radius)) is not None:
            raise SceneError(f"{self.where}: {why}")
        if self.mass and self._packing_fraction() > HOPELESS and count > MANY:
            raise SceneError(self._too_dense(None))
        low, high = [], []
        for axis in (0, 1):
            margin = 0.0 if self.wraps[axis] else self.radius
            low.append(self.region[axis] + margin - self.origin[axis])
            high.append(self.region[axis + 2] - margin - self.origin[axis])
        corner = np.array(self.origin)
        for _ in range(ROUNDS):
            if self.gas.radii is not None:
                order = np.argsort(-self.gas.radii, kind="stable")
                lower, upper = np.array(self.region[:2]) - corner, np.array(self.region[2:]) - corner
                centres = insert_sizes(
                    self.gas.radii[order], self.mass, lower, upper, self.wraps, self.period, self._relative_free, rng
                )
                if len(centres) == count:
                    back = np.empty((count, 2))
                    back[order] = centres + corner
                    return back
                raise SceneError(self._too_dense(len(centres)))
            placed = insert_at_random(
                count,
                self.radius,
                self.mass,
                (low[0], low[1]),
                (high[0], high[1]),
                self.period,
                lambda drops: self.is_free(drops + corner),
                rng,
            )
            missing = count - len(placed)
            if not missing:
                centers: Floats = placed + corner
                return centers
            if count > MANY or missing > 1 + count // 30:
                break
        raise SceneError(self._too_dense(len(placed)))

    def on_lattice(self) -> Floats:
        """Centres (count, 2) on a lattice; sites that are left over are spread evenly."""
        count = self.gas.count
        lattice = Lattice(self.gas.arrangement == "hexagonal", self.region, self.radius, self.wraps)
        wanted = count
        while (shape := lattice.shape(wanted)) and wanted <= MOST_SITES + BLOCKED_SHARE * count:
            sites = lattice.sites(shape)
            sites = sites[self.is_free(sites)]
            if len(sites) >= count:
                return sites[np.arange(count) * len(sites) // count]
            # As many more as the share of blocked sites lets expect, but at most twice as many at a time.
            tried = max(wanted, shape.columns * shape.rows)
            wanted = min(tried * count // max(1, len(sites)), 2 * tried) + 1
        most = lattice.capacity(count)
        found = f"the region {self._extent()} has room for {most}"
        if most >= count:
            found = "too many sites are blocked by walls or other disks"
        denser = "" if lattice.hexagonal else "; hexagonal is denser"
        if self.mass and self.radius and count > (bound := most_disks(self.region, self.radius)):
            denser = f"; no arrangement holds more than {bound}"
        raise SceneError(
            f"{self.where}: {count} disks of radius {self.radius:.6g} (packing fraction"
            f" {self._packing_fraction():.4g}) do not fit on a {self.gas.arrangement} lattice: {found}{denser}"
        )

    def _relative_free(self, drops: Floats, radii: Floats) -> NDArray[np.bool_]:
        return self.is_free(drops + np.array(self.origin), radii)

    def is_free(self, position: Floats, radii: Floats | None = None) -> NDArray[np.bool_]:
        """Which of these centres (M, 2) keep the disks clear of walls and others; touching is allowed.

        radii: (M,); None: all alike.
        """
        relative = position - np.array(self.origin)
        # Rounding may lift a centre onto the end of a period, which is no place of its own.
        free: NDArray[np.bool_] = (relative < np.array(self.period)).all(axis=1)
        for found in self.others.overlaps(relative, self.radius if radii is None else radii, self.mass):
            free[found.first[found.depth > self.rounding]] = False
        radius = np.full(len(position), self.radius) if radii is None else radii
        if self.gas.container is not None:
            inside = self.gas.container.contains(position)
            free &= True if inside is None else inside
        for _, near, depth in wall_overlaps(self.parts, position, radius, self.origin, self.period):
            free[near[depth > self.rounding]] = False
        return free

    def _packing_fraction(self) -> float:
        x0, y0, x1, y1 = self.region
        squares = self.gas.count * self.radius**2 if self.gas.radii is None else float((self.gas.radii**2).sum())
        return math.pi * squares / ((x1 - x0) * (y1 - y0))

    def _extent(self) -> str:
        x0, y0, x1, y1 = self.region
        return f"[{x0:.6g}, {x1:.6g}] x [{y0:.6g}, {y1:.6g}]"

    def _too_dense(self, placed: int | None) -> str:
        found = "" if placed is None else f" ({placed} found a place)"
        of = "" if self.gas.radii is None else "up to "
        return (
            f'{self.where}.arrangement = "random": {self.gas.count} disks of radius {of}{self.radius:.6g} do not fit at'
            f" random into {self._extent()}, packing fraction {self._packing_fraction():.4g}{found}; random insertion"
            ' works up to about 0.5 in all: use "compressed", "square" or "hexagonal"'
        )
