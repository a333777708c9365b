"""A Dask cluster as an executor."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager, suppress

from eventsim.errors import EventsimError

PATIENCE = 10.0
"""Seconds in which a scheduler must answer."""

TALKATIVE = ("distributed", "distributed.client", "tornado", "tornado.application")
"""Loggers that print the traceback of a lost connection."""


@contextmanager
def dask_executor(address: str | None) -> Iterator[Executor | None]:
    """The executor of the cluster whose scheduler is at an address; None without one.

    Every worker of the cluster needs the same version of eventsim.  Raises EventsimError where Dask is not installed or the
    scheduler does not answer.
    """
    if address is None:
        yield None
        return
    try:
        from distributed import Client, KilledWorker
    except ImportError:
        raise EventsimError("--dask needs Dask: pip install 'eventsim-disks[dask]'") from None
    try:
        client = Client(address, timeout=PATIENCE)
    except (OSError, ValueError) as error:
        raise EventsimError(f"--dask {address}: no scheduler answers there ({error})") from None
    # A scheduler that is gone is told here, in a sentence.
    levels = {logger: logger.level for logger in map(logging.getLogger, TALKATIVE)}
    for logger in levels:
        logger.setLevel(logging.CRITICAL)
    try:
        yield client.get_executor(pure=False)
    except KilledWorker as error:
        raise EventsimError(f"--dask {address}: {error}") from None
    finally:
        with suppress(OSError, TimeoutError):  # of a scheduler that is gone there is nothing to take leave
            client.close(timeout=PATIENCE)
        for logger, level in levels.items():
            logger.setLevel(level)
