"""Checkpoints: all that a run needs to go on after it was stopped, or killed, in one file that is replaced as a whole.

The file is an .npz without pickled objects, whatever its name: the array `eventsim` holds JSON (scene, version, stop, counters,
how far the log had come, and how the snapshot's fields are packed), the other arrays its numbers.
"""

from __future__ import annotations

import json
import os
from contextlib import suppress
from dataclasses import asdict, dataclass, fields
from math import inf, isfinite
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from eventsim import __version__
from eventsim.engines.base import Counters, Snapshot, Stop
from eventsim.errors import CheckpointError, LogError
from eventsim.reading import Npz, reading
from eventsim.record.digest import CHUNK, Progress, record_of
from eventsim.record.events import Kind, Rows, row_of
from eventsim.record.files import Mark
from eventsim.record.files.atomic import demand_place
from eventsim.record.provenance import BITS, Provenance, has_spin, provenance_from_text
from eventsim.runner.snapshots import Arrays, demand_fit, packed, unpacked
from eventsim.scene.numbers import as_whole
from eventsim.scene.stage import stage_of

FORMAT = 2
"""Version of the file format."""

METADATA, LAST_ROWS = "eventsim", "last_rows"
CHUNKS, RECORDS = "digest_chunks", "digest_records"
"""Arrays of a run with a compact log: how far its digest has come."""

TEMPORARY = ".part~"
"""After the name of a checkpoint in the making; NAME.part is what its run claims."""

HASH = 32
"""Bytes of a SHA-256."""

SECONDS = {"min": 60.0, "s": 1.0, "h": 3600.0}
"""Units of time in which an interval can be given."""


@dataclass(frozen=True, slots=True)
class Every:
    """How often a checkpoint is written: after so many events, or so many seconds of the stopwatch."""

    events: int | None = None
    seconds: float | None = None


def interval(every: float | str) -> Every:
    """How often a checkpoint is written, from a number of events (1000000, "1000000") or a time ("90s", "5min", "2h").

    Raises CheckpointError for anything else.
    """
    if (whole := as_whole(every)) is not None and whole >= 1:
        return Every(events=whole)
    text = str(every).strip()
    unit = next((unit for unit in SECONDS if text.endswith(unit)), "")
    number = text.removesuffix(unit).strip()
    with suppress(ValueError, OverflowError):
        if not unit and int(number) >= 1:
            return Every(events=int(number))
        if unit and 0.0 <= (seconds := float(number) * SECONDS[unit]) < inf:
            return Every(seconds=seconds)
    raise CheckpointError(f"every = {every!r}: must be a number of events, or a time such as 90s, 5min or 2h")


@dataclass(frozen=True, slots=True)
class KeptLog:
    """The log of the run: where it is, whether it is compact, how far it had come."""

    path: Path
    compact: bool
    mark: Mark


@dataclass(frozen=True, slots=True)
class Checkpoint:
    """A run between two of its events.

    provenance: of its rows, with the engine that was asked for.  stop: where it is to stop.  every: how often checkpoints were
    written.  log: None where none is kept.  last_rows: what a diagnosis of a collapse looks at, an array of ROW.  elapsed_s,
    write_s: seconds so far.  digest: of all rows, where the log is compact.
    """

    provenance: Provenance
    stop: Stop
    every: Every
    snapshot: Snapshot
    counters: Counters
    log: KeptLog | None
    last_rows: Rows
    elapsed_s: float
    write_s: float
    digest: Progress | None = None


