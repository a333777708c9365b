"""Options of an engine as the command line gives them: --dt DT, --option KEY=VALUE."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import click


def _number(text: str) -> float:
    return float(text)


def _whole(text: str) -> int:
    return int(text)


def _truth(text: str) -> bool:
    return {"true": True, "false": False}[text.lower()]


KNOWN: dict[str, dict[str, tuple[Callable[[str], Any], str]]] = {
    "frames": {"dt": (_number, "a time"), "memory": (str, "apart or frame")},
    "stepped": {"dt": (_number, "a time"), "locate": (_truth, "true or false")},
    "penalty": {"dt": (_number, "a time"), "stiffness": (_number, "a number, force / length")},
    "pymunk": {"dt": (_number, "a time"), "iterations": (_whole, "a whole number"), "slop": (_number, "a length")},
}
"""For each stepped engine: its options, how they are read, and what they are."""

DT_HELP = (
    "Step of a time-stepped engine. Default: 1/60 (frames); else a twentieth of the time in which a typical disk flies, "
    "or falls, its radius."
)
OPTION_HELP = (
    "An option of a time-stepped engine: " + "; ".join(f"{name}: {', '.join(options)}" for name, options in KNOWN.items()) + "."
)


def engine_options(engine: str, dt: float | None, given: Sequence[str]) -> dict[str, Any]:
    """The options for `simulate`; click.UsageError for what the engine does not have or what cannot be read."""
    texts = {} if dt is None else {"dt": repr(dt)}
    for setting in given:
        key, equals, text = setting.partition("=")
        if not equals:
            raise click.UsageError(f"--option {setting!r}: must be KEY=VALUE, like memory=frame")
        texts[key.strip()] = text.strip()
    known = KNOWN.get(engine, {})
    read = {}
    for key, text in texts.items():
        if key not in known:
            raise click.UsageError(f"the engine {engine} has no option {key!r}; {_there_are(engine)}")
        reader, words = known[key]
        try:
            read[key] = reader(text)
        except (ValueError, KeyError):
            raise click.UsageError(f"--option {key}={text}: must be {words}") from None
    return read


def _there_are(engine: str) -> str:
    if engine in KNOWN:
        return f"it has {', '.join(KNOWN[engine])}"
    return f"steps belong to the engines {', '.join(KNOWN)}"
