"""Files of states for other programs: extended XYZ (ASE, OVITO, freud), GSD (HOOMD, OVITO, freud), dumps of LAMMPS."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from eventsim import suffixes
from eventsim.errors import EventsimError
from eventsim.record.events import Floats, State
from eventsim.record.files.atomic import atomic_write
from eventsim.replay.flight_table import Indices
from eventsim.scene import Scene
from eventsim.scene.disks import species_among

if TYPE_CHECKING:
    from gsd.hoomd import Frame

THICKNESS = 1.0
"""The extent of the cell across the plane, where a format wants one."""

ELEMENTS = "".join(
    (
        "Ar Kr Ne Xe He Rn Li Be B C N O F Na Mg Al Si P S Cl K Ca Sc Ti V Cr Mn Fe Co Ni Cu Zn Ga Ge As Se Br Rb Sr Y Zr Nb Mo ",
        "Tc Ru Rh Pd Ag Cd In Sn Sb Te I Cs Ba La Ce Pr Nd Pm Sm Eu Gd Tb Dy Ho Er Tm Yb Lu Hf Ta W Re Os Ir Pt Au Hg Tl Pb Bi",
    )
).split()
"""What species are called in .xyz, where programs know chemical elements alone: hard disks are noble gases first."""


def write_exchange(path: Path, scene: Scene, states: Sequence[State], images: Indices | None = None) -> None:
    """Write states to .xyz (extended XYZ, every bit), .gsd (through its library, single precision), or a dump of LAMMPS.

    Species are numbered by (radius, mass), ascending.  Infinite masses are written as such, in .gsd as 0.  images: (T, N, 2),
    for .gsd and dumps.  Raises EventsimError for another suffix, a missing library, or a file that cannot be written.
    """
    suffix = path.suffix.lower()
    if suffix not in suffixes.EXCHANGE:
        raise EventsimError(f"{path}: a trajectory ends in {' or '.join(suffixes.EXCHANGE)}")
    with atomic_write(path) as part:
        if suffix == ".xyz":
            _write_xyz(part, scene, states)
        elif suffix == ".gsd":
            _write_gsd(part, scene, states, images)
        else:
            _write_dump(part, scene, states, images)


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
    """Source of the format: https://github.com/libAtoms/extxyz; `masses` is what ASE calls them, `mass` what others do."""
    size, corner = _cell(scene, states)
    width, height = (repr(value) for value in size.tolist())
    lattice = f"{width} 0.0 0.0 0.0 {height} 0.0 0.0 0.0 {THICKNESS!r}"
    origin = " ".join(repr(value) for value in [*corner.tolist(), 0.0])
    periodic = " ".join("T" if axis else "F" for axis in (*scene.domain.periodic, False))
    columns = "species:S:1:pos:R:3:velo:R:3:radius:R:1:mass:R:1:masses:R:1"
    names = [ELEMENTS[number % len(ELEMENTS)] for number in species_among(scene.disks).of.tolist()]
    tails = [f"{r!r} {m!r} {m!r}" for r, m in zip(scene.disks.radius.tolist(), scene.disks.mass.tolist(), strict=True)]
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


def _write_dump(path: Path, scene: Scene, states: Sequence[State], images: Indices | None) -> None:
    """Source of the format: https://docs.lammps.org/dump.html.

    The time stands in a column, as a variable does there: MDAnalysis cannot read an ITEM: TIME.
    """
    size, corner = _cell(scene, states)
    flags = ["pp" if axis else "ff" for axis in scene.domain.periodic]
    bounds = "".join(f"{low!r} {high!r}\n" for low, high in zip(corner.tolist(), (corner + size).tolist(), strict=True))
    kinds = (species_among(scene.disks).of + 1).tolist()
    radius, mass = scene.disks.radius.tolist(), scene.disks.mass.tolist()
    names = "id type x y z vx vy vz radius mass v_time" + ("" if images is None else " ix iy iz")
    with path.open("w", encoding="utf-8", newline="\n") as file:
        for number, state in enumerate(states):
            file.write(f"ITEM: TIMESTEP\n{number}\nITEM: NUMBER OF ATOMS\n{len(kinds)}\n")
            file.write(f"ITEM: BOX BOUNDS {flags[0]} {flags[1]} pp\n{bounds}{-THICKNESS / 2!r} {THICKNESS / 2!r}\n")
            file.write(f"ITEM: ATOMS {names}\n")
            time = repr(float(state.time))
            gone = [""] * len(kinds) if images is None else [f" {i} {j} 0" for i, j in images[number].tolist()]
            rows = zip(kinds, state.position.tolist(), state.velocity.tolist(), radius, mass, gone, strict=True)
            file.writelines(
                f"{i} {kind} {x!r} {y!r} 0.0 {vx!r} {vy!r} 0.0 {r!r} {m!r} {time}{image}\n"
                for i, (kind, (x, y), (vx, vy), r, m, image) in enumerate(rows, 1)
            )


def _write_gsd(path: Path, scene: Scene, states: Sequence[State], images: Indices | None) -> None:
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
            frame = _frame(gsd.hoomd.Frame(), number, scene, state, size, corner)
            if images is not None:
                frame.particles.image = np.column_stack([images[number], np.zeros(len(scene.disks), np.int64)])
            file.append(frame)


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
