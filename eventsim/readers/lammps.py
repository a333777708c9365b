"""Files of LAMMPS, of systems in two dimensions: dumps (frames of atoms), and data files (one start).

Source of the formats: https://docs.lammps.org/dump.html, https://docs.lammps.org/read_data.html; positions are absolute there.
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

STYLES = {
    "atomic": ("id", "type", "x", "y", "z"),
    "charge": ("id", "type", "q", "x", "y", "z"),
    "molecular": ("id", "mol", "type", "x", "y", "z"),
    "full": ("id", "mol", "type", "q", "x", "y", "z"),
    "sphere": ("id", "type", "diameter", "density", "x", "y", "z"),
}
"""Columns of the section Atoms, by the style that its line names; three image flags may follow."""

SECTION = re.compile(r"([A-Z][A-Za-z ]*?)\s*(?:#\s*(\w+))?\s*$")


class Frame(NamedTuple):
    """One frame: the step, its time or None, (low, high) of the box along x and y, and columns by name, ordered by id."""

    step: int
    time: float | None
    box: Floats
    columns: dict[str, Floats]


def read_dump(path: Path, dt: float | None = None, least: int = 2) -> Samples:
    """The samples of a dump; dt: the time of one step of LAMMPS, where the dump has no ITEM: TIME and no column v_time.

    Raises:
        EventsimError: naming the file and the line.
    """
    lines = lines_of(path, EventsimError, "is not a LAMMPS dump")
    frames = list(_frames(path, lines))
    if not frames:
        raise EventsimError(f"{path}: holds no frame (ITEM: TIMESTEP)")
    first = frames[0].columns
    for number, frame in enumerate(frames):
        if not np.array_equal(frame.columns["id"], first["id"]):
            raise EventsimError(f"{path}: frame {number} holds other atoms than frame 0: must be the same")
    told = [frame.time if dt is None or frame.time is not None else dt * frame.step for frame in frames]
    position = np.stack([_places(path, frame) for frame in frames])
    moving = "vx" in first and "vy" in first
    velocity = np.stack([_two(frame, "vx", "vy") for frame in frames]) if moving else None
    radius = first["radius"] if "radius" in first else 0.5 * first["diameter"] if "diameter" in first else None
    times = times_of_frames(str(path), told, None)
    return checked(Samples(str(path), times, position, velocity, radius, first.get("mass")), least)


def _frames(path: Path, lines: list[str]) -> Iterator[Frame]:
    """The frames, one after the other."""
    place, count, step, time, box = 0, 0, 0, None, np.zeros((2, 2))
    while place < len(lines):
        item, _, rest = lines[place].removeprefix("ITEM: ").partition("  ")
        here, place = place + 1, place + 1
        try:
            if item.startswith("TIMESTEP"):
                step, time, place = int(lines[place]), None, place + 1
            elif item.startswith("TIME"):
                time, place = float(lines[place]), place + 1
            elif item.startswith("NUMBER OF ATOMS"):
                count, place = int(lines[place]), place + 1
            elif item.startswith("BOX BOUNDS"):
                if "xy" in item + rest:
                    raise EventsimError(f"{path} line {here}: the box is tilted: must have right angles")
                box = np.array([[float(word) for word in line.split()] for line in lines[place : place + 2]]).reshape(2, 2)
                place += 3
            elif item.startswith("ATOMS"):
                names = lines[here - 1].split()[2:]
                rows = [line.split() for line in lines[place : place + count]]
                if len(rows) < count or not count:
                    raise EventsimError(f"{path} line {here}: announces {count} atoms, and {len(rows)} lines follow")
                place += count
                columns = _numbers(path, here, names, rows)
                told = float(columns["v_time"][0]) if "v_time" in columns else time
                yield Frame(step, told, box, columns)
            elif lines[here - 1].startswith("ITEM: UNITS"):
                place += 1
            else:
                raise EventsimError(f"{path} line {here}: {lines[here - 1][:60]!r}: must be an ITEM of a dump")
        except (ValueError, IndexError):
            raise EventsimError(f"{path}: the item of line {here} is not as LAMMPS writes it") from None


def _numbers(path: Path, line: int, names: list[str], rows: list[list[str]]) -> dict[str, Floats]:
    """Columns of numbers by name, ordered by id; columns of texts are left out."""
    wrong = next((number for number, row in enumerate(rows) if len(row) < len(names)), None)
    if wrong is not None:
        raise EventsimError(f"{path} line {line + 1 + wrong}: has {len(rows[wrong])} words under {len(names)} names")
    if len(set(names)) < len(names):
        raise EventsimError(f"{path} line {line}: has a column twice: {' '.join(names)}")
    columns: dict[str, Floats] = {}
    for place, name in enumerate(names):
        try:
            columns[name] = np.array([row[place] for row in rows], dtype=np.float64)
        except ValueError:
            if name not in ("element", "typelabel"):
                raise EventsimError(f"{path}: the atoms from line {line} on: {name} must be numbers") from None
    order = np.argsort(columns.setdefault("id", np.arange(len(rows), dtype=np.float64)), kind="stable")
    ordered = {name: column[order] for name, column in columns.items()}
    if np.any(np.diff(ordered["id"]) == 0.0):
        raise EventsimError(f"{path}: the atoms from line {line} on: an id is there twice")
    return ordered


def _two(frame: Frame, x: str, y: str) -> Floats:
    return np.stack([frame.columns[x], frame.columns[y]], axis=-1)


def _places(path: Path, frame: Frame) -> Floats:
    """Positions (n, 2), unwrapped where the dump tells images."""
    low, size = frame.box[:, 0], frame.box[:, 1] - frame.box[:, 0]
    known = frame.columns
    if "xu" in known and "yu" in known:
        return _two(frame, "xu", "yu")
    if "xsu" in known and "ysu" in known:
        return low + size * _two(frame, "xsu", "ysu")
    if "x" in known and "y" in known:
        place = _two(frame, "x", "y")
    elif "xs" in known and "ys" in known:
        place = low + size * _two(frame, "xs", "ys")
    else:
        raise EventsimError(f"{path}: the atoms have the columns {', '.join(known)}: must have x and y (or xs, xu, xsu)")
    return place + size * _two(frame, "ix", "iy") if "ix" in known and "iy" in known else place


def read_data(path: Path) -> Samples:
    """The one state of a data file, at time 0.

    Raises:
        EventsimError: naming the file and the line.
    """
    lines = lines_of(path, EventsimError, "is not a LAMMPS data file")
    count, style, tables = _sections(path, lines)
    if "Atoms" not in tables:
        raise EventsimError(f"{path}: has no section Atoms")
    at, rows = tables["Atoms"]
    if style is None:
        style = {5: "atomic", 8: "atomic", 7: "sphere", 10: "sphere"}.get(len(rows[0]) if rows else 0)
    if style not in STYLES:
        raise EventsimError(f"{path} line {at}: Atoms of the style {style}: must be one of {', '.join(STYLES)}")
    if len(rows) != count:
        raise EventsimError(f"{path} line {at}: {len(rows)} atoms follow, and {count} are announced")
    atoms = _numbers(path, at + 1, list(STYLES[style]), rows)
    if atoms["z"].any():
        raise EventsimError(f"{path} line {at}: not all atoms have z = 0: must be a system in two dimensions")
    velocity = mass = None
    if "Velocities" in tables:
        line, words = tables["Velocities"]
        told = _numbers(path, line + 1, ["id", "vx", "vy"], words)
        if not np.array_equal(told["id"], atoms["id"]):
            raise EventsimError(f"{path} line {line}: Velocities are of other atoms than Atoms: must be the same")
        velocity = np.stack([told["vx"], told["vy"]], axis=-1)[None]
    if "Masses" in tables:
        line, words = tables["Masses"]
        masses = {row[0]: row[1] for row in words if len(row) > 1}
        types = [str(int(kind)) for kind in atoms["type"].tolist()]
        if not masses.keys() >= set(types):
            raise EventsimError(f"{path} line {line}: Masses lack a type that Atoms have")
        mass = _numbers(path, line, ["mass"], [[masses[kind]] for kind in types])["mass"]
    elif style == "sphere":  # Source: https://docs.lammps.org/atom_style.html: the mass of a sphere of that density
        mass = atoms["density"] * np.pi / 6.0 * atoms["diameter"] ** 3
    radius = 0.5 * atoms["diameter"] if style == "sphere" else None
    place = np.stack([atoms["x"], atoms["y"]], axis=-1)[None]
    return checked(Samples(str(path), np.zeros(1), place, velocity, radius, mass), 1)


def _sections(path: Path, lines: list[str]) -> tuple[int, str | None, dict[str, tuple[int, list[list[str]]]]]:
    """The number of atoms, the style of the section Atoms, and the rows of each section with its line."""
    count, style, here = 0, None, ""
    tables: dict[str, tuple[int, list[list[str]]]] = {}
    for number, line in enumerate(lines[1:], 2):  # the first line is a title
        bare = line.partition("#")[0].strip()
        if not bare:
            continue
        if "xy xz yz" in bare:
            raise EventsimError(f"{path} line {number}: the box is tilted: must have right angles")
        header = re.fullmatch(r"(\d+)\s+atoms", bare)
        section = SECTION.fullmatch(line.strip())
        if header is not None:
            count = int(header[1])
        elif section is not None:
            here = section[1].strip()
            tables[here] = (number, [])
            style = section[2] if here == "Atoms" else style
        elif here:
            tables[here][1].append(bare.split())
    return count, style, tables
