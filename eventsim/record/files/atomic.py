"""A file that appears under its name only when it is whole."""

from __future__ import annotations

import os
import secrets
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from eventsim.errors import EventsimError
from eventsim.suffixes import PART

BEHIND = f".{'0' * 8}{PART}"
"""What is put behind a name while its file grows."""


def demand_place(path: Path, error: type[EventsimError] = EventsimError) -> None:
    """Raise an error for a name that no file can have here, or that a pipe, a device or the like has, which would be replaced."""
    try:
        with suppress(FileNotFoundError):
            os.lstat(path.with_name(path.name + BEHIND))
        with suppress(FileNotFoundError):
            mode = os.stat(path).st_mode
            if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
                raise error(f"{path}: is no ordinary file, so none takes its place")
    except (OSError, ValueError) as problem:
        reason = problem.strerror if isinstance(problem, OSError) else problem
        raise error(f"{path}: no file can be written there ({reason or problem})") from None


@contextmanager
def atomic_write(path: Path) -> Iterator[Path]:
    """Give a name to write to; rename it in the end, remove it where something went wrong or was interrupted.

    The name is nobody else's: two runs that write the same file do not mix, the later one stays.
    Raises EventsimError where the file cannot be written.
    """
    demand_place(path)
    part = path.with_name(f"{path.name}.{secrets.token_hex(4)}{PART}")
    try:
        yield part
        os.replace(part, path)
    except OSError as error:
        _remove(part)
        raise EventsimError(f"{path}: cannot be written ({error.strerror or error})") from None
    except BaseException:
        _remove(part)
        raise


def _remove(part: Path) -> None:
    with suppress(OSError):  # where it could not be written it may not be reached either
        part.unlink(missing_ok=True)
