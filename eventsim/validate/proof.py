"""A proof: which events are certain, at how many bits, where all disks then are, and how far float64 had it right."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike

import numpy as np

from eventsim.engines import ENGINES
from eventsim.engines.base import Stop
from eventsim.engines.certified.options import FIRST_BITS, MOST_BITS, CertifiedOptions
from eventsim.engines.certified.session import Attempt, CertifiedSession
from eventsim.formulas.clock import clock_time
from eventsim.record.events import ROW, Floats, Rows
from eventsim.record.times import two_sum
from eventsim.replay.past import PastRun
from eventsim.runner.interrupt import Interrupt
from eventsim.runner.loop import run_session
from eventsim.runner.options import Progress, RunOptions
from eventsim.scene import Scene
from eventsim.scene.stage import stage_of
from eventsim.validate.rounded import Rounded, rounded


@dataclass(frozen=True, slots=True)
class Proof:
    """What is proven of a scene.

    Attributes:
        run: the certified run; its log and state are the floats nearest to the balls.
        proven: events whose order is certain.
        bits, traced: of the attempt that came farthest; attempts: the other ones.
        enclosures: (n, 4); how far the true x, y, vx, vy may be from those of the final state; length, length / time.
        float64: what float64 makes of the scene.
        difference_time: of the first event that float64 has otherwise, or not, on the scene's clock; None: there is none.
    """

    run: PastRun
    proven: int
    bits: int
    traced: bool
    attempts: tuple[Attempt, ...]
    enclosures: Floats
    float64: Rounded
    difference_time: float | None


def prove(
    scene: Scene,
    stop: Stop,
    log: bool | str | PathLike[str] = False,
    bits: int = FIRST_BITS,
    most_bits: int = MOST_BITS,
    progress: Progress | None = None,
    command: str | None = None,
    interrupt: Interrupt | None = None,
) -> Proof:
    """Prove the order of the events of a scene up to its stop, and compare float64 with it.

    log: True (in memory) or a path; interrupt: as of `simulate`.  Raises EventsimError for a scene that cannot be proven.
    """
    stage = stage_of(scene)
    session = CertifiedSession(stage, options=CertifiedOptions(bits, most_bits))
    blocks: list[Rows] = [np.zeros(0, ROW)]
    wanted = RunOptions(log=log, progress=progress, on_event=blocks.append, command=command, interrupt=interrupt)
    run = PastRun.of(run_session(session, ENGINES["certified"], scene, stop, wanted))
    certified = np.concatenate(blocks)
    float64 = rounded(stage, scene.domain.size, certified, stop.until)
    time = None
    if float64.difference is not None:
        row = certified[float64.difference]
        time = clock_time(int(row["epoch"]), float(row["remainder"]), stage.epoch_length, stage.start_time)
    return Proof(
        run=run,
        proven=session.counters.events,
        bits=session.bits,
        traced=session.traced,
        attempts=tuple(session.attempts),
        enclosures=_on_axes(session, run),
        float64=float64,
        difference_time=time,
    )


def _on_axes(session: CertifiedSession, run: PastRun) -> Floats:
    """How far the true numbers are from those of the final state: positions may lose a last bit on the scene's axes."""
    distances, motion, corner = session.distances(), session.motion(), session.stage.corner
    for axis, place in enumerate((motion.x, motion.y)):
        shown = run.state.position[:, axis]
        moved, lost = two_sum(place, corner[axis])
        distances[:, axis] += np.where((moved == shown) & (lost == 0.0), 0.0, np.spacing(np.abs(shown)))
    return distances
