"""Files of states: where all disks are at some times, as a table that a scene can start from."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from pathlib import Path
from typing import IO

import numpy as np

from eventsim import suffixes
from eventsim.errors import EventsimError
from eventsim.record.events import Column, State
from eventsim.record.files.atomic import atomic_write
from eventsim.record.provenance import has_spin
from eventsim.replay.exchange import write_exchange
from eventsim.replay.flight_table import Indices
from eventsim.scene import Scene

STATE_COLUMNS = ("time", "disk", "x", "y", "vx", "vy", "radius", "mass")


def state_columns(scene: Scene, states: Sequence[State]) -> dict[str, Column]:
    """Return the columns of a table with one row per time and disk; radius and mass come from the scene."""
    count = len(scene.disks)
    position = np.concatenate([np.empty((0, 2)), *(state.position for state in states)])
    velocity = np.concatenate([np.empty((0, 2)), *(state.velocity for state in states)])
    species = scene.disks.species
    return {
        "time": np.repeat(np.array([state.time for state in states]), count),
        "disk": np.tile(np.arange(count), len(states)),
        "x": position[:, 0],
        "y": position[:, 1],
        "vx": velocity[:, 0],
        "vy": velocity[:, 1],
        "radius": np.tile(scene.disks.radius, len(states)),
        "mass": np.tile(scene.disks.mass, len(states)),
        **({} if species is None else {"species": np.tile(species, len(states))}),
        **_turning_columns(scene, states),
    }


def _turning_columns(scene: Scene, states: Sequence[State]) -> dict[str, Column]:
    """Spins, and moments, of a scene whose disks have them."""
    spins = [state.spin for state in states if state.spin is not None]
    if not has_spin(scene) or not spins:
        return {}
    return {"spin": np.concatenate(spins), "moment": np.tile(scene.disks.moments(), len(states))}


def write_states(
    path: str | PathLike[str], scene: Scene, states: Sequence[State], images: Indices | None = None
) -> None:
    """Write states to `path`: .csv (floats that read back as the same bits), .npz (one array per column), or
    .xyz, .gsd, .dump, .lammpstrj for other programs (see `exchange`).

    images: (T, N, 2), see `images`; those formats that have a place for them keep them.
    The file appears under its name only when whole. Raises EventsimError where it cannot be written.
    """
    file = Path(path)
    if file.suffix.lower() not in suffixes.STATES:
        raise EventsimError(f"{file}: a file of states ends in {', '.join(suffixes.STATES)}")
    if file.suffix.lower() in suffixes.EXCHANGE:
        write_exchange(file, scene, states, images)
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
    words = (map(str if column.dtype.kind == "U" else repr, column.tolist()) for column in columns.values())
    target.writelines(f"{','.join(line)}\n".encode() for line in zip(*words, strict=True))
