"""Samples: where all disks are at some times, as somebody else tells it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from eventsim.errors import EventsimError

Floats: TypeAlias = NDArray[np.float64]
Column: TypeAlias = NDArray[Any]
Named: TypeAlias = list[tuple[str, Column]]
"""The columns of a file under the names that it gives them."""

Columns: TypeAlias = Mapping[str, Column]
"""Name, in small letters, -> numbers or texts."""


@dataclass(frozen=True, slots=True)
class Samples:
    """Positions of n disks at T times, increasing.

    Attributes:
        source: where they come from, for messages.
        times: (T,).
        position: (T, n, 2), length.
        velocity: (T, n, 2), or None where none are told.
        radius, mass: (n,), or None where they are not told.
        cell: width and height of the cell in whose middle positions have their origin; None: they are on axes of their own.
        counted: the number that its source gives to the first disk.
        step: about the last digit that positions have, length; 0 where they have all of a float64.
    """

    source: str
    times: Floats
    position: Floats
    velocity: Floats | None = None
    radius: Floats | None = None
    mass: Floats | None = None
    cell: tuple[float, float] | None = None
    step: float = 0.0
    counted: int = 0

    @property
    def n(self) -> int:
        """The number of disks."""
        return int(self.position.shape[1])

    def first(self, count: int) -> Samples:
        """So many of them, from the first on."""
        velocity = None if self.velocity is None else self.velocity[:count]
        return replace(self, times=self.times[:count], position=self.position[:count], velocity=velocity)

    def at(self, frame: int) -> Samples:
        """One of them alone."""
        chosen = slice(frame, frame + 1 or None)
        velocity = None if self.velocity is None else self.velocity[chosen]
        return replace(self, times=self.times[chosen], position=self.position[chosen], velocity=velocity)

    def placed(self, corner: tuple[float, float]) -> Samples:
        """The same on the axes of a domain with this lower-left corner."""
        if self.cell is None:
            return self
        shift = np.array(corner) + 0.5 * np.array(self.cell)
        return replace(self, position=self.position + shift, cell=None)


def checked(samples: Samples, least: int = 2) -> Samples:
    """The samples, their times in order; EventsimError for what cannot be positions at `least` times."""
    shape = samples.position.shape
    if len(shape) != 3 or shape[2] != 2 or shape[0] != len(samples.times) or not shape[1]:
        raise EventsimError(f"{samples.source}: positions {shape} at times {samples.times.shape}: must be (T, n, 2) at (T,)")
    if len(samples.times) < least:
        raise EventsimError(f"{samples.source}: its number of times is {len(samples.times)}; a motion has at least two")
    if samples.velocity is not None and samples.velocity.shape != shape:
        raise EventsimError(f"{samples.source}: velocities {samples.velocity.shape} of positions {shape}: must be alike")
    for name, values in (("radius", samples.radius), ("mass", samples.mass)):
        if values is not None and values.shape != shape[1:2]:
            raise EventsimError(f"{samples.source}: {name} {values.shape} of {shape[1]} disks: must be ({shape[1]},)")
        if values is not None and not np.all(values >= 0.0):
            raise EventsimError(f"{samples.source}: {name} of disk {int(np.argmin(values >= 0.0))}: must be at least 0")
    for name, values in (("times", samples.times), ("positions", samples.position), ("velocities", samples.velocity)):
        if values is not None and not np.all(np.isfinite(values)):
            place = tuple(np.argwhere(~np.isfinite(values))[0].tolist())
            whose = f"of disk {place[1]} at time number {place[0]}" if len(place) > 1 else f"number {place[0]}"
            raise EventsimError(f"{samples.source}: {name} must be finite; {whose} there is {values[place]}")
    order = np.argsort(samples.times, kind="stable")
    times = samples.times[order]
    if np.any(np.diff(times) == 0.0):
        twice = times[:-1][np.diff(times) == 0.0][0]
        raise EventsimError(f"{samples.source}: holds the time {twice:g} twice")
    velocity = None if samples.velocity is None else samples.velocity[order]
    return replace(samples, times=times, position=samples.position[order], velocity=velocity)


def times_of_frames(source: str, told: list[float | None], dt: float | None) -> Floats:
    """The times of frames: as told, or every `dt`; EventsimError where neither is known."""
    known = [time for time in told if time is not None]
    if len(known) == len(told):
        return np.array(known, dtype=np.float64)
    if dt is None:
        raise EventsimError(f"{source}: frame {told.index(None)} tells no time: say the time between frames (--dt)")
    return dt * np.arange(len(told), dtype=np.float64)


def last_digit(values: NDArray[Any]) -> float:
    """About the last digit that numbers of a type have at the size of these; 0 for float64."""
    if values.dtype.kind != "f" or values.dtype.itemsize >= 8 or not values.size:
        return 0.0
    return float(np.finfo(values.dtype).eps) * float(np.abs(values).max())
