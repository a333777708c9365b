"""P2, further: exact ties of a pair with what is round, of three walls, across periodic borders, behind kicks, under gravity."""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from functools import wraps
from typing import Any

import numpy as np

import eventsim as es
from tests.oracle.families.case import Case, Place, scene
from tests.oracle.families.ties import Start, at_rest, dyadic, mirrored, moving
from tests.oracle.story import Kick


def ahead(rng: np.random.Generator, x: float) -> tuple[list[Any], list[tuple[Place, float]]]:
    """(walls, immovable disks): something that is met head-on at (x, 0) by what comes along the axis, in numbers of few bits."""
    k = 2.0 ** float(rng.integers(-2, 2))
    kind = int(rng.integers(6))
    if kind == 0:
        return [es.Circle((0.0, 0.0), x)], []
    if kind == 1:  # from inside
        return [es.Arc((x - 2 * k, 4 * k), (x, 0.0), (x - 2 * k, -4 * k))], []
    if kind == 2:  # from outside
        return [es.Arc((x + 2 * k, 4 * k), (x, 0.0), (x + 2 * k, -4 * k))], []
    if kind == 3:
        return [es.Segment((x, 0.0), (x + 4.0, dyadic(rng, -2, 2, 4)))], []
    if kind == 4:
        return [es.Segment((x, -8.0), (x, 8.0))], []
    return [], [((x + k, 0.0), k)]


def mixed(rng: np.random.Generator) -> Case:
    """A disk meets a wall, an end, an arc, a container, an immovable disk head-on, and another disk at the same time."""
    r, t = 0.5, 2.0 ** float(rng.integers(-8, 5))
    v, w = (float(rng.integers(1, 8)) / 4 / t for _ in range(2))
    x = r + v * t + dyadic(rng, 0.0, 2.0, 3)  # the wall; the disk touches it at x - r
    start = x - r - v * t
    if rng.random() < 0.5:  # from behind
        other, speed = (x - 3 * r - (v + w) * t, 0.0), (v + w, 0.0)
    else:  # from the side
        other, speed = (x - r, -2 * r - w * t), (0.0, w)
    walls, posts = ahead(rng, 16.0 if (offset := float(rng.random() < 0.3)) else x)
    shift = 16.0 - x if offset else 0.0
    made = scene(
        position=[(start + shift, 0.0), (other[0] + shift, other[1]), *(place for place, _ in posts)],
        velocity=[(v, 0.0), speed, *((0.0, 0.0) for _ in posts)],
        radius=[r, r, *(radius for _, radius in posts)],
        mass=[1.0, float(rng.choice([1.0, 2.0, 0.5])), *(math.inf for _ in posts)],
        domain=es.Open(),
        walls=walls,
        restitution=float(rng.choice([1.0, 1.0, 0.5])),
        until=1.5 * t,
        events=30,
    )
    return Case(made)


NORMALS = ((63, 16), (63, -16), (60, 25), (60, -25), (52, 39), (52, -39), (33, 56), (33, -56), (25, 60), (25, -60))
"""Directions of length 65."""


def three_walls(rng: np.random.Generator) -> Case:
    """A disk meets three slanted walls at once; the feet of its centre on them are numbers of few bits."""
    k, t = 2.0 ** float(rng.integers(-9, -6)), 2.0 ** float(rng.integers(-10, 6))
    x, way, long = dyadic(rng, -2, 2, 4), dyadic(rng, 0.25, 4.0, 4), float(rng.choice([0.25, 0.125]))
    walls = []
    for n in rng.choice(len(NORMALS), 3, replace=False):
        a, b = (k * one for one in NORMALS[int(n)])
        walls.append(es.Segment((x + a - b * long, b + a * long), (x + a + b * long, b - a * long)))
    made = scene(
        position=[(x - way, 0.0)],
        velocity=[(way / t, 0.0)],
        radius=65 * k,
        domain=es.Open(),
        walls=walls,
        restitution=float(rng.choice([1.0, 0.5])),
        until=1.5 * t,
        events=30,
    )
    return Case(made)


def starts(rng: np.random.Generator) -> Start:
    """A tie of pairs that is not too large for a box."""
    while True:
        start = (at_rest, mirrored, moving)[int(rng.integers(3))](rng)
        if start is not None and max(start.radii) < 8.0 and max(abs(x) for place in start.places for x in place) < 20.0:
            return start


def _exactly(x: float, shift: float, size: float) -> float | None:
    """(x + shift) mod size; None where a bit is lost."""
    moved = (Fraction(x) + Fraction(shift)) % Fraction(size)
    return float(moved) if Fraction(float(moved)) == moved and 0.0 < float(moved) < size else None


def _placed(start: Start, shift: tuple[float, float], size: float) -> list[tuple[float | None, ...]]:
    """The disks of a start in a box."""
    return [tuple(_exactly(x, s, size) for x, s in zip(place, shift, strict=True)) for place in start.places]


