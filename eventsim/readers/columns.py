"""From named columns to samples: one row for each disk and time, one row for each time, or arrays of all disks.

    time, disk, x, y [, vx, vy] [, radius, mass]     a row for each disk and time; without `disk`: in one order at each time
    time, x0, y0, x1, y1, ... [, vx0, vy0, ...]      a row for each time; from x1 on as well
    time (T,), position (T, n, 2) [, velocity], or x, y (T, n) [, vx, vy]     arrays, in .npz

`t` is another name of `time`, `id` of `disk` (`read_columns`).
"""

from __future__ import annotations

import re
from collections.abc import Iterable

import numpy as np

from eventsim.errors import EventsimError
from eventsim.readers.samples import Column, Columns, Floats, Samples, checked, last_digit, times_of_frames
from eventsim.reading import NUMBERS, as_floats

WIDE = re.compile(r"x(\d+)")
"""The column of one disk in a row for each time."""


def samples_of(named: Columns, source: str, dt: float | None = None) -> Samples:
    """The samples that columns hold; EventsimError, naming the source, where they are of no such kind."""
    if "position" in named or ("x" in named and named["x"].ndim == 2):
        return _of_arrays(named, source, dt)
    if "x" in named and "y" in named:
        return _of_rows(named, source, dt)
    if any(WIDE.fullmatch(name) for name in named):
        return _of_times(named, source, dt)
    raise EventsimError(
        f"{source}: has the columns {', '.join(named)}; positions are time, disk, x, y (a row for each disk and time) "
        "or time, x0, y0, x1, y1, ... (a row for each time); in .npz arrays time (T,), position (T, n, 2) [, velocity (T, n, 2)]"
    )


def _of_arrays(named: Columns, source: str, dt: float | None) -> Samples:
    """Arrays of all times: position (T, n, 2 or 3), or x and y (T, n)."""
    if "position" in named:
        if named["position"].ndim != 3:
            raise EventsimError(f"{source}: position has the shape {named['position'].shape}: must be (T, n, 2)")
        position, velocity = _numbers(named, "position", source)[..., :2], None
        step = last_digit(named["position"])
        if "velocity" in named:
            velocity = _numbers(named, "velocity", source)[..., :2]
    else:
        shapes = {name: named[name].shape for name in ("x", "y", "vx", "vy") if name in named}
        if len(set(shapes.values())) > 1 or "y" not in named:
            raise EventsimError(f"{source}: x, y (and vx, vy) must be (T, n) all, not {shapes}")
        position, step = _stacked(named, ("x", "y"), source), last_digit(named["x"])
        velocity = _stacked(named, ("vx", "vy"), source) if "vx" in named and "vy" in named else None
    frames: list[float | None] = [None] * len(position)
    times = _numbers(named, "time", source) if "time" in named else times_of_frames(source, frames, dt)
    radius, mass = (_per_disk(named, name, source) for name in ("radius", "mass"))
    return checked(Samples(source, times, position, velocity, radius, mass, step=step))


def _per_disk(named: Columns, name: str, source: str) -> Floats | None:
    """Radius or mass of the disks, where it is told once for all times."""
    return _numbers(named, name, source) if name in named and named[name].ndim == 1 else None


