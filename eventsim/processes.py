"""Processes that work for another one: they leave Ctrl-C to it, and end where it has ended, however that was."""

import multiprocessing
import multiprocessing.connection
import os
import signal
import threading
import time


def obey_parent() -> None:
    """To be called in a child: let only its parent be interrupted, and end with it, even where that was killed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_end_after, args=(parent.sentinel,), name="eventsim parent", daemon=True).start()


def end_with(parent: int) -> None:
    """To be called in a child that is a command of its own: end with the process that has begun it, however that ends."""
    threading.Thread(target=_end_without, args=(parent,), name="eventsim parent", daemon=True).start()


def _end_without(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(0.5)
    os._exit(1)


def _end_after(sentinel: int) -> None:
    multiprocessing.connection.wait([sentinel])
    os._exit(1)
