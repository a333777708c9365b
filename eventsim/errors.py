"""What can go wrong in eventsim, as exceptions whose text is meant for the user."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

LONGEST_REASON = 200
"""Letters of what a library has to say."""


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
    """The contacts of a scene accumulate at an instant, so that time cannot go on."""


class CheckpointError(EventsimError):
    """A checkpoint cannot be read or written, or belongs to another scene or version."""


@contextmanager
def told_as(error: type[EventsimError], path: Path, what: str) -> Iterator[None]:
    """Tell whatever a library raises over the bytes of a file, of which every one may be any, as one error of ours.

    Args:
        error: its type.
        path: the file.
        what: what it then is, such as "not a whole .npz event log".
    """
    try:
        yield
    except EventsimError:
        raise
    except OSError as problem:
        raise error(f"{path}: cannot be read ({problem.strerror or problem})") from problem
    except Exception as problem:  # zipfile alone has ten kinds, and numpy's readers let those of Python's parser through
        why = " ".join(str(problem).split())[:LONGEST_REASON]
        raise error(f"{path}: {what} ({why or type(problem).__name__})") from problem
