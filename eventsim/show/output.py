"""Output: which formats a file's name may ask for, and how names are drawn."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from eventsim.errors import EventsimError
from eventsim.replay.log import AnyLog


def suffix_of(path: Path, suffixes: Sequence[str], what: str) -> str:
    """Return the suffix of a file's name; raise EventsimError where it is not one of those that can be written."""
    suffix = path.suffix.lower()
    if suffix not in suffixes:
        raise EventsimError(
            f"{path}: {what} is written as {', '.join(suffixes)}; the file's name must end in one of them"
        )
    return suffix


def title_of(log: AnyLog) -> str:
    """Return how a picture calls the run that a log tells: by its scene, or else by its file."""
    return log.scene.called if log.scene.name or log.path is None else log.path.stem


def name_of(log: AnyLog) -> str:
    """Return the same as matplotlib draws it."""
    return as_written(title_of(log))


def as_written(text: str) -> str:
    """Return a name as matplotlib draws it letter by letter: without it, what stands between two dollars is a formula."""
    return text.replace("$", r"\$")


def short_number(value: float, digits: int = 2) -> str:
    """Return a number to some significant digits, without an exponent where it has few before the point: 110, not 1.1e+02."""
    return f"{float(f'{value:.{digits}g}'):g}"


def span_words(span: float, digits: int = 2) -> str:
    """Return a span of time in words."""
    told = short_number(span, digits)
    return f"{told} time unit" if told == "1" else f"{told} time units"
