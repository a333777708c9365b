"""float64 beside a proof: how far it has the proven order, why it ends before, and how large its errors are until then."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eventsim.engines.base import Stop
from eventsim.engines.reference.loop import ReferenceSession
from eventsim.record.compare import VELOCITIES, agreement, deviations
from eventsim.record.events import Floats, Rows
from eventsim.runner.outcome import diagnosed
from eventsim.scene.stage import Stage

AHEAD = 4
"""Rows per disk that float64 is simulated beyond the proven ones, so that a contact which comes late there is found."""


@dataclass(frozen=True, slots=True)
class Rounded:
    """What float64 makes of a scene whose order of events is proven.

    Attributes:
        difference: the first proven event that float64 has otherwise, or has not since it stopped; None where there is none.
        agreed: events that it has in the same order.
        stopped, reason: why it stopped before that event, and the sentence about it; None where it went on.
        deviation: largest distance of a coordinate at an agreed contact from the certified one, length.
        deviation_share: the same as a part of the longer side of the domain; on the open plane, of the extent of all places.
        velocity_deviation: largest distance of a component of a velocity after an agreed contact, length / time.
        velocity_deviation_share: the same as a part of the fastest speed.
    """

    difference: int | None
    agreed: int
    stopped: str | None
    reason: str | None
    deviation: float
    deviation_share: float
    velocity_deviation: float
    velocity_deviation_share: float


def rounded(stage: Stage, size: tuple[float, float] | None, certified: Rows, until: float | None) -> Rounded:
    """Simulate a scene in float64 and compare it with its certified rows; size: of its domain, None on the open plane."""
    session = ReferenceSession(stage)
    stopped = session.advance(Stop(until, len(certified) + AHEAD * stage.n), 1 << 62)
    assert stopped is not None
    plain = session.take_rows()
    pairs, difference = agreement(certified, plain)
    missing = difference is None and len(pairs) < len(certified) and stopped != "events"
    early, reason = diagnosed(session, stopped, plain) if missing else (None, None)
    places = float(deviations(certified, plain, pairs).max(initial=0.0))
    velocities = float(deviations(certified, plain, pairs, VELOCITIES).max(initial=0.0))
    length = max(size) if size is not None else _extent(stage, certified, plain)
    return Rounded(
        difference=len(pairs) if missing else difference,
        agreed=len(pairs),
        stopped=early,
        reason=reason,
        deviation=places,
        deviation_share=_share(places, length),
        velocity_deviation=velocities,
        velocity_deviation_share=_share(velocities, _fastest(stage, certified, plain)),
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
