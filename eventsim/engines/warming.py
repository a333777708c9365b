"""A second process that compiles the kernels of a run into the cache, while the reference engine goes on with the run.

Both engines write the same log, so a run takes kernels up when they are there, and nobody sees the seam.  The process ends with
its parent; where it fails, nothing is said, and the run compiles for itself.
"""

from __future__ import annotations

import atexit
import os
import pickle
import sys
from typing import IO

from eventsim.engines.base import Snapshot
from eventsim.processes import cores, end_with
from eventsim.scene.stage import Stage

SWITCH = "EVENTSIM_WARM"
"""The variable of the environment by which, as 0, this is switched off: in sweeps, whose workers need all cores."""

PARENT = "EVENTSIM_WARM_PARENT"
"""The variable that tells the process whose child it is."""

FREE = 2.0
"""Cores that are needed: one for the run, one for the compiler."""


class Warming:
    """The process that compiles for one run."""

    def __init__(self, stage: Stage, keep_rows: bool, saved: Snapshot) -> None:
        """Begin to compile what a run of this stage needs that goes on from a snapshot.

        Raises OSError where no process can be started.
        """
        import subprocess  # a run that needs none of it does not load it
        import tempfile

        with tempfile.TemporaryFile() as job:
            pickle.dump((stage, keep_rows, saved), job)
            job.seek(0)
            self._process = subprocess.Popen(
                [sys.executable, "-m", "eventsim", "warm", "--job"],
                stdin=job,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                start_new_session=True,
                env=os.environ | {SWITCH: "0", PARENT: str(os.getpid())},
            )
        atexit.register(self._process.kill)

    @property
    def is_at_work(self) -> bool:
        """Whether it still compiles."""
        return self._process.poll() is None

    @property
    def has_failed(self) -> bool:
        """Whether it has ended without kernels."""
        return self._process.poll() not in (None, 0)


def may_warm() -> bool:
    """Whether a second process would take nothing from this one."""
    return os.environ.get(SWITCH, "").strip() != "0" and cores() >= FREE


def work(job: IO[bytes]) -> None:
    """Do what a Warming asks for, in its process: the job is pickled."""
    if PARENT in os.environ:
        end_with(int(os.environ[PARENT]))
    warm(*pickle.load(job))


def warm(stage: Stage, keep_rows: bool, saved: Snapshot | None = None) -> float:
    """Compile the kernels for a run of a stage into the cache, one process at a time; the seconds that it took.

    Args:
        stage: what is simulated.
        keep_rows: whether a log is kept.
        saved: where the run goes on; None: at its beginning.
    """
    from eventsim.engines.fast.compiled import compiling_alone
    from eventsim.engines.fast.session import FastSession

    with compiling_alone():
        session = FastSession(stage, keep_rows, saved=saved)
        session.compile()
    return session.compile_s
