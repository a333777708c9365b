"""A gas: many equal disks that are described by a rule."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import TypeAlias

import numpy as np

from eventsim.scene.disks import Floats
from eventsim.scene.domain import Domain
from eventsim.scene.numbers import RADII, is_length, is_place
from eventsim.scene.sizes import Sizes
from eventsim.scene.walls import Wall

Region: TypeAlias = tuple[float, float, float, float]

# Equal disks on a hexagonal lattice, touching: the densest packing there is.
CLOSE_PACKING = math.pi / math.sqrt(12.0)
# Of a packing fraction, which a sum of squares gives to some last bits.
ROUNDING = 1e-9
# More disks than this are a slip of the pen: their numbers alone would take gigabytes.
MOST_DISKS = 50_000_000


@dataclass(frozen=True, slots=True)
class Gas:
    """`count` disks that differ at most in their radius; the fields are the keys of a [[gas]] table.

    Attributes:
        count: number of disks.
        radius: length, or the law of lengths; or else packing_fraction, of the region.
        mass: of each.
        species: its name; None: that of others of its radius and mass.
        spin, moment: of each; see `Disks`.
        temperature: kT, mass length^2 / time^2; or else speed, the same for all; neither: at rest.
        arrangement: "random", "square", "hexagonal", or "compressed": grown in place, together with the other gases of the
            region that are.
        region: x0, y0, x1, y1; None for the domain.
        inside: the name of a closed wall in which disks lie; the region is then the rectangle around it.
        seed: of the random numbers.
        radii: (count,) that have been drawn; no key.
        container: the wall that `inside` names; no key.
    """

    count: int
    radius: float | Sizes | None = None
    packing_fraction: float | None = None
    mass: float = 1.0
    species: str | None = None
    spin: float = 0.0
    moment: float = 0.5
    temperature: float | None = None
    speed: float | None = None
    arrangement: str = "random"
    region: Region | None = None
    inside: str | None = None
    seed: int | None = None
    radii: Floats | None = field(default=None, compare=False)
    container: Wall | None = field(default=None, compare=False)

    @property
    def uses_chance(self) -> bool:
        """Whether the gas cannot be made without random numbers."""
        random = self.arrangement in ("random", "compressed") or isinstance(self.radius, Sizes)
        return random or bool(self.temperature) or bool(self.speed)


def region_of(gas: Gas, domain: Domain) -> Region:
    """The region that a gas that keeps the rules fills: its own one, or the domain."""
    if gas.region is not None:
        return gas.region
    assert domain.size is not None
    (x, y), (width, height) = domain.origin, domain.size
    return x, y, x + width, y + height


def with_radii(gas: Gas, rng: np.random.Generator) -> Gas:
    """The gas with radii drawn, where they follow a law."""
    return replace(gas, radii=gas.radius.drawn(gas.count, rng)) if isinstance(gas.radius, Sizes) else gas


def inside_of(gas: Gas, wall: Wall, domain: Domain) -> Gas:
    """The gas with the wall that it lies in, its region the rectangle around that, as far as the domain goes."""
    boxes = [part.bounds() for part in wall.parts("")]
    low = [min(box[0][axis] for box in boxes) for axis in (0, 1)]
    high = [max(box[1][axis] for box in boxes) for axis in (0, 1)]
    if domain.size is not None:
        low = [max(value, start) for value, start in zip(low, domain.origin, strict=True)]
        high = [min(value, start + size) for value, start, size in zip(high, domain.origin, domain.size, strict=True)]
    return replace(gas, region=(low[0], low[1], high[0], high[1]), container=wall)


def disk_radius(gas: Gas, region: Region) -> float:
    """The radius of each disk, from the packing fraction where that is given; the largest, where radii were drawn."""
    if gas.radii is not None:
        return float(gas.radii.max())
    if gas.packing_fraction is None:
        return gas.radius if isinstance(gas.radius, float) else 0.0
    x0, y0, x1, y1 = region
    return math.sqrt(gas.packing_fraction * (x1 - x0) * (y1 - y0) / (gas.count * math.pi))


def most_disks(region: Region, radius: float) -> int:
    """How many equal disks no arrangement in a rectangle exceeds."""
    x0, y0, x1, y1 = region
    return int(CLOSE_PACKING * (1.0 + ROUNDING) * (x1 - x0) * (y1 - y0) / (math.pi * radius**2))


def too_many(gas: Gas, region: Region, radius: float) -> str | None:
    """Why no arrangement holds a gas, and what one could hold at most; None where it may.

    Disks in a rectangle, laid side by side with its copies, fill the plane: so they cover no more of it than the densest
    packing does, if they are equal, and not all of it in any case.
    """
    if not gas.mass:
        return None  # tracers may lie on each other
    x0, y0, x1, y1 = region
    area = (x1 - x0) * (y1 - y0)
    squares = gas.count * radius**2 if gas.radii is None else float((gas.radii**2).sum())
    share, most = math.pi * squares / area, CLOSE_PACKING if gas.radii is None else 1.0
    if share <= most * (1.0 + ROUNDING):
        return None
    covers = f"cover {share:.4g} of their region, and no arrangement more than {most:.4g}"
    if gas.radii is not None:
        return f"{gas.count} disks of radii up to {radius:.6g} {covers}: give fewer or smaller ones, or more room"
    widest = math.sqrt(most * area / (gas.count * math.pi))
    fewer = f"at most {most_disks(region, radius)} disks of radius {radius:.6g} fit, or "
    return f"{gas.count} disks of radius {radius:.6g} {covers}: {fewer}{gas.count} of radius {math.floor(widest * 1e6) / 1e6:.6g}"


def gas_problems(gas: Gas, domain: Domain | None, where: str, *, seeded: bool) -> Iterator[str]:
    """Every rule that a gas breaks, one sentence each.

    Args:
        gas: the gas; types have been checked.
        domain: the domain, None where it is not known.
        where: how to call the table, as in "gas[0]".
        seeded: whether a seed for all tables has been given.
    """
    if gas.count > MOST_DISKS:
        yield f"{where}.count = {gas.count}: must be at most {MOST_DISKS}"
    if (gas.radius is None) == (gas.packing_fraction is None):
        wrong = "needs radius or packing_fraction" if gas.radius is None else "has both radius and packing_fraction"
        yield f"{where}: {wrong}: give one of them"
    if isinstance(gas.radius, Sizes):
        yield from (f"{where}.radius.{problem}" for problem in gas.radius.problems())
        if gas.arrangement in ("square", "hexagonal"):
            rule = 'disks of many sizes lie on no lattice; use "random" or "compressed"'
            yield f'{where}.arrangement = "{gas.arrangement}": {rule}'
    elif gas.radius is not None and gas.radius != 0.0 and not is_length(gas.radius):
        yield f"{where}.radius = {gas.radius}: {RADII}"
    if gas.inside is not None and (gas.region is not None or gas.packing_fraction is not None):
        other = "region" if gas.region is not None else "packing_fraction"
        yield f"{where}: has both inside and {other}: the wall is the region, and disks have a radius"
    if gas.inside is not None and gas.arrangement == "compressed":
        yield f'{where}.inside: "compressed" fills rectangles alone; use "random"'
    if gas.packing_fraction is not None and not 0.0 < gas.packing_fraction <= CLOSE_PACKING:
        rule = f"must be above 0 and at most {CLOSE_PACKING:.7f}..., the densest packing of equal disks"
        yield f"{where}.packing_fraction = {gas.packing_fraction}: {rule}"
    if not gas.mass >= 0.0:
        yield f"{where}.mass = {gas.mass}: must be at least 0 (inf: cannot be deflected)"
    if gas.temperature is not None and gas.speed is not None:
        yield f"{where}: has both temperature and speed: give one of them"
    for key in ("temperature", "speed"):
        value = getattr(gas, key)
        if value is not None and not 0.0 <= value < math.inf:
            yield f"{where}.{key} = {value}: must be finite and at least 0"
    if gas.temperature and gas.mass in (0.0, math.inf):
        yield f"{where}.temperature: a mass of {gas.mass} has no temperature; use speed"
    if gas.uses_chance and gas.seed is None and not seeded:
        yield f"{where}.seed is missing: where chance is used, a seed makes the scene the same every time"
    yield from _region_problems(gas, domain, where)


def _region_problems(gas: Gas, domain: Domain | None, where: str) -> Iterator[str]:
    """Rules for the region: an area, inside the domain."""
    if gas.region is None:
        if gas.inside is None and domain is not None and domain.size is None:
            yield f"{where}.region is missing: an open domain has no size that a gas could fill"
        return
    x0, y0, x1, y1 = gas.region
    if not (is_place(gas.region) and x0 < x1 and y0 < y1):
        yield f"{where}.region = {list(gas.region)}: must be finite numbers [x0, y0, x1, y1], x0 < x1 and y0 < y1"
    elif domain is not None and domain.size is not None:
        (x, y), (width, height) = domain.origin, domain.size
        if x0 < x or y0 < y or x1 > x + width or y1 > y + height:
            extent = [x, y, x + width, y + height]
            yield f"{where}.region = {list(gas.region)}: must be inside the domain {extent}"


def start_velocity(gas: Gas, rng: np.random.Generator) -> Floats:
    """Velocities (N, 2) as the gas wants them."""
    if gas.temperature:
        return thermal_velocities(gas.count, gas.mass, gas.temperature, rng)
    if gas.speed:
        return equal_speeds(gas.count, gas.speed, rng)
    return np.zeros((gas.count, 2))


def thermal_velocities(count: int, mass: float, temperature: float, rng: np.random.Generator) -> Floats:
    """Maxwell's velocities (N, 2) of N equal disks at kT = `temperature`, without total momentum.

    They are scaled so that the mean of m v^2 / 2 is kT but for rounding. A single disk keeps the velocity that is
    drawn for it: without momentum it would be at rest. Draws 2 N normal numbers, x before y, disk by disk.
    """
    velocity = rng.standard_normal((count, 2))
    if count > 1:
        velocity -= velocity.mean(axis=0)
        velocity *= math.sqrt(2.0 * count / float((velocity**2).sum()))
    velocity *= math.sqrt(temperature) / math.sqrt(mass)
    return velocity


def equal_speeds(count: int, speed: float, rng: np.random.Generator) -> Floats:
    """Velocities (N, 2) of one speed in random directions. Draws N uniform numbers, one angle for each disk."""
    angle = 2.0 * math.pi * rng.random(count)
    return speed * np.stack([np.cos(angle), np.sin(angle)], axis=1)
