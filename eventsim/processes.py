"""Processes that work for another one: they leave Ctrl-C to it, and end where it has ended, however that was.

And how many may work at once.
"""

import math
import multiprocessing
import multiprocessing.connection
import os
import signal
import threading
import time
from contextlib import suppress
from pathlib import Path

QUOTA = Path("/sys/fs/cgroup/cpu.max")
"""Where Linux tells how many cores a container may use."""


def cores() -> float:
    """How many cores this process may use at once, by its affinity and by the quota of its container."""
    count = float(len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1)
    with suppress(OSError, ValueError):
        quota, period = QUOTA.read_text().split()
        count = min(count, math.inf if quota == "max" else float(quota) / float(period))
    return count


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
