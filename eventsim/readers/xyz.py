"""Frames of an .xyz file: plain, or extended (Properties, Time).

Source of the format: https://github.com/libAtoms/extxyz.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from eventsim.errors import EventsimError
from eventsim.readers.samples import Floats, Samples, checked, times_of_frames
from eventsim.reading import lines_of

PLAIN = "species:S:1:pos:R:3"
TIME = re.compile(r"(?:^|[\s,;])(?:time|t)\s*=\s*\"?([^\s\",;]+)", re.IGNORECASE)
PROPERTIES = re.compile(r"(?:^|\s)properties\s*=\s*\"?([^\s\"]+)", re.IGNORECASE)
VELOCITIES = ("velo", "vel", "velocity", "velocities")
RADII, MASSES = ("radius", "radii"), ("mass", "masses")


class Frame(NamedTuple):
    """One frame: its time, None where none is told, and its columns by name, each (n, k)."""

    time: float | None
    columns: dict[str, Floats]


def read_xyz(path: Path, dt: float | None = None, least: int = 2) -> Samples:
    """The samples of a file; dt: the time between frames where they tell none.

    Raises:
        EventsimError: naming the file and the line.
    """
    lines = lines_of(path, EventsimError, "is not an xyz file")
    frames = list(_frames(path, lines))
    if not frames:
        raise EventsimError(f"{path}: holds no frame")
    counts = [len(frame.columns["pos"]) for frame in frames]
    if len(set(counts)) > 1:
        other = next(k for k, count in enumerate(counts) if count != counts[0])
        raise EventsimError(f"{path}: frame 0 has {counts[0]} disks and frame {other} has {counts[other]}: must be the same")
    names = frames[0].columns
    velocity = next((name for name in VELOCITIES if all(name in frame.columns for frame in frames)), None)
    times = times_of_frames(str(path), [frame.time for frame in frames], dt)
    position = np.stack([frame.columns["pos"][:, :2] for frame in frames])
    speeds = None if velocity is None else np.stack([frame.columns[velocity][:, :2] for frame in frames])
    radius, mass = (next((names[name][:, 0] for name in words if name in names), None) for words in (RADII, MASSES))
    return checked(Samples(str(path), times, position, speeds, radius, mass), least)


def _frames(path: Path, lines: list[str]) -> Iterator[Frame]:
    """The frames, one after the other."""
    first = 0
    while first < len(lines):
        if not lines[first].strip():
            first += 1
            continue
        try:
            n = int(lines[first])
        except ValueError:
            raise EventsimError(f"{path} line {first + 1}: {lines[first][:40]!r}: must be a number of disks") from None
        if not 0 < n <= len(lines) - first - 2:
            raise EventsimError(f"{path} line {first + 1}: announces {n} disks, and {len(lines) - first - 2} lines follow")
        comment, rows = lines[first + 1], [line.split() for line in lines[first + 2 : first + 2 + n]]
        yield Frame(_time(path, first + 2, comment), _columns(path, first + 3, comment, rows))
        first += 2 + n


def _time(path: Path, line: int, comment: str) -> float | None:
    """The time of a frame, None where none is told."""
    found = TIME.search(comment)
    if found is None:
        return None
    try:
        return float(found[1])
    except ValueError:
        raise EventsimError(f"{path} line {line}: time = {found[1]!r}: must be a number") from None


def _columns(path: Path, line: int, comment: str, rows: list[list[str]]) -> dict[str, Floats]:
    """The columns of numbers of a frame by name."""
    found = PROPERTIES.search(comment)
    words = (found[1] if found else PLAIN).split(":")
    columns: dict[str, Floats] = {}
    place = 0
    for name, kind, count in zip(words[::3], words[1::3], words[2::3], strict=False):
        width = int(count) if re.fullmatch("[1-9][0-9]{0,3}", count) else 1
        if kind in "RI":
            for number, row in enumerate(rows):
                if len(row) < place + min(width, 2):
                    raise EventsimError(f"{path} line {line + number}: has {len(row)} words, too few for {name}")
            try:
                columns[name.lower()] = np.array([row[place : place + width] for row in rows], dtype=np.float64)
            except ValueError:
                raise EventsimError(f"{path}: the frame from line {line} on: {name} must be numbers") from None
        place += width
    if "pos" not in columns or columns["pos"].shape[1] < 2:
        raise EventsimError(f"{path} line {line - 1}: Properties lack pos")
    return columns
