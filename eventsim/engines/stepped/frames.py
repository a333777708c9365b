"""`frames`: the per-frame engine of a students' project that this package replaces, rule by rule.

Every frame all circles move by v dt.  Then, circle by circle in the order of the list: if it overlaps a border, the component of
its velocity across that border is flipped, and it is the next one's turn; else its two closest circles are looked at in turn: if
the pair is in the memory, it is the next one's turn; if the centres are closer than the sum of the radii, normal and tangent
components are updated and the pair enters the memory.  When a pair leaves the memory the source does not say; two readings:

    memory = "apart"    once its circles are apart
    memory = "frame"    at the end of the frame

What follows from these rules, and shows in its log: a disk that is inside a border in two frames running is flipped twice and
may stick there for seconds; contacts that begin and end between two frames are missed; the normal is taken where the frame
happened to look, so the angles are wrong; energy is kept to the last bits by all of this.

Elastic, circles of finite mass above 0, borders parallel to the axes.  Gravity, which the project did not have, advances the
velocity before the position (semi-implicit Euler).  Order 1.  Cost per frame: O(N^2).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eventsim.engines.stepped import FramesOptions
from eventsim.engines.stepped.compiled import kernel, part
from eventsim.engines.stepped.disks import Moving
from eventsim.engines.stepped.found import (
    DEEPEST,
    EVENTS,
    OUTER_X,
    OUTER_Y,
    ROW_COUNT,
    TESTS,
    Found,
    note_pair,
    note_wall,
)
from eventsim.engines.stepped.ground import POST, Ground, nearest
from eventsim.engines.stepped.session import SteppedSession
from eventsim.errors import EventsimError
from eventsim.formulas.walls.face import Face
from eventsim.scene.stage import Stage

FRAME = 1.0 / 60.0
MOST_DISKS = 5000
"""The memory of pairs is a square table, and each frame looks at all pairs."""


class FramesSession(SteppedSession):
    """The engine `frames` in the middle of a run; without a dt, a frame is 1/60."""

    name = "frames"

    def __init__(self, stage: Stage, keep_rows: bool = True, options: FramesOptions | None = None) -> None:
        _demand_known(stage)
        options = options or FramesOptions()
        super().__init__(stage, keep_rows, FRAME if options.dt is None else options.dt)
        self._apart = options.memory == "apart"
        self._met = np.zeros((stage.n, stage.n), np.bool_)
        self._held = np.zeros(stage.n, np.int64)
        self._run(0, 0)  # compiles, so that no stopwatch sees it

    def _run(self, steps: int, most_events: int) -> int:
        self._make_room(3 * self.stage.n)
        first = self.clock_of_steps.steps
        done: int = run_frames(
            self.disks, self.ground, self.found, self._met, self._held, self._apart, self.dt, first, steps, most_events
        )
        return done

    def _memory(self) -> tuple[Any, ...]:
        return tuple(np.argwhere(self._met).ravel().tolist())

    def _remember(self, memory: tuple[Any, ...]) -> None:
        pairs = np.array(memory, np.int64).reshape(-1, 2)
        self._met[:] = False
        self._met[pairs[:, 0], pairs[:, 1]] = True
        self._held[:] = self._met.sum(axis=1)


def _demand_known(stage: Stage) -> None:
    """Raise EventsimError for what that project did not know."""
    reasons = {
        "it knows no disks that spin": stage.law.rough is not None,
        "it knows no periodic boundaries": stage.periodic,
        "its contacts are elastic, this scene has a restitution": stage.law.loses_energy(),
        "it needs masses that are finite and above 0": stage.mass is not None
        and not bool(np.all(np.isfinite(stage.mass) & (stage.mass > 0.0))),
        "its borders are parallel to the axes": not set(ground_kinds(stage)) <= {"Face", "Post"},
        f"it looks at all pairs, so at most {MOST_DISKS:,} disks": stage.n > MOST_DISKS,
    }
    for reason, applies in reasons.items():
        if applies:
            raise EventsimError(f"frames cannot simulate this scene: {reason}")


def ground_kinds(stage: Stage) -> list[str]:
    """The kinds of the walls inside a domain; "Sloped" for a face that is not parallel to an axis."""
    shapes = [feature.shape for feature in stage.features]
    return [
        "Sloped" if isinstance(shape, Face) and shape.ex != 0.0 and shape.ey != 0.0 else type(shape).__name__
        for shape in shapes
    ]


@kernel
def run_frames(
    m: Moving,
    ground: Ground,
    found: Found,
    met: NDArray[np.bool_],
    held: NDArray[np.int64],
    apart: bool,
    dt: float,
    first: int,
    frames: int,
    most_events: int,
) -> int:
    """Frames first, first + 1, ...; how many were done."""
    n = len(m.x)
    for k in range(frames):
        if found.counts[EVENTS] >= most_events or 0 < len(found.rows) < found.counts[ROW_COUNT] + 3 * n:
            return k
        for i in range(n):
            m.vx[i] += ground.gx * dt
            m.vy[i] += ground.gy * dt
            m.x[i] += m.vx[i] * dt
            m.y[i] += m.vy[i] * dt
        now = (first + k + 1) * dt
        for i in range(n):
            if not flip_at_borders(m, ground, found, i, now):
                meet_closest(m, found, met, held, i, now)
        forget(m, met, held, apart)
    return frames


@part
def flip_at_borders(m: Moving, ground: Ground, found: Found, i: int, now: float) -> bool:
    """Flip the component across a border that circle i overlaps, whichever way it moves; whether there was one."""
    flipped_x, flipped_y = False, False
    for w in range(len(ground.kind)):
        if ground.kind[w] == POST:
            continue  # the end of a border
        nx, ny, distance = nearest(ground.kind[w], ground.numbers[w], m.x[i], m.y[i])
        if not distance < m.radius[i]:
            continue
        if nx != 0.0 and not flipped_x:
            m.vx[i], flipped_x = -m.vx[i], True
            found.sums[OUTER_X] += 2.0 * m.mass[i] * m.vx[i]
            note_wall(found, m, i, ground.wall[w], now, 2.0 * m.mass[i] * abs(m.vx[i]))
        elif ny != 0.0 and not flipped_y:
            m.vy[i], flipped_y = -m.vy[i], True
            found.sums[OUTER_Y] += 2.0 * m.mass[i] * m.vy[i]
            note_wall(found, m, i, ground.wall[w], now, 2.0 * m.mass[i] * abs(m.vy[i]))
    return flipped_x or flipped_y


@part
def meet_closest(m: Moving, found: Found, met: NDArray[np.bool_], held: NDArray[np.int64], i: int, now: float) -> None:
    """Look at the two closest circles of circle i; resolve overlaps that are not in the memory."""
    one, two = -1, -1
    near, far = math.inf, math.inf
    for j in range(len(m.x)):
        if j == i:
            continue
        dx, dy = m.x[j] - m.x[i], m.y[j] - m.y[i]
        distance2 = dx * dx + dy * dy
        if distance2 < near:
            two, far = one, near
            one, near = j, distance2
        elif distance2 < far:
            two, far = j, distance2
    found.counts[TESTS] += len(m.x) - 1
    for j in (one, two):
        if j < 0 or met[i, j]:
            return
        dx, dy = m.x[j] - m.x[i], m.y[j] - m.y[i]
        distance = math.sqrt(dx * dx + dy * dy)
        reach = m.radius[i] + m.radius[j]
        if 0.0 < distance < reach:
            found.sums[DEEPEST] = max(found.sums[DEEPEST], 1.0 - distance / reach)
            impulse = exchange(m, i, j, dx / distance, dy / distance)
            met[i, j] = met[j, i] = True
            held[i] += 1
            held[j] += 1
            note_pair(found, m, i, j, now, impulse)


@part
def exchange(m: Moving, i: int, j: int, nx: float, ny: float) -> float:
    """The normal/tangent update as the project wrote it; the magnitude of the impulse."""
    tx, ty = -ny, nx
    m1, m2 = m.mass[i], m.mass[j]
    v1n, v1t = m.vx[i] * nx + m.vy[i] * ny, m.vx[i] * tx + m.vy[i] * ty
    v2n, v2t = m.vx[j] * nx + m.vy[j] * ny, m.vx[j] * tx + m.vy[j] * ty
    w1n = (v1n * (m1 - m2) + 2.0 * m2 * v2n) / (m1 + m2)
    w2n = (v2n * (m2 - m1) + 2.0 * m1 * v1n) / (m1 + m2)
    m.vx[i], m.vy[i] = w1n * nx + v1t * tx, w1n * ny + v1t * ty
    m.vx[j], m.vy[j] = w2n * nx + v2t * tx, w2n * ny + v2t * ty
    impulse: float = abs(m1 * (w1n - v1n))
    return impulse


@part
def forget(m: Moving, met: NDArray[np.bool_], held: NDArray[np.int64], apart: bool) -> None:
    """Let pairs leave the memory: all of them, or those that are apart; held: pairs of each circle in it."""
    for i in range(len(m.x)):
        if held[i] == 0:
            continue
        for j in range(len(m.x)):
            if met[i, j]:
                dx, dy = m.x[j] - m.x[i], m.y[j] - m.y[i]
                reach = m.radius[i] + m.radius[j]
                if not apart or not dx * dx + dy * dy < reach * reach:
                    met[i, j] = False
                    held[i] -= 1
