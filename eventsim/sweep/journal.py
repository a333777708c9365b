"""The journal of a sweep: one line for each task that is done, so that an interrupted sweep goes on where it was."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

from eventsim import __version__
from eventsim.errors import EventsimError
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
        try:
            if self.path.exists():
                self._read(identity)
            else:
                self.path.write_text(json.dumps({"sweep": identity}) + "\n", encoding="utf-8")
            self._file = self.path.open("a", encoding="utf-8")
        except OSError as error:
            raise EventsimError(f"{self.path}: cannot be written ({error.strerror or error})") from None

    def add(self, task: Task, row: Row) -> None:
        """Note that a task is done."""
        self.done[task.name] = row
        self._file.write(json.dumps({"task": task.name, "row": row}) + "\n")
        self._file.flush()

    def close(self, whole: bool) -> None:
        """Close it; where the table is whole it is not needed any more."""
        self._file.close()
        if whole:
            self.path.unlink()

    def _read(self, identity: str) -> None:
        lines = self.path.read_text(encoding="utf-8").splitlines(keepends=True)
        kept = []
        for number, line in enumerate(lines):
            try:
                entry = json.loads(line)
            except ValueError:
                break  # the last line of a sweep that was killed while writing
            if number == 0 and entry.get("sweep") != identity:
                raise EventsimError(
                    f"{self.path}: belongs to another sweep (another scene, stop or version); remove it to begin anew"
                )
            if "task" in entry:
                self.done[entry["task"]] = entry["row"]
            kept.append(line)
        if not kept:
            kept = [json.dumps({"sweep": identity}) + "\n"]
        if kept != lines:
            self.path.write_text("".join(kept), encoding="utf-8")


def identity_of(plan: Plan, first: Task) -> str:
    """What the rows of a sweep have in common, as a hash: the scene without its settings, the stop, the version."""
    try:
        scene = scene_to_dict(plan.make((), 0))
    except EventsimError:  # not every scene stands without settings
        scene = {"keys": [key for key, _ in first.settings]}
    facts = (scene, plan.until, plan.events, plan.discard, plan.engine, __version__)
    return hashlib.sha256(repr(facts).encode()).hexdigest()
