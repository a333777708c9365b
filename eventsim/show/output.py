"""Output: a file that appears under its name only when it is whole."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from eventsim.errors import EventsimError
from eventsim.record.files.sink import PART


def suffix_of(path: Path, suffixes: Sequence[str], what: str) -> str:
    """Return the suffix of a file's name; raise EventsimError where it is not one of those that can be written."""
    suffix = path.suffix.lower()
    if suffix not in suffixes:
        raise EventsimError(
            f"{path}: {what} is written as {', '.join(suffixes)}; the file's name must end in one of them"
        )
    return suffix


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """Give the name NAME.part to write to; rename it in the end, remove it where something went wrong or was interrupted.

    Raises EventsimError where the file cannot be written.
    """
    part = path.with_name(path.name + PART)
    try:
        yield part
        os.replace(part, path)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise EventsimError(f"{path}: cannot be written ({error.strerror or error})") from None
    except BaseException:
        part.unlink(missing_ok=True)
        raise
