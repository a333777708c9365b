"""P4: rounds of contacts that become shorter, near the restitution at which they never end."""

from __future__ import annotations

import math

import numpy as np

import eventsim as es
from tests.oracle.families.case import Case, scene

THREE, WALL_AND_TWO = 7 - 4 * math.sqrt(3), 3 - 2 * math.sqrt(2)
"""Critical restitutions of equal masses.  Source: McNamara and Young, Phys. Fluids A 4, 496 (1992), doi:10.1063/1.858323."""


def _near(rng: np.random.Generator, critical: float) -> float:
    return critical * (1 + float(rng.uniform(-0.1, 0.1)) * float(rng.choice([1.0, 0.1, 0.01])))


def three(rng: np.random.Generator) -> Case:
    """Three disks on a line, or slightly bent."""
    bent = 0.0 if rng.random() < 0.5 else float(rng.choice([1e-3, 1e-6, 1e-2])) * float(rng.normal())
    gap = (float(rng.uniform(0.3, 2.0)), float(rng.uniform(0.3, 2.0)))
    made = scene(
        position=[(0.0, 0.0), (1.0 + gap[0], bent), (2.0 + sum(gap), 0.0)],
        velocity=[(1.0, 0.0), (0.0, 0.0), (-float(rng.uniform(0.5, 1.5)), 0.0)],
        radius=0.5,
        mass=1.0 if rng.random() < 0.7 else [1.0, float(rng.uniform(0.5, 2)), 1.0],
        domain=es.Open(),
        restitution=_near(rng, THREE),
        until=1e4,
        events=3000,
    )
    return Case(made, to_the_end=True)


def wall_and_two(rng: np.random.Generator) -> Case:
    """Two disks and a wall."""
    bent = 0.0 if rng.random() < 0.6 else float(rng.choice([1e-3, 1e-6])) * float(rng.normal())
    gap = (float(rng.uniform(0.2, 2.0)), float(rng.uniform(0.3, 2.0)))
    made = scene(
        position=[(0.5 + gap[0], 0.0), (1.5 + sum(gap), bent)],
        velocity=[(0.0, 0.0), (-1.0, 0.0)],
        radius=0.5,
        mass=1.0 if rng.random() < 0.7 else [1.0, float(rng.uniform(0.5, 2))],
        domain=es.Open(),
        walls=[es.Segment((0.0, -9.0), (0.0, 9.0))],
        restitution=_near(rng, WALL_AND_TWO),
        until=1e4,
        events=3000,
    )
    return Case(made, to_the_end=True)


def four(rng: np.random.Generator) -> Case:
    """Four disks on a line, or slightly bent; some with a contact duration."""
    gaps = [float(rng.uniform(0.3, 2.0)) for _ in range(3)]
    bent = 0.0 if rng.random() < 0.5 else float(rng.choice([1e-3, 1e-6])) * float(rng.normal())
    place = [(float(k) + sum(gaps[:k]), bent if k == 2 else 0.0) for k in range(4)]
    lasting = rng.random() < 0.25
    made = scene(
        position=place,
        velocity=[(1.0, 0.0), (0.0, 0.0), (0.0, 0.0), (-float(rng.uniform(0.5, 1.5)), 0.0)],
        radius=0.5,
        mass=1.0 if rng.random() < 0.7 else [1.0, float(rng.uniform(0.5, 2)), float(rng.uniform(0.5, 2)), 1.0],
        domain=es.Open(),
        restitution=float(rng.uniform(0.05, 0.4)),
        contact_duration=float(10.0 ** rng.uniform(-9, -2)) if lasting else None,
        until=1e4,
        events=3000,
    )
    return Case(made, to_the_end=not lasting)


def slanted(rng: np.random.Generator) -> Case:
    """Two disks and a slanted wall, or the side of a channel; some with a contact duration."""
    gap = (float(rng.uniform(0.2, 2.0)), float(rng.uniform(0.3, 2.0)))
    bent = 0.0 if rng.random() < 0.6 else float(rng.choice([1e-3, 1e-6])) * float(rng.normal())
    channel, angle = rng.random() < 0.4, float(rng.uniform(0.1, 1.4))
    nx, ny = (0.0, 1.0) if channel else (math.cos(angle), math.sin(angle))
    along = 5.0, 0.0
    height = 0.5 + gap[0], 1.5 + sum(gap)
    place = [(along[0] + nx * h - ny * s, ny * h + nx * s) for h, s in zip(height, (0.0, bent), strict=True)]
    lasting = rng.random() < 0.25
    made = scene(
        position=place,
        velocity=[(0.0, 0.0), (-nx, -ny)],
        radius=0.5,
        mass=1.0 if rng.random() < 0.7 else [1.0, float(rng.uniform(0.5, 2))],
        domain=es.Channel((10.0, 1e5)) if channel else es.Open(),
        walls=[] if channel else [es.Segment((along[0] - 9 * ny, 9 * nx), (along[0] + 9 * ny, -9 * nx))],
        restitution=_near(rng, WALL_AND_TWO),
        contact_duration=float(10.0 ** rng.uniform(-9, -2)) if lasting else None,
        until=1e4,
        events=3000,
    )
    return Case(made, to_the_end=not lasting)


def heavy(rng: np.random.Generator) -> Case:
    """A light disk between a wall and a heavy one, near the mass at which its contacts never end.

    A round turns approach velocities by a map of determinant e^2, whose trace is 2 e at that mass.
    """
    restitution = 1.0 - float(10.0 ** rng.uniform(-1.3, -0.2))
    mass = 4.0 * restitution / (1.0 - restitution) ** 2
    gap = (float(rng.uniform(0.2, 2.0)), float(rng.uniform(0.3, 2.0)))
    made = scene(
        position=[(0.5 + gap[0], 0.0), (1.5 + sum(gap), 0.0)],
        velocity=[(0.0, 0.0), (-1.0, 0.0)],
        radius=0.5,
        mass=[1.0, _near(rng, mass)],
        domain=es.Open(),
        walls=[es.Segment((0.0, -9.0), (0.0, 9.0))],
        restitution=restitution,
        until=1e6,
        events=3000,
    )
    return Case(made, to_the_end=True)


FAMILIES = {"P4-three": three, "P4-wall": wall_and_two, "P4-four": four, "P4-slanted": slanted, "P4-heavy": heavy}
