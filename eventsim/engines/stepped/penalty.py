"""`penalty`: soft disks. An overlap pushes back like a linear spring; velocity Verlet integrates the springs.

Force k depth along the normal, depth = reach - distance; with a restitution e < 1 a dashpot beside it, whose damping makes a free
contact of two disks lose what e says.  A contact lasts pi sqrt(mu / k); the stiffness k is given, or chosen so that the shortest
contact lasts 20 steps.

Order: 2 in dt at constant k (the force is continuous); towards hard disks the error falls like k^(-1/2), so with k chosen
from dt it is of order 1 in dt.  A row of its log is written when a contact ends, with the impulse of the whole contact; contacts
that never end (a pile at rest) have none.  Kinetic energy is short of the total by what the springs hold.

Cost per step: O(neighbour pairs).  Source: P. A. Cundall, O. D. L. Strack, Geotechnique 29, 47 (1979),
doi:10.1680/geot.1979.29.1.47; W. C. Swope et al., Journal of Chemical Physics 76, 637 (1982), doi:10.1063/1.442716.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from eventsim.engines.stepped import PenaltyOptions
from eventsim.engines.stepped.compiled import kernel, part
from eventsim.engines.stepped.disks import Moving, fastest, wrap
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
from eventsim.errors import EventsimError
from eventsim.formulas.image import nearest_image
from eventsim.record.events import Floats
from eventsim.scene.stage import Stage

STEPS_PER_CONTACT = 20.0
"""Steps that the shortest contact lasts where no stiffness is given: enough for 1e-3 of the energy."""


class Springs(NamedTuple):
    """Accelerations (n,), and the impulse so far of each touching pair of the list and each touching (disk, wall); 0: apart."""

    ax: Floats
    ay: Floats
    pair: Floats
    wall: Floats


class PenaltySession(SteppedSession):
    """The engine `penalty` in the middle of a run."""

    name = "penalty"

    def __init__(self, stage: Stage, keep_rows: bool = True, options: PenaltyOptions | None = None) -> None:
        options = options or PenaltyOptions()
        super().__init__(stage, keep_rows, options.dt)
        mass = self.disks.mass
        if not np.all(mass > 0.0):
            raise EventsimError("penalty cannot simulate this scene: a disk of mass 0 has no acceleration")
        finite = mass[np.isfinite(mass)]
        lightest = 0.5 * float(finite.min()) if len(finite) else 1.0
        usual = lightest * (math.pi / (STEPS_PER_CONTACT * self.dt)) ** 2
        self.stiffness = usual if options.stiffness is None else float(options.stiffness)
        if not 0.0 < self.stiffness < math.inf:
            raise EventsimError(f"penalty: stiffness = {options.stiffness!r}: must be finite and above 0")
        self._damping = damping_ratio(stage.law.pair), damping_ratio(stage.law.wall)
        self._neighbours = Neighbours(stage.n)
        touching = np.zeros((stage.n, len(self.ground.kind)))
        self._springs = Springs(np.zeros(stage.n), np.zeros(stage.n), np.zeros(0), touching)
        self._ended = np.empty(0, np.int64)
        self._pull()
        self._run(0, 0)  # compiles, so that no stopwatch sees it

    def _run(self, steps: int, most_events: int) -> int:
        self._list()
        room = self._neighbours.count + self.stage.n * len(self.ground.kind)
        self._make_room(room)
        if len(self._ended) < room:
            self._ended = np.empty(2 * room, np.int64)
        near = self._neighbours
        done: int = run_springs(
            self.disks,
            self.ground,
            self.found,
            near.pairs[: near.count],
            near.skin,
            self._springs,
            self._ended,
            self.stiffness,
            *self._damping,
            self.dt,
            self.clock_of_steps.steps,
            steps,
            most_events,
        )
        return done

    def _list(self) -> None:
        """Have a list that is good for the next step; pairs that touch keep their impulses."""
        near, n = self._neighbours, self.stage.n
        old = near.pairs[: near.count, 0] * n + near.pairs[: near.count, 1]
        if not near.renew(self.disks, self.ground, self.found, self.dt):
            return
        keys = near.pairs[: near.count, 0] * n + near.pairs[: near.count, 1]
        impulses = np.zeros(near.count)
        touching = np.flatnonzero(self._springs.pair)
        if len(touching):
            order = np.argsort(keys)
            place = order[np.searchsorted(keys, old[touching], sorter=order)]
            impulses[place] = self._springs.pair[touching]
        self._springs = self._springs._replace(pair=impulses)

    def _pull(self) -> None:
        """Set the accelerations at the start: those of gravity; disks that only touch do not push."""
        free = np.isfinite(self.disks.mass)
        self._springs.ax[:] = np.where(free, self.ground.gx, 0.0)
        self._springs.ay[:] = np.where(free, self.ground.gy, 0.0)

    def _memory(self) -> tuple[Any, ...]:
        near, springs = self._neighbours, self._springs
        return (
            tuple(springs.ax.tolist()),
            tuple(springs.ay.tolist()),
            tuple(map(tuple, springs.wall.tolist())),
            tuple(map(tuple, near.pairs[: near.count].tolist())),
            tuple(springs.pair.tolist()),
            (near.skin, float(self.found.sums[MOVED])),
        )

    def _remember(self, memory: tuple[Any, ...]) -> None:
        ax, ay, wall, pairs, impulses, (skin, moved) = memory
        springs, near = self._springs, self._neighbours
        springs.ax[:], springs.ay[:], springs.wall[:] = ax, ay, np.array(wall).reshape(springs.wall.shape)
        near.pairs, near.count, near.skin = np.array(pairs, np.int64).reshape(-1, 2), len(pairs), skin
        self.found.sums[MOVED] = moved
        self._springs = springs._replace(pair=np.array(impulses))


def damping_ratio(restitution: float) -> float:
    """The damping of an oscillator, in critical ones, whose half swing keeps a fraction of its speed; 1 for none."""
    if restitution >= 1.0:
        return 0.0
    if restitution <= 0.0:
        return 1.0
    swing = math.log(restitution)
    return -swing / math.hypot(math.pi, swing)


@kernel
def run_springs(
    m: Moving,
    ground: Ground,
    found: Found,
    pairs: NDArray[np.int64],
    skin: float,
    springs: Springs,
    ended: NDArray[np.int64],
    stiffness: float,
    pair_damping: float,
    wall_damping: float,
    dt: float,
    first: int,
    steps: int,
    most_events: int,
) -> int:
    """Steps first, first + 1, ...; how many were done before `steps`, the list getting old, or enough rows and events."""
    walls = len(ground.kind)
    room = len(pairs) + len(m.x) * walls
    fall = math.sqrt(ground.gx * ground.gx + ground.gy * ground.gy) * dt
    for k in range(steps):
        if found.counts[EVENTS] >= most_events or 0 < len(found.rows) < found.counts[ROW_COUNT] + room:
            return k
        flight = (fastest(m) + fall) * dt
        if 2.0 * (found.sums[MOVED] + flight) > skin:
            return k
        found.sums[MOVED] += flight
        for i in range(len(m.x)):
            m.vx[i] += 0.5 * dt * springs.ax[i]
            m.vy[i] += 0.5 * dt * springs.ay[i]
            m.x[i] += m.vx[i] * dt
            m.y[i] += m.vy[i] * dt
            free = not math.isinf(m.mass[i])
            springs.ax[i] = ground.gx if free else 0.0
            springs.ay[i] = ground.gy if free else 0.0
        wrap(m, ground)
        count = push_pairs(m, ground, found, pairs, springs, ended, stiffness, pair_damping, dt)
        count = push_walls(m, ground, found, springs, ended, count, len(pairs), stiffness, wall_damping, dt)
        for i in range(len(m.x)):
            m.vx[i] += 0.5 * dt * springs.ax[i]
            m.vy[i] += 0.5 * dt * springs.ay[i]
        now = (first + k + 1) * dt
        for c in range(count):
            if ended[c] < len(pairs):
                p = ended[c]
                note_pair(found, m, pairs[p, 0], pairs[p, 1], now, springs.pair[p])
                springs.pair[p] = 0.0
            else:
                i, w = (ended[c] - len(pairs)) // walls, (ended[c] - len(pairs)) % walls
                note_wall(found, m, i, ground.wall[w], now, springs.wall[i, w])
                springs.wall[i, w] = 0.0
    return steps


@part
def push_pairs(
    m: Moving,
    ground: Ground,
    found: Found,
    pairs: NDArray[np.int64],
    springs: Springs,
    ended: NDArray[np.int64],
    stiffness: float,
    damping: float,
    dt: float,
) -> int:
    """Add what overlapping pairs push; the number of pairs in `ended` that touch no more."""
    count = 0
    for p in range(len(pairs)):
        i, j = pairs[p, 0], pairs[p, 1]
        dx = nearest_image(m.x[i] - m.x[j], ground.length_x)
        dy = nearest_image(m.y[i] - m.y[j], ground.length_y)
        reach = m.radius[i] + m.radius[j]
        distance2 = dx * dx + dy * dy
        if 0.0 < distance2 < reach * reach and meet(m.mass[i], m.mass[j]):
            distance = math.sqrt(distance2)
            nx, ny = dx / distance, dy / distance
            found.sums[DEEPEST] = max(found.sums[DEEPEST], 1.0 - distance / reach)
            rate = nx * (m.vx[i] - m.vx[j]) + ny * (m.vy[i] - m.vy[j])
            inverse = 1.0 / m.mass[i] + 1.0 / m.mass[j]
            force = push(stiffness, damping, 1.0 / inverse, reach - distance, rate)
            springs.ax[i] += force * nx / m.mass[i]
            springs.ay[i] += force * ny / m.mass[i]
            springs.ax[j] -= force * nx / m.mass[j]
            springs.ay[j] -= force * ny / m.mass[j]
            if math.isinf(m.mass[i]) or math.isinf(m.mass[j]):
                sign = -1.0 if math.isinf(m.mass[i]) else 1.0
                found.sums[OUTER_X] += sign * force * nx * dt
                found.sums[OUTER_Y] += sign * force * ny * dt
            springs.pair[p] += force * dt
        elif springs.pair[p] > 0.0:
            ended[count] = p
            count += 1
    found.counts[TESTS] += len(pairs)
    return count


@part
def push_walls(
    m: Moving,
    ground: Ground,
    found: Found,
    springs: Springs,
    ended: NDArray[np.int64],
    count: int,
    base: int,
    stiffness: float,
    damping: float,
    dt: float,
) -> int:
    """Add what walls push; the number in `ended` with the walls that are not touched any more, counted from `base`."""
    walls = len(ground.kind)
    for i in range(len(m.x)):
        if math.isinf(m.mass[i]):
            continue
        for w in range(walls):
            nx, ny, distance = nearest(ground.kind[w], ground.numbers[w], m.x[i], m.y[i])
            if distance < m.radius[i]:
                rate = nx * m.vx[i] + ny * m.vy[i]
                force = push(stiffness, damping, m.mass[i], m.radius[i] - distance, rate)
                springs.ax[i] += force * nx / m.mass[i]
                springs.ay[i] += force * ny / m.mass[i]
                found.sums[OUTER_X] += force * nx * dt
                found.sums[OUTER_Y] += force * ny * dt
                springs.wall[i, w] += force * dt
            elif springs.wall[i, w] > 0.0:
                ended[count] = base + i * walls + w
                count += 1
    return count


@part
def push(stiffness: float, damping: float, mass: float, depth: float, rate: float) -> float:
    """The force of spring and dashpot, never a pull; rate: of the distance, negative while it shrinks."""
    force = stiffness * depth - 2.0 * damping * math.sqrt(stiffness * mass) * rate
    return max(force, 0.0)
