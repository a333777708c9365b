"""Disks that grow while they fly, from contact to contact: plain Python, and machine code where there is a compiler.

All radii are R_i s(t) with one scale s(t) = s0 + g t.  Formulas and loop are in one file, so that numba, which keeps compiled
code by the file it came from, notices every edit.  Both ways give the same bits.
"""

from __future__ import annotations

import math
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

Floats: TypeAlias = NDArray[np.float64]
Indices: TypeAlias = NDArray[np.int64]

WALLS, ESCAPE, NOTHING = -2, -7, -1
"""Partners that are no disks: walls are WALLS - 0 (left), -1 (right), -2 (bottom), -3 (top)."""

ARRIVED, ESCAPED, EXHAUSTED = 0, 1, 2
"""Why `grow` returns: the end has come; a disk leaves the place where its neighbours are known; the budget is spent."""


class Stretch(NamedTuple):
    """What holds while disks grow for a while.

    home: (N, 2) places at its beginning.  radius: (N,) that the disks shall have.  first, near: neighbours of disk i are
    near[first[i] : first[i + 1]].  size, period: (2,); period 0 between walls.  scale: of the radii at its beginning; rate: by
    which it grows.  room: how far a disk may go from home.  end: its duration.
    """

    home: Floats
    radius: Floats
    first: Indices
    near: Indices
    size: Floats
    period: Floats
    scale: float
    rate: float
    room: float
    end: float


def growing_delay(dx: float, dy: float, du: float, dw: float, reach: float, rate: float) -> float:
    """The delay until |d + v t| = reach + rate t from above; inf: never; 0 for an overlap that deepens."""
    b = (dx * du + dy * dw) - reach * rate
    c = (dx * dx + dy * dy) - reach * reach
    if c <= 0.0:
        return 0.0 if b < 0.0 else math.inf
    a = (du * du + dw * dw) - rate * rate
    discriminant = b * b - a * c
    if b < 0.0:
        return c / (math.sqrt(discriminant) - b) if discriminant >= 0.0 else math.inf
    return (b + math.sqrt(discriminant)) / -a if a < 0.0 else math.inf


def wall_delay(gap: float, speed: float, rate: float) -> float:
    """The delay until a gap closes that shrinks with the disk's speed towards the wall and its growth."""
    closing = speed + rate
    return max(gap, 0.0) / closing if closing > 0.0 else math.inf


def escape_delay(qx: float, qy: float, u: float, w: float, room: float) -> float:
    """The delay until a disk at q from its place of reference is `room` away from it."""
    v2 = u * u + w * w
    if v2 == 0.0:
        return math.inf
    along = qx * u + qy * w
    inside = max(room * room - (qx * qx + qy * qy), 0.0)
    return (math.sqrt(along * along + v2 * inside) - along) / v2


def nearest(d: float, period: float) -> float:
    """A difference of coordinates to the nearest image; period 0: there are no images."""
    if period > 0.0:
        if d > 0.5 * period:
            return d - period
        if d < -0.5 * period:
            return d + period
    return d


def predict(i: int, now: float, state: Floats, s: Stretch, due: Floats, partner: Indices) -> None:
    """Find the next event of disk i; its flight begins now."""
    x, y, u, w = state[i, 0], state[i, 1], state[i, 2], state[i, 3]
    best = escape_delay(x - s.home[i, 0], y - s.home[i, 1], u, w, s.room)
    who = ESCAPE
    r, growth = s.radius[i] * (s.scale + s.rate * now), s.radius[i] * s.rate
    for axis in range(2):
        if s.period[axis] == 0.0:
            z, v = state[i, axis], state[i, 2 + axis]
            low, high = wall_delay(z - r, -v, growth), wall_delay(s.size[axis] - r - z, v, growth)
            if low < best:
                best, who = low, WALLS - 2 * axis
            if high < best:
                best, who = high, WALLS - 2 * axis - 1
    for k in range(s.first[i], s.first[i + 1]):
        j = s.near[k]
        lag = now - state[j, 4]
        dx = nearest(x - (state[j, 0] + state[j, 2] * lag), s.period[0])
        dy = nearest(y - (state[j, 1] + state[j, 3] * lag), s.period[1])
        reach = s.radius[i] + s.radius[j]
        delay = growing_delay(
            dx, dy, u - state[j, 2], w - state[j, 3], reach * (s.scale + s.rate * now), reach * s.rate
        )
        if delay < best:
            best, who = delay, j
    due[i] = now + best
    partner[i] = who


