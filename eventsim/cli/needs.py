"""What a scene has, and therefore needs: the facts that `eventsim check` explains."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from eventsim.engines.auto import first_engine
from eventsim.engines.base import Stop
from eventsim.engines.reference.cells import images_of, plan
from eventsim.formulas.laws import Law
from eventsim.measure.ensemble import ensemble_of
from eventsim.scene.disks import Disks, species_among
from eventsim.scene.overlaps import pair_overlaps
from eventsim.scene.scene import touching_by_rounding
from eventsim.scene.stage import stage_of
from eventsim.scene.walls import parts_of, wall_names
from eventsim.validation.near_ties import NearTie, near_ties

if TYPE_CHECKING:
    from eventsim.scene import Scene
    from eventsim.scene.stage import Stage

SPECIES_SHOWN = 5

WIDER = 1.0 + 2.0**-50
"""Disks wider by this factor, four units in the last place, overlap where they touch."""


@dataclass(frozen=True, slots=True)
class Species:
    """Disks of one radius and one mass, and how many there are."""

    count: int
    radius: float
    mass: float


@dataclass(frozen=True, slots=True)
class Search:
    """How the neighbours of a disk are found: among all others, or in cells of a side (x, y), length.

    giants: disks that are in no cell, because they would make every cell as large as they are.
    """

    kind: Literal["all pairs", "cells"]
    side: tuple[float, float] | None = None
    columns: int | None = None
    rows: int | None = None
    giants: int = 0


@dataclass(frozen=True, slots=True)
class Needs:
    """The facts about a scene.

    Attributes:
        disks: their number; moving, immovable (mass inf), obstacles (mass inf, moving) and tracers
            (mass 0) count some of them.
        species: the commonest radius-mass combinations, at most SPECIES_SHOWN; species_count: how many there are.
        radii, masses: (least, largest).
        fastest: largest speed at the start, length / time.
        temperature: kT = sum m |v|^2 / 2N over disks of finite positive mass, as a text where that is no float; None where
            there are none.
        packing_fraction: area of the disks that carry energy over the area that they can cover; None where nothing bounds it.
        table: area and perimeter of the region that a lone disk's or a tracer's centre sees, and its mean free path pi A / P;
            None where disks meet each other.
        domain, size, origin: its kind, width and height, lower-left corner.
        walls: name -> kind of the walls inside the domain.
        shapes: name -> number of the primitive shapes that the walls are made of, periodic images included.
        gravity, restitution, contact_duration: None without; restitution (pair, wall).
        law: of contacts.
        low_parts: whether masses are so uneven that velocities carry what their rounding leaves.
        gap_bits: bits that coordinates leave of the 53 of a gap, relative to the smallest diameter; None of points.
        points: whether disks are so small that they have to remember on which side of a wall they are.
        epoch_length: time, a power of two.
        search: all pairs or cells.
        images: in how many periodic images a disk can be met from inside the domain: 1, 3 or 9.
        touching_pairs: pairs of disks at contact at the start, exactly or but for rounding.
        touching_notes: sentences on starting overlaps so small that they count as touching.
        near_ties: contacts in a short run that share a disk and that only rounding parts; None where nobody looked.
        until, events: the stop that the scene carries.
        engine: what `auto` chooses.
    """

    disks: int
    moving: int
    immovable: int
    obstacles: int
    tracers: int
    species: tuple[Species, ...]
    species_count: int
    radii: tuple[float, float]
    masses: tuple[float, float]
    fastest: float
    temperature: float | None
    packing_fraction: float | None
    table: tuple[float, float, float] | None
    domain: str
    size: tuple[float, float] | None
    origin: tuple[float, float]
    walls: dict[str, str]
    shapes: dict[str, int]
    gravity: tuple[float, float] | None
    restitution: tuple[float, float] | None
    contact_duration: float | None
    law: Law
    low_parts: bool
    gap_bits: int | None
    points: bool
    start_time: float
    epoch_length: float
    search: Search
    images: int
    touching_pairs: int
    touching_notes: tuple[str, ...]
    near_ties: tuple[NearTie, ...] | None
    until: float | None
    events: int | None
    engine: str


def needs_of(scene: Scene) -> Needs:
    """Return the facts about a scene; O(N log N) for N disks, and a short run where these are few."""
    disks, domain, stage = scene.disks, scene.domain, stage_of(scene)
    species, species_count = _species(disks)
    speed = np.hypot(disks.velocity[:, 0], disks.velocity[:, 1])
    size = domain.size
    ensemble = ensemble_of(scene)
    table = ensemble.table if ensemble.billiard else None
    shapes = Counter(type(feature.shape).__name__.lower() for feature in stage.features)
    return Needs(
        disks=len(disks),
        moving=int(np.count_nonzero(speed)),
        immovable=int(np.count_nonzero(np.isinf(disks.mass))),
        obstacles=int(np.count_nonzero(np.isinf(disks.mass) & (speed > 0.0))),
        tracers=int(np.count_nonzero(disks.mass == 0.0)),
        species=species,
        species_count=species_count,
        radii=(float(disks.radius.min()), float(disks.radius.max())),
        masses=(float(disks.mass.min()), float(disks.mass.max())),
        fastest=float(speed.max()),
        temperature=_temperature(disks, speed),
        packing_fraction=ensemble.packing_fraction,
        table=None if table is None else (table.area, table.perimeter, table.mean_free_path),
        domain=domain.kind,
        size=size,
        origin=domain.origin,
        walls=dict(zip(wall_names(scene.walls), (wall.kind for wall in scene.walls), strict=True)),
        shapes=dict(shapes),
        gravity=scene.gravity,
        restitution=None if scene.restitution is None else (scene.restitution.pair, scene.restitution.wall),
        contact_duration=stage.law.duration,
        law=stage.law,
        low_parts=stage.low_parts,
        gap_bits=_gap_bits(stage),
        points=stage.points,
        start_time=scene.start_time,
        epoch_length=stage.epoch_length,
        search=_search(stage),
        images=len(images_of(stage)),
        touching_pairs=_touching_pairs(scene),
        touching_notes=tuple(touching_by_rounding(scene)),
        near_ties=near_ties(scene),
        until=scene.until,
        events=scene.events,
        engine=first_engine(stage, Stop(scene.until, scene.events)),
    )


def _species(disks: Disks) -> tuple[tuple[Species, ...], int]:
    """The commonest species, and how many species there are."""
    found = species_among(disks)
    commonest = np.lexsort((found.first, -found.count))[:SPECIES_SHOWN]
    rows = zip(*(column[commonest].tolist() for column in (found.count, found.radius, found.mass)), strict=True)
    return tuple(Species(*row) for row in rows), len(found.count)


def _temperature(disks: Disks, speed: np.typing.NDArray[np.float64]) -> float | None:
    massive = (disks.mass > 0.0) & np.isfinite(disks.mass)
    if not massive.any():
        return None
    return float(np.mean(disks.mass[massive] * speed[massive] ** 2) / 2.0)


def _gap_bits(stage: Stage) -> int | None:
    """A gap is a difference of coordinates: it lacks the bits by which these are larger than a diameter."""
    sizes = stage.radius[stage.radius > 0.0]
    if not len(sizes):
        return None
    largest = max([float(np.abs([stage.x, stage.y]).max()), *(stage.size or ())])
    return max(0, 53 - max(0, math.frexp(largest)[1] - math.frexp(2.0 * float(sizes.min()))[1]))


def _touching_pairs(scene: Scene) -> int:
    """Pairs that would overlap if all disks were wider by a few units in the last place."""
    disks = scene.disks
    wider = Disks(disks.position, disks.velocity, disks.radius * WIDER, disks.mass)
    return len(pair_overlaps(wider, scene.domain, parts_of(scene.walls)))


def _search(stage: Stage) -> Search:
    grid = plan(stage)
    if grid is None:
        return Search("all pairs")
    return Search("cells", grid.side, grid.columns, grid.rows, len(grid.giants))
