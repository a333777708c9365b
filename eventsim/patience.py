"""Patience: until when somebody waits for a piece of work.  Long loops ask now and then whether to go on."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from time import monotonic

from eventsim.errors import EventsimError

_until: ContextVar[float] = ContextVar("until", default=math.inf)


@contextmanager
def patience(seconds: float) -> Iterator[None]:
    """Wait so long for what is done inside, in this thread and those that it is handed to."""
    before = _until.set(monotonic() + seconds)
    try:
        yield
    finally:
        _until.reset(before)


def is_bounded() -> bool:
    """Whether somebody waits only so long."""
    return _until.get() < math.inf


def is_over() -> bool:
    """Whether nobody waits any more."""
    return monotonic() > _until.get()


def go_on(work: str) -> None:
    """Raise EventsimError where nobody waits any more; work: what is being done, such as "to place these disks"."""
    if is_over():
        raise EventsimError(f"it takes too long {work}")
