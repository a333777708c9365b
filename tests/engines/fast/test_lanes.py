"""Pairs eight at a time, in NumPy, give the log of the reference engine: what is done around lanes, in plain Python."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import eventsim as es
from eventsim.compiler import is_interpreted
from eventsim.engines.base import Stop
from eventsim.engines.fast import cells, predict
from eventsim.engines.fast.layout import RADIUS, REALS, VX, VY, T, X, Y
from eventsim.formulas.contact import DIGITS_LOST, NEAR, SMALLEST
from eventsim.formulas.doubt import latest_tie
from eventsim.scene.stage import stage_of
from tests.engines.fast.test_same_log import assert_same
from tests.engines.fast.test_same_log import lattice_gas as square_gas
from tests.engines.scenes import lattice_gas, wide_mixture

pytestmark = [
    pytest.mark.kernels,
    pytest.mark.skipif(not is_interpreted(), reason="compiled kernels have lanes of their own"),
]

STOP = Stop(until=100.0, events=60)
SAFE = 1.0 + 2.0**-20


def gather_disks(slots: Any, start: int, limit: int, near: Any, count: int, empty: int, me: int, skip: int) -> int:
    """As `numba_memory.gather_disks`."""
    listed = [j for j in slots.words[start : start + min(limit, 16)].tolist() if j not in (empty, me, skip)]
    near.words[count : count + 16] = listed + [empty] * (16 - len(listed))
    return count + len(listed)


def contact_of_eight(
    disks: Any,
    near: Any,
    first: int,
    x: float,
    y: float,
    vx: float,
    vy: float,
    t: float,
    r: float,
    now: float,
    floor: float,
    x_now: float,
    y_now: float,
    length_x: float,
    length_y: float,
    screen: float,
    edge: float,
    gx: float | None,
    gy: float | None,
) -> tuple[float, int, int, int]:
    """As `numba_memory.contact_of_eight`."""
    others = near.words[first : first + 8]
    other = {k: disks.reals[others * REALS + k] for k in (X, Y, VX, VY, T, RADIUS)}
    begin = np.where(other[T] < t, t, other[T])
    apart: list[Any] = []
    speeds: list[Any] = []
    for z, v, k, kv, here, length, g in ((x, vx, X, VX, x_now, length_x, gx), (y, vy, Y, VY, y_now, length_y, gy)):

        def place(z: Any, v: Any, lag: Any, g: float | None = g) -> Any:
            return z + v * lag if g is None else z + lag * (v + 0.5 * g * lag)

        d = place(z, v, begin - t) - place(other[k], other[kv], begin - other[T])
        if edge and math.isfinite(length):
            seen = here - place(other[k], other[kv], now - other[T])
            d = d - np.where(seen > 0.5 * length, length, np.where(seen < -0.5 * length, -length, 0.0))
        fall = 0.0 if g is None else g
        apart.append(d)
        speeds.append((v + fall * (begin - t)) - (other[kv] + fall * (begin - other[T])))
    (dx, dy), (du, dw) = apart, speeds
    approach, cross, a, d2 = dx * du + dy * dw, dx * dw - dy * du, du * du + dw * dw, dx * dx + dy * dy
    reach2 = (r + other[RADIUS]) * (r + other[RADIUS])
    c, discriminant = d2 - reach2, a * reach2 - cross * cross
    slack = SAFE * (DIGITS_LOST * a * d2 + SMALLEST)
    told = (c > NEAR * SAFE * reach2) & (np.abs(discriminant) > slack)
    doubted = ~(told | (approach * np.abs(approach) > slack)) & ~np.isnan(other[X])
    time = begin + c / (np.sqrt(np.maximum(discriminant, 0.0)) - approach)
    times = np.where(told & (approach < 0.0) & (discriminant > slack) & (time >= floor), time, np.inf)
    lane = int(np.argmin(times))
    many = np.count_nonzero(times <= latest_tie(times[lane], screen)) > 1
    return float(times[lane]), int(others[lane]), int(many), int(sum(1 << k for k in range(8) if doubted[k]))


def ties(domain: str, spacing: float) -> es.Scene:
    return square_gas(9, 9, spacing, np.random.default_rng(8), domain, True, 0.6)


@pytest.mark.parametrize(
    "scene",
    [
        lattice_gas(49, 0.7, es.Periodic),
        lattice_gas(49, 0.7, es.Box),
        es.Scene(lattice_gas(49, 0.4, es.Box).disks, lattice_gas(49, 0.4, es.Box).domain, gravity=(0.25, -0.5)),
        wide_mixture(120, 1, es.Periodic),
        wide_mixture(120, 1, es.Box),
        ties("periodic", 1.0),
        ties("box", 1.25),
    ],
    ids=["torus", "box", "fall", "levels on a torus", "levels in a box", "ties on a torus", "ties in a box"],
)
@pytest.mark.parametrize("all_doubted", [False, True])
def test_lanes_have_the_log_of_the_reference_engine(
    scene: es.Scene, all_doubted: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = []

    def lanes(disks: Any, near: Any, first: int, *flight: Any) -> tuple[float, int, int, int]:
        asked.append(first)
        found = contact_of_eight(disks, near, first, *flight)
        there = ~np.isnan(disks.reals[near.words[first : first + 8] * REALS])
        return (np.inf, found[1], 0, int(sum(1 << k for k in range(8) if there[k]))) if all_doubted else found

    monkeypatch.setattr(predict, "contact_of_eight", lanes)
    monkeypatch.setattr(predict, "gather_disks", gather_disks)
    monkeypatch.setattr(cells, "gather_disks", gather_disks)
    assert_same(stage_of(scene), STOP, lanes=True)
    assert asked
