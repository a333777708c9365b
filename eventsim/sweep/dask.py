"""A Dask cluster as an executor."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager

from eventsim.errors import EventsimError

PATIENCE = 10.0
"""Seconds in which a scheduler must answer."""


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
        from distributed import Client
    except ImportError:
        raise EventsimError("--dask needs Dask: pip install 'eventsim-disks[dask]'") from None
    try:
        client = Client(address, timeout=PATIENCE)
    except (OSError, ValueError) as error:
        raise EventsimError(f"--dask {address}: no scheduler answers there ({error})") from None
    with client:
        yield client.get_executor(pure=False)
