"""The journal of a sweep: one line for each task that is done, so that an interrupted sweep goes on where it was."""

from __future__ import annotations

import hashlib
import json
from contextlib import suppress
from pathlib import Path
from typing import Any

from eventsim import __version__
from eventsim.errors import EventsimError
from eventsim.reading import reading
from eventsim.record.files.claim import Claim
from eventsim.scene.files import scene_to_dict
from eventsim.sweep.grid import Task
from eventsim.sweep.task import Plan, Row

SUFFIX = ".journal"


class Journal:
    """A file beside the table; its first line says what sweep it belongs to."""

    def __init__(self, out: Path, identity: str) -> None:
        """Open the journal of a table; raise EventsimError where it belongs to another sweep or cannot be written."""
        self.path = out.with_name(out.name + SUFFIX)
        self.done: dict[str, Row] = {}
        self._claim = Claim(self.path, EventsimError, f"the sweep {out.name}")
        try:
            self._claim.take(make=True)
            self._read(json.dumps({"sweep": identity}).encode() + b"\n")
            self._file = self.path.open("a", encoding="utf-8")
        except OSError as error:
            raise self._unwritten(error) from None

    def _unwritten(self, error: OSError) -> EventsimError:
        return EventsimError(f"{self.path}: cannot be written ({error.strerror or error})")

    def add(self, task: Task, row: Row) -> None:
        """Note that a task is done; raise EventsimError where it cannot be written."""
        self.done[task.name] = row
        try:
            self._file.write(json.dumps({"task": task.name, "row": row}) + "\n")
            self._file.flush()
        except OSError as error:
            raise self._unwritten(error) from None

    def close(self, whole: bool) -> None:
        """Close it; where the table is whole it is not needed any more."""
        with suppress(OSError):  # of a line that could not be written, which was told
            self._file.close()
        if whole:
            self._claim.remove()
            self.path.unlink(missing_ok=True)
        self._claim.release()

    def _read(self, head: bytes) -> None:
        """Take over the rows of a sweep that was broken off; its last line may not be whole."""
        with reading(self.path, EventsimError, "is not the journal of a sweep") as file:
            lines = file.read().splitlines(keepends=True)
        if lines and lines[0] != head and not (len(lines) == 1 and head.startswith(lines[0])):
            raise EventsimError(
                f"{self.path}: belongs to another sweep (another scene, stop or version), or to none; remove it to begin anew"
            )
        kept = [head]
        for line in lines[1:]:
            entry = _entry(line)
            if entry is None:
                break
            self.done[entry["task"]] = entry["row"]
            kept.append(line)
        self.path.write_bytes(b"".join(kept))


def _entry(line: bytes) -> dict[str, Any] | None:
    """The row that a line tells; None where it is not whole, or none."""
    try:
        entry = json.loads(line)
    except (ValueError, RecursionError):
        return None
    if not isinstance(entry, dict) or not line.endswith(b"\n"):
        return None
    return entry if isinstance(entry.get("task"), str) and isinstance(entry.get("row"), dict) else None


def identity_of(plan: Plan, first: Task) -> str:
    """What the rows of a sweep have in common, as a hash: the scene without its settings, the stop, the version."""
    try:
        scene = scene_to_dict(plan.make((), 0))
    except EventsimError:  # not every scene stands without settings
        scene = {"keys": [key for key, _ in first.settings]}
    facts = (scene, plan.until, plan.events, plan.discard, plan.engine, *plan.studies, __version__)
    return hashlib.sha256(repr(facts).encode()).hexdigest()
