"""How far floats may be from the truth: rounding, and its growth along the true trajectory.

`Doubt` holds the covariance of what rounding has made of all places and velocities, to first order.  A flight, a
contact, a rest are linear maps of small deviations; each event adds the rounding of an engine that calculates with
care: a last bit of each place, velocity and time.  What is exact stays exact: a coordinate that is a float and came
by exact steps gets no rounding.  So a tie, a tangency or a touch in the starting floats is not in doubt, and is
judged.

Contacts make the map of a deviation: a place that is off by dx meets at another time, dt = -n.dx / n.v, at another
place and, on a round wall, with another normal.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from tests.oracle.digits import UNIT

Floats: TypeAlias = NDArray[np.float64]

SAFE = 64.0
"""How many standard deviations of rounding are granted: roundings add up in one direction, and formulas take some
steps.
"""


class Doubt:
    """The covariance (4n, 4n) of the deviations (x, y, u, w) of n disks, each at the time of its flight's beginning."""

    def __init__(self, n: int) -> None:
        self.p: Floats = np.zeros((4 * n, 4 * n))

    def fly(self, i: int, delay: float) -> None:
        """Let disk i fly on."""
        if delay == 0.0:
            return
        p, k = self.p, 4 * i
        p[k : k + 2] += delay * p[k + 2 : k + 4]
        p[:, k : k + 2] += delay * p[:, k + 2 : k + 4]

    def round(self, i: int, sigma: Sequence[float]) -> None:
        """Add independent roundings of x, y, u, w of disk i."""
        k = 4 * i
        for axis, s in enumerate(sigma):
            self.p[k + axis, k + axis] += s * s

    def map(self, disks: Sequence[int], matrix: Floats) -> None:
        """Apply a linear map to the deviations of some disks."""
        rows = [4 * i + k for i in disks for k in range(4)]
        with np.errstate(over="ignore", invalid="ignore"):  # what has grown so far ends the judging
            self.p[rows] = matrix @ self.p[rows]
            self.p[:, rows] = self.p[:, rows] @ matrix.T

    def spread(self, terms: Sequence[tuple[int, float, float, float]]) -> float:
        """The standard deviation of a sum of h.dx over (disk, delay since its flight began, hx, hy)."""
        rows: list[int] = []
        weights: list[float] = []
        for i, delay, hx, hy in terms:
            rows += [4 * i, 4 * i + 1, 4 * i + 2, 4 * i + 3]
            weights += [hx, hy, delay * hx, delay * hy]
        h = np.array(weights)
        square = h @ self.p[np.ix_(rows, rows)] @ h
        return float(np.sqrt(square)) if square > 0.0 else 0.0

    def error(self, i: int, delay: float) -> float:
        """A bound of the standard deviation of the place of disk i after a delay."""
        p, k = self.p, 4 * i
        return float(
            np.sqrt(max(p[k, k] + p[k + 1, k + 1], 0.0))
            + abs(delay) * np.sqrt(max(p[k + 2, k + 2] + p[k + 3, k + 3], 0.0))
        )

    def speed_error(self, i: int) -> float:
        """The standard deviation of the velocity of disk i."""
        p, k = self.p, 4 * i
        return float(np.sqrt(max(p[k + 2, k + 2] + p[k + 3, k + 3], 0.0)))


class NoDoubt(Doubt):
    """Puts doubt aside: nothing is rounded, nothing grows."""

    def fly(self, i: int, delay: float) -> None:
        """Nothing grows."""

    def round(self, i: int, sigma: Sequence[float]) -> None:
        """Nothing is rounded."""

    def map(self, disks: Sequence[int], matrix: Floats) -> None:
        """Nothing grows."""

    def spread(self, terms: Sequence[tuple[int, float, float, float]]) -> float:
        """Nothing is in doubt."""
        return 0.0


def contact_map(
    normal: tuple[float, float],
    bend: float,
    velocities: Sequence[tuple[tuple[float, float], tuple[float, float]]],
    pulls: Sequence[tuple[tuple[float, float], tuple[float, float]]],
    shares: Sequence[float],
    restitution: float,
) -> Floats:
    """The map of deviations by one contact, of a disk with a wall (4, 4) or of two disks (8, 8).

    normal: unit, pointing to the first disk.  bend: how the normal turns with the place, 1/distance from a round
    thing's centre (negative inside).  velocities, pulls: before and after, of each disk.  shares: what part of the
    change each disk takes, 1 at a wall.
    """
    n = np.array(normal)
    count = len(shares)
    size = 4 * count
    sides = (1.0, -1.0)[:count]
    w = sum(s * np.array(v[0]) for s, v in zip(sides, velocities, strict=True))
    acc = sum(s * np.array(g[0]) for s, g in zip(sides, pulls, strict=True))
    across = np.zeros((2, size))
    moving = np.zeros((2, size))
    for k, s in enumerate(sides):
        across[:, 4 * k : 4 * k + 2] = s * np.eye(2)
        moving[:, 4 * k + 2 : 4 * k + 4] = s * np.eye(2)
    rate = float(n @ w)
    late = -(n @ across) / rate
    shift = across + np.outer(w, late)
    faster = moving + np.outer(acc, late)
    turn = bend * (np.eye(2) - np.outer(n, n)) @ shift
    change = np.outer(n, w @ turn + n @ faster) + rate * turn
    matrix = np.eye(size)
    for k, (s, share) in enumerate(zip(sides, shares, strict=True)):
        before, after = (np.array(v) for v in velocities[k])
        pull_before, pull_after = (np.array(g) for g in pulls[k])
        matrix[4 * k : 4 * k + 2] += np.outer(before - after, late)
        matrix[4 * k + 2 : 4 * k + 4] += (
            np.outer(pull_before - pull_after, late) - s * share * (1.0 + restitution) * change
        )
    return matrix


def rest_map(e: tuple[float, float]) -> Floats:
    """Coming to rest on a line of direction e: what was across it is gone."""
    along = np.outer(e, e)
    matrix = np.zeros((4, 4))
    matrix[:2, :2] = matrix[2:, 2:] = along
    return matrix


def leave_map(e: tuple[float, float], speed: float, pull_change: tuple[float, float]) -> Floats:
    """Sliding over the end of a line of direction e at that speed: the pull changes then."""
    late = np.array([-e[0] / speed, -e[1] / speed, 0.0, 0.0])
    matrix = np.eye(4)
    matrix[2:] += np.outer(np.array(pull_change), late)
    return matrix


def last_bits(*sizes: Any) -> float:
    """What rounding takes of a number that is a sum of terms of these sizes."""
    return UNIT * float(sum(abs(float(s)) for s in sizes))
