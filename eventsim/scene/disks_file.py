"""Disks from a table in a file: csv with a header, or npz."""

from __future__ import annotations

import csv
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import IO

import numpy as np

from eventsim.errors import SceneError
from eventsim.reading import Npz, reading
from eventsim.scene.cells import Indices
from eventsim.scene.disks import Disks, Floats
from eventsim.scene.gas import MOST_DISKS

COLUMNS = ("x", "y", "vx", "vy", "radius", "mass")

MOST_BYTES = 1 << 32
"""What a file may have: enough for as many disks as a scene may have."""


@dataclass(frozen=True, slots=True)
class DisksFile:
    """The disks of a file, and how to call the place of each: `row` is "line" or "row", `number` is (N,)."""

    disks: Disks
    row: str
    number: Indices


def read_disks_file(path: Path) -> DisksFile:
    """The disks of a file with the columns x, y, vx, vy, radius, mass; further columns are ignored.

    A file written by `eventsim state` will do if it holds one time.

    Raises:
        SceneError: naming the file, and the line where there is one.
    """
    packed = path.suffix.lower() == ".npz"
    what = "is not an npz file with arrays of numbers" if packed else "is not a table of disks"
    with reading(path, SceneError, what, MOST_BYTES) as file:
        columns, row, number = _read_npz(path, file) if packed else _read_csv(path, file)
    if "time" in columns:
        times = np.unique(columns["time"])
        if len(times) > 1:
            listed = ", ".join(str(time) for time in times[:3].tolist()) + (", ..." if len(times) > 3 else "")
            raise SceneError(
                f"{path}: holds the disks at {len(times)} times ({listed}); one start needs one time"
            )
    x, y, vx, vy, radius, mass = (columns[key] for key in COLUMNS)
    return DisksFile(Disks(np.stack([x, y], axis=1), np.stack([vx, vy], axis=1), radius, mass), row, number)


def write_disks_file(path: Path, disks: Disks) -> None:
    """Write disks as an .npz file; every bit of them is read back."""
    columns = (*disks.position.T, *disks.velocity.T, disks.radius, disks.mass)
    np.savez(path, **dict(zip(COLUMNS, columns, strict=True)))


def _read_csv(path: Path, file: IO[bytes]) -> tuple[dict[str, Floats], str, Indices]:
    """The columns by name, and the line of each row; lines that begin with # are comments."""
    try:
        lines = file.read().decode("utf-8-sig").splitlines()
    except UnicodeDecodeError:
        raise SceneError(f"{path}: is not a text file (UTF-8)") from None
    number = [n for n, line in enumerate(lines, 1) if line.strip() and not line.startswith("#")]
    header = [name.strip() for name in next(csv.reader([lines[number[0] - 1]]))] if number else []
    _demand_columns(path, header)
    wanted = [*COLUMNS, *(["time"] if "time" in header else [])]
    places = [header.index(name) for name in wanted]
    number = number[1:]
    rows = [lines[n - 1] for n in number]
    if not rows:
        raise SceneError(f"{path}: has a header but no disks")
    try:
        table = np.loadtxt(rows, delimiter=",", usecols=places, comments=None, quotechar='"', ndmin=2)
    except ValueError:
        raise SceneError(_bad_lines(path, rows, number, wanted, places)) from None
    return dict(zip(wanted, table.T, strict=True)), "line", np.array(number)


def _bad_lines(
    path: Path, rows: list[str], number: list[int], wanted: list[str], places: list[int]
) -> list[str]:
    """What is wrong with the first lines that cannot be read."""
    problems: list[str] = []
    for n, cells in zip(number, csv.reader(rows), strict=False):
        for name, place in zip(wanted, places, strict=True):
            if place >= len(cells):
                problems.append(f"{path} line {n}: {name} is missing")
                continue
            try:
                float(cells[place])
            except ValueError:
                problems.append(f"{path} line {n}: {name} = {cells[place]!r}: must be a number")
        if len(problems) >= 5:
            return [*problems, f"{path}: the lines after line {n} were not looked at"]
    return problems or [f"{path}: cannot be read as comma-separated numbers"]


def _read_npz(path: Path, file: IO[bytes]) -> tuple[dict[str, Floats], str, Indices]:
    """The columns by name, and the index of each row."""
    if not zipfile.is_zipfile(file):
        raise SceneError(f"{path}: is not an npz file with arrays of numbers; a table of text is named .csv")
    arrays = Npz(file)
    _demand_columns(path, arrays.names)
    wanted = [*COLUMNS, *(["time"] if "time" in arrays.names else [])]
    longest = max(arrays.open(name).count for name in wanted)
    if longest > MOST_DISKS:
        raise SceneError(f"{path}: holds {longest} disks: must be at most {MOST_DISKS}")
    columns = {name: np.asarray(arrays.read(name), dtype=np.float64) for name in wanted}
    shapes = {name: array.shape for name, array in columns.items() if name != "time"}
    if len(set(shapes.values())) > 1 or len(shapes["x"]) != 1:
        listed = ", ".join(f"{name} {shape}" for name, shape in shapes.items())
        raise SceneError(f"{path}: the arrays must be one-dimensional and equally long, not {listed}")
    return columns, "row", np.arange(len(columns["x"]))


def _demand_columns(path: Path, header: list[str]) -> None:
    """Raise if a column is missing or there twice."""
    missing = [name for name in COLUMNS if name not in header]
    if missing:
        raise SceneError(
            f"{path}: lacks {', '.join(missing)}: the columns must be named {', '.join(COLUMNS)}"
        )
    twice = [name for name in COLUMNS if header.count(name) > 1]
    if twice:
        raise SceneError(f"{path}: has more than one column {', '.join(twice)}")
