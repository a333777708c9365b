"""How good a run is: what should have been conserved, and by how much it was not."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from eventsim.engines.base import Motion, Session
from eventsim.record.events import Floats
from eventsim.scene.stage import Stage


@dataclass(frozen=True, slots=True)
class Residuals:
    """How good the run is.

    energy: relative change, None where energy is not conserved.  momentum: what is not booked against walls, immovable
    disks, gravity and kicks, divided by sum m |v|.  max_overlap: the deepest overlap of a pair at contact, in reaches.
    angular_momentum: of places and spins, its change over the sum of the magnitudes of its terms; None where disks have no spin,
    or something outside turns them: walls, periods, gravity, immovable disks, kicks.
    """

    energy: float | None
    momentum: float
    max_overlap: float
    angular_momentum: float | None = None


def residuals_of(session: Session) -> Residuals:
    """The residuals of a run that has come to where its session stands; disks of finite positive mass only."""
    stage = session.stage
    still = np.zeros(stage.n, np.int64)
    start = Motion(stage.x, stage.y, stage.vx, stage.vy, still, still, stage.spin)
    return Residuals(
        energy=_energy_change(session, start, session.motion()),
        momentum=_momentum_left(session, start, session.motion()),
        max_overlap=float(session.counters.deepest_overlap),
        angular_momentum=_angular_momentum_change(session, start, session.motion()),
    )


def _masses(stage: Stage) -> Floats:
    """The masses, with 0 for those that are not finite."""
    if stage.mass is None:
        return np.full(stage.n, stage.common_mass)
    return np.where(np.isfinite(stage.mass), stage.mass, 0.0)


def _energy_change(session: Session, start: Motion, end: Motion) -> float | None:
    """The relative change of the energy; None where contacts, kicks or moving obstacles change it."""
    if not keeps_energy(session.stage) or session.counters.kicks:
        return None
    return energy_change(session.stage, start, end)


def keeps_energy(stage: Stage) -> bool:
    """Whether neither contacts nor moving obstacles change the energy."""
    moves = (stage.vx != 0.0) | (stage.vy != 0.0)
    if stage.spin is not None:
        moves |= stage.spin != 0.0
    return stage.law.keeps_energy() and not (stage.mass is not None and bool(np.any(np.isinf(stage.mass) & moves)))


def energy_change(stage: Stage, start: Motion, end: Motion) -> float:
    """By how much the energy of disks of finite mass changed, over the sum of the magnitudes of its terms at the start."""
    before, scale = _energy(stage, start)
    after, _ = _energy(stage, end)
    return (after - before) / scale if scale > 0.0 else after - before


def _energy(stage: Stage, motion: Motion) -> tuple[float, float]:
    """(energy, sum of the magnitudes of its terms); the potential energy counts from the corner."""
    mass = _masses(stage)
    terms = [0.5 * mass * speed**2 for speed in (motion.vx, motion.vy)]
    if stage.gravity is not None:
        (gx, gy), (length_x, length_y) = stage.gravity, stage.period
        terms.append(-mass * gx * (motion.x + motion.wraps_x * (length_x or 0.0)))
        terms.append(-mass * gy * (motion.y + motion.wraps_y * (length_y or 0.0)))
    if motion.spin is not None and stage.moment is not None:
        terms.append(0.5 * mass * stage.moment * (stage.radius * motion.spin) ** 2)
    every = np.concatenate(terms)
    return math.fsum(every.tolist()), math.fsum(np.abs(every).tolist())


def _angular_momentum_change(session: Session, start: Motion, end: Motion) -> float | None:
    """The change of the angular momentum about the corner, over the sum of the magnitudes of its terms."""
    stage = session.stage
    turned = stage.size is not None or stage.features or stage.gravity is not None or session.counters.kicks
    if stage.moment is None or turned or (stage.mass is not None and np.isinf(stage.mass).any()):
        return None
    mass = _masses(stage)
    before, after = (
        np.concatenate([mass * m.x * m.vy, -mass * m.y * m.vx, mass * stage.moment * stage.radius**2 * _spin(m)])
        for m in (start, end)
    )
    scale = max(math.fsum(np.abs(terms).tolist()) for terms in (before, after))
    change = math.fsum([*after.tolist(), *(-before).tolist()])
    return change / scale if scale > 0.0 else change


def _spin(motion: Motion) -> Floats:
    return np.zeros(len(motion.x)) if motion.spin is None else motion.spin


def _momentum_left(session: Session, start: Motion, end: Motion) -> float:
    """The momentum that is not booked against walls, immovable disks, gravity and kicks, over sum m |v|.

    Where the disks are at rest at both ends, what was booked is the scale.
    """
    stage = session.stage
    mass = _masses(stage)
    epoch, remainder = session.clock
    duration = epoch * stage.epoch_length + remainder
    gravity = stage.gravity or (0.0, 0.0)
    counters = session.counters
    outer = [
        given + force * duration for given, force in zip(counters.outer_momentum, counters.support_force, strict=True)
    ]
    left, booked = [], []
    for axis, (before, after) in enumerate(((start.vx, end.vx), (start.vy, end.vy))):
        change = math.fsum([*(mass * after).tolist(), *(-mass * before).tolist()])
        pull = math.fsum(mass.tolist()) * gravity[axis] * duration
        left.append(change - outer[axis] - pull)
        booked.append(max(abs(outer[axis]), abs(pull)))
    scale = max(*(math.fsum((mass * np.hypot(m.vx, m.vy)).tolist()) for m in (start, end)), *booked)
    return math.hypot(*left) / scale if scale > 0.0 else math.hypot(*left)
