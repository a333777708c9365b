"""What a log says about the whole gas: its collision rate and its pressure."""

from __future__ import annotations

import numpy as np

from eventsim.record.events import Floats, Kind, Rows
from eventsim.scene.stage import Stage


def kinetic_energy(stage: Stage, velocity: Floats) -> float:
    """The kinetic energy of the finite masses, velocities (n, 2)."""
    mass = np.full(stage.n, stage.common_mass) if stage.mass is None else stage.mass
    mass = np.where(np.isfinite(mass), mass, 0.0)
    return float(0.5 * np.sum(mass * np.sum(velocity**2, axis=-1)))


def collision_rate(stage: Stage, rows: Rows, duration: float) -> float:
    """Contacts with other disks per disk and time."""
    return 2.0 * float(np.count_nonzero(rows["kind"] == Kind.PAIR)) / (stage.n * duration)


def virial_pressure(stage: Stage, rows: Rows, energy: float, duration: float) -> float:
    """Z = 1 + sum of reach times impulse over the pair contacts / (2 E t), E the kinetic energy at the start (= N kT in 2D).

    Of smooth disks, whose impulses are along the normal; stepped engines know no others.

    Source: J. J. Erpenbeck, W. W. Wood, in Modern Theoretical Chemistry 6B (1977); nan without energy.
    """
    pairs = rows[rows["kind"] == Kind.PAIR]
    if not energy > 0.0:
        return float("nan")
    reach = stage.radius[pairs["a"]] + stage.radius[pairs["b"]]
    return 1.0 + float(np.sum(reach * pairs["impulse"])) / (2.0 * energy * duration)
