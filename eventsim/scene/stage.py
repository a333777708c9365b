"""The stage: a scene in the numbers that engines and replay work with.

Positions are relative to the domain's corner, walls are broken up into primitive shapes, what the scene does not have is
None.  `origin` and `start_time` end here: a shifted or a late scene has the same stage, bit for bit.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eventsim.formulas.doubt import tie_screen
from eventsim.formulas.laws import Law, Treatment
from eventsim.formulas.motion import periods
from eventsim.formulas.real import Real, is_float
from eventsim.formulas.rest import Support
from eventsim.formulas.walls.boundary import Boundary
from eventsim.formulas.walls.point import closeness, is_near, is_point
from eventsim.formulas.walls.post import is_post_to
from eventsim.formulas.walls.shape import Closed, Thin
from eventsim.scene.clock import SceneClock, clock_of
from eventsim.scene.contact_law import law_of_scene
from eventsim.scene.corner import corner_of
from eventsim.scene.disks import Floats, named_species
from eventsim.scene.numbers import Point
from eventsim.scene.scene import Scene
from eventsim.scene.surfaces import Feature, any_lies, boundaries_of, features_of, supports_of, turn_of, with_one_size
from eventsim.scene.walls import feature_names, parts_of

UNEVEN = 2.0**16
"""Ratio of masses M/m from which on velocities carry their low parts: the roundings of the pi sqrt(M/m) contacts that a light
disk can have with a heavy one add up to about 2**-53 (M/m)**.75 of a small final velocity, here 2**-41."""

EXTREME = 2.0**400
"""Masses beyond it, or below its inverse, leave the range of error-free arithmetic."""


@dataclass(frozen=True, slots=True)
class Stage:
    """What an engine needs to know of a scene of n disks.

    Attributes:
        n: number of disks.
        x, y, vx, vy: (n,) start, relative to the corner; length, length / time.
        radius: (n,).
        mass: (n,), or None where all are equal, finite and positive; then common_mass is that mass.
        mass_ratio: of the heaviest to the lightest disk, tracers and immovable ones apart.
        low_parts: whether velocities carry what their rounding leaves (`formulas/careful_impulse`): nothing falls, masses
            are very uneven, and disks have no spin.
        spin, moment: (n,) angular velocities at the start, and I / m r^2; None where disks have no spin.
        gravity: (gx, gy), or None.
        law: the law of its contacts.
        seed: of chance at walls; None where there is none.
        turns: of each surface, 1 or -1: its direction is that, times the side, times its normal turned to the right; 0: a post.
        species: (n,) the species of each disk, where the law asks for it; else None.
        period: the period along x and y; None along an axis without one.
        size: (width, height) of the domain, or None.
        boundaries: hard walls of the domain.
        features: shapes of the walls inside it; in a periodic domain with the images that disks can meet.
        supports: what boundaries and features, in this order, support disks with; None where no disk comes to rest, or where
            it would roll on a rough wall, which no law here tells.
        points: whether disks are points to some walls, whose sides they have to remember.
        wall_names: the names that the walls have in an event log.
        corner: what to add to a position to have it on the scene's axes.
        start_time: what the scene's clock shows at remainder 0 of epoch 0.
        clock: how long its epochs and its windows are.
        extent: the sum of the largest coordinates that gaps are differences of; length.
        tie_screen: the span of time within which contacts that share a disk are ordered exactly, in the first window.
    """

    n: int
    x: Floats
    y: Floats
    vx: Floats
    vy: Floats
    radius: Floats
    mass: Floats | None
    common_mass: float
    mass_ratio: float
    low_parts: bool
    spin: Floats | None
    moment: Floats | None
    gravity: Point | None
    law: Law
    seed: int | None
    turns: tuple[int, ...]
    species: NDArray[np.int64] | None
    period: tuple[float | None, float | None]
    size: Point | None
    boundaries: tuple[Boundary, ...]
    features: tuple[Feature, ...]
    surfaces: tuple[Boundary | Feature, ...]
    supports: tuple[Support | None, ...] | None
    points: bool
    wall_names: tuple[str, ...]
    corner: Point
    start_time: float
    clock: SceneClock
    extent: float
    tie_screen: float

    @property
    def epoch_length(self) -> float:
        """The length of an epoch of the clock: time, a power of two."""
        return self.clock.epoch_length

    @property
    def periodic(self) -> bool:
        """Whether any axis is periodic."""
        return self.period != (None, None)

    def shifts(self, image: tuple[int, int]) -> tuple[float, float]:
        """The distance of an image (kx, ky) of the domain, along x and y."""
        return periods(image[0], self.period[0]), periods(image[1], self.period[1])

    def usual(self, a: int, b: int) -> float:
        """The usual restitution of disks a and b, or of a and the surface -1 - b."""
        if b < 0:
            return self.law.of_wall(self.surfaces[-1 - b].wall)
        return self.law.pair if self.species is None else self.law.of_pair(int(self.species[a]), int(self.species[b]))

    def nearest(self, d: Floats) -> Floats:
        """Differences (..., 2) of any two places to their nearest images."""
        for axis, length in enumerate(self.period):
            if length is not None:
                d[..., axis] -= length * np.round(d[..., axis] / length)
        return d

    def boundary(self, surface: int) -> Boundary | None:
        """The boundary of the domain with this number among all surfaces; None of a feature's number."""
        return self.boundaries[surface] if surface < len(self.boundaries) else None

    def normal(self, surface: int, side: int, x: Real, y: Real) -> tuple[Real, Real]:
        """The normal of a surface, of any length, towards a disk at (x, y)."""
        found = self.surfaces[surface]
        if isinstance(found, Boundary):
            return found.normal()
        return found.shape.normal(side, x, y)

    def at_end(self, met: Iterable[int], x: Real, y: Real, reached: float, radius: float) -> tuple[Real, Real]:
        """The place of a point that meets several surfaces at once: the end of a wall, if it is there but for the last bits.

        reached: how far it may have flown there.
        """
        for surface in met:
            found = self.surfaces[surface]
            shape = None if isinstance(found, Boundary) else found.shape
            if isinstance(shape, Thin) and is_point(radius, shape.size) and is_float(x):
                close = closeness(shape.size + reached, x, y, 0.0, 0.0, 0.0)
                for px, py in ((shape.x, shape.y), (shape.x1, shape.y1)):
                    if is_near(px, py, x, y, close):
                        return px, py
        return x, y

    def touching(self, surface: int, side: int, x: Real, y: Real, radius: Real) -> tuple[Real, Real]:
        """The place of a disk on the surface that it meets: exactly on a boundary of the domain.

        On a shape on contact but for the last bits, where disks settle or the shape supports them; else where it is.
        """
        found = self.surfaces[surface]
        if isinstance(found, Boundary):
            return found.touching(x, y, radius)
        if self.is_exact_hit(surface, radius):
            return found.shape.x, found.shape.y
        if self.settles or (self.supports is not None and self.supports[surface] is not None):
            return found.shape.touching(side, x, y, radius)
        return x, y

    def is_exact_hit(self, surface: int, radius: Real) -> bool:
        """Whether a disk that meets this surface is a point that hits a post: it turns round, the limit of a central hit."""
        found = self.surfaces[surface]
        return is_float(radius) and self.points and not isinstance(found, Boundary) and is_post_to(found.shape, radius)

    def is_round_outside(self, surface: int, side: int) -> bool:
        """Whether this surface is round, and bends away from a disk that meets it on that side."""
        found = self.surfaces[surface]
        return not isinstance(found, Boundary) and side >= 0 and found.shape.line() is None

    @property
    def slopes(self) -> Floats:
        """(walls, 2) the acceleration that a disk has which rests on a wall; 0 for walls on which none does."""
        slopes = np.zeros((len(self.wall_names), 2))
        for surface, support in zip(self.surfaces, self.supports or (), strict=False):
            if support is not None:
                slopes[surface.wall] = support.ax, support.ay
        return slopes

    @property
    def settles(self) -> bool:
        """Whether disks end up lying on something: gravity, and bounces that become ever lower."""
        return self.gravity is not None and self.law.comes_to_rest()

    @property
    def goes_on_as_fast(self) -> bool:
        """Whether something moves that neither leaves nor slows down, so that there is no end of events."""
        confined = self.size is not None or bool(self.features)
        moves = self.gravity is not None or bool(np.any(self.vx) or np.any(self.vy))
        return confined and moves and not self.law.loses_energy()


