"""Files of states: where all disks are at some times, as a table that a scene can start from."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from pathlib import Path
from typing import IO, TYPE_CHECKING

import numpy as np

from eventsim import suffixes
from eventsim.errors import EventsimError
from eventsim.record.events import Column, Floats, State
from eventsim.record.files.atomic import atomic_write
from eventsim.scene import Scene
from eventsim.scene.disks import species_among

if TYPE_CHECKING:
    from gsd.hoomd import Frame


STATE_COLUMNS = ("time", "disk", "x", "y", "vx", "vy", "radius", "mass")


def state_columns(scene: Scene, states: Sequence[State]) -> dict[str, Column]:
    """Return the columns of a table with one row per time and disk; radius and mass come from the scene."""
    count = len(scene.disks)
    position = np.concatenate([np.empty((0, 2)), *(state.position for state in states)])
    velocity = np.concatenate([np.empty((0, 2)), *(state.velocity for state in states)])
    return {
        "time": np.repeat(np.array([state.time for state in states]), count),
        "disk": np.tile(np.arange(count), len(states)),
        "x": position[:, 0],
        "y": position[:, 1],
        "vx": velocity[:, 0],
        "vy": velocity[:, 1],
        "radius": np.tile(scene.disks.radius, len(states)),
        "mass": np.tile(scene.disks.mass, len(states)),
    }


def write_states(path: str | PathLike[str], scene: Scene, states: Sequence[State]) -> None:
    """Write states to `path`: .csv (floats that read back as the same bits), .npz (one array per column), or
    .xyz or .gsd for other programs (see `exchange`).

    The file appears under its name only when whole. Raises EventsimError where it cannot be written.
    """
    file = Path(path)
    if file.suffix.lower() not in suffixes.STATES:
        raise EventsimError(f"{file}: a file of states ends in {', '.join(suffixes.STATES)}")
    if file.suffix.lower() in suffixes.EXCHANGE:
        write_exchange(file, scene, states)
        return
    columns = state_columns(scene, states)
    with atomic_write(file) as part, part.open("wb") as target:
        if file.suffix.lower() == ".npz":
            np.savez(target, allow_pickle=False, **columns)
        else:
            write_csv(target, columns)


def write_csv(target: IO[bytes], columns: dict[str, Column]) -> None:
    """Write columns as CSV with a header row; used for files and for standard output."""
    target.write((",".join(columns) + "\n").encode())
    words = (map(repr, column.tolist()) for column in columns.values())
    target.writelines(f"{','.join(line)}\n".encode() for line in zip(*words, strict=True))


THICKNESS = 1.0
"""The extent of the cell across the plane, where a format wants one."""


def write_exchange(path: Path, scene: Scene, states: Sequence[State]) -> None:
    """Write states to .xyz (extended XYZ, every bit) or .gsd (through its library, single precision).

    Species are numbered by (radius, mass), ascending.  Infinite masses are written as such in .xyz and as 0 in .gsd.
    Raises EventsimError for another suffix, a missing library, or a file that cannot be written.
    """
    suffix = path.suffix.lower()
    if suffix not in suffixes.EXCHANGE:
        raise EventsimError(f"{path}: a trajectory ends in {' or '.join(suffixes.EXCHANGE)}")
    with atomic_write(path) as part:
        if suffix == ".xyz":
            _write_xyz(part, scene, states)
        else:
            _write_gsd(part, scene, states)


def _cell(scene: Scene, states: Sequence[State]) -> tuple[Floats, Floats]:
    """(size, corner) of the cell: the domain, or on the open plane what holds all disks."""
    domain = scene.domain
    if domain.size is not None:
        return np.array(domain.size), np.array(domain.origin)
    places = np.concatenate([state.position for state in states])
    reach = scene.disks.radius.max()
    low, high = places.min(axis=0) - reach, places.max(axis=0) + reach
    return high - low, low


def _write_xyz(path: Path, scene: Scene, states: Sequence[State]) -> None:
    """Source of the format: https://github.com/libAtoms/extxyz."""
    size, corner = _cell(scene, states)
    width, height = (repr(value) for value in size.tolist())
    lattice = f"{width} 0.0 0.0 0.0 {height} 0.0 0.0 0.0 {THICKNESS!r}"
    origin = " ".join(repr(value) for value in [*corner.tolist(), 0.0])
    periodic = " ".join("T" if axis else "F" for axis in (*scene.domain.periodic, False))
    columns = "species:S:1:pos:R:3:velo:R:3:radius:R:1:mass:R:1"
    # letters that programs take for chemical elements would bring those colours and masses
    names = [f"D{number}" for number in species_among(scene.disks).of.tolist()]
    tails = [f"{r!r} {m!r}" for r, m in zip(scene.disks.radius.tolist(), scene.disks.mass.tolist(), strict=True)]
    with path.open("w", encoding="utf-8", newline="\n") as file:
        for state in states:
            file.write(f"{len(names)}\n")
            file.write(
                f'Lattice="{lattice}" Origin="{origin}" Properties={columns} pbc="{periodic}" Time={float(state.time)!r}\n'
            )
            rows = zip(names, state.position.tolist(), state.velocity.tolist(), tails, strict=True)
            file.writelines(
                f"{name} {x!r} {y!r} 0.0 {vx!r} {vy!r} 0.0 {tail}\n" for name, (x, y), (vx, vy), tail in rows
            )


def _write_gsd(path: Path, scene: Scene, states: Sequence[State]) -> None:
    """Source of the format: https://gsd.readthedocs.io; positions count from the middle of the cell."""
    try:
        import gsd.hoomd
    except ImportError:
        raise EventsimError(
            "a .gsd file is written by the gsd library: pip install 'eventsim-disks[structure]'"
        ) from None
    size, corner = _cell(scene, states)
    with gsd.hoomd.open(name=str(path), mode="w") as file:
        for number, state in enumerate(states):
            file.append(_frame(gsd.hoomd.Frame(), number, scene, state, size, corner))


def _frame(frame: Frame, number: int, scene: Scene, state: State, size: Floats, corner: Floats) -> Frame:
    disks = scene.disks
    count, flat = len(disks), np.zeros(len(disks))
    species = species_among(scene.disks).of
    mass = np.where(np.isfinite(disks.mass), disks.mass, 0.0)
    frame.configuration.step = number
    frame.configuration.dimensions = 2
    frame.configuration.box = [*size.tolist(), THICKNESS, 0.0, 0.0, 0.0]
    frame.particles.N = count
    frame.particles.position = np.column_stack([state.position - corner - 0.5 * size, flat])
    frame.particles.velocity = np.column_stack([state.velocity, flat])
    frame.particles.mass = mass
    frame.particles.diameter = 2.0 * disks.radius
    frame.particles.types = [f"D{kind}" for kind in range(int(species.max()) + 1)]
    frame.particles.typeid = species
    frame.log["time"] = np.array([state.time])
    return frame
