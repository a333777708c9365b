"""The horizon: up to which event a float64 trajectory is the true one, told by shadows with last bits of their own.

Rounding moves a trajectory by last bits, at its start and at every contact; from then on its error grows as that of any other
trajectory which is a last bit away.  So where the first of a few such shadows takes another order of events, the true one is
about to do so too: an error that is twice as large is only as early as it takes to gain a bit, one of 53.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from eventsim.engines.base import Session, Stop
from eventsim.engines.reference.calendar import Event
from eventsim.engines.reference.loop import ReferenceSession
from eventsim.engines.reference.resolve import Resolver
from eventsim.record.compare import Comparison, time_differences
from eventsim.record.events import Floats, Rows
from eventsim.scene import Scene
from eventsim.scene.stage import Stage, stage_of
from eventsim.validation.near_ties import WatchfulSession

SHADOWS, SEED = 4, 1
"""Shadows, and the seed of the last bits that they differ by."""

CLOCK = ["time", "epoch", "remainder"]
"""The columns that are kept of rows that have been compared."""

BLOCK = 4
"""Rows per disk between two comparisons."""

FARTHEST = 400
"""Rows per disk after which no estimate goes on: a scene that has not parted by then hardly amplifies errors."""


@dataclass(frozen=True, slots=True)
class Horizon:
    """Where float64 stops being the true trajectory.

    event, time: of the first row that differs in a shadow, or that only one of both has (time on the scene's clock); None where
    none differs in the `events` rows that were compared, up to the time `until`.
    near_ties: contacts until then that share a disk and that only last bits part.
    apart: the largest difference, time, between when a contact before that event comes in the scene and in a shadow.
    """

    event: int | None
    time: float | None
    events: int
    until: float
    near_ties: int = 0
    apart: float = 0.0


def horizon(scene: Scene, stop: Stop, farthest: int = FARTHEST) -> Horizon:
    """Estimate the horizon of a scene; not beyond its stop, and not beyond `farthest` rows a disk.

    Costs as much as simulating 5 times up to there, with the reference engine.
    """
    stage = stage_of(scene)
    rng = np.random.default_rng(SEED)
    true = WatchfulSession(stage, keep_rows=True)
    shadows: list[Session] = [_Shadow(_moved(stage, rng), rng) for _ in range(SHADOWS)]
    comparisons = [Comparison() for _ in shadows]
    limit = farthest * stage.n if stop.events is None else min(farthest * stage.n, stop.events)
    done, time = 0, stage.start_time
    seen: list[Rows] = []
    theirs: list[list[Rows]] = [[] for _ in shadows]
    stopped: str | None = None
    while stopped in (None, "events") and done < limit:
        target = min(limit, done + BLOCK * stage.n)
        stopped = _advance(true, stop.until, target)
        rows = true.take_rows()
        done += len(rows)
        seen.append(rows[CLOCK])
        for shadow, comparison, kept in zip(shadows, comparisons, theirs, strict=True):
            ended = _advance(shadow, stop.until, target)
            other = shadow.take_rows()
            kept.append(other[CLOCK])
            comparison.add(rows, other)
            if stopped not in (None, "events") and ended not in (None, "events"):
                comparison.end()
        found = [comparison.difference for comparison in comparisons if comparison.difference is not None]
        if found:
            first, times = min(found), np.concatenate(seen)["time"]
            at = float(times[min(first, len(times) - 1)]) if len(times) else time  # a surplus row comes behind the last one
            apart = _apart(stage, seen, theirs, comparisons, first)
            return Horizon(first, at, done, float(times[-1]) if len(times) else time, true.near_ties_until(at), apart)
        time = float(rows["time"][-1]) if len(rows) else time
    return Horizon(None, None, done, time, len(true.near_ties), _apart(stage, seen, theirs, comparisons, done))


def _apart(
    stage: Stage, seen: list[Rows], theirs: list[list[Rows]], comparisons: list[Comparison], first: int
) -> float:
    """The largest difference in time of the contacts before row `first` that a shadow has too; time."""
    largest = 0.0
    for kept, comparison in zip(theirs, comparisons, strict=True):
        pairs = comparison.agreement().pairs
        pairs = pairs[pairs[:, 0] < first]
        if len(pairs):
            differences = time_differences(np.concatenate(seen), np.concatenate(kept), pairs, stage.epoch_length)
            largest = max(largest, float(differences.max()))
    return largest


def _advance(session: Session, until: float | Fraction | None, events: int) -> str | None:
    """Simulate to the number of events in all; the reason where the session stopped before."""
    stopped = None
    while stopped is None:
        stopped = session.advance(Stop(until, events), 1 << 20)
    return stopped


class _Noisy(Resolver):
    """Leaves the velocities behind a contact by a last bit off, up or down; not those of what rests, or what nothing deflects."""

    rng: np.random.Generator

    def resolve(self, component: list[Event]) -> list[int]:
        changed = super().resolve(component)
        for i in changed:
            if self._state.support_of(i) is None and not self._masses.is_immovable(i):
                for values in (self._state.vx, self._state.vy):
                    if values[i] != 0.0:
                        values[i] = math.nextafter(values[i], math.inf if self.rng.random() < 0.5 else -math.inf)
        return changed


class _Shadow(ReferenceSession):
    """The reference engine with other last bits at every contact."""

    resolver = _Noisy

    def __init__(self, stage: Stage, rng: np.random.Generator) -> None:
        super().__init__(stage)
        assert isinstance(self._resolver, _Noisy)
        self._resolver.rng = rng


def _moved(stage: Stage, rng: np.random.Generator) -> Stage:
    """The stage with every coordinate and velocity of a moving disk changed by its last bit, up or down."""

    def nudged(values: Floats) -> Floats:
        moves = (stage.vx != 0.0) | (stage.vy != 0.0)
        return np.where(moves, np.nextafter(values, np.where(rng.random(len(values)) < 0.5, -np.inf, np.inf)), values)

    vx, vy = nudged(stage.vx), nudged(stage.vy)
    return replace(stage, x=nudged(stage.x), y=nudged(stage.y), vx=vx, vy=vy)
