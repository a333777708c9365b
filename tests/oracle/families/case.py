"""A scene to be judged, with its kicks, and what must hold of it even where floats determine nothing."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

import eventsim as es
from tests.oracle.judge import CLOSE
from tests.oracle.story import Kick

Place = tuple[float, float]


@dataclass(frozen=True)
class Case:
    """scene: with its stop.  inside(x, y): whether a disk may be there, with some tolerance; None: not asked.

    close: what is right, in mean free times and the like.
    to_the_end: a run must tell all contacts, also those that floats do not determine, or stop with a reason, so that a tail
    of rounding is no answer.
    """

    scene: Any
    kicks: tuple[Kick, ...] = ()
    inside: Callable[[float, float], bool] | None = None
    close: float = CLOSE
    to_the_end: bool = False


def scatter(
    rng: np.random.Generator,
    radii: Sequence[float],
    low: Place,
    high: Place,
    allowed: Callable[[float, float, float], bool] | None = None,
) -> list[Place] | None:
    """Places for disks of these radii in a rectangle of centres, apart from each other; None where there is no room."""
    places: list[Place] = []
    for r in radii:
        for _ in range(300):
            x, y = float(rng.uniform(low[0] + r, high[0] - r)), float(rng.uniform(low[1] + r, high[1] - r))
            apart = all(
                math.hypot(x - px, y - py) > 1.0001 * (r + pr) for (px, py), pr in zip(places, radii, strict=False)
            )
            if apart and (allowed is None or allowed(x, y, r)):
                places.append((x, y))
                break
        else:
            return None
    return places


def scene(**parts: Any) -> Any:
    """A scene from the parts of its disks and the rest."""
    disks = es.Disks(parts.pop("position"), parts.pop("velocity", None), parts.pop("radius"), parts.pop("mass", 1.0))
    return es.Scene(disks=disks, **parts)


def polygon_distance(points: Sequence[Place], x: float, y: float) -> float:
    """How far a point is from the boundary of a polygon: positive inside, negative outside."""
    inside, nearest = False, math.inf
    for (ax, ay), (bx, by) in zip(points, [*points[1:], points[0]], strict=True):
        if (ay > y) != (by > y) and x < ax + (bx - ax) * (y - ay) / (by - ay):
            inside = not inside
        nearest = min(nearest, segment_distance((ax, ay), (bx, by), x, y))
    return nearest if inside else -nearest


def segment_distance(a: Place, b: Place, x: float, y: float) -> float:
    """The distance of a point from a segment."""
    ex, ey = b[0] - a[0], b[1] - a[1]
    share = ((x - a[0]) * ex + (y - a[1]) * ey) / (ex * ex + ey * ey)
    share = min(1.0, max(0.0, share))
    return math.hypot(x - a[0] - share * ex, y - a[1] - share * ey)


def nudged(x: float, ulps: int) -> float:
    """The float that is so many floats above x."""
    for _ in range(abs(ulps)):
        x = math.nextafter(x, math.inf if ulps > 0 else -math.inf)
    return x


def aim(rng: np.random.Generator, start: Place, goal: Place, speed: float, ulps: int) -> Place:
    """A velocity from a place to a goal, missed by up to so many last bits."""
    dx, dy = goal[0] - start[0], goal[1] - start[1]
    length = math.hypot(dx, dy)
    u, w = speed * dx / length, speed * dy / length
    return nudged(u, int(rng.integers(-ulps, ulps + 1))), nudged(w, int(rng.integers(-ulps, ulps + 1)))
