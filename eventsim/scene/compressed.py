"""From gases that share a region to disks that fill it densely."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from eventsim.compiler import has_compiler
from eventsim.errors import SceneError
from eventsim.growth.schedule import JammedError, grown
from eventsim.scene.cells import Cells, Indices
from eventsim.scene.disks import Disks, Floats, join
from eventsim.scene.domain import Box, Channel, Domain, Periodic
from eventsim.scene.fill import clear_of, place_gas
from eventsim.scene.gas import Gas, Region, disk_radius, region_of, start_velocity, too_many, with_radii
from eventsim.scene.numbers import Point
from eventsim.scene.walls import Wall

LOOSE = 0.35
"""Packing fraction at which growth begins from random places."""

ORDERED = 0.72
"""Above it equal disks crystallise: they begin on the hexagonal lattice, where it has room for them at their full size."""

MANY = 300
"""Disks that plain Python compresses within a minute or so."""


def place_compressed(
    gases: Sequence[Gas],
    domain: Domain,
    walls: Sequence[Wall],
    present: Disks,
    rngs: Sequence[np.random.Generator],
    where: str = "gas",
) -> list[Disks]:
    """The disks of gases that fill one region together, by growth; one entry for each gas.

    Random numbers are drawn gas by gas: velocities, then the places at the start; the first gas's go on through the growth.
    N = 1000 disks of radii 1 : 1.4 at a packing fraction of .84 take some seconds, compiled.

    Raises:
        SceneError: if the disks do not fit or did not find how, or the region is not free; `where` is how to call them.
    """
    region = region_of(gases[0], domain)
    count = sum(gas.count for gas in gases)
    if count > MANY and not has_compiler():
        raise SceneError(
            f'{where}.arrangement = "compressed": {count} disks need the compiler (plain Python does up to {MANY}):'
            " pip install 'eventsim-disks[fast]'"
        )
    size = (region[2] - region[0], region[3] - region[1])
    wraps = tuple(wrap and whole for wrap, whole in zip(domain.periodic, _whole(region, domain), strict=True))
    period = (size[0] if wraps[0] else math.inf, size[1] if wraps[1] else math.inf)
    velocities, drawn = [], []
    for gas, rng in zip(gases, rngs, strict=True):
        velocities.append(start_velocity(gas, rng))
        drawn.append(with_radii(gas, rng))
    gases = drawn
    each = [np.full(gas.count, disk_radius(gas, region)) if gas.radii is None else gas.radii for gas in gases]
    radii = np.concatenate(each)
    if not radii.all():
        raise SceneError(f'{where}.arrangement = "compressed": a radius of 0 cannot grow; use "random"')
    for gas, own in zip(gases, each, strict=True):
        if (why := too_many(gas, region, float(own.max(initial=0.0)))) is not None:
            raise SceneError(f"{where}: {why}")
    share = math.pi * float((radii**2).sum()) / (size[0] * size[1])
    start, scale = _start(gases, region, wraps, share, rngs)
    try:
        centres = grown(start, radii, scale, size, period, rngs[0], neighbours)
    except JammedError as jammed:
        raise SceneError(
            f'{where}.arrangement = "compressed": a packing fraction of {share:.4f} was not reached:'
            f" the disks {jammed}; disordered mixtures come to about .84, equal disks beyond .72 need a region that fits"
            " the hexagonal lattice"
        ) from None
    centres += np.array(region[:2])
    cuts = np.cumsum([gas.count for gas in gases])[:-1]
    placed = []
    for gas, centre, velocity, own in zip(gases, np.split(centres, cuts), velocities, each, strict=True):
        if not clear_of(domain, walls, present, centre, disk_radius(gas, region), gas, where):
            raise SceneError(
                f'{where}.arrangement = "compressed": the region must be free of walls and of other disks'
            )
        placed.append(Disks(centre, velocity, own, gas.mass, gas.species, gas.spin, gas.moment))
    return placed


def neighbours(position: Floats, radius: Floats, period: Point) -> tuple[Indices, Indices]:
    """Pairs (first, second), (M,) each, of disks of these radii that overlap."""
    pairs = [(found.first, found.second) for found in Cells(position, radius, np.ones(len(radius)), period).pairs()]
    none = np.empty(0, dtype=np.int64)
    first, second = (np.concatenate([none, *(pair[k] for pair in pairs)]) for k in (0, 1))
    return first, second


def _whole(region: Region, domain: Domain) -> tuple[bool, bool]:
    """Whether the region is as wide, and as high, as the domain."""
    if domain.size is None:
        return False, False
    return region[2] - region[0] >= domain.size[0], region[3] - region[1] >= domain.size[1]


def _start(
    gases: Sequence[Gas], region: Region, wraps: tuple[bool, ...], share: float, rngs: Sequence[np.random.Generator]
) -> tuple[Floats, float]:
    """(centres (N, 2) relative to the region's corner, scale of the radii there)."""
    size = (region[2] - region[0], region[3] - region[1])
    domain: Domain = Periodic(size) if all(wraps) else Channel(size) if wraps[0] else Box(size)
    plain = [
        replace(
            gas,
            radius=gas.radius if gas.radii is not None else disk_radius(gas, region),
            packing_fraction=None,
            region=None,
            temperature=None,
            speed=None,
        )
        for gas in gases
    ]
    none = join([])
    if share > ORDERED and len({gas.radius for gas in plain}) == 1 and plain[0].radii is None:
        together = replace(plain[0], count=sum(gas.count for gas in plain), arrangement="hexagonal")
        try:
            crystal = place_gas(together, domain, (), none, rngs[0])
            return crystal.position.copy(), math.sqrt(ORDERED / share)
        except SceneError:
            pass  # the lattice does not fit: a polycrystal may
    scale = min(1.0, math.sqrt(LOOSE / share))
    # the largest first: the small ones find their way between them
    parts: list[Disks] = [none] * len(plain)
    for k in sorted(range(len(plain)), key=lambda k: -disk_radius(plain[k], region)):
        loose = replace(plain[k], arrangement="random", mass=1.0)
        if loose.radii is None:
            loose = replace(loose, radius=disk_radius(loose, region) * scale)
        else:
            loose = replace(loose, radii=loose.radii * scale)
        parts[k] = place_gas(loose, domain, (), join(parts), rngs[k])
    return join(parts).position.copy(), scale