def save_checkpoint(path: Path, checkpoint: Checkpoint, provenance: str) -> None:
    """Replace the file `path` as a whole, durably: after a crash of the machine it is the old or the new one.

    provenance: the text of that of the checkpoint, which is the same each time.  Raises CheckpointError.
    """
    arrays: Arrays = {LAST_ROWS: checkpoint.last_rows}
    saved = checkpoint.snapshot
    if checkpoint.digest is not None:
        arrays[CHUNKS] = np.frombuffer(checkpoint.digest.chunks, np.uint8)
        arrays[RECORDS] = checkpoint.digest.records.view(np.uint8)
    data = {
        "checkpoint": FORMAT,
        "stop": asdict(checkpoint.stop),
        "every": asdict(checkpoint.every),
        "log": None if checkpoint.log is None else _log_table(checkpoint.log, path),
        "counters": asdict(checkpoint.counters),
        "elapsed_s": checkpoint.elapsed_s,
        "write_s": checkpoint.write_s,
        "snapshot": {item.name: packed(item.name, getattr(saved, item.name), arrays) for item in fields(Snapshot)},
    }
    text = f'{{"provenance": {provenance}, {json.dumps(data)[1:]}'
    arrays[METADATA] = np.frombuffer(text.encode("ascii"), np.uint8)
    temporary = path.with_name(path.name + TEMPORARY)
    try:
        with temporary.open("wb") as file:
            np.savez(file, allow_pickle=False, **arrays)
            file.flush()
            os.fsync(file.fileno())
        os.replace(temporary, path)
        _settle(path.parent)
    except OSError as error:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)
        raise CheckpointError(f"{path}: cannot be written ({error.strerror or error})") from None


