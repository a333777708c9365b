"""The built-in scenes: one file a scene, found by listing this folder.

A scene file holds a docstring (a title, then the sections What happens, Why, Source, A question) and one
function `scene`, whose keyword parameters, each with a default, are the parameters of the scene. The file
`newton_cradle.py` is the scene `newton-cradle`. Files that begin with an underscore are no scenes.
"""

from __future__ import annotations

import inspect
import pkgutil
from collections.abc import Callable
from dataclasses import dataclass
from difflib import get_close_matches
from importlib import import_module
from typing import TypeAlias

from eventsim.errors import SceneError
from eventsim.scene.numbers import as_whole
from eventsim.scene.scene import Scene

Value: TypeAlias = bool | int | float | str

_WORDS = {bool: "true or false", int: "a whole number", float: "a number", str: "a text"}


@dataclass(frozen=True, slots=True)
class Entry:
    """What the gallery says about a scene.

    Attributes:
        name: as in `eventsim run NAME`.
        title: one line.
        text: the sections What happens, Why, Source, A question.
        about: what the parameters mean.
        parameters: the defaults of the scene's parameters, in order.
    """

    name: str
    title: str
    text: str
    about: str
    parameters: dict[str, Value]


def names() -> list[str]:
    """The names of all built-in scenes, sorted; no scene is imported for it."""
    return sorted(_modules())


def describe(name: str) -> Entry:
    """What the gallery says about the scene `name`.

    Raises:
        SceneError: if there is no such scene.
    """
    rule = _rule(name)
    title, _, text = inspect.cleandoc(import_module(rule.__module__).__doc__ or "").partition("\n")
    about = " ".join((rule.__doc__ or "").split())
    return Entry(name, title.rstrip("."), text.strip(), about, _defaults(rule))


def gallery(name: str, **parameters: Value) -> Scene:
    """The built-in scene `name` with these parameters; those left out keep their defaults.

    Raises:
        SceneError: if there is no such scene or parameter, or a value has the wrong type or breaks a rule.
    """
    rule = _rule(name)
    defaults = _defaults(rule)
    problems: list[str] = []
    checked: dict[str, Value] = {}
    for key, value in parameters.items():
        if key not in defaults:
            problems.append(f"{name} has no parameter {key!r}{_hint(key, list(defaults))}; {_allowed(defaults)}")
            continue
        wanted = type(defaults[key])
        # A whole number will do where any number does, and may be written as 1e3; true and false are no numbers here.
        whole = as_whole(value) is not None
        fits = type(value) is wanted or (wanted in (int, float) and whole)
        if not fits:
            problems.append(f"{name}: {key} = {value!r}: must be {_WORDS[wanted]}; {_allowed(defaults)}")
            continue
        checked[key] = wanted(value)
    if problems:
        raise SceneError(problems)
    try:
        return rule(**checked)
    except SceneError as error:
        raise SceneError(f"{name}: {problem}" for problem in error.problems) from None


def _modules() -> dict[str, str]:
    """Scene name -> module name; `break_.py` is the scene `break`, whose name Python keeps for itself."""
    found = (module.name for module in pkgutil.iter_modules(__path__))
    return {module.strip("_").replace("_", "-"): module for module in found if not module.startswith("_")}


def _rule(name: str) -> Callable[..., Scene]:
    """The function that makes the scene `name`."""
    modules = _modules()
    if name not in modules:
        known = sorted(modules)
        hint = _hint(name.replace("_", "-"), known)
        raise SceneError(f"there is no built-in scene {name!r}{hint}; there are {', '.join(known)}")
    rule: Callable[..., Scene] = import_module(f"{__name__}.{modules[name]}").scene
    return rule


def _defaults(rule: Callable[..., Scene]) -> dict[str, Value]:
    return {key: parameter.default for key, parameter in inspect.signature(rule).parameters.items()}


def _hint(word: str, known: list[str]) -> str:
    close = get_close_matches(word, known, n=1)
    return f", did you mean {close[0]!r}?" if close else ""


def _allowed(defaults: dict[str, Value]) -> str:
    if not defaults:
        return "it has no parameters"
    return "its parameters and their defaults are " + ", ".join(f"{k} = {v!r}" for k, v in defaults.items())
