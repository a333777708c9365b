"""`pymunk`: the Chipmunk engine through pymunk: code that nobody here wrote, asked the same question.

Disks are circles without friction or rotation, elasticity from the restitution (1 where elastic); the domain's walls are thick
segments outside it, walls inside are thin ones.  Iterations as in Chipmunk; the slop, an overlap that Chipmunk tolerates, is by
default a hundredth of the smallest radius (its own 0.1 would be larger than many a disk).  Each impulse is a row, at the end
of the step in which the solver applied it: a contact that it spreads over steps has several rows.

Chipmunk advances positions, then finds overlaps, then velocities: order 1.  Source: S. Lembcke, Chipmunk2D 7; V. Blomqvist,
pymunk 7 (https://www.pymunk.org).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pymunk

from eventsim.engines.stepped import ChipmunkOptions
from eventsim.engines.stepped.found import DEEPEST, EVENTS, OUTER_X, OUTER_Y, note_pair, note_wall
from eventsim.engines.stepped.session import SteppedSession
from eventsim.errors import EventsimError
from eventsim.formulas.walls.boundary import Boundary
from eventsim.formulas.walls.post import Post
from eventsim.scene.stage import Stage

SLOP = 0.01
"""In smallest radii."""

THICK = 4.0
"""In largest radii: how thick the walls of the domain are, so that nothing gets through them in one step."""


class ChipmunkSession(SteppedSession):
    """The engine `pymunk` in the middle of a run."""

    name = "pymunk"

    def __init__(self, stage: Stage, keep_rows: bool = True, options: ChipmunkOptions | None = None) -> None:
        options = options or ChipmunkOptions()
        if not options.iterations >= 1:
            raise EventsimError(f"pymunk: iterations = {options.iterations!r}: must be at least 1")
        if options.slop is not None and not 0.0 <= options.slop < math.inf:
            raise EventsimError(f"pymunk: slop = {options.slop!r}: must be finite and at least 0")
        _demand_known(stage)
        super().__init__(stage, keep_rows, options.dt)
        space = self._space = pymunk.Space()
        space.gravity = stage.gravity or (0.0, 0.0)
        space.iterations = options.iterations
        space.collision_slop = SLOP * float(stage.radius.min()) if options.slop is None else options.slop
        elasticity = math.sqrt(stage.law.pair)
        self._bodies = [self._circle(i, elasticity) for i in range(stage.n)]
        self._walls: dict[Any, int] = {}
        for shape, wall in self._outlines():
            # Chipmunk multiplies the elasticities of the two shapes.
            shape.elasticity = min(stage.law.wall / elasticity, 1.0) if elasticity else 0.0
            space.add(shape)
            self._walls[shape] = wall
        self._disk_of = {shape: i for i, body in enumerate(self._bodies) for shape in body.shapes}
        self._hits: list[tuple[int, int, bool, float]] = []
        self._watched, self._listening = True, False

    def only_step(self) -> None:
        """As all stepped engines; and contacts are not told, since asking Chipmunk for them takes longer than its steps."""
        super().only_step()
        self._watched = False

    def _circle(self, i: int, elasticity: float) -> Any:
        m = self.disks
        kind = pymunk.Body.KINEMATIC if math.isinf(m.mass[i]) else pymunk.Body.DYNAMIC
        body = pymunk.Body(float(m.mass[i]), math.inf, body_type=kind)
        body.position, body.velocity = (float(m.x[i]), float(m.y[i])), (float(m.vx[i]), float(m.vy[i]))
        circle = pymunk.Circle(body, float(m.radius[i]))
        circle.elasticity, circle.friction = elasticity, 0.0
        self._space.add(body, circle)
        return body

    def _outlines(self) -> list[tuple[Any, int]]:
        """The walls as segments, each with its number."""
        stage, static = self.stage, self._space.static_body
        thick = THICK * float(stage.radius.max())
        found = [(_behind(static, boundary, stage, thick), boundary.wall) for boundary in stage.boundaries]
        for feature in stage.features:
            line = feature.shape.line()
            if line is not None:
                ends = (line.x, line.y), (line.x + line.ex, line.y + line.ey)
                found.append((pymunk.Segment(static, *ends, 0.0), feature.wall))
        return found

    def _solved(self, arbiter: Any, space: Any, data: Any) -> None:
        if not self._watched:
            return
        one, other = arbiter.shapes
        impulse = math.hypot(*arbiter.total_impulse)  # its own length squares, which overflows
        depth = max((-point.distance for point in arbiter.contact_point_set.points), default=0.0)
        i, j = self._disk_of.get(one), self._disk_of.get(other)
        if i is None:
            i, one, other, j = j, other, one, None
        assert i is not None
        if j is not None:
            reach = float(self.disks.radius[i] + self.disks.radius[j])
            self.found.sums[DEEPEST] = max(self.found.sums[DEEPEST], depth / reach)
        if impulse > 0.0:
            self._hits.append((i, self._walls[other] if j is None else j, j is None, impulse))

    def _run(self, steps: int, most_events: int) -> int:
        m, found = self.disks, self.found
        room = 8 * self.stage.n + 64
        if not self._watched:
            for _ in range(steps):
                self._space.step(self.dt)
            return steps
        if not self._listening:
            self._space.on_collision(None, None, post_solve=self._solved)
            self._listening = True
        for done in range(steps):
            if found.counts[EVENTS] >= most_events:
                return done
            self._hits.clear()
            before = m.vx.copy(), m.vy.copy()
            self._space.step(self.dt)
            self._read()
            now = (self.clock_of_steps.steps + done + 1) * self.dt
            self._make_room(len(self._hits) + room)
            for i, other, wall, impulse in self._hits:
                if wall:
                    note_wall(found, m, i, other, now, impulse)
                else:
                    note_pair(found, m, i, other, now, impulse)
            self._book(before)
            if self._keep_rows and found.counts[-1] + room > len(found.rows):
                return done + 1
        return steps

    def _book(self, before: tuple[Any, Any]) -> None:
        """Book what no pair of finite disks can have changed as momentum given from outside."""
        m = self.disks
        mass = np.where(np.isfinite(m.mass), m.mass, 0.0)
        if not self._walls and np.all(np.isfinite(m.mass)):
            return
        pull_x, pull_y = self.ground.gx * self.dt, self.ground.gy * self.dt
        self.found.sums[OUTER_X] += float(mass @ (m.vx - before[0] - pull_x))
        self.found.sums[OUTER_Y] += float(mass @ (m.vy - before[1] - pull_y))

    def _read_back(self) -> None:
        if not self._watched:
            self._read()

    def _read(self) -> None:
        m = self.disks
        for i, body in enumerate(self._bodies):
            m.x[i], m.y[i] = body.position
            m.vx[i], m.vy[i] = body.velocity

    def _write(self) -> None:
        m = self.disks
        for i, body in enumerate(self._bodies):
            body.position, body.velocity = (float(m.x[i]), float(m.y[i])), (float(m.vx[i]), float(m.vy[i]))

    def _kicked(self) -> None:
        self._write()

    def _remember(self, memory: tuple[Any, ...]) -> None:
        self._write()


def _behind(static: Any, boundary: Boundary, stage: Stage, thick: float) -> Any:
    """A thick segment whose inner side is a wall of the domain."""
    assert stage.size is not None
    across = boundary.position - boundary.side * thick
    along = -thick, stage.size[1 - boundary.axis] + thick
    begin, end = ((across, t) if boundary.axis == 0 else (t, across) for t in along)
    return pymunk.Segment(static, begin, end, thick)


def _demand_known(stage: Stage) -> None:
    """Raise EventsimError for what Chipmunk does not know."""
    round_walls = any(
        feature.shape.line() is None and not isinstance(feature.shape, Post) for feature in stage.features
    )
    reasons = {
        "it knows no periodic boundaries": stage.periodic,
        "it knows no round walls": round_walls,
        "a circle needs a radius above 0": not bool(np.all(stage.radius > 0.0)),
        "a circle needs a mass above 0": stage.mass is not None and not bool(np.all(stage.mass > 0.0)),
    }
    for reason, applies in reasons.items():
        if applies:
            raise EventsimError(f"pymunk cannot simulate this scene: {reason}")
