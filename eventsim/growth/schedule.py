"""The schedule of growth: fast while there is room, slow towards the end, always at kT = 1 and unit masses."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from eventsim.errors import SceneError
from eventsim.growth.compiled import grower
from eventsim.growth.kernel import ARRIVED, Floats, Indices, Stretch
from eventsim.patience import go_on

Point: TypeAlias = tuple[float, float]

Neighbours: TypeAlias = Callable[[Floats, Floats, Point], tuple[Indices, Indices]]
"""Finds the overlapping pairs (first, second), (M,) each, of disks from places (N, 2), radii (N,) and periods."""

FAST, SLOW = 0.1, 0.01
"""Growth of a mean diameter per time, over the thermal speed: at the start, and from `DENSE` on."""

DENSE = 0.7
"""Packing fraction from which on disks must find their places."""

ROOM = 0.3
"""How far disks may go, in mean radii, before neighbours are looked for again."""

HAIR = 1e-9
"""They grow by so much more than they shall: rounding must not make them overlap."""

PATIENCE, STALLED = 200, 1e-5
"""A packing that grows by less than this share during so many contacts of each disk counts as jammed."""

ATTEMPTS, SLOWER = 3, 0.2
"""A packing that jams too early is made again, growing by this factor more slowly."""


class JammedError(Exception):
    """The disks cannot grow any more; packing_fraction: how far they came."""

    def __init__(self, packing_fraction: float) -> None:
        super().__init__(f"jammed at a packing fraction of {packing_fraction:.4f}")
        self.packing_fraction = packing_fraction


def grown(
    position: Floats,
    radius: Floats,
    scale: float,
    size: Point,
    period: Point,
    rng: np.random.Generator,
    neighbours: Neighbours,
) -> Floats:
    """Centres (N, 2) of disks that have grown to their radii (N,), without overlap.

    position: centres (N, 2) in a rectangle of `size` with corner (0, 0), clear of each other at radii `scale` times as
    large.  period: its periods, inf between walls.  neighbours: finds who is near.  O(contacts log N).

    Raises:
        JammedError: where they do not fit, or did not find how.
    """
    best = 0.0
    for attempt in range(ATTEMPTS):
        slowness = SLOWER**attempt
        try:
            return _Growth(position, radius, scale, size, period, rng, neighbours).run(slowness)
        except JammedError as jammed:
            best = max(best, jammed.packing_fraction)
    raise JammedError(best)


class _Growth:
    """One attempt."""

    def __init__(
        self,
        position: Floats,
        radius: Floats,
        scale: float,
        size: Point,
        period: Point,
        rng: np.random.Generator,
        neighbours: Neighbours,
    ) -> None:
        n = len(radius)
        self.radius = radius
        self.neighbours = neighbours
        self.size = np.array(size)
        self.period = np.array(period)
        self.scale = scale
        self.share = math.pi * float((radius**2).sum()) / (size[0] * size[1])
        self.state = np.zeros((n, 5))
        self.state[:, :2] = position
        self.state[:, 2:4] = rng.standard_normal((n, 2))
        mean = float(radius.mean())
        self.room = ROOM * mean
        self.growth = 0.5 / mean
        widest = 2.0 * float(radius.max()) + 2.0 * self.room
        if (np.isfinite(self.period) & (self.period < 2.0 * widest)).any():
            raise SceneError("a compressed gas needs a period of at least four of its diameters and a little")

    def run(self, slowness: float) -> Floats:
        """Grow to the end; the centres."""
        n = len(self.radius)
        grow = grower(n)
        due, partner = np.zeros(n), np.zeros(n, dtype=np.int64)
        tree = np.zeros(2 << max(n - 1, 1).bit_length(), dtype=np.int64)
        target = 1.0 + HAIR
        turn = math.sqrt(DENSE / self.share)
        before, left = self.scale, PATIENCE * n
        while self.scale < target:
            go_on("to compress these disks")
            fast = self.scale < turn
            rate = self.growth * slowness * (FAST if fast else SLOW)
            goal = min(target, turn) if fast else target
            stretch = self._stretch(rate, (goal - self.scale) / rate)
            reason, time, contacts = grow(self.state, stretch, left, due, partner, tree)
            self._advance(time)
            self.scale = goal if reason == ARRIVED else self.scale + rate * time
            left -= contacts
            if left <= 0:
                if self.scale < before * (1.0 + STALLED):
                    raise JammedError(self.share * self.scale**2)
                before, left = self.scale, PATIENCE * n
        return self.state[:, :2].copy()

    def _stretch(self, rate: float, end: float) -> Stretch:
        """Find everyone's neighbours; bring the velocities back to kT = 1."""
        velocity = self.state[:, 2:4]
        if np.isfinite(self.period).all():
            velocity -= velocity.mean(axis=0)
        velocity /= math.sqrt(0.5 * float((velocity**2).sum()) / len(velocity))
        n = len(self.radius)
        halos = (1.0 + 2.0 * HAIR) * self.radius + self.room
        one, other = self.neighbours(self.state[:, :2].copy(), halos, (float(self.period[0]), float(self.period[1])))
        mine, near = np.concatenate([one, other]), np.concatenate([other, one])
        order = np.lexsort((near, mine))
        first = np.searchsorted(mine[order], np.arange(n + 1)).astype(np.int64)
        period = np.where(np.isfinite(self.period), self.period, 0.0)
        home = self.state[:, :2].copy()
        return Stretch(home, self.radius, first, near[order], self.size, period, self.scale, rate, self.room, end)

    def _advance(self, time: float) -> None:
        """Bring everyone to the end of a stretch, and back into the periods."""
        state = self.state
        state[:, :2] += state[:, 2:4] * (time - state[:, 4])[:, None]
        state[:, 4] = 0.0
        for axis, period in enumerate(self.period.tolist()):
            if math.isfinite(period):
                state[:, axis] -= period * np.floor(state[:, axis] / period)
                state[state[:, axis] >= period, axis] = 0.0
