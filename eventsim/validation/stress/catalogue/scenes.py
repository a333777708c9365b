"""Scenes that several cases are built from, and contact times without rounding."""

from __future__ import annotations

import math
from decimal import Decimal, localcontext
from typing import Any

import numpy as np

from eventsim.scene import Box, Disks, Open, Periodic, Scene

DIGITS = 60
"""Decimal digits of the oracle of contact times; the cases lose at most 20 of them to cancellation."""


def on_plane(position: Any, velocity: Any, radius: Any = 0.5, mass: Any = 1.0, **rest: Any) -> Scene:
    """Disks on the open plane."""
    return Scene(Disks(position, velocity, radius, mass), Open(), **rest)


def in_box(side: float, position: Any, velocity: Any, radius: Any = 0.5, **rest: Any) -> Scene:
    """Disks in a square box."""
    return Scene(Disks(position, velocity, radius), Box((side, side)), **rest)


def lattice_gas(
    n: int,
    packing: float,
    domain: type[Box] | type[Periodic] | type[Open] = Box,
    seed: int = 1,
    quantum: float | None = None,
    **rest: Any,
) -> Scene:
    """n disks of diameter 1 on a square lattice, normal velocities of zero sum, or multiples of a quantum (many ties)."""
    rng = np.random.default_rng(seed)
    columns = math.ceil(math.sqrt(n))
    pitch = math.sqrt(math.pi * n / (4.0 * packing)) / columns
    if quantum is not None:
        pitch = math.ceil(8.0 * pitch) / 8.0
    sites = np.array([(i, j) for i in range(columns) for j in range(columns)][:n])
    velocity = rng.normal(size=(n, 2))
    velocity -= velocity.mean(axis=0)
    if quantum is not None:
        velocity = np.round(velocity / quantum) * quantum
    disks = Disks((sites + 0.5) * pitch, velocity, 0.5)
    if domain is Open:
        return Scene(disks, Open(), **rest)
    side = pitch * columns
    return Scene(disks, Box((side, side)) if domain is Box else Periodic((side, side)), **rest)


def relabelled(scene: Scene, order: Any) -> Scene:
    """The same scene with its disks in another order."""
    disks = scene.disks
    return with_disks(
        scene, Disks(disks.position[order], disks.velocity[order], disks.radius[order], disks.mass[order])
    )


def with_disks(scene: Scene, disks: Disks, **changes: Any) -> Scene:
    """The same scene with other disks."""
    given: dict[str, Any] = {
        "domain": scene.domain,
        "walls": scene.walls,
        "gravity": scene.gravity,
        "restitution": scene.restitution,
        "contact_duration": scene.contact_duration,
        "until": scene.until,
        "events": scene.events,
        "start_time": scene.start_time,
    }
    return Scene(disks, **(given | changes))


def exact_delay(dx: float, dy: float, du: float, dw: float, reach: float) -> float:
    """When two disks meet, rounded once: c / (-b + sqrt D) in decimal numbers of 60 digits."""
    with localcontext() as context:
        context.prec = DIGITS
        x, y, u, w, r = (Decimal(value) for value in (dx, dy, du, dw, reach))
        b, c = x * u + y * w, x * x + y * y - r * r
        cross = x * w - y * u
        d = (u * u + w * w) * r * r - cross * cross
        return float(c / (-b + d.sqrt()))
