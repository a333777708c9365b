"""Exact ties of representable numbers: two contacts of one disk at the same time, wherever that falls on the clock."""

from __future__ import annotations

import math

import numpy as np

from eventsim.scene import Box, Disks, Open, Scene, Segment
from eventsim.validation.stress.case import Bench, Case, off

ULP = 2.0**-52

DROPS = (2.0**-20, 0.0502817, 1.0, 6.5)
"""Heights from which a disk falls into the valley of `valley`: ties early and late on the clock."""

AFTER_TIE = np.array([[5247.0, 1056.0], [3490.0, 8376.0], [7074.0, -9432.0]]) / 15811.0
"""(3, 2) the velocities that the disks of `two_partners` leave with."""

PACES = (0.25, 16.0, 256.0)
"""Speeds of a spectator that has a unit to go: it meets walls never, a few times, a hundred times before the tie."""


def valley(drop: float) -> Scene:
    """A disk falls at speed 1 onto two walls, which are mirror images of each other, from `drop` above them."""
    touching = 0.5 * math.hypot(0.7, 3.0) / 3.0
    walls = [Segment((0.0, 0.7), (3.0, 0.0)), Segment((3.0, 0.0), (6.0, 0.7))]
    return Scene(Disks([[3.0, touching + drop]], [[0.0, -1.0]], 0.5), Box((6.0, 8.0)), walls=walls)


def two_partners(pace: float = 0.0) -> Scene:
    """A disk meets two at rest at once, along the hypotenuses of triangles 5-12-13 and 3-4-5.

    pace: speed of a spectator far away, which bounces between two walls; 0: there is none.
    """
    place = [[0.0, 0.0], [0.8865209077803513, 1.5], [1.0115209077803513, -1.0]]
    velocity = [[1.0, 0.0], [0.0, 0.0], [0.0, 0.0]]
    radius = [0.5, 1.125, 0.75]
    if pace == 0.0:
        return Scene(Disks(place, velocity, radius), Open())
    walls = [Segment((90.0, y), (94.0, y)) for y in (20.0, 21.5)]
    return Scene(Disks([*place, [92.0, 20.5]], [*velocity, [0.0, pace]], [*radius, 0.25]), Open(), walls=walls)


def _two_walls(bench: Bench) -> float:
    return max(off(bench.run(valley(drop), until=drop + 0.5).state.velocity, [[0.0, 1.0]]) for drop in DROPS)


def _three_disks(bench: Bench) -> float:
    return off(bench.run(two_partners(), until=0.5).state.velocity, AFTER_TIE)


def _spectator(bench: Bench) -> float:
    """The largest error of the three, for ever faster spectators."""
    return max(off(bench.run(two_partners(pace), until=0.5).state.velocity[:3], AFTER_TIE) for pace in PACES)


CASES = (
    Case(
        "p2-two-walls",
        "a disk meets two walls, mirror images, at once",
        "Rounding parts the two contacts, and the first one turns the disk away from the second wall.",
        "By symmetry it goes straight back, whenever it comes.",
        0.0,
        "Symmetric in floats.",
        _two_walls,
    ),
    Case(
        "p2-three-disks",
        "a disk meets two others at once, one of them by a rounded time",
        "The two contact times differ in their last bit, and the first contact moves the disk out of the second.",
        "Exact rationals, by Moreau's law: v0 = (5247, 1056)/15811.",
        4 * ULP,
        "The places at the contact are rounded, by a last bit of 1.",
        _three_disks,
    ),
    Case(
        "p2-spectator",
        "the same, beside a spectator that moves the clock",
        "How fine the clock is where the tie falls hangs on a disk that has nothing to do with it.",
        "As without it: v0 = (5247, 1056)/15811.",
        4 * ULP,
        "The places at the contact are rounded, by a last bit of 1.",
        _spectator,
    ),
)
