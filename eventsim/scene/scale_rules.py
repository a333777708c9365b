"""The rules of scale: numbers of a scene whose products, quotients and sums must be numbers too."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from eventsim.scene.disks import Disks
from eventsim.scene.domain import Domain
from eventsim.scene.numbers import LONGEST, Point
from eventsim.scene.walls import Wall, parts_of

MOST, LARGEST = 1e300, 1e305
"""A number of which many can be added; one of which a few can, and whose inverse has all its digits."""


def scale_problems(disks: Disks, domain: Domain, walls: Sequence[Wall], gravity: Point | None) -> Iterator[str]:
    """Rules for numbers together, of parts of a scene whose numbers each keep their own.

    Parabolas take squares of lengths times accelerations.
    """
    extent, shortest = _lengths(disks, domain, walls)
    fastest = float(np.abs(disks.velocity).max())
    mass = disks.mass[(disks.mass > 0.0) & np.isfinite(disks.mass)]
    lightest, heaviest = (float(mass.min()), float(mass.max())) if len(mass) else (1.0, 0.0)
    if gravity is not None:
        yield from _falling_problems(max(map(abs, gravity)), fastest, extent, heaviest)
        return
    # if all energy came to the lightest disk
    driven = fastest * math.sqrt(len(disks)) * max(math.sqrt(heaviest) / math.sqrt(lightest), 1.0)
    if not driven * max(extent, 1.0) <= LARGEST:
        yield (
            f"velocity: {driven:g}, the most that a disk can come to, times the largest length, {extent:g}, must be at"
            f" most {LARGEST}"
        )
    if not driven <= LARGEST * shortest:
        yield (
            f"velocity: {driven:g}, the most that a disk can come to, over the shortest length, {shortest:g}, must be at"
            f" most {LARGEST}"
        )
    momentum = heaviest * max(fastest, 1.0)
    if not momentum * max(fastest, 1.0) <= MOST:
        yield f"mass: {heaviest:g}, and the energy of such a disk, must be at most {MOST}"
    elif not momentum <= LARGEST * shortest:
        yield (
            f"mass: {heaviest:g}: the momentum of such a disk over the shortest length, {shortest:g}, must be at most"
            f" {LARGEST}"
        )


def _falling_problems(pull: float, fastest: float, extent: float, heaviest: float) -> Iterator[str]:
    """The same under gravity, where the roots are those of squares."""
    if fastest * max(extent, 1.0) > LONGEST:
        yield (
            f"velocity: {fastest:g}, and that times the largest length, {extent:g}, must be at most {LONGEST}"
            " where there is gravity"
        )
    if pull * extent > LONGEST:
        yield f"gravity: {pull:g} times the largest length, {extent:g}, must be at most {LONGEST}"
    if not heaviest * max(fastest, 1.0) * max(fastest, pull * extent, 1.0) <= MOST:
        yield f"mass: {heaviest:g}, and the energy of such a disk, must be at most {MOST}"


def _lengths(disks: Disks, domain: Domain, walls: Sequence[Wall]) -> tuple[float, float]:
    """The largest length of a scene, coordinates among them, and the shortest one that is none."""
    places, sizes = [*domain.origin], [*(domain.size or ())]
    for part in parts_of(walls):
        low, high = part.bounds()
        places += [*low, *high]
        sizes.append(max(high[0] - low[0], high[1] - low[1]))
    lengths = np.concatenate([disks.radius, sizes])
    largest = float(np.abs(np.concatenate([disks.position.ravel(), places, lengths])).max())
    return largest, float(lengths[lengths > 0.0].min(initial=math.inf))
