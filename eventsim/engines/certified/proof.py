"""A proof: which events are certain, at how many bits, where all disks then are, and how far float64 had it right."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike

import numpy as np

from eventsim.engines.base import Progress, Run, Stop
from eventsim.engines.certified.session import FIRST_BITS, MOST_BITS, Attempt, CertifiedSession
from eventsim.engines.drive import Wishes, drive
from eventsim.engines.reference import ReferenceSession
from eventsim.formulas.clock import clock_time
from eventsim.record.compare import agreement, deviations
from eventsim.record.events import ROW, Floats, Rows
from eventsim.scene import Scene
from eventsim.scene.stage import Stage, stage_of

AHEAD = 4
"""Rows per disk that float64 is simulated beyond the proven ones, so that a contact which comes late there is found."""


@dataclass(frozen=True, slots=True)
class Proof:
    """What is proven of a scene.

    Attributes:
        run: the certified run; its log and state are the floats nearest to the balls.
        proven: events whose order is certain.
        bits, traced: of the attempt that came farthest; attempts: the other ones.
        enclosures: (n, 4); how far the true x, y, vx, vy may be from those of the final state; length, length / time.
        difference: the first proven event that float64 has otherwise, None where it has none.
        difference_time: its time on the scene's clock.
        agreed: events that float64 has in the same order.
        deviation: largest distance of a float64 coordinate at an agreed contact from the certified one, length.
    """

    run: Run
    proven: int
    bits: int
    traced: bool
    attempts: tuple[Attempt, ...]
    enclosures: Floats
    difference: int | None
    difference_time: float | None
    agreed: int
    deviation: float


def prove(
    scene: Scene,
    stop: Stop,
    log: bool | str | PathLike[str] = False,
    bits: int = FIRST_BITS,
    most_bits: int = MOST_BITS,
    progress: Progress | None = None,
    command: str | None = None,
) -> Proof:
    """Prove the order of the events of a scene up to its stop, and compare float64 with it.

    log: True (in memory) or a path, as of `simulate`.  Raises EventsimError for a scene that cannot be proven.
    """
    stage = stage_of(scene)
    session = CertifiedSession(stage, bits=bits, most_bits=most_bits)
    blocks: list[Rows] = [np.zeros(0, ROW)]
    wishes = Wishes(log=log, progress=progress, on_event=blocks.append, command=command)
    run = drive(session, "certified", scene, stop, wishes)
    certified = np.concatenate(blocks)
    plain = _float64(stage, Stop(stop.until, len(certified) + AHEAD * stage.n))
    common = agreement(certified, plain)
    time = None
    if common.difference is not None:
        row = certified[common.difference]
        time = clock_time(int(row["epoch"]), float(row["remainder"]), stage.epoch_length, stage.start_time)
    return Proof(
        run=run,
        proven=session.counters.events,
        bits=session.bits,
        traced=session.traced,
        attempts=tuple(session.attempts),
        enclosures=_on_axes(session.distances(), run, stage),
        difference=common.difference,
        difference_time=time,
        agreed=len(common.pairs),
        deviation=float(deviations(certified, plain, common.pairs).max(initial=0.0)),
    )


def _on_axes(distances: Floats, run: Run, stage: Stage) -> Floats:
    """Distances that allow for the last bit that positions lose when they are put onto the scene's axes."""
    if stage.corner == (0.0, 0.0):
        return distances
    return np.column_stack([distances[:, :2] + np.spacing(np.abs(run.state.position)), distances[:, 2:]])


def _float64(stage: Stage, stop: Stop) -> Rows:
    session = ReferenceSession(stage)
    session.advance(stop, 1 << 62)
    return session.take_rows()
