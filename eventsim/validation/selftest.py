"""Self-test: whether this machine, with what is installed on it, computes the bits that the package promises."""

from __future__ import annotations

import hashlib
import json
import math
import platform
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from importlib.resources import files
from time import monotonic
from typing import Any, NamedTuple

import numpy as np

from eventsim.compiler import has_compiler
from eventsim.engines import ENGINES
from eventsim.engines.base import Stop
from eventsim.engines.stepped.compiled import COMPILED, kernel
from eventsim.record.events import Rows
from eventsim.record.provenance import Recorded
from eventsim.replay.expand import expand_rows
from eventsim.replay.log import EventLog
from eventsim.runner.loop import run_scene
from eventsim.runner.options import RunOptions
from eventsim.scene import Disks, Periodic, Scene
from eventsim.scene.gallery import gallery, names
from eventsim.validation.versions import versions

TABLE = "digests.json"
"""Beside this file: what every machine must compute."""

EVENTS, GAS_EVENTS = 200, 4000
SECONDS = 55.0
"""By then all is said: kernels that may take longer, as long as the slowest so far, are told as not looked at."""

COLUMNS = ("kind", "a", "b", "wall", "epoch", "remainder", "xa", "ya", "vxa", "vya", "xb", "yb", "vxb", "vyb")


@dataclass(frozen=True, slots=True)
class Finding:
    """One question and its answer: `well`, `wrong`, or `open` where it could not be asked, and why."""

    question: str
    answer: str
    words: str = ""


class Entry(NamedTuple):
    """What is known of a scene: how it starts, and what its first events are."""

    start: str
    events: int
    rows: str


def selftest(seconds: float = SECONDS) -> Iterator[Finding]:
    """Ask all questions, one after the other."""
    until = monotonic() + seconds
    yield from arithmetic()
    known = {name: Entry(*entry) for name, entry in json.loads(_table()).items()}
    logs: dict[str, EventLog] = {}
    for name, scene in scenes():
        entry, (found, logs[name]) = known[name], told(name, scene)
        if found.start != entry.start:
            yield Finding(f"{name}: its log", "open", "NumPy draws other numbers here, so its start is another one")
        else:
            yield _judged(f"{name}: its log", found == entry, "its rows are not those of the table")
    for name, log in logs.items():
        replayed = expand_rows(replace(log.provenance, compact=True), log.rows)
        yield _judged(f"{name}: its replay", _rows_digest(replayed) == _rows_digest(log.rows), "it is another run")
    longest = 0.0
    for name in (GAS, *names()):
        began = monotonic()
        yield _engines_agree(name, logs[name], until - longest)
        longest = max(longest, monotonic() - began)


def arithmetic() -> Iterator[Finding]:
    """Floats as IEEE 754 has them: nothing fused, nothing flushed to zero, roots rounded right."""
    x, tiny = 1.0 + 2.0**-30, 5e-324
    for language, product in (("Python", _multiply_and_add_plainly), ("numba", _multiply_and_add)):
        if language == "numba" and not COMPILED:
            yield Finding("numba: floats", "open", "numba is not installed, or told not to compile")
            continue
        fused = product(x, x, -(1.0 + 2.0**-29)) != 0.0
        yield _judged(f"{language}: products are rounded before sums", not fused, "multiplications and additions are fused")
        yield _judged(f"{language}: the least floats are kept", product(tiny, 1.0, 0.0) == tiny, "they are taken for zero")
    roots = math.sqrt(2.0).hex(), float(np.sqrt(np.array([2.0]))[0]).hex()
    yield _judged("roots are rounded right", roots == ("0x1.6a09e667f3bcdp+0",) * 2, f"sqrt(2) = {roots}")


def told(name: str, scene: Scene) -> tuple[Entry, EventLog]:
    """What this machine says of a scene, for the table; and the log."""
    log = EventLog(*_run("reference", scene, GAS_EVENTS if name == GAS else EVENTS))
    disks = scene.disks
    start = _digest([disks.position, disks.velocity, disks.radius, disks.mass])
    return Entry(start, len(log), _rows_digest(log.rows)), log


def scenes() -> Iterator[tuple[str, Scene]]:
    """The gas whose start is drawn from whole numbers, and all of the gallery."""
    yield GAS, gas()
    for name in names():
        yield name, gallery(name)


GAS = "a gas"


def gas(n: int = 8) -> Scene:
    """n x n disks on a lattice whose velocities follow from whole numbers, so that no library draws them."""
    number, velocity = 1, []
    for _ in range(2 * n * n):
        number = (number * 6364136223846793005 + 1442695040888963407) % 2**64  # D. E. Knuth, TAOCP 2, 3.3.4
        velocity.append((number >> 40) / 2**23 - 1.0)
    place = [(i + 0.5, j + 0.5) for i in range(n) for j in range(n)]
    return Scene(Disks(place, np.array(velocity).reshape(-1, 2), 0.3), Periodic((float(n), float(n))), name=GAS)


def bug_report() -> dict[str, str]:
    """What a report of a fault should say: versions and machine."""
    return {**versions(), "machine": platform.machine(), "system": platform.platform(), "libc": " ".join(platform.libc_ver())}


def _engines_agree(name: str, log: EventLog, until: float) -> Finding:
    question = f"{name}: reference = fast"
    if not has_compiler():
        return Finding(question, "open", "numba is not installed, or told not to compile")
    if monotonic() > until:
        return Finding(question, "open", "the time was over; another call goes on with what was compiled")
    rows = _run("fast", log.scene, len(log)).rows
    return _judged(question, _rows_digest(rows) == _rows_digest(log.rows), "the two engines differ")


def _run(engine: str, scene: Scene, events: int) -> Recorded:
    recorded = run_scene(ENGINES[engine], scene, Stop(scene.until, events), RunOptions(log=True)).recorded
    assert recorded is not None
    return recorded


def _judged(question: str, holds: bool, otherwise: str) -> Finding:
    return Finding(question, "well" if holds else "wrong", "" if holds else otherwise)


def _rows_digest(rows: Rows) -> str:
    return _digest([rows[name] for name in COLUMNS])


def _digest(columns: list[Any]) -> str:
    """SHA-256 of numbers as 64-bit little-endian; one zero, one NaN."""
    sha = hashlib.sha256()
    for column in columns:
        wide = np.asarray(column, "<f8" if np.asarray(column).dtype.kind == "f" else "<i8")
        if wide.dtype.kind == "f":
            wide = np.where(np.isnan(wide), np.nan, wide + 0.0)
        sha.update(np.ascontiguousarray(wide).tobytes())
    return sha.hexdigest()


def _table() -> str:
    return files(__package__).joinpath(TABLE).read_text(encoding="utf-8")


def _multiply_and_add_plainly(x: float, y: float, z: float) -> float:
    return x * y + z


_multiply_and_add: Callable[[float, float, float], float] = kernel(_multiply_and_add_plainly)
