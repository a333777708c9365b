"""What a scene has, as kernels take it: None is what it lacks, and is compiled away."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from eventsim.engines.fast.compiled import compiled_law
from eventsim.engines.fast.layout import OWN_OF_WALL, SUPPORT, SUPPORT_FACE, Rules
from eventsim.engines.fast.plan import Grids
from eventsim.engines.fast.shapes import CORNERS, KINDS, WIDTH
from eventsim.engines.reference.instants import instant_of, stillness_of
from eventsim.engines.reference.sunk import can_be_too_small, can_creep, can_sink
from eventsim.formulas.doubt import piled_up
from eventsim.formulas.laws import Law, Numbers, Own
from eventsim.formulas.rough import SMOOTH
from eventsim.record.events import Floats
from eventsim.scene.stage import Stage
from eventsim.scene.surfaces import moved_on

STEPS = (1, 0), (-1, 0), (0, 1), (0, -1)
"""Wraps, in the order of `images_of`."""


def rules_of(stage: Stage) -> Rules:
    """What kernels need to know of a scene besides its disks."""
    gx, gy = stage.gravity or (None, None)
    wall_x = next((k for k, boundary in enumerate(stage.boundaries) if boundary.axis == 0), None)
    wall_y = next((k for k, boundary in enumerate(stage.boundaries) if boundary.axis == 1), None)
    classes = stage.mass is not None and bool(np.any(np.isinf(stage.mass) | (stage.mass == 0.0)))
    present = {type(feature.shape) for feature in stage.features}
    width, height = stage.size or (math.inf, math.inf)
    return Rules(
        gx,
        gy,
        *stage.period,
        wall_x,
        wall_y,
        width,
        height,
        stage.law.pair,
        max(stage.law.shares(pairs=False)),
        stage.law.series(stage.law.wall),
        law_in_kernels(stage.law),
        1 if stage.law.by_speed else None,
        stage.extent if isinstance(stage.law, Own) else None,
        1 if stage.law.drives else None,
        stage.seed,
        1 if classes else None,
        stage.common_mass,
        len(stage.features) or None,
        tuple(1 if kind in present else None for kind in KINDS),
        len(stage.boundaries),
        *instant_of(stage),
        stillness_of(stage),
        stage.tie_screen,
        piled_up(stage.law.loss()) if can_sink(stage) or can_creep(stage) or can_be_too_small(stage) else None,
        *(None if beta == SMOOTH else beta for beta in stage.law.rough or (SMOOTH, SMOOTH)),
    )


def law_in_kernels(law: Law) -> Numbers | None:
    """The numbers of a law; that of a user by the address of its machine code.

    Raises EventsimError where it cannot be compiled.
    """
    numbers = law.numbers()
    return numbers._replace(own=compiled_law(law.own)) if isinstance(law, Own) and numbers is not None else numbers


def kind_of(stage: Stage, grids: Grids, keep_rows: bool) -> str:
    """A name for what kernels are compiled for: scenes of one kind, in cells of one kind, share theirs."""
    law = (shares_of(stage), stage.law.pairs, *(stage.law.numbers() or ()))
    asked = [keep_rows, stage.low_parts, stage.points, grids.sizes is not None, grids.near_walls() is not None]
    wanted = (True if want else None for want in asked)
    rules = rules_of(stage)
    needs = [*rules, *rules.shapes, *grids.grid(None), stage.mass, stage.supports, stage.spin, *wanted, *law]
    return "".join("0" if need is None else "1" for need in needs)


def features_of(stage: Stage) -> Floats | None:
    """The wall shapes as a table of numbers, in one row of memory."""
    if not stage.features:
        return None
    table = np.zeros((len(stage.features), WIDTH))
    for row, feature in zip(table, stage.features, strict=True):
        row[0], row[1] = KINDS.index(type(feature.shape)), feature.wall
        numbers = tuple(feature.shape)  # every shape is a tuple of numbers
        row[2 : 2 + len(numbers)] = numbers
        row[CORNERS:] = feature.corners
    return table.reshape(-1)


def shares_of(stage: Stage) -> Floats | None:
    """What each wall does, in one row of memory; None where all walls are alike.

    What comes back there, and of low bounces; the temperature, or 0; the speed of its shaking; that along itself, times its turn.
    """
    law = stage.law
    if law.walls is None and not law.drives:
        return None
    table = np.zeros((len(stage.surfaces), OWN_OF_WALL))
    for row, turn, wall in zip(table, stage.turns, (surface.wall for surface in stage.surfaces), strict=True):
        share, done = law.of_wall(wall), law.treatment(wall)
        row[:] = share, law.series(share), done.temperature or 0.0, done.shaking, turn * done.velocity
    return table.reshape(-1)


def pairs_of(stage: Stage) -> Floats | None:
    """How many species there are, then what comes back between them, in one row of memory; None where all are alike."""
    pairs = stage.law.pairs
    return None if pairs is None else np.array([float(len(pairs)), *(share for row in pairs for share in row)])


def images_of(stage: Stage) -> NDArray[np.int32] | None:
    """For wraps to the right, left, top and bottom: from which shape each takes over the sides of points."""
    if not stage.points or not stage.periodic:
        return None
    table = np.full((4, len(stage.features)), -1, np.int32)
    for row, step in zip(table, STEPS, strict=True):
        for k, image in enumerate(moved_on(stage.features, (-step[0], -step[1]))):
            if image >= 0:
                row[image] = k
    return table.reshape(-1)


def supports_of(stage: Stage) -> Floats | None:
    """What walls support disks with as a table of numbers, in one row of memory."""
    if stage.supports is None:
        return None
    table = np.zeros((len(stage.supports), SUPPORT))
    for row, support in zip(table, stage.supports, strict=True):
        if support is not None:
            row[:SUPPORT_FACE] = support.ax, support.ay, support.low, support.high, support.line
            row[SUPPORT_FACE:] = support.face
    return table.reshape(-1)
