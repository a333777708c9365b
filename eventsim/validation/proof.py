"""A proof: which events are certain, at how many bits, where all disks then are, and how far float64 had it right."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from os import PathLike

import numpy as np

from eventsim.engines import ENGINES
from eventsim.engines.base import Stop
from eventsim.engines.certified import FIRST_BITS, MOST_BITS, CertifiedOptions
from eventsim.engines.certified.session import Attempt, CertifiedSession
from eventsim.formulas.clock import clock_time
from eventsim.formulas.expansion import two_sum
from eventsim.record.compare import VELOCITIES, agreement, deviations, time_differences
from eventsim.record.events import Floats, Rows, joined
from eventsim.replay.past import PastRun
from eventsim.runner.loop import run_session
from eventsim.runner.options import Interrupt, Progress, RunOptions
from eventsim.runner.outcome import diagnosed
from eventsim.scene import Scene
from eventsim.scene.stage import Stage, stage_of
from eventsim.validation.near_ties import WatchfulSession


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
    blocks: list[Rows] = []
    wanted = RunOptions(log=log, progress=progress, on_event=blocks.append, command=command, interrupt=interrupt)
    run = PastRun.of(run_session(session, ENGINES["certified"], scene, stop, wanted))
    certified = joined(blocks)
    float64 = rounded(stage, scene.domain.size, certified, stop.until, run.stopped in ("quiet", "until"))
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


AHEAD = 4
"""Rows per disk that float64 is simulated beyond the proven ones, so that a contact which comes late there is found."""


@dataclass(frozen=True, slots=True)
class Rounded:
    """What float64 makes of a scene whose order of events is proven.

    Attributes:
        difference: the first proven event that float64 has otherwise, or has not since it stopped; None where there is none.
        agreed: events that it has in the same order.
        surplus: events of float64 behind the last proven one, where the proof came to its end: the scene has no further ones.
        stopped, reason: why it stopped before that event, and the sentence about it; None where it went on.
        deviation: largest distance of a coordinate at an agreed contact from the certified one, length.
        deviation_share: the same as a part of the longer side of the domain; on the open plane, of the extent of all places.
        velocity_deviation: largest distance of a component of a velocity after an agreed contact, length / time.
        velocity_deviation_share: the same as a part of the fastest speed.
        time_deviation: largest difference of the times of an agreed contact, time.
        near_ties: contacts among the agreed ones that share a disk with another one and that only its last bits part from it.
    """

    difference: int | None
    agreed: int
    surplus: int
    stopped: str | None
    reason: str | None
    deviation: float
    deviation_share: float
    velocity_deviation: float
    velocity_deviation_share: float
    time_deviation: float
    near_ties: int


def rounded(
    stage: Stage, size: tuple[float, float] | None, certified: Rows, until: float | Fraction | None, ended: bool
) -> Rounded:
    """Simulate a scene in float64 and compare it with its certified rows.

    size: of its domain, None on the open plane.  ended: whether the proof came to the end of the scene, or to its stop time.
    """
    session = WatchfulSession(stage, keep_rows=True)
    stopped = session.advance(Stop(until, len(certified) + AHEAD * stage.n), 1 << 62)
    assert stopped is not None
    plain = session.take_rows()
    pairs, difference, _, surplus = agreement(certified, plain)
    missing = difference is None and len(pairs) < len(certified) and stopped != "events"
    early, reason = diagnosed(session, stopped, plain) if missing else (None, None)
    places = float(deviations(certified, plain, pairs).max(initial=0.0))
    velocities = float(deviations(certified, plain, pairs, VELOCITIES).max(initial=0.0))
    length = max(size) if size is not None else _extent(stage, certified, plain)
    return Rounded(
        difference=len(pairs) if missing else difference,
        agreed=len(pairs),
        surplus=surplus if ended and difference is None else 0,
        stopped=early,
        reason=reason,
        deviation=places,
        deviation_share=_share(places, length),
        velocity_deviation=velocities,
        velocity_deviation_share=_share(velocities, _fastest(stage, certified, plain)),
        time_deviation=float(time_differences(certified, plain, pairs, stage.epoch_length).max(initial=0.0)),
        near_ties=session.near_ties_until(float(plain["time"][pairs[-1][1]])) if len(pairs) else 0,
    )


def _share(part: float, whole: float) -> float:
    return part / whole if part else 0.0  # of what has no extent, or lies still, nothing differs


def _extent(stage: Stage, *logs: Rows) -> float:
    """The longer side of the box around all disks at the start and at their contacts; length."""
    sides = []
    for start, names in ((stage.x, ("xa", "xb")), (stage.y, ("ya", "yb"))):
        values = np.concatenate([start, *(rows[name] for rows in logs for name in names)])
        sides.append(float(np.nanmax(values) - np.nanmin(values)))
    return max(sides) + 2.0 * float(stage.radius.max())


def _fastest(stage: Stage, *logs: Rows) -> float:
    """The largest speed of a disk at the start or after a contact; length / time."""
    speeds: list[Floats] = [np.hypot(stage.vx, stage.vy)]
    for rows in logs:
        speeds += [np.hypot(rows["vxa"], rows["vya"]), np.hypot(rows["vxb"], rows["vyb"])]
    return float(np.nanmax(np.concatenate(speeds)))
