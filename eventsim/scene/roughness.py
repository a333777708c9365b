"""Rough disks: what comes back of the velocity at which surfaces slide past each other at a contact."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from eventsim.errors import SceneError
from eventsim.scene.disks import USUAL, Disks, Floats
from eventsim.scene.names import DiskNames
from eventsim.scene.numbers import FASTEST, SLOWEST, number

EXAMPLE = "tangential_restitution = 0.5"


@dataclass(frozen=True, slots=True)
class TangentialRestitution:
    """The share (-1 smooth ... 1 perfectly rough) of the sliding velocity that is turned round: between disks, and at walls."""

    pair: float = -1.0
    wall: float = -1.0

    def __post_init__(self) -> None:
        for key in KEYS:
            object.__setattr__(self, key, number(getattr(self, key), f"tangential_restitution.{key}"))

    def problems(self) -> Iterator[str]:
        """Rules that its numbers break, one sentence each."""
        name = "tangential_restitution"
        both = {name: self.pair} if self.pair == self.wall else {f"{name}.pair": self.pair, f"{name}.wall": self.wall}
        for key, value in both.items():
            if not -1.0 <= value <= 1.0:
                yield f"{key} = {value}: must be from -1 (smooth) to 1 (perfectly rough)"


KEYS = tuple(item.name for item in fields(TangentialRestitution))
"""The keys of a `tangential_restitution = {...}` table."""


def as_tangential(value: TangentialRestitution | Mapping[str, float] | float | None) -> TangentialRestitution | None:
    """The tangential restitution meant by a number (both alike), a mapping with its keys, or None; None: disks have no spin.

    Raises:
        SceneError: if the value is none of these.
    """
    if value is None or isinstance(value, TangentialRestitution):
        return value
    if isinstance(value, Mapping):
        unknown = [key for key in value if key not in KEYS]
        if unknown:
            raise SceneError([f"tangential_restitution.{key}: unknown key (known: {', '.join(KEYS)})" for key in unknown])
        return TangentialRestitution(**value)
    both = number(value, "tangential_restitution")
    return TangentialRestitution(both, both)


LEAST_MOMENT = 1e-9
"""A disk whose mass lies so close to its centre turns a billion times as fast as others."""

FIRST = 3
"""Disks that are named where many break a rule."""


def roughness_problems(disks: Disks, tangential: TangentialRestitution | None, names: DiskNames) -> Iterator[str]:
    """Rules for spins and moments, and for the disks of a rough scene, one sentence each."""
    for key, values, kept, rule in _smooth_rules(disks) if tangential is None else _rough_rules(disks, tangential):
        broken = np.flatnonzero(~kept)
        for i in broken[:FIRST].tolist():
            yield f"{names.key(i, key)} = {values[i].tolist()}: {rule}"
        if len(broken) > FIRST:
            yield f"... and {len(broken) - FIRST} more disks like this ({key})"


def _smooth_rules(disks: Disks) -> Iterator[_Rule]:
    """Disks of a scene that tells no roughness have neither spins nor moments."""
    rule = f"is for disks that turn: say {EXAMPLE}, or -1 where they are smooth and their spins are to be told"
    yield _Rule("spin", disks.spins(), disks.spins() == USUAL["spin"], rule)
    yield _Rule("moment", disks.moments(), disks.moments() == USUAL["moment"], rule)


def _rough_rules(disks: Disks, tangential: TangentialRestitution) -> Iterator[_Rule]:
    spin, moment = np.abs(disks.spins()), disks.moments()
    with np.errstate(invalid="ignore", over="ignore"):
        turns = (spin >= SLOWEST) & (spin <= FASTEST) & (spin * disks.radius <= FASTEST)
    rule = f"must be 0, or {SLOWEST} to {FASTEST}, and so must the speed of its surface"
    yield _Rule("spin", disks.spins(), (spin == 0.0) | turns, rule)
    rule = f"must be at most 1 and at least {LEAST_MOMENT} (I / m r^2: 1/2 is a disk, 1 a ring)"
    yield _Rule("moment", moment, (moment >= LEAST_MOMENT) & (moment <= 1.0), rule)
    if tangential != TangentialRestitution():
        left = "leave out tangential_restitution"
        yield _Rule("radius", disks.radius, disks.radius != 0.0, f"a point has no surface that could be rough; {left}")
        yield _Rule("mass", disks.mass, disks.mass != 0.0, f"a tracer has no moment that could turn; {left}")


class _Rule(NamedTuple):
    """Which disks (N,) keep a rule for one of their numbers."""

    key: str
    values: Floats
    kept: NDArray[np.bool_]
    rule: str
