"""A second process that compiles kernels of a run into the cache, all but the loop, which the run compiles at the same time.

The process ends with its parent; where it fails, nothing is said, and the run compiles for itself.
"""

from __future__ import annotations

import os
import pickle
import sys
from subprocess import DEVNULL, Popen, TimeoutExpired
from typing import IO

from eventsim.engines.base import Snapshot
from eventsim.processes import cores, end_with
from eventsim.scene.stage import Stage

SWITCH = "EVENTSIM_WARM"
"""The variable of the environment by which, as 0, this is switched off: in sweeps, whose workers need all cores."""

PARENT = "EVENTSIM_WARM_PARENT"
"""The variable that tells the process whose child it is."""

FREE = 2.0
"""Cores that are needed: one for each of the two."""


PATIENCE = 60.0
"""Seconds that a run waits when it has compiled its own share."""


class Warming:
    """The process that compiles for one run."""

    def __init__(self, stage: Stage, keep_rows: bool, saved: Snapshot | None) -> None:
        """Begin to compile what a run of this stage needs that goes on from a snapshot, or begins (None).

        Raises OSError where no process can be started; what pickle raises where the stage is no data.
        """
        import tempfile  # a run that needs none of it does not load it

        with tempfile.TemporaryFile() as job:
            pickle.dump((stage, keep_rows, saved), job)
            job.seek(0)
            self._process = Popen(
                [sys.executable, "-m", "eventsim", "warm", "--job"],
                stdin=job,
                stdout=DEVNULL,
                stderr=DEVNULL,
                start_new_session=True,
                env=os.environ | {SWITCH: "0", PARENT: str(os.getpid())},
            )

    def wait(self) -> bool:
        """Wait until it has ended, or takes too long, perhaps in its turn behind another process; whether it has compiled."""
        try:
            return self._process.wait(PATIENCE) == 0
        except TimeoutExpired:
            return False

    def end(self) -> None:
        """End it, whatever it has done."""
        self._process.kill()
        self._process.wait()


def may_warm() -> bool:
    """Whether a second process would take nothing from this one."""
    return os.environ.get(SWITCH, "").strip() != "0" and cores() >= FREE


def work(job: IO[bytes]) -> None:
    """Do what a Warming asks for, in its process: the job is pickled."""
    if PARENT in os.environ:
        end_with(int(os.environ[PARENT]))
    stage, keep_rows, saved = pickle.load(job)
    warm(stage, keep_rows, saved, with_loop=False)


def warm(stage: Stage, keep_rows: bool, saved: Snapshot | None = None, with_loop: bool = True) -> float:
    """Compile the kernels for a run of a stage into the cache, one process at a time; the seconds that it took.

    Args:
        stage: what is simulated.
        keep_rows: whether a log is kept.
        saved: where the run goes on; None: at its beginning.
        with_loop: False where the run itself compiles that.
    """
    from eventsim.engines.fast.compiled import compiling_alone
    from eventsim.engines.fast.session import FastSession

    with compiling_alone():
        session = FastSession(stage, keep_rows, saved=saved)
        session.compile(with_loop)
    return session.compile_s
