"""Disks from a file: a table (csv with a header, npz), or one frame of a format of molecular dynamics."""

from __future__ import annotations

import csv
import zipfile
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

import numpy as np

from eventsim import suffixes
from eventsim.errors import EventsimError, SceneError
from eventsim.readers import read_start
from eventsim.readers.columns import decimal_comma
from eventsim.reading import Npz, as_floats, no_text, reading
from eventsim.scene.cells import Indices
from eventsim.scene.disks import USUAL, Disks
from eventsim.scene.domain import Domain
from eventsim.scene.gas import MOST_DISKS

COLUMNS = ("x", "y", "vx", "vy", "radius", "mass")
SPECIES = "species"
"""A column of texts that may be there."""

TURNING = tuple(USUAL)
"""Columns that a file of disks with spin has besides."""

DEFAULTS = {"vx": 0.0, "vy": 0.0, "mass": 1.0, **USUAL}
"""What disks have where a file lacks a column, as in [[disk]]."""

MOST_BYTES = 1 << 32
"""What a file may have: enough for as many disks as a scene may have."""


@dataclass(frozen=True, slots=True)
class DisksFile:
    """The disks of a file, and how to call the place of each: `row` is "line" or "row", `number` is (N,)."""

    disks: Disks
    row: str
    number: Indices


def read_disks_file(
    path: Path, domain: Domain | None = None, frame: int | None = None, radius: float | None = None, mass: float | None = None
) -> DisksFile:
    """The disks of a file with the columns x, y, vx, vy, radius, mass, spin, moment, species; further columns are ignored.

    All but x, y and radius may be missing, as in [[disk]].  A file written by `eventsim state` will do if it holds one time.

    Args:
        path: a file that ends as one of `suffixes.STARTS`.
        domain: in which the disks are put; None: not known.
        frame: which frame of an .xyz, .gsd or LAMMPS file, from 0 on, or from -1 back.
        radius, mass: of disks of which the file tells none.

    Raises:
        SceneError: naming the file, and the line where there is one.
    """
    suffix = path.suffix.lower()
    given = DEFAULTS | {key: value for key, value in (("radius", radius), ("mass", mass)) if value is not None}
    if suffix in suffixes.STARTS and suffix not in (".csv", ".npz"):
        return _read_frame(path, domain, frame, given)
    if frame is not None:
        raise SceneError(f"{path}: frame = {frame}: a table has no frames; it holds one time")
    packed = path.suffix.lower() == ".npz"
    what = "is not an npz file with arrays of numbers" if packed else "is not a table of disks"
    with reading(path, SceneError, what, MOST_BYTES) as file:
        columns, row, number = (_read_npz if packed else _read_csv)(path, file, given)
    if "time" in columns:
        times = np.unique(columns["time"])
        if len(times) > 1:
            listed = ", ".join(str(time) for time in times[:3].tolist()) + (", ..." if len(times) > 3 else "")
            raise SceneError(
                f"{path}: holds the disks at {len(times)} times ({listed}); one start needs one time"
            )
    every = (*COLUMNS, *TURNING)
    x, y, vx, vy, r, m, *turning = (columns[key] if key in columns else np.full(len(columns["x"]), given[key]) for key in every)
    disks = Disks(np.stack([x, y], axis=1), np.stack([vx, vy], axis=1), r, m, columns.get(SPECIES), *turning)
    return DisksFile(disks, row, number)


def _read_frame(path: Path, domain: Domain | None, frame: int | None, given: dict[str, float]) -> DisksFile:
    """The disks of one frame, inside the period of the domain."""
    try:
        samples = read_start(path, frame)
    except EventsimError as error:
        raise SceneError(str(error)) from None
    size = None if domain is None else domain.size
    if domain is not None and size is not None:
        if samples.cell is not None and not np.allclose(samples.cell, size, rtol=1e-6):  # single precision
            raise SceneError(f"{path}: has the box {list(samples.cell)}, and the domain the size {list(size)}: must be alike")
        samples = samples.placed(domain.origin)
    position = samples.position[0].copy()
    for axis, period in enumerate((None, None) if domain is None else domain.period):
        if period is not None and domain is not None:
            low = domain.origin[axis]
            place = position[:, axis]
            inside = (place >= low) & (place < low + period)
            folded = low + np.mod(place - low, period)
            position[:, axis] = np.where(inside, place, np.where(folded < low + period, folded, low))
    if samples.radius is None and "radius" not in given:
        raise SceneError(f"{path}: tells no radius: say radius = 0.5 beside the path")
    radius = given["radius"] if samples.radius is None else samples.radius
    velocity = None if samples.velocity is None else samples.velocity[0]
    mass = given["mass"] if samples.mass is None else samples.mass
    return DisksFile(Disks(position, velocity, radius, mass), "atom", np.arange(samples.n))


