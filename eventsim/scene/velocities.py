"""Velocities of a gas at its start."""

from __future__ import annotations

import math

import numpy as np

from eventsim.scene.disks import Floats


def thermal_velocities(count: int, mass: float, temperature: float, rng: np.random.Generator) -> Floats:
    """Maxwell's velocities (N, 2) of N equal disks at kT = `temperature`, without total momentum.

    They are scaled so that the mean of m v^2 / 2 is kT but for rounding. A single disk keeps the velocity that is
    drawn for it: without momentum it would be at rest. Draws 2 N normal numbers, x before y, disk by disk.
    """
    velocity = rng.standard_normal((count, 2))
    if count > 1:
        velocity -= velocity.mean(axis=0)
        velocity *= math.sqrt(2.0 * count / float((velocity**2).sum()))
    velocity *= math.sqrt(temperature) / math.sqrt(mass)
    return velocity


def equal_speeds(count: int, speed: float, rng: np.random.Generator) -> Floats:
    """Velocities (N, 2) of one speed in random directions. Draws N uniform numbers, one angle for each disk."""
    angle = 2.0 * math.pi * rng.random(count)
    return speed * np.stack([np.cos(angle), np.sin(angle)], axis=1)