def borders(rng: np.random.Generator) -> Case:
    """A tie of pairs anywhere in a periodic box or channel, mostly of images across its borders, some behind wraps."""
    while True:
        start, size = starts(rng), 64.0
        shift = [float(rng.choice([0.0, 0.0, 32.0])) + dyadic(rng, -2, 2, 2) for _ in range(2)]
        channel = rng.random() < 0.3
        if channel:
            shift[1] = 32.0
        if rng.random() < 0.6:  # one that moves passes a border on its way
            way = float(rng.uniform(0.0, 1.0))
            k = int(rng.integers(3))
            axis = 0 if channel else int(rng.integers(2))
            passes = start.places[k][axis] + start.velocities[k][axis] * start.t * way
            shift[axis] = -float(np.round(passes * 2.0**9) / 2.0**9)
        places = _placed(start, (shift[0], shift[1]), size)
        if any(x is None for place in places for x in place):
            continue
        made = scene(
            position=places,
            velocity=start.velocities,
            radius=start.radii,
            mass=[1.0, float(rng.choice([1.0, 2.0])), 1.0],
            domain=es.Channel((size, size)) if channel else es.Periodic((size, size)),
            restitution=float(rng.choice([1.0, 0.5])),
            until=1.5 * start.t,
            events=30,
        )
        return Case(made)


def kicked(rng: np.random.Generator) -> Case:
    """All rest or glide until a disk is kicked so that it meets two others at once; the kick is at any time of few bits."""
    start, size = starts(rng), 64.0
    places = _placed(start, (32.0, 32.0), size)
    if start.velocities[1] != (0.0, 0.0) or start.velocities[2] != (0.0, 0.0) or any(x is None for p in places for x in p):
        return kicked(rng)
    when = 2.0 ** float(rng.integers(-8, 12)) * float(rng.integers(1, 4))
    made = scene(
        position=places,
        velocity=[(0.0, 0.0)] * 3,
        radius=start.radii,
        mass=[1.0, float(rng.choice([1.0, 2.0])), 1.0],
        domain=es.Box((size, size)),
        restitution=float(rng.choice([1.0, 0.5])),
        until=when + 1.5 * start.t,
        events=30,
    )
    return Case(made, kicks=(Kick(0, start.velocities[0], time=when),))


def falling(rng: np.random.Generator) -> Case:
    """Under gravity, on the axis of two mirror images: faces, ends, arcs, immovable disks, or disks that fall as well."""
    r, x, y = 0.5, dyadic(rng, 0.25, 1.5, 6) if rng.random() < 0.5 else float(rng.uniform(0.3, 1.5)), dyadic(rng, -1, 1, 4)
    kind, walls, posts = int(rng.integers(5)), [], []
    rise = float(rng.uniform(0.3, 2.0))
    for s in (1.0, -1.0):
        if kind == 0:
            walls.append(es.Segment((s * 0.125, y), (s * 3.0, y + 3.0 * rise)))
        elif kind == 1:
            walls.append(es.Segment((s * min(x, 0.9 * r), y), (s * 3.0, y - rise)))
        elif kind == 2:
            wide = min(x, 0.8)
            walls.append(es.Arc((s * wide, y), (s * (wide + 1.0), y + 0.75), (s * (wide + 2.0), y)))
        else:
            posts.append(((s * (0.55 + min(x, 0.8) / 4), y), 0.5))
    mass = math.inf if kind == 3 else 1.0
    height = dyadic(rng, 0.5, 4.0, 5) + (1.0 if kind else 3.0 * rise)
    made = scene(
        position=[(0.0, y + r + height), *(place for place, _ in posts)],
        velocity=[(0.0, -dyadic(rng, 0.0, 2.0, 4) - (0.5 if kind == 4 else 0.0)), *((0.0, 0.0) for _ in posts)],
        radius=[r, *(radius for _, radius in posts)],
        mass=[1.0, *(mass for _ in posts)],
        domain=es.Open(),
        walls=walls,
        gravity=(0.0, -1.0),
        restitution=float(rng.choice([1.0, 1.0, 0.75])),
        until=4.0,
        events=8,
    )
    return Case(made)


def valid(make: Callable[[np.random.Generator], Case]) -> Callable[[np.random.Generator], Case]:
    """The same, again until the scene is a legal one."""

    @wraps(make)
    def made(rng: np.random.Generator) -> Case:
        while True:
            try:
                return make(rng)
            except es.SceneError:
                continue

    return made


FAMILIES = {
    "P2-mixed": valid(mixed),
    "P2-three-walls": valid(three_walls),
    "P2-borders": valid(borders),
    "P2-kicked": valid(kicked),
    "P2-falling": valid(falling),
}