def write_disks_file(path: Path, disks: Disks) -> None:
    """Write disks as an .npz file; every bit of them is read back."""
    columns = (*disks.position.T, *disks.velocity.T, disks.radius, disks.mass)
    others = {key: getattr(disks, key) for key in (SPECIES, *TURNING)}
    there: dict[str, Any] = {key: column for key, column in others.items() if column is not None}
    np.savez(path, **there, **dict(zip(COLUMNS, columns, strict=True)))


def _read_csv(path: Path, file: IO[bytes], given: dict[str, float]) -> tuple[dict[str, Any], str, Indices]:
    """The columns by name, and the line of each row; lines that begin with # are comments."""
    data = file.read()
    try:
        lines = data.decode("utf-8-sig").splitlines()
    except UnicodeDecodeError as error:
        raise SceneError(f"{path}: {no_text(data, error)}") from None
    number = [n for n, line in enumerate(lines, 1) if line.strip() and not line.startswith("#")]
    first = lines[number[0] - 1] if number else ""
    between = next((mark for mark in ",;\t" if mark in first), ",")
    header = [name.strip() for name in next(csv.reader([first], delimiter=between))] if number else []
    wanted = _wanted_columns(path, header, given)
    places = [header.index(name) for name in wanted]
    number = number[1:]
    rows = [lines[n - 1] for n in number]
    if not rows:
        raise SceneError(f"{path}: has a header but no disks")
    try:
        table = np.loadtxt(rows, delimiter=between, usecols=places, comments=None, quotechar='"', ndmin=2)
    except ValueError:
        raise SceneError(_bad_lines(path, csv.reader(rows, delimiter=between), number, wanted, places)) from None
    columns: dict[str, Any] = dict(zip(wanted, table.T, strict=True))
    if SPECIES in header:
        place = header.index(SPECIES)
        split = csv.reader(rows, delimiter=between)
        columns[SPECIES] = np.array([cells[place].strip() if place < len(cells) else "" for cells in split])
    return columns, "line", np.array(number)


def _bad_lines(
    path: Path, rows: Iterable[list[str]], number: list[int], wanted: list[str], places: list[int]
) -> list[str]:
    """What is wrong with the first lines that cannot be read."""
    problems: list[str] = []
    for n, cells in zip(number, rows, strict=False):
        for name, place in zip(wanted, places, strict=True):
            if place >= len(cells):
                problems.append(f"{path} line {n}: {name} is missing")
                continue
            try:
                float(cells[place])
            except ValueError:
                problems.append(f"{path} line {n}: {name} = {cells[place]!r}: must be a number{decimal_comma(cells[place])}")
        if len(problems) >= 5:
            return [*problems, f"{path}: the lines after line {n} were not looked at"]
    return problems or [f"{path}: cannot be read as comma-separated numbers"]


def _read_npz(path: Path, file: IO[bytes], given: dict[str, float]) -> tuple[dict[str, Any], str, Indices]:
    """The columns by name, and the index of each row."""
    if not zipfile.is_zipfile(file):
        raise SceneError(f"{path}: is not an npz file with arrays of numbers; a table of text is named .csv")
    arrays = Npz(file)
    wanted = _wanted_columns(path, arrays.names, given)
    longest = max(arrays.open(name).count for name in wanted)
    if longest > MOST_DISKS:
        raise SceneError(f"{path}: holds {longest} disks: must be at most {MOST_DISKS}")
    columns: dict[str, Any] = {name: as_floats(arrays.read(name)) for name in wanted}
    if SPECIES in arrays.names:
        columns[SPECIES] = arrays.read(SPECIES)
    shapes = {name: array.shape for name, array in columns.items() if name != "time"}
    if len(set(shapes.values())) > 1 or len(shapes["x"]) != 1:
        listed = ", ".join(f"{name} {shape}" for name, shape in shapes.items())
        raise SceneError(f"{path}: the arrays must be one-dimensional and equally long, not {listed}")
    return columns, "row", np.arange(len(columns["x"]))


def _wanted_columns(path: Path, header: list[str], given: dict[str, float]) -> list[str]:
    """The columns to read; raise if one is missing that has no default, or there twice."""
    missing = [name for name in COLUMNS if name not in header and name not in given]
    if ("vx" in header) != ("vy" in header):
        missing.append("vy" if "vx" in header else "vx")
    if missing:
        raise SceneError(f"{path}: lacks {', '.join(missing)}: the columns must be named {', '.join(COLUMNS)}")
    twice = [name for name in (*COLUMNS, *TURNING) if header.count(name) > 1]
    if twice:
        raise SceneError(f"{path}: has more than one column {', '.join(twice)}")
    return [name for name in (*COLUMNS, *TURNING, "time") if name in header]
