"""Signals: what Ctrl-C and the signal to terminate do while a verb of the command line is at work."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    from eventsim.runner.interrupt import Interrupt

Handler: TypeAlias = Callable[[int, FrameType | None], Any]


@contextmanager
def terminable() -> Iterator[None]:
    """Let the signal to terminate raise KeyboardInterrupt inside, so that processes are ended and what was found is told."""
    with _handled((signal.SIGTERM,), _raise):
        yield


@contextmanager
def interruptible() -> Iterator[Interrupt]:
    """For one run: Ctrl-C, or the signal to terminate, ends it between two events; a second one breaks in.

    While the engine only prepares itself (loads a compiler, compiles), which takes long, the first one breaks in.
    """
    from eventsim.runner.interrupt import Interrupt

    interrupt = Interrupt()
    with _handled((signal.SIGINT, signal.SIGTERM), lambda number, frame: interrupt.break_in()):
        yield interrupt


def _raise(number: int, frame: FrameType | None) -> None:
    raise KeyboardInterrupt


@contextmanager
def _handled(numbers: tuple[signal.Signals, ...], handler: Handler) -> Iterator[None]:
    """Handle signals; where they do not come, in other threads, leave them alone."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {number: signal.signal(number, handler) for number in numbers}
    try:
        yield
    finally:
        for number, usual in before.items():
            signal.signal(number, usual)
