"""A case of the catalogue: why methods fail on a scene, what is true, and how far off an engine may be."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from time import process_time
from typing import Any

import numpy as np

from eventsim.engines import STEPPED, engine_named
from eventsim.replay.past import PastRun
from eventsim.runner.loop import run_scene, run_session
from eventsim.runner.options import RunOptions, stop_of
from eventsim.scene import Scene
from eventsim.scene.stage import stage_of

CERTIFIED = "certified"
"""The engine that proves."""

GOES_ON = ("until", "events", "quiet")
"""Reasons to stop that are none of the engine's; with any other it says that it cannot go on."""


LOOK, FAR = 0.1, 10.0
"""In limits: after so long the pace of an engine with time steps is looked at; if it would take so long, it is not waited for."""

PROOF = 10.0
"""In limits: what the certified engine is given.  A proof costs far more than a run: of `c2-lattice` some 40 s."""


class GaveUpError(Exception):
    """An engine stopped early with a reason."""

    def __init__(self, stopped: str, reason: str | None) -> None:
        super().__init__(reason or stopped)
        self.stopped = stopped


class TimeUpError(Exception):
    """An engine took longer than it was given, or would; the message says so."""


class Bench:
    """One engine, ready for the runs of one case; keeps the worst change of energy that it saw.

    limit: seconds of computing that all runs together may take, `PROOF` times as many where they are proofs, whatever else the
    machine does; what comes before the first events of a run, compiling, is not counted.  Steps go at a steady pace: what has far
    to go at it is not waited for.
    """

    def __init__(self, engine: str, limit: float) -> None:
        self.engine = engine
        self.energy = 0.0
        self._limit = self._left = limit * PROOF if engine == CERTIFIED else limit
        self._begun: tuple[float, float, float] | None = None

    def run(
        self,
        scene: Scene,
        until: float | None = None,
        events: int | None = None,
        log: bool = False,
        may_give_up: bool = False,
    ) -> PastRun:
        """Simulate a scene; raises GaveUpError where the engine stops early, unless that is what the case is about."""
        self._begun = None
        wanted = RunOptions(log=log, progress=self._watch)
        run = PastRun.of(run_scene(engine_named(self.engine), scene, stop_of(scene, until, events), wanted))
        return self._looked_at(run, may_give_up)

    def run_kicked(self, scene: Scene, wait: float, disk: int, velocity: tuple[float, float], until: float) -> PastRun:
        """Simulate a scene in which a disk is given another velocity after `wait`."""
        self._begun = None
        engine, wanted = engine_named(self.engine), RunOptions(progress=self._watch)
        session = engine.open(stage_of(scene), keep_rows=False)
        run_session(session, engine, scene, stop_of(scene, wait, None), wanted)
        session.kick(disk, *velocity)
        self._begun = None
        return self._looked_at(
            PastRun.of(run_session(session, engine, scene, stop_of(scene, until, None), wanted)), False
        )

    def _looked_at(self, run: PastRun, may_give_up: bool) -> PastRun:
        """Keep the change of energy, and raise where a run gave up."""
        change = run.residuals.energy
        if change is not None and abs(change) > abs(self.energy):
            self.energy = change
        if run.stopped not in GOES_ON and not may_give_up:
            raise GaveUpError(run.stopped, run.reason)
        return run

    def _watch(self, share: float | None, _events: int, _time: float) -> None:
        """Count the seconds since the last look; raises TimeUpError where none are left, or far too few.

        share: what is done of the run.
        """
        now, share = process_time(), share or 0.0
        if self._begun is None:
            self._begun = now, share, self._left
        spent, done = now - self._begun[0], share - self._begun[1]
        self._left = self._begun[2] - spent
        if self._left < 0.0:
            raise TimeUpError(f"not done after {self._limit:g} s")
        steady = self.engine in STEPPED
        if steady and spent > LOOK * self._limit and 0.0 < done < spent / (FAR * self._limit):
            raise TimeUpError(f"not done before {spent / done:.2g} s, at its pace")


@dataclass(frozen=True, slots=True)
class Case:
    """A hard scene, or a family of them.

    Attributes:
        name: as in `eventsim stress NAME`.
        title: what happens, in a few words.
        why: why methods fail on it.
        oracle: what is true, and how that is known.
        tolerance: the largest error that counts as right, and `because`: where it comes from.
        judge: runs an engine and returns its error: lengths in reaches, velocities in typical ones, counts as they are.
        refusals: reasons to stop that are a right answer here.
    """

    name: str
    title: str
    why: str
    oracle: str
    tolerance: float
    because: str
    judge: Callable[[Bench], float]
    refusals: tuple[str, ...] = ()


def off(got: Any, expected: Any) -> float:
    """The largest difference between two arrays; inf where they differ in shape or one is not finite."""
    one, other = np.asarray(got, float), np.asarray(expected, float)
    if one.shape != other.shape:
        return np.inf
    if one.size == 0:
        return 0.0
    with np.errstate(invalid="ignore"):
        worst = float(np.abs(one - other).max())
    return worst if worst == worst else np.inf
