"""A file that appears under its name only when it is whole."""

from __future__ import annotations

import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from eventsim.errors import EventsimError
from eventsim.suffixes import PART


@contextmanager
def atomic_write(path: Path) -> Iterator[Path]:
    """Give a name to write to; rename it in the end, remove it where something went wrong or was interrupted.

    The name is nobody else's: two runs that write the same file do not mix, the later one stays.
    Raises EventsimError where the file cannot be written.
    """
    part = path.with_name(f"{path.name}.{secrets.token_hex(4)}{PART}")
    try:
        yield part
        os.replace(part, path)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise EventsimError(f"{path}: cannot be written ({error.strerror or error})") from None
    except BaseException:
        part.unlink(missing_ok=True)
        raise