def settle(i: int, due: Floats, tree: Indices) -> None:
    """Let a disk whose time has changed play against the others up to the root of the tournament."""
    half = len(tree) // 2
    place = (half + i) // 2
    while place >= 1:
        left, right = tree[2 * place], tree[2 * place + 1]
        winner = left
        if left < 0 or (right >= 0 and due[right] < due[left]):
            winner = right
        tree[place] = winner
        place //= 2


def grow(
    state: Floats, s: Stretch, budget: int, due: Floats, partner: Indices, tree: Indices
) -> tuple[int, float, int]:
    """Let disks fly, meet and grow until the end of a stretch; (reason, time, contacts).

    state: (N, 5) x, y, vx, vy and the time of these, 0 at the call.  budget: of contacts.  due, partner: (N,) when each disk has
    its next event and with whom; tree: (2 M,), M >= N a power of two, the tournament of who is next.
    """
    n = len(s.radius)
    half = len(tree) // 2
    for i in range(len(tree)):
        tree[i] = i - half if half <= i < half + n else -1
    for i in range(n):
        predict(i, 0.0, state, s, due, partner)
    for i in range(n):
        settle(i, due, tree)
    now, contacts = 0.0, 0
    while True:
        i = tree[1]
        if due[i] >= s.end:
            return ARRIVED, s.end, contacts
        now = max(now, due[i])
        j = partner[i]
        if j == ESCAPE:
            return ESCAPED, now, contacts
        if contacts >= budget:
            return EXHAUSTED, now, contacts
        contacts += 1
        move(i, now, state)
        if j >= 0:
            move(j, now, state)
            dx = nearest(state[i, 0] - state[j, 0], s.period[0])
            dy = nearest(state[i, 1] - state[j, 1], s.period[1])
            distance = math.sqrt(dx * dx + dy * dy)
            nx, ny = dx / distance, dy / distance
            approach = (state[i, 2] - state[j, 2]) * nx + (state[i, 3] - state[j, 3]) * ny
            # equal masses; elastic in the frame of the growing surfaces, so that they part at once
            push = (s.radius[i] + s.radius[j]) * s.rate - approach
            state[i, 2] += push * nx
            state[i, 3] += push * ny
            state[j, 2] -= push * nx
            state[j, 3] -= push * ny
        else:
            wall = WALLS - j
            axis = wall // 2
            side = 1.0 if wall % 2 == 0 else -1.0
            state[i, 2 + axis] = 2.0 * side * s.radius[i] * s.rate - state[i, 2 + axis]
        for changed in (i, j):
            if changed < 0:
                continue
            predict(changed, now, state, s, due, partner)
            settle(changed, due, tree)
        for changed in (i, j):
            if changed < 0:
                continue
            for k in range(s.first[changed], s.first[changed + 1]):
                other = s.near[k]
                # what it had foreseen with a disk that flies differently now is stale
                if partner[other] == changed and other != i and other != j:
                    move(other, now, state)
                    predict(other, now, state, s, due, partner)
                    settle(other, due, tree)


def move(i: int, now: float, state: Floats) -> None:
    """Bring a disk to the present."""
    lag = now - state[i, 4]
    state[i, 0] += state[i, 2] * lag
    state[i, 1] += state[i, 3] * lag
    state[i, 4] = now