def _of_rows(named: Columns, source: str, dt: float | None) -> Samples:
    """A row for each disk and time, or frame."""
    if "time" not in named and "frame" in named and dt is not None:
        named = {**named, "time": dt * _numbers(named, "frame", source)}
    if "time" not in named:
        raise EventsimError(f"{source}: lacks a column time (or frame, with the time between two of them: --dt)")
    demand_alike(named, ("time", "disk", "x", "y", "vx", "vy", "radius", "mass"), source)
    time = _numbers(named, "time", source)
    if len(time) == 0:
        raise EventsimError(f"{source}: holds no row")
    disk = _numbers(named, "disk", source) if "disk" in named else np.zeros(len(time))
    order = np.lexsort((disk, time))
    times, counts = np.unique(time, return_counts=True)
    n = int(counts[0])
    if np.any(counts != n):
        other = int(np.argmax(counts != n))
        raise EventsimError(
            f"{source}: holds {n} disks at the time {times[0]:g} and {counts[other]} at {times[other]:g}: must be the same"
        )
    counted = 0
    if "disk" in named:
        which = disk[order].reshape(-1, n)
        if np.any(which != which[0]) or np.any(np.diff(which[0]) <= 0.0):
            raise EventsimError(f"{source}: the column disk must name the same {n} disks at each time, each once")
        counted = int(which[0, 0]) if np.array_equal(which[0] - which[0, 0], np.arange(n)) else 0

    def of(name: str) -> Floats:
        return _numbers(named, name, source)[order].reshape(-1, n)

    position = np.stack([of("x"), of("y")], axis=-1)
    velocity = np.stack([of("vx"), of("vy")], axis=-1) if "vx" in named and "vy" in named else None
    radius, mass = (of(name)[0] if name in named else None for name in ("radius", "mass"))
    return checked(Samples(source, times, position, velocity, radius, mass, step=last_digit(named["x"]), counted=counted))


def _of_times(named: Columns, source: str, dt: float | None) -> Samples:
    """A row for each time; its disks may be counted from any number on."""
    numbers = [int(match[1]) for name in named if (match := WIDE.fullmatch(name))]
    disks = range(min(numbers), max(numbers) + 1)
    position = np.stack([_stacked(named, (f"x{i}", f"y{i}"), source) for i in disks], axis=1)
    moving = all(f"v{axis}{i}" in named for axis in "xy" for i in disks)
    velocity = np.stack([_stacked(named, (f"vx{i}", f"vy{i}"), source) for i in disks], axis=1) if moving else None
    frames: list[float | None] = [None] * len(position)
    times = _numbers(named, "time", source) if "time" in named else times_of_frames(source, frames, dt)
    step = last_digit(named[f"x{disks[0]}"])
    return checked(Samples(source, times, position, velocity, step=step, counted=disks[0]))


def _stacked(named: Columns, names: tuple[str, str], source: str) -> Floats:
    return np.stack([_numbers(named, name, source) for name in names], axis=-1)


def _numbers(named: Columns, name: str, source: str) -> Floats:
    """A column as numbers; EventsimError where it is missing or holds others."""
    if name not in named:
        raise EventsimError(f"{source}: lacks a column {name}")
    return numbers_of(named[name], name, source)


def demand_alike(named: Columns, names: Iterable[str], source: str) -> None:
    """Raise EventsimError where columns that share their rows have not one number for each."""
    shapes = {name: named[name].shape for name in names if name in named}
    if len(set(shapes.values())) > 1 or any(len(shape) != 1 for shape in shapes.values()):
        raise EventsimError(f"{source}: columns must be equally long, not {shapes}")


def numbers_of(column: Column, name: str, source: str) -> Floats:
    """A column as numbers; EventsimError, with the first row, where there are others in it."""
    if column.dtype.kind not in NUMBERS:
        raise EventsimError(f"{source}: {name} has values of the type {column.dtype}: must be numbers")
    try:
        return as_floats(column)
    except (ValueError, TypeError):
        for row, value in enumerate(column.ravel().tolist()):
            try:
                float(value)
            except (ValueError, TypeError):
                raise EventsimError(f"{source}: row {row}: {name} = {value!r}: must be a number{decimal_comma(value)}") from None
        raise EventsimError(f"{source}: {name} must be numbers") from None


def decimal_comma(value: object) -> str:
    """What to say of a number with a decimal comma."""
    return ", with a decimal point" if isinstance(value, str) and re.fullmatch(r"[-+]?\d*,\d+(e[-+]?\d+)?", value) else ""