def _settle(directory: Path) -> None:
    """Have the new name on the disk, where the system lets a directory be synchronised."""
    with suppress(OSError):
        handle = os.open(directory, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def _log_table(log: KeptLog, path: Path) -> dict[str, Any]:
    """What the file says of the log: its place as seen from the checkpoint, so that both can be moved together."""
    place = os.path.relpath(log.path.resolve(), path.resolve().parent)
    return {"path": place, "compact": log.compact, "rows": log.mark.rows, "kicks": log.mark.kicks}


def load_checkpoint(path: str | PathLike[str]) -> Checkpoint:
    """Read a checkpoint.

    Raises CheckpointError with a sentence where the file is none, is damaged, or was written by another version of eventsim.
    """
    file = Path(path)
    with reading(file, CheckpointError, "not a checkpoint, or cut short or damaged") as opened:
        try:
            return _checkpoint(*_contents(Npz(opened), file), file)
        except LogError as error:
            raise CheckpointError(str(error)) from None


def place_for(path: str | PathLike[str]) -> Path:
    """Where checkpoints are to be written; CheckpointError for a file that is there and is none: it may be dear to somebody."""
    place = Path(path)
    demand_place(place, CheckpointError)
    if place.exists() and not _is_checkpoint(place):
        raise CheckpointError(f"{place}: is there and is not a checkpoint, so no checkpoint takes its place")
    return place


def _is_checkpoint(path: Path) -> bool:
    """Whether a file looks like a checkpoint."""
    try:
        with reading(path, CheckpointError, "not a checkpoint") as file:
            return {METADATA, LAST_ROWS} <= set(Npz(file).names)
    except CheckpointError:
        return False


def _contents(arrays: Npz, path: Path) -> tuple[dict[str, Any], Arrays]:
    """The metadata and the arrays; none is larger than the file."""
    if not {METADATA, LAST_ROWS} <= set(arrays.names):
        raise CheckpointError(f"{path}: not a checkpoint")
    if arrays.packed:
        raise ValueError("its arrays are compressed")
    data = json.loads(arrays.read(METADATA).tobytes().decode("ascii"))
    if not isinstance(data, dict) or data.get("checkpoint") != FORMAT:
        raise CheckpointError(f"{path}: not a checkpoint of format {FORMAT}, which this version of eventsim reads")
    return data, {name: arrays.read(name) for name in arrays.names if name != METADATA}


def _checkpoint(data: dict[str, Any], arrays: Arrays, path: Path) -> Checkpoint:
    provenance = data["provenance"]
    if provenance["version"] != __version__ or provenance["bits"] != BITS:
        raise CheckpointError(
            f"{path}: written by eventsim {provenance['version']} (bits {provenance['bits']}); this is eventsim {__version__} "
            f"(bits {BITS}), which may differ in the last bits, so the run has to be begun anew or continued with that version"
        )
    return Checkpoint(
        provenance=(kept := provenance_from_text(json.dumps(provenance), str(path))),
        stop=_stop(**data["stop"]),
        every=_every(**data["every"]),
        snapshot=_snapshot(data["snapshot"], arrays, kept),
        counters=_counters(data["counters"]),
        log=None if data["log"] is None else _kept_log(**data["log"], directory=path.resolve().parent),
        last_rows=_last_rows(arrays[LAST_ROWS], kept),
        elapsed_s=_seconds(data["elapsed_s"]),
        write_s=_seconds(data["write_s"]),
        digest=_progress(arrays, data, kept),
    )


def _progress(arrays: Arrays, data: dict[str, Any], provenance: Provenance) -> Progress | None:
    """How far the digest of a compact log has come; it is of as many rows as the log has."""
    if data["log"] is None or not data["log"]["compact"]:
        return None
    chunks, records = arrays[CHUNKS], arrays[RECORDS]
    if chunks.dtype != np.uint8 or records.dtype != np.uint8 or chunks.ndim != 1 or records.ndim != 1 or len(chunks) % HASH:
        raise ValueError("its digest is none")
    progress = Progress(chunks.tobytes(), np.frombuffer(records.tobytes(), record_of(has_spin(provenance.scene))))
    if len(chunks) // HASH * CHUNK + len(progress.records) != data["log"]["rows"] or len(progress.records) >= CHUNK:
        raise ValueError("its digest is that of another number of rows")
    return progress


def _stop(until: float | None, events: int | None) -> Stop:
    stop = Stop(None if until is None else float(until), None if events is None else int(events))
    if stop.until is not None and not isfinite(stop.until):
        raise ValueError(f"until = {until!r}")
    return stop


def _every(events: int | None, seconds: float | None) -> Every:
    every = Every(None if events is None else int(events), None if seconds is None else float(seconds))
    if (every.events is not None and every.events < 1) or (every.seconds is not None and not every.seconds >= 0.0):
        raise ValueError(f"every {every} is no interval")
    return every


def _kept_log(path: str, compact: bool, rows: int, kicks: list[list[float]], directory: Path) -> KeptLog:
    if int(rows) < 0:
        raise ValueError(f"{rows} rows")
    set_in_them = tuple((int(event), float(vx), float(vy)) for event, vx, vy in kicks)
    return KeptLog(Path(os.path.normpath(directory / path)), bool(compact), Mark(int(rows), set_in_them))


def _counters(data: dict[str, Any]) -> Counters:
    """Counters of the types that their defaults have: counts, amounts, and pairs of amounts."""
    usual, counters = Counters(), Counters(**data)
    for item in fields(Counters):
        value = getattr(counters, item.name)
        match getattr(usual, item.name):
            case int():
                fits = type(value) is int and 0 <= value < 2**62
            case float():
                fits = type(value) is float and isfinite(value)
            case _:
                fits = type(value) is list and list(map(type, value)) == [float, float] and all(map(isfinite, value))
        if not fits:
            raise ValueError(f"counter {item.name} = {value!r}")
    return counters


def _seconds(value: Any) -> float:
    if type(value) is not float or not 0.0 <= value < inf:
        raise ValueError(f"{value!r} seconds")
    return value


def _last_rows(rows: Rows, provenance: Provenance) -> Rows:
    """The last rows, whose numbers a diagnosis looks up in the scene."""
    if rows.dtype != row_of(has_spin(provenance.scene)) or rows.ndim != 1:
        raise ValueError("its last rows are not rows of a log")
    disks, walls = len(provenance.scene.disks), len(provenance.wall_names)
    for name, least, most in (("a", 0, disks), ("b", -1, disks), ("wall", -1, walls), ("kind", 0, len(Kind))):
        if np.any((rows[name] < least) | (rows[name] >= most)):
            raise ValueError(f"its last rows have {name} = {rows[name].tolist()}, which the scene has not"[:200])
    return rows


def _snapshot(forms: dict[str, Any], arrays: Arrays, provenance: Provenance) -> Snapshot:
    """The snapshot, which fits the scene: compiled engines trust it."""
    names = {item.name for item in fields(Snapshot)}
    if set(forms) != names:
        raise ValueError(f"its snapshot has other fields: {', '.join(sorted(set(forms) ^ names))}")
    snapshot = Snapshot(**{name: unpacked(form, arrays) for name, form in forms.items()})
    demand_fit(snapshot, stage_of(provenance.scene))
    return snapshot
