"""Where a log comes from: the scene it tells about, what wrote it, and where the telling ends."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from eventsim.errors import LogError, SceneError
from eventsim.record.events import COMPACT_COLUMNS, Kind, Rows, columns_of
from eventsim.scene import Scene
from eventsim.scene.corner import least_starting_place
from eventsim.scene.files import listed_scene, scene_beside_disks, scene_to_json
from eventsim.scene.numbers import Point, point

FORMAT = 2
"""Version of the file format; format 1, of eventsim 0.1, is read as well."""

BITS = 2
"""Version of the rules that make the bits of a log; it goes up when a rule changes what any scene writes.  Version 0.1 had 1."""

UNCHECKED = "a log of format 1 does not vouch for its scene: nothing tells whether a mass, a start or a row was changed since"

SUM = "metadata_digest"
"""The last key of the metadata; see `metadata_digest`."""

BEFORE_SCENE = '{"scene": '

Kick = tuple[int, float, float]
"""Event number and the velocity that was set."""


@dataclass(frozen=True, slots=True)
class Ending:
    """Where a run ended: the exact clock (epoch, remainder) and the reason in one word.

    digest: of its full rows (`record.digest`); None where nobody computed it.  stored: of its rows as the file has them, by which
    a reader notices that they were changed; None in format 1.  Both follow from the rows, so endings that differ in nothing else
    are equal.
    """

    epoch: int
    remainder: float
    reason: str
    digest: str | None = field(default=None, compare=False)
    stored: str | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class Provenance:
    """What a log carries besides its rows.

    scene: the realised scene, every disk listed. epoch_length: a power of two, time. wall_names: what the column
    `wall` counts. command: the command line or call that ran it, where known. kicks: velocities that were set from outside,
    which a compact log cannot compute. ending: None while the run goes on. rows: their number, None while it grows. bits: the
    version of the rules that made them. corner: what places in rows are relative to; None: what the scene has by these rules.
    """

    scene: Scene
    engine: str
    version: str
    epoch_length: float
    wall_names: tuple[str, ...]
    command: str | None = None
    compact: bool = False
    kicks: tuple[Kick, ...] = ()
    ending: Ending | None = None
    rows: int | None = None
    bits: int = BITS
    corner: Point | None = None

    def finished(self, ending: Ending | None, kicks: tuple[Kick, ...], rows: int) -> Provenance:
        """Return the provenance of the whole log."""
        return replace(self, ending=ending, kicks=kicks, rows=rows)


def columns_kept(provenance: Provenance) -> tuple[str, ...]:
    """Return the names of the columns that a log has, in order."""
    return COMPACT_COLUMNS if provenance.compact else columns_of(has_spin(provenance.scene))


def has_spin(scene: Scene) -> bool:
    """Whether the disks of a scene turn, so that its rows tell their spins."""
    return scene.tangential_restitution is not None


class Recorded(NamedTuple):
    """A log as it is kept: where its rows come from, and the rows; of a compact one what replay computes is missing."""

    provenance: Provenance
    rows: Rows


def kicks_of(rows: Rows) -> list[Kick]:
    """Return the velocities that rows of full logs set, in order."""
    chosen = rows[rows["kind"] == Kind.KICK]
    return list(zip(chosen["event"].tolist(), chosen["vxa"].tolist(), chosen["vya"].tolist(), strict=True))


def provenance_text(provenance: Provenance, scene: str | None = None) -> str:
    """Return the provenance as one line of JSON (ASCII only, so that characters are bytes).

    scene: its scene as JSON, where that is known.
    """
    return BEFORE_SCENE + (scene or scene_to_json(provenance.scene)) + text_after_scene(provenance)


def text_after_scene(provenance: Provenance) -> str:
    """Return what of that line comes after the scene: the one part that the end of a run changes."""
    ending = provenance.ending
    data = {
        "format": FORMAT,
        "version": provenance.version,
        "engine": provenance.engine,
        "command": provenance.command,
        "bits": provenance.bits,
        "epoch_length": provenance.epoch_length,
        "corner": provenance.corner,
        "wall_names": list(provenance.wall_names),
        "scene_digest": scene_digest(provenance),
        "compact": provenance.compact,
        "kicks": [list(kick) for kick in provenance.kicks],
        "ending": None
        if ending is None
        else {
            "epoch": ending.epoch,
            "remainder": ending.remainder,
            "reason": ending.reason,
            "digest": ending.digest,
            "stored": ending.stored,
        },
        "rows": provenance.rows,
    }
    return f", {json.dumps({**data, SUM: metadata_digest(data)})[1:]}"


def provenance_from_text(text: str, source: str, folder: Path | None = None) -> Provenance:
    """Read what `provenance_text` wrote.  No file that it names is opened.

    Args:
        text: one line of JSON.
        source: what messages call the file that it comes from.
        folder: of a journal, where the disks of its scene are.

    Raises:
        LogError: for anything else.
    """
    try:
        data = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise LogError(f"{source}: not an event log: its metadata is not JSON ({error})") from None
    if not isinstance(data, dict) or "scene" not in data or "format" not in data:
        raise LogError(f"{source}: not an event log: no metadata with the keys scene and format")
    if data["format"] not in (1, FORMAT):
        raise LogError(
            f"{source}: written in log format {data['format']!r}; this version of eventsim reads the formats 1 and {FORMAT}"
        )
    try:
        scene = listed_scene(data["scene"], folder)
    except SceneError as error:
        raise LogError(f"{source}: the scene inside the log is damaged: {error}") from None
    try:
        provenance = _provenance(data, scene)
        if data["format"] == FORMAT and data["scene_digest"] != scene_digest(provenance):
            raise LogError(
                f"{source}: its scene is not the one of its run: a disk, a wall, a rule or the frame of the clock was changed "
                "since. Take the file as it was written, or run the scene again"
            )
        if data["format"] == FORMAT and data[SUM] != metadata_digest(data):
            raise LogError(
                f"{source}: its metadata are not those that its run wrote: what wrote it, a kick, the ending or the number of "
                "rows was changed since. Take the file as it was written, or run the scene again"
            )
        return provenance
    except (KeyError, TypeError, ValueError, OverflowError) as error:
        why = f" ({error})" if isinstance(error, ValueError) else ""
        raise LogError(f"{source}: the metadata of the log are damaged{why}") from None


def _provenance(data: Mapping[str, Any], scene: Scene) -> Provenance:
    ending = data["ending"]
    epoch_length = float(data["epoch_length"])
    if not (epoch_length > 0 and math.frexp(epoch_length)[0] == 0.5):
        raise ValueError(f"epoch_length {epoch_length!r} is not a power of two")
    return Provenance(
        scene=scene,
        engine=str(data["engine"]),
        version=str(data["version"]),
        epoch_length=epoch_length,
        wall_names=tuple(str(name) for name in data["wall_names"]),
        command=None if data["command"] is None else str(data["command"]),
        compact=bool(data["compact"]),
        kicks=tuple((int(event), float(vx), float(vy)) for event, vx, vy in data["kicks"]),
        ending=None if ending is None else _ending(ending, data["format"]),
        rows=None if data["rows"] is None else int(data["rows"]),
        **_rules(data, scene),
    )


def _rules(data: Mapping[str, Any], scene: Scene) -> dict[str, Any]:
    """The rules that made the bits, and the corner that places are relative to; format 1 had one of each."""
    if data["format"] == 1:
        return {"bits": 1, "corner": least_starting_place(scene.disks, scene.domain)}
    corner = data["corner"]
    return {"bits": int(data["bits"]), "corner": None if corner is None else point(corner, "corner")}


def scene_digest(provenance: Provenance) -> str:
    """Return the SHA-256 of all that rows are read by: scene, frame of the clock, corner, walls, version of the rules."""
    scene, frame = provenance.scene, provenance
    disks = scene.disks
    sha = hashlib.sha256(scene_beside_disks(scene).encode())
    columns = (disks.position, disks.velocity, disks.radius, disks.mass, disks.spin, disks.moment)
    for column in (column for column in columns if column is not None):
        sha.update(np.ascontiguousarray(column, "<f8").data)
    if disks.species is not None:
        sha.update(json.dumps(disks.species.tolist()).encode())
    sha.update(json.dumps([frame.bits, frame.epoch_length, frame.corner, list(frame.wall_names)]).encode())
    return sha.hexdigest()


def metadata_digest(data: Mapping[str, Any]) -> str:
    """Return the SHA-256 of the metadata beside the scene, whose digest is among them, and the command, which nothing reads."""
    beside = {key: value for key, value in data.items() if key not in ("scene", "command", SUM)}
    return hashlib.sha256(json.dumps(beside).encode()).hexdigest()


def _ending(data: Mapping[str, Any], form: int) -> Ending:
    digest = data["digest"] if form == FORMAT else None  # that of format 1 was another sum
    return Ending(
        epoch=int(data["epoch"]),
        remainder=float(data["remainder"]),
        reason=str(data["reason"]),
        digest=None if digest is None else str(digest),
        stored=None if data.get("stored") is None else str(data["stored"]),
    )
