"""What long work is at, as one line on a terminal's stderr that is written over."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from eventsim.cli.output import visible

CLEAR = "\r\x1b[K"


@contextmanager
def telling(quiet: bool) -> Iterator[Callable[[str], None]]:
    """Give a function that shows a line; it shows nothing where stderr is not a terminal."""
    wanted = not quiet and sys.stderr.isatty()

    def tell(text: str) -> None:
        if wanted:
            sys.stderr.write(f"{CLEAR}{visible(text)[:100]}")
            sys.stderr.flush()

    try:
        yield tell
    finally:
        if wanted:
            sys.stderr.write(CLEAR)
            sys.stderr.flush()
