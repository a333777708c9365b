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


def begun_by(error: SceneError, data: Mapping[str, Any], overrides: Iterable[str] | None) -> SceneError:
    """The same problems; those of a table that only settings have begun, and that lacks keys, in one sentence that says so.

    Args:
        error: of the scene with its settings.
        data: the tables without them.
        overrides: the settings.
    """
    problems = list(error.problems)
    for setting in settings_of(overrides):
        match = re.match(r"\s*(\w+)(?:\.|\[)(\d+)", setting)
        listed = data.get(match[1], []) if match is not None else None
        if match is None or not isinstance(listed, list) or int(match[2]) < len(listed):
            continue
        name, number = match[1], match[2]
        lacks = [(k, found[1]) for k, one in enumerate(problems) if (found := re.search(_lacking(name, number), one)) is not None]
        if not lacks:
            continue
        keys = " and ".join(key for _, key in lacks)
        source = problems[lacks[0][0]].partition(f"{name}[{number}]")[0]
        told = f"{source}setting {setting!r}: {_there(name, len(listed))}; this would begin another one, which lacks {keys}"
        problems = [told if k == lacks[0][0] else one for k, one in enumerate(problems) if k not in [k for k, _ in lacks[1:]]]
    return SceneError(problems)


def _lacking(name: str, number: str) -> str:
    """The pattern of a problem that says which key a table lacks."""
    return rf"\b{name}\[{number}\]\.(\w+) is missing"


def _there(name: str, count: int) -> str:
    """Say what there is in a list."""
    if count < 2:
        return f"there is {name}.0 alone" if count else f"there is no {name}"
    return f"there are {name}.0 {'and' if count == 2 else 'to'} {name}.{count - 1}"


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
                raise SceneError(
                    f"there is no {here}.{step}: {_there(here, len(place))} ({here}.{len(place)} would add one)"
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
