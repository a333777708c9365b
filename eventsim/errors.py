"""What can go wrong in eventsim, as exceptions whose text is meant for the user."""

from __future__ import annotations

import re
from collections.abc import Iterable


class EventsimError(Exception):
    """Something a user can mend or must know; the text is a clear sentence."""


class SceneError(EventsimError):
    """A scene, or the file that describes it, breaks rules; `problems` lists every one of them."""

    problems: tuple[str, ...]

    def __init__(self, problems: str | Iterable[str]) -> None:
        self.problems = (problems,) if isinstance(problems, str) else tuple(problems)
        super().__init__(self.problems)

    def __str__(self) -> str:
        return "\n".join(self.problems)


class LogError(EventsimError):
    """An event log cannot be read, written or replayed."""


class LogWarning(UserWarning):
    """An event log can be read, but does not say what its run wrote."""


class CollapseError(EventsimError):
    """A simulation cannot go on: contacts accumulate at an instant or lie below the digits, or no law tells what they do.

    Its text begins with "stopped by collapse", "stopped by digits" or "stopped by law".
    """


class CheckpointError(EventsimError):
    """A checkpoint cannot be read or written, or belongs to another scene or version."""


def sentence_of(problem: str) -> str:
    """A problem without the lines that are quoted below it."""
    return re.split(r"\n    \S", problem, maxsplit=1)[0]


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Return " (did you mean 'break'?)" for a word near to a known one, or to a part of one, else an empty text."""
    from difflib import get_close_matches  # only who errs pays for it

    names = list(known)
    meant = {part: name for name in names for part in name.split("-")} | {name: name for name in names}
    near = get_close_matches(word, list(meant), n=1)
    return f" (did you mean {meant[near[0]]!r}?)" if near else ""