def stage_of(scene: Scene, corner: Point | None = None) -> Stage:
    """The stage of a scene; corner: None, or that of an older log."""
    disks, domain = scene.disks, scene.domain
    corner = corner_of(disks, domain, parts_of(scene.walls)) if corner is None else corner
    x, y = disks.position[:, 0] - corner[0], disks.position[:, 1] - corner[1]
    vx, vy = disks.velocity[:, 0].copy(), disks.velocity[:, 1].copy()
    size = domain.size
    boundaries, names = boundaries_of(domain)
    features = features_of(scene.walls, float(disks.radius.max()), corner, domain.period, boundaries)
    features = with_one_size(features, disks.radius)
    law = law_of_scene(scene)
    lightest, heaviest = _extreme_masses(disks.mass)
    clock = clock_of(scene)
    extent = _extent(scene, x, y, corner, features)
    return Stage(
        n=len(disks),
        x=x,
        y=y,
        vx=vx,
        vy=vy,
        radius=disks.radius,
        mass=None if _all_equal(disks.mass) else disks.mass,
        common_mass=float(disks.mass[0]),
        mass_ratio=heaviest / lightest,
        low_parts=(
            scene.gravity is None and not law.drives
            and law.rough is None
            and heaviest / lightest > UNEVEN
            and lightest > 1.0 / EXTREME
            and heaviest < EXTREME
        ),
        spin=None if law.rough is None else disks.spins(),
        moment=None if law.rough is None else disks.moments(),
        gravity=scene.gravity,
        law=law,
        seed=scene.seed if law.heats else None,
        turns=(*map(turn_of, boundaries), *map(turn_of, features)),
        species=None if law.pairs is None else named_species(disks)[1],
        period=domain.period,
        size=size,
        boundaries=boundaries,
        features=features,
        surfaces=(*boundaries, *features),
        supports=None if law.grips[1] else _supports(scene, boundaries, features, law, x, y),
        points=_has_points(features, float(disks.radius.min())),
        wall_names=(*names, *feature_names(scene.walls)),
        corner=corner,
        start_time=scene.start_time,
        clock=clock,
        extent=extent,
        tie_screen=tie_screen(extent, _slowest(vx, vy), clock.epoch_length / len(disks)),
    )


