"""Signals: what Ctrl-C and the signals to end do while a verb of the command line is at work."""

from __future__ import annotations

import _thread
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from types import FrameType
from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    from eventsim.runner.options import Interrupt

Handler: TypeAlias = Callable[[bool], Any]
"""Called with whether this is said once more, since what the handler raised was lost."""

SHORTLY = 0.05
"""Seconds until a signal is said once more."""

HANGUP = getattr(signal, "SIGHUP", None)
"""The terminal has gone; there is no such signal everywhere."""

ENDING = tuple(number for number in (signal.SIGTERM, HANGUP) if number is not None)
"""Signals that ask a process to end."""


@contextmanager
def terminable() -> Iterator[None]:
    """Let a signal to end raise KeyboardInterrupt inside, so that processes are ended and what was found is told."""
    with _handled(ENDING, _raise):
        yield


@contextmanager
def interruptible() -> Iterator[Interrupt]:
    """For one run: Ctrl-C, or a signal to end, ends it between two events; a second one breaks in.

    While the engine only prepares itself (loads a compiler, compiles), which takes long, the first one breaks in.
    """
    from eventsim.runner.options import Interrupt

    interrupt = Interrupt()
    with _handled((signal.SIGINT, *ENDING), interrupt.break_in):
        yield interrupt


def _raise(once_more: bool) -> None:
    raise KeyboardInterrupt


@contextmanager
def _handled(numbers: tuple[signal.Signals, ...], handler: Handler) -> Iterator[None]:
    """Handle signals; where they do not come, in other threads, leave them alone.

    A signal may be heard inside a function that machine code calls, as LLVM does while it compiles. What a handler raises there
    is lost, and Python writes a traceback. So it is said once more, until it is heard elsewhere.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    terminals, usual_hook = _terminals(), sys.unraisablehook
    raised: tuple[int, BaseException | None] = 0, None
    once_more = False

    def handle(number: int, frame: FrameType | None) -> None:
        nonlocal raised, once_more
        if number == HANGUP:
            _leave(terminals)
        repeated, once_more = once_more, False
        try:
            handler(repeated)
        except BaseException as error:
            raised = number, error
            raise

    def lost(unraisable: Any) -> None:
        nonlocal once_more
        if unraisable.exc_value is not raised[1]:
            usual_hook(unraisable)
            return
        once_more = True
        again = threading.Timer(SHORTLY, _thread.interrupt_main, raised[:1])
        again.daemon = True
        again.start()

    # nohup lets a command ignore that its terminal goes
    wanted = [number for number in numbers if number != HANGUP or signal.getsignal(number) is not signal.SIG_IGN]
    before = {number: signal.signal(number, handle) for number in wanted}
    sys.unraisablehook = lost
    try:
        yield
    finally:
        sys.unraisablehook = usual_hook
        for number, usual in before.items():
            signal.signal(number, usual)


def _terminals() -> list[int]:
    """Which of stdout and stderr are terminals; of one that is gone nobody could tell any more."""
    found = []
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError, AttributeError):  # it may be closed, or none
            if stream.isatty():
                found.append(stream.fileno())
    return found


def _leave(terminals: list[int]) -> None:
    """Write nowhere what would be written to a terminal that is gone: the last words would end in an error."""
    for number in terminals:
        os.dup2(os.open(os.devnull, os.O_WRONLY), number)
