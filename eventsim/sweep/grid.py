"""The tasks of a sweep: every combination of values, several replicas each, every one with a seed of its own."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from eventsim.errors import EventsimError

MOST_TASKS = 1_000_000


@dataclass(frozen=True, slots=True)
class Task:
    """One run: settings (key, value as written) of the scene, which replica it is, and the seed that makes it so."""

    settings: tuple[tuple[str, str], ...]
    replica: int
    seed: int

    @property
    def overrides(self) -> tuple[str, ...]:
        """The settings as a scene takes them."""
        return tuple(f"{key}={value}" for key, value in self.settings)

    @property
    def name(self) -> str:
        """Tells the task from all others of a sweep, whatever else is in it."""
        return "; ".join([*self.overrides, f"replica={self.replica}", f"seed={self.seed}"])


def tasks_of(grid: Mapping[str, Sequence[str]], replicas: int, seed: int) -> list[Task]:
    """All tasks, the last key varying fastest, then the replicas.

    A task's seed depends on the sweep's seed, the task's own settings and its replica only: a sweep that gets more values or
    replicas later keeps the seeds, and so the results, of those it had.
    Raises EventsimError for a key without values, a value given twice, or too many tasks.
    """
    if replicas < 1:
        raise EventsimError(f"replicas = {replicas}: must be at least 1")
    count = replicas
    for key, values in grid.items():
        if not values:
            raise EventsimError(f"{key}: has no values")
        if len(set(values)) < len(values):
            raise EventsimError(f"{key}: has a value twice; replicas repeat a run with another seed")
        count *= len(values)
    if count > MOST_TASKS:
        raise EventsimError(f"{count} runs are asked for: at most {MOST_TASKS} are done in one sweep")
    tasks = []
    for values in product(*grid.values()):
        settings = tuple(zip(grid, values, strict=True))
        tasks += [Task(settings, replica, seed_of(seed, settings, replica)) for replica in range(replicas)]
    return tasks


def seed_of(seed: int, settings: Iterable[tuple[str, str]], replica: int) -> int:
    """The seed of a task: 63 bits of a hash, so that no two tasks share one."""
    text = repr((seed, sorted(settings), replica))
    return int.from_bytes(hashlib.sha256(text.encode()).digest()[:8], "little") >> 1


def grid_of(settings: Iterable[str]) -> dict[str, list[str]]:
    """The grid meant by settings as typed: key=a,b,c lists values, key=start:stop:count spaces them evenly.

    Commas inside brackets or quotation marks belong to a value: gravity=[0,-1],[0,-2] are two.
    Raises EventsimError for what is no setting, or a key that is set twice.
    """
    grid: dict[str, list[str]] = {}
    for setting in settings:
        key, equals, text = setting.partition("=")
        key = key.strip()
        if not equals or not key or not text.strip():
            raise EventsimError(f"setting {setting!r}: must be key=value, key=a,b,c or key=start:stop:count")
        if key in grid:
            raise EventsimError(f"setting {setting!r}: {key} is set twice")
        grid[key] = _spaced(text) or _listed(text)
    return grid


def _spaced(text: str) -> list[str] | None:
    """The values of start:stop:count; None where it is something else."""
    parts = text.split(":")
    if len(parts) != 3:
        return None
    try:
        start, stop, count = float(parts[0]), float(parts[1]), int(parts[2])
    except ValueError:
        return None
    if not 1 <= count <= MOST_TASKS:
        raise EventsimError(f"{text}: the count must be from 1 to {MOST_TASKS}")
    # 12 digits: 0.30000000000000004 is not what anybody means by 0.1:0.6:6
    return [f"{value:.12g}" for value in np.linspace(start, stop, count).tolist()]


def _listed(text: str) -> list[str]:
    """The values between commas outside of brackets and quotation marks."""
    values, depth, quote, begin = [], 0, "", 0
    for place, letter in enumerate(text):
        if quote:
            quote = "" if letter == quote else quote
        elif letter in "\"'":
            quote = letter
        elif letter in "[{":
            depth += 1
        elif letter in "]}":
            depth -= 1
        elif letter == "," and depth == 0:
            values.append(text[begin:place])
            begin = place + 1
    values.append(text[begin:])
    stripped = [value.strip() for value in values]
    if not all(stripped):
        raise EventsimError(f"{text}: has an empty value between commas")
    return stripped
