"""Rough disks: what comes back of the velocity at which surfaces slide past each other at a contact."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields

import numpy as np

from eventsim.errors import SceneError
from eventsim.scene.disks import Disks
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
    with np.errstate(invalid="ignore"):
        spin, surface = np.abs(disks.spins()), np.abs(disks.spins() * disks.radius)
        moment = disks.moments()
        told = {
            "spin": ((spin == 0.0) | ((spin >= SLOWEST) & (spin <= FASTEST) & (surface <= FASTEST)),
                     f"must be 0, or {SLOWEST} to {FASTEST}, and so must the speed of its surface"),
            "moment": ((moment >= LEAST_MOMENT) & (moment <= 1.0),
                       f"must be at most 1 and at least {LEAST_MOMENT} (I / m r^2: 1/2 is a disk, 1 a ring)"),
        }
    if tangential is None:
        smooth = f"is for disks that turn: say {EXAMPLE}, or -1 where they are smooth and their spins are to be told"
        told = {key: (np.equal(value, usual), smooth) for key, value, usual in
                (("spin", spin, 0.0), ("moment", moment, 0.5))}
    elif tangential.pair > -1.0 or tangential.wall > -1.0:
        told["radius"] = (disks.radius != 0.0, "a point has no surface that could be rough; leave out tangential_restitution")
        told["mass"] = (disks.mass != 0.0, "a tracer has no moment that could turn; leave out tangential_restitution")
    for key, (kept, rule) in told.items():
        broken = np.flatnonzero(~kept)
        values = getattr(disks, {"spin": "spins", "moment": "moments"}.get(key, key))
        values = values() if callable(values) else values
        for i in broken[:FIRST].tolist():
            yield f"{names.key(i, key)} = {values[i].tolist()}: {rule}"
        if len(broken) > FIRST:
            yield f"... and {len(broken) - FIRST} more disks like this ({key})"