def _extent(scene: Scene, x: Floats, y: Floats, corner: Point, features: tuple[Feature, ...]) -> float:
    """The sum of the largest coordinates that gaps are differences of; length."""
    largest = []
    for axis, places in ((0, x), (1, y)):
        ends = [(one.shape.x, one.shape.y)[axis] for one in features]
        largest.append(max([float(np.abs(places).max()), *map(abs, ends)]))
    size = scene.domain.size
    walls = max((part.scale(corner) for part in parts_of(scene.walls)), default=0.0)
    return sum(largest) + walls + (0.0 if size is None else sum(size)) + float(scene.disks.radius.max())


def _slowest(vx: Floats, vy: Floats) -> float:
    """The lowest speed of a disk that moves, 0 where none does; of its components the larger."""
    speeds = np.maximum(np.abs(vx), np.abs(vy))
    return float(speeds[speeds > 0.0].min(initial=math.inf)) if np.any(speeds > 0.0) else 0.0


def _has_points(features: tuple[Feature, ...], least: float) -> bool:
    return any(isinstance(one.shape, Thin | Closed) and is_point(least, one.shape.size) for one in features)


def _all_equal(mass: Floats) -> bool:
    return bool(np.all(mass == mass[0]) and 0.0 < mass[0] < math.inf)


def _extreme_masses(mass: Floats) -> tuple[float, float]:
    """The smallest and the largest of those that are positive and finite; 1 where none is."""
    finite = mass[(mass > 0.0) & (mass < math.inf)]
    return (float(finite.min()), float(finite.max())) if len(finite) else (1.0, 1.0)


def _supports(
    scene: Scene, boundaries: tuple[Boundary, ...], features: tuple[Feature, ...], law: Law, x: Floats, y: Floats
) -> tuple[Support | None, ...] | None:
    """The supports of a scene in which disks can come to rest: walls take energy, or a disk lies on one at the start.

    In the TC model contacts that are close to each other take none.  A wall inside the domain that disks also meet in an image
    supports nobody: so a disk on it does not reach the border, and a wrap ends no rest.
    """
    gravity, disks = scene.gravity, scene.disks
    if gravity is None:
        return None
    faces = [None if item.imaged else item.shape.line() for item in features]
    shares = [law.series(law.of_wall(one.wall)) for one in features]
    bare = [law.treatment(wall) == Treatment() for wall in (*(b.wall for b in boundaries), *(f.wall for f in features))]
    supports = supports_of([(one.axis, one.position) for one in boundaries], faces, gravity, shares)
    if all(law.series(share) == 1.0 for share in law.shares(pairs=False)):
        falls = np.isfinite(disks.mass)
        flights = x[falls], y[falls], disks.velocity[falls, 0], disks.velocity[falls, 1]
        if not any(one is not None and any_lies(one, flights, disks.radius[falls], gravity) for one in supports):
            return None
    supports = tuple(one if holds else None for one, holds in zip(supports, bare, strict=True))
    return supports if any(supports) else None
