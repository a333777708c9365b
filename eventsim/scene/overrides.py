"""Settings like gas.0.count=500, typed on a command line, that change keys of a scene."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Mapping
from copy import deepcopy
from typing import Any

from eventsim.errors import SceneError

DEEPEST = 30
"""Tables and lists within each other; the points of a polygon, the deepest that a scene has, are the fourth."""


def apply_overrides(data: Mapping[str, Any], overrides: Iterable[str] | None) -> dict[str, Any]:
    """A copy of a scene's tables with keys set as in ["restitution=0.9", "gas.0.count=500"].

    The value is read as TOML and, where it is none, as a text. Tables that are not there are made; the index
    after the last one appends to a list. gas[0].count means the same as gas.0.count.

    Raises:
        SceneError: with every setting that has no `=` or whose path does not lead anywhere.
    """
    if not is_shallow(data):
        raise SceneError("the tables are nested too deeply for a scene")
    changed = deepcopy(dict(data))
    problems: list[str] = []
    for override in settings_of(overrides):
        path, equals, value = override.partition("=")
        steps = re.sub(r"\[(\d+)\]", r".\1", path.strip()).split(".")
        if not equals or not all(steps):
            problems.append(f"setting {override!r}: must be key=value, like restitution=0.9 or gas.0.count=500")
            continue
        try:
            _set(changed, steps, value_of(value.strip()))
        except SceneError as error:
            problems += [f"setting {override!r}: {problem}" for problem in error.problems]
    if problems:
        raise SceneError(problems)
    return changed


def settings_of(overrides: Iterable[str] | None) -> list[str]:
    """The settings that were given, one or several; SceneError for what holds none."""
    if overrides is None or isinstance(overrides, str):
        return [] if overrides is None else [overrides]
    settings = [] if isinstance(overrides, Mapping) or not isinstance(overrides, Iterable) else list(overrides)
    if (overrides and not settings) or not all(isinstance(one, str) for one in settings):
        raise SceneError(f'overrides = {overrides!r}: must be settings "key=value", like ["restitution=0.9", "gas.0.count=500"]')
    return settings


def is_shallow(data: object) -> bool:
    """Whether tables are not nested so deeply that whatever calls itself would give up."""
    level = [data]
    for _ in range(DEEPEST):
        inner: list[object] = []
        for here in level:
            if isinstance(here, Mapping):
                inner += here.values()
            elif isinstance(here, list | tuple):
                inner += here
        level = inner
    return not level


def value_of(written: str) -> Any:
    """The value that TOML sees, or the text itself."""
    try:
        table = tomllib.loads(f"value = {written}")
    except (ValueError, RecursionError):  # not TOML, or a number of thousands of digits
        return written
    return table["value"] if len(table) == 1 else written


def _set(table: dict[str, Any], steps: list[str], value: Any) -> None:
    """Set the value at the end of the path."""
    place: Any = table
    for depth, step in enumerate(steps):
        here = ".".join(steps[:depth]) or "the scene"
        last = depth == len(steps) - 1
        fresh = value if last else ([] if steps[depth + 1].isdigit() else {})
        if isinstance(place, list):
            if not step.isdigit() or int(step) > len(place):
                known = f"ends at {here}.{len(place) - 1}" if place else "is empty"
                raise SceneError(
                    f"there is no {here}.{step}: the list {here} {known} ({here}.{len(place)} would add to it)"
                )
            index = int(step)
            if index == len(place):
                place.append(fresh)
            elif last:
                place[index] = value
            place = place[index]
        elif isinstance(place, dict):
            if last or step not in place:
                place[step] = fresh
            place = place[step]
        else:
            raise SceneError(f"{here} is {place!r}, which has no key {step!r}")
