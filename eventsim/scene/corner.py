"""The corner of a scene: where the places of its stage, and of the rows of a log, are counted from."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from eventsim.scene.disks import Disks, Floats
from eventsim.scene.domain import Domain, Open
from eventsim.scene.numbers import Point
from eventsim.scene.walls.wall import Part

FAR = 8
"""So many times its size away from the point (0, 0) a scene on the open plane counts its places from a corner of its own."""

CLOSE_ULP = 4
"""Last bits of a rounded end of a disk within which the exact one may be the outermost."""


def corner_of(disks: Disks, domain: Domain, parts: Sequence[Part]) -> Point:
    """Return what is added to a place on the stage to have it on the scene's axes.

    A domain has its origin.  On the open plane it is, along each axis, 0 where the middle of disks and wall points is within
    FAR p of (0, 0), else the multiple of p nearest to the middle, ties away from 0; p is the smallest power of two that is at
    least the larger extent of these, 1 where that is 0.  So ordinary scenes have their own coordinates.

    Args:
        disks: at the start; without any the corner is (0, 0).
        domain: of the scene.
        parts: the pieces of its walls.
    """
    if not isinstance(domain, Open):
        return domain.origin
    if not len(disks):
        return 0.0, 0.0
    ends = [_ends(disks, parts, axis) for axis in (0, 1)]
    extent = max(high - low for low, high in ends)
    unit = _power_of_two_from(extent) if extent else Fraction(1)
    x, y = (_along(low, high, unit) for low, high in ends)
    return x, y


def least_starting_place(disks: Disks, domain: Domain) -> Point:
    """Return the corner that logs of format 1 have: on the open plane the least x and y of the centres at the start."""
    if not isinstance(domain, Open):
        return domain.origin
    x, y = disks.position.min(axis=0)
    return float(x), float(y)


def _along(low: Fraction, high: Fraction, unit: Fraction) -> float:
    """The corner along one axis, along which all lies from low to high."""
    middle = (low + high) / 2
    if abs(middle) <= FAR * unit:
        return 0.0
    count = math.floor(abs(middle) / unit + Fraction(1, 2))
    return float(count * unit if middle > 0 else -count * unit)


def _ends(disks: Disks, parts: Sequence[Part], axis: int) -> tuple[Fraction, Fraction]:
    """The exact ends, along an axis, of the disks at the start and of the points of the walls."""
    low = _outermost(disks.position[:, axis], -disks.radius)
    high = _outermost(-disks.position[:, axis], -disks.radius)
    bounds = [part.span(axis) for part in parts]
    return min([low, *(first for first, _ in bounds)]), max([-high, *(last for _, last in bounds)])


def _outermost(places: Floats, reach: Floats) -> Fraction:
    """The least of the exact sums of two columns (N,)."""
    sums = places + reach
    least = sums.min()
    near = np.flatnonzero(sums <= least + CLOSE_ULP * np.spacing(abs(least)))
    pairs = {(float(places[i]), float(reach[i])) for i in near.tolist()}
    return min(Fraction(place) + Fraction(more) for place, more in pairs)


def _power_of_two_from(length: Fraction) -> Fraction:
    """The smallest power of two that is at least a length > 0."""
    exponent = length.numerator.bit_length() - length.denominator.bit_length() - 1
    unit = Fraction(2) ** exponent
    while unit < length:
        unit *= 2
    return unit
