"""`stepped`: a fair fixed-step engine: move everything for dt, then resolve what overlaps and approaches.

Each contact once: after it is resolved the pair recedes, and is left alone however long it overlaps.  Order: free flight
exact (also under gravity); a contact is found up to one step late, so positions are wrong by O(dt): order 1.

locate: go back to the instant of first touch within the step, resolve there, fly the rest; earliest contacts first.  Then a
contact of its own is exact (on a chord of the parabola at walls: order 2), and what is wrong are contacts that a step skips, or
that follow one another within one step.

Cost per step: O(neighbour pairs), whether something happens or not.  Source: what game and robot engines do, as in E. Catto,
Continuous collision, Game Developers Conference (2013); neighbour lists by Verlet (see `neighbours`).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from eventsim.engines.stepped import FixedStepOptions
from eventsim.engines.stepped.compiled import kernel, part
from eventsim.engines.stepped.disks import Moving, fastest, fly, wrap
from eventsim.engines.stepped.found import (
    DEEPEST,
    EVENTS,
    MOVED,
    OUTER_X,
    OUTER_Y,
    ROW_COUNT,
    TESTS,
    Found,
    meet,
    note_pair,
    note_wall,
)
from eventsim.engines.stepped.ground import Ground, nearest
from eventsim.engines.stepped.neighbours import Neighbours
from eventsim.engines.stepped.session import SteppedSession
from eventsim.formulas.image import nearest_image
from eventsim.formulas.impulse import mass_fractions, pair_update, wall_update
from eventsim.record.events import Floats
from eventsim.scene.stage import Stage


class FixedStepSession(SteppedSession):
    """The engine `stepped` in the middle of a run; locate: find the instant of touch within a step."""

    name = "stepped"

    def __init__(self, stage: Stage, keep_rows: bool = True, options: FixedStepOptions | None = None) -> None:
        options = options or FixedStepOptions()
        super().__init__(stage, keep_rows, options.dt)
        self._locate = options.locate
        self._neighbours = Neighbours(stage.n)
        self._scratch = np.empty(0), np.empty(0, np.int64)
        self._run(0, 0)  # compiles, so that no stopwatch sees it

    def _run(self, steps: int, most_events: int) -> int:
        near, m = self._neighbours, self.disks
        near.renew(m, self.ground, self.found, self.dt)
        room = near.count + self.stage.n * len(self.ground.kind)
        self._make_room(room)
        if len(self._scratch[0]) < room:
            self._scratch = np.empty(2 * room), np.empty(2 * room, np.int64)
        done: int = run_steps(
            m,
            self.ground,
            self.found,
            near.pairs[: near.count],
            near.skin,
            self.stage.law.pair,
            self.stage.law.wall,
            self.dt,
            self._locate,
            self.clock_of_steps.steps,
            steps,
            most_events,
            *self._scratch,
        )
        return done


@kernel
def run_steps(
    m: Moving,
    ground: Ground,
    found: Found,
    pairs: NDArray[np.int64],
    skin: float,
    pair_restitution: float,
    wall_restitution: float,
    dt: float,
    locate: bool,
    first: int,
    steps: int,
    most_events: int,
    since: Floats,
    touching: NDArray[np.int64],
) -> int:
    """Steps first, first + 1, ...; how many were done before `steps`, the list getting old, or enough rows and events."""
    walls = len(ground.kind)
    room = len(pairs) + len(m.x) * walls
    fall = math.sqrt(ground.gx * ground.gx + ground.gy * ground.gy) * dt
    for k in range(steps):
        if found.counts[EVENTS] >= most_events or 0 < len(found.rows) < found.counts[ROW_COUNT] + room:
            return k
        if 2.0 * (found.sums[MOVED] + (fastest(m) + fall) * dt) > skin:
            return k
        found.sums[MOVED] += (fly(m, ground, dt) + fall) * dt
        now = (first + k + 1) * dt
        count = overlaps(m, ground, found, pairs, dt, locate, since, touching)
        if count > 1:
            sort_contacts(pairs, len(m.x), locate, since[:count], touching[:count])
        for c in range(count):
            index = touching[c]
            if index < len(pairs):
                i, j = pairs[index, 0], pairs[index, 1]
                resolve_pair(m, ground, found, i, j, pair_restitution, dt, locate, now)
            else:
                i, w = (index - len(pairs)) // walls, (index - len(pairs)) % walls
                resolve_wall(m, ground, found, i, w, wall_restitution, dt, locate, now)
        if locate and count > 0:
            wrap(m, ground)
    return steps


@part
def sort_contacts(pairs: NDArray[np.int64], n: int, locate: bool, since: Floats, touching: NDArray[np.int64]) -> None:
    """Order contacts by (a, b), walls last, so that no list of neighbours decides; located: the earliest first."""
    keys = np.empty(len(touching), np.int64)
    for c in range(len(touching)):
        index = touching[c]
        keys[c] = pairs[index, 0] * n + pairs[index, 1] if index < len(pairs) else n * n + index - len(pairs)
    order = np.argsort(keys)
    if locate:
        order = order[np.argsort(-since[order], kind="mergesort")]
    touching[:] = touching[order]


@part
def overlaps(
    m: Moving,
    ground: Ground,
    found: Found,
    pairs: NDArray[np.int64],
    dt: float,
    locate: bool,
    since: Floats,
    touching: NDArray[np.int64],
) -> int:
    """Note in `touching` which pairs and walls overlap, in `since` for how long; their number."""
    count = 0
    x, y, radius = m.x, m.y, m.radius
    length_x, length_y = ground.length_x, ground.length_y
    for p in range(len(pairs)):
        i, j = pairs[p, 0], pairs[p, 1]
        dx = nearest_image(x[i] - x[j], length_x)
        dy = nearest_image(y[i] - y[j], length_y)
        reach = radius[i] + radius[j]
        distance2 = dx * dx + dy * dy
        if distance2 < reach * reach and meet(m.mass[i], m.mass[j]):
            found.sums[DEEPEST] = max(found.sums[DEEPEST], 1.0 - math.sqrt(distance2) / reach)
            back = time_of_pair(m, ground, i, j)
            approach = dx * (m.vx[i] - m.vx[j]) + dy * (m.vy[i] - m.vy[j]) < 0.0
            if approach or (locate and back <= dt):
                since[count], touching[count] = back, p
                count += 1
    found.counts[TESTS] += len(pairs)
    walls = len(ground.kind)
    for i in range(len(x)):
        for w in range(walls):
            nx, ny, distance = nearest(ground.kind[w], ground.numbers[w], x[i], y[i])
            if distance < radius[i]:
                speed = nx * m.vx[i] + ny * m.vy[i]
                if speed < 0.0:
                    since[count], touching[count] = (radius[i] - distance) / -speed, len(pairs) + i * walls + w
                    count += 1
    return count


@part
def time_of_pair(m: Moving, ground: Ground, i: int, j: int) -> float:
    """How long ago an overlapping pair touched: the positive root of |d - u s| = reach; inf where it never did."""
    dx = nearest_image(m.x[i] - m.x[j], ground.length_x)
    dy = nearest_image(m.y[i] - m.y[j], ground.length_y)
    du, dw = m.vx[i] - m.vx[j], m.vy[i] - m.vy[j]
    reach = m.radius[i] + m.radius[j]
    a, b = du * du + dw * dw, dx * du + dy * dw
    c = dx * dx + dy * dy - reach * reach
    if a == 0.0:
        return math.inf
    root = math.sqrt(max(b * b - a * c, 0.0))
    back: float = (b + root) / a if b >= 0.0 else -c / (root - b)
    return back


@part
def fly_back(m: Moving, ground: Ground, i: int, back: float) -> None:
    """Put a disk where it was a time ago."""
    m.x[i] -= back * (m.vx[i] - 0.5 * ground.gx * back)
    m.y[i] -= back * (m.vy[i] - 0.5 * ground.gy * back)
    m.vx[i] -= ground.gx * back
    m.vy[i] -= ground.gy * back


@part
def resolve_pair(
    m: Moving, ground: Ground, found: Found, i: int, j: int, restitution: float, dt: float, locate: bool, now: float
) -> None:
    """Resolve a pair if it still overlaps and approaches; located: at the instant of touch, then back to now."""
    back = 0.0
    if locate:
        dx = nearest_image(m.x[i] - m.x[j], ground.length_x)
        dy = nearest_image(m.y[i] - m.y[j], ground.length_y)
        reach = m.radius[i] + m.radius[j]
        if not dx * dx + dy * dy < reach * reach:
            return  # an earlier contact of this step has parted them
        back = time_of_pair(m, ground, i, j)
        back = back if back <= dt else 0.0
        fly_back(m, ground, i, back)
        fly_back(m, ground, j, back)
    dx = nearest_image(m.x[i] - m.x[j], ground.length_x)
    dy = nearest_image(m.y[i] - m.y[j], ground.length_y)
    share_i, share_j = mass_fractions(m.mass[i], m.mass[j])
    m.vx[i], m.vy[i], m.vx[j], m.vy[j], q = pair_update(
        dx, dy, m.vx[i], m.vy[i], m.vx[j], m.vy[j], share_i, share_j, restitution
    )
    if q != 0.0:
        mass = share_j * m.mass[i] if math.isinf(m.mass[j]) else share_i * m.mass[j]
        if math.isinf(m.mass[i]) or math.isinf(m.mass[j]):
            sign = 1.0 if math.isinf(m.mass[i]) else -1.0
            found.sums[OUTER_X] += sign * mass * q * dx
            found.sums[OUTER_Y] += sign * mass * q * dy
        note_pair(found, m, i, j, now - back, -q * mass * math.sqrt(dx * dx + dy * dy))
    if back > 0.0:
        fly_back(m, ground, i, -back)
        fly_back(m, ground, j, -back)


@part
def resolve_wall(
    m: Moving, ground: Ground, found: Found, i: int, w: int, restitution: float, dt: float, locate: bool, now: float
) -> None:
    """Resolve a disk with a wall if it still overlaps and approaches; located: where the chord of its step met the wall."""
    kind, numbers = ground.kind[w], ground.numbers[w]
    nx, ny, distance = nearest(kind, numbers, m.x[i], m.y[i])
    if not distance < m.radius[i]:
        return
    speed = nx * m.vx[i] + ny * m.vy[i]
    if not speed < 0.0:
        return
    back = 0.0
    if locate:
        back = (m.radius[i] - distance) / -speed
        back = back if back <= dt else 0.0
        fly_back(m, ground, i, back)
        nx, ny, distance = nearest(kind, numbers, m.x[i], m.y[i])
    vx, vy = m.vx[i], m.vy[i]
    m.vx[i], m.vy[i], q = wall_update(nx, ny, vx, vy, restitution)
    if q != 0.0:
        mass = m.mass[i] if not math.isinf(m.mass[i]) else 0.0
        found.sums[OUTER_X] += mass * (m.vx[i] - vx)
        found.sums[OUTER_Y] += mass * (m.vy[i] - vy)
        note_wall(found, m, i, ground.wall[w], now - back, mass * abs(q))
    if back > 0.0:
        fly_back(m, ground, i, -back)
