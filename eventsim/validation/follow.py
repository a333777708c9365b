"""Follow an engine: its positions at chosen times, what it found on the way, and how long it took."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from time import perf_counter, thread_time
from typing import NamedTuple

import numpy as np

from eventsim.engines.base import Counters, Session, Stop
from eventsim.record.events import Floats, Rows, blank_rows, joined
from eventsim.runner.outcome import state_of
from eventsim.runner.residuals import Residuals, residuals_of
from eventsim.scene.stage import Stage

STINT = 20_000
"""Steps between two looks at the stopwatch."""


@dataclass(frozen=True, slots=True)
class Followed:
    """What an engine did.

    times: (T,) on the scene's clock, those that it reached.  position, velocity: (T, n, 2) then.  rows: its log.
    elapsed_s: simulating only, in CPU seconds: what a stopwatch shows where nothing else runs, and what other programs do not
    change.  stopped: the reason where it did not reach the last time, else None.
    """

    times: Floats
    position: Floats
    velocity: Floats
    rows: Rows
    counters: Counters
    residuals: Residuals
    elapsed_s: float
    stopped: str | None


def follow(session: Session, times: Sequence[float], patience_s: float = float("inf")) -> Followed:
    """Let a session run through increasing times; it is given up when it takes longer than `patience_s` CPU seconds."""
    blocks = [blank_rows(0)]
    states = []
    elapsed, wall, stopped, before = 0.0, 0.0, None, session.compile_s
    for time in times:
        reason = None
        while reason is None and elapsed < patience_s:
            began, began_wall = thread_time(), perf_counter()
            reason = session.advance(Stop(until=time), STINT)
            elapsed, wall = elapsed + thread_time() - began, wall + perf_counter() - began_wall
            blocks.append(session.take_rows())
        if reason not in ("until", "quiet"):
            stopped = reason or "patience"
            break
        states.append(state_of(session, Stop(until=time), reason))
    compiled = session.compile_s - before  # by a stopwatch
    if compiled > 0.0:
        elapsed = max(wall - compiled, 0.0)
    n = session.stage.n
    empty: Floats = np.empty((0, n, 2))
    return Followed(
        times=np.array(times[: len(states)], dtype=np.float64),
        position=np.array([state.position for state in states]) if states else empty,
        velocity=np.array([state.velocity for state in states]) if states else empty,
        rows=joined(blocks),
        counters=session.counters.copy(),
        residuals=residuals_of(session),
        elapsed_s=elapsed,
        stopped=stopped,
    )


class Scouted(NamedTuple):
    """Why a session stopped, None where its time was over; and the first rows of its log."""

    stopped: str | None
    rows: Rows


def advanced(session: Session, stop: Stop, patience_s: float, most_rows: int) -> Scouted:
    """Let a session run to a stop, for about `patience_s` CPU seconds of simulating at most.

    Args:
        session: the engine.
        stop: when it is to stop.
        patience_s: seconds after which it is given up.
        most_rows: about how many rows are kept.
    """
    spent, blocks, kept = 0.0, [blank_rows(0)], 0
    while True:
        began, compiled = thread_time(), session.compile_s
        reason = session.advance(stop, STINT)
        spent += max(thread_time() - began - (session.compile_s - compiled), 0.0)
        rows = session.take_rows()
        if kept < most_rows:
            blocks.append(rows)
            kept += len(rows)
        if reason is not None or spent >= patience_s:
            return Scouted(reason, joined(blocks))


def distances(stage: Stage, one: Floats, other: Floats) -> Floats:
    """How far disks are apart, length, (..., n), for positions (..., n, 2) on the scene's axes; nearest images."""
    d = stage.nearest(one - other)
    return np.hypot(d[..., 0], d[..., 1])


def position_errors(stage: Stage, one: Followed, other: Followed) -> Floats:
    """Root mean square distance at each common time, in mean diameters (in length units where all disks are points)."""
    count = min(len(one.times), len(other.times))
    d = distances(stage, one.position[:count], other.position[:count])
    diameter = 2.0 * float(stage.radius.mean()) or 1.0
    return np.asarray(np.sqrt(np.mean(d**2, axis=-1)) / diameter)
