"""The sides of walls that points are on: remembered where they are close to a wall, since there rounded places do not tell."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeAlias

from eventsim.formulas.rest import Support
from eventsim.formulas.walls.face import Face, side_in_line
from eventsim.formulas.walls.point import CORNER, closeness, end_of, is_near, is_point
from eventsim.formulas.walls.post import Post
from eventsim.formulas.walls.shape import Closed, Thin
from eventsim.scene.stage import Stage
from eventsim.scene.surfaces import moved_on

Flight: TypeAlias = tuple[float, float, float, float, Any, Any]
"""x, y, vx, vy and the acceleration."""

Contact: TypeAlias = tuple[int, int]
"""A wall by its place among all walls, boundaries first, and the side from which it is met."""


class Sides:
    """Which side of each wall shape points are on.

    What is remembered of a point: for each shape 0 where its place tells, else its side, +1 or -1; 2 or -2 in the corner of two
    walls, one of which it has just met: the other one is met as soon as the point approaches it.  The side of a closed wall never
    changes.
    """

    def __init__(self, stage: Stage) -> None:
        self._shapes = [feature.shape for feature in stage.features]
        self._thin = [shape if isinstance(shape, Thin) else None for shape in self._shapes]
        self._closed = [shape if isinstance(shape, Closed) else None for shape in self._shapes]
        self._corners = [feature.corners for feature in stage.features]
        self.first = len(stage.boundaries)
        self._on = {step: moved_on(stage.features, step) for step in ((1, 0), (-1, 0), (0, 1), (0, -1))}

    def __len__(self) -> int:
        return len(self._shapes)

    def at_start(self, x: float, y: float, vx: float, vy: float, radius: float) -> list[int]:
        """What to remember of a point that is placed somewhere: one exactly on a line is on the side that it moves to."""
        found = []
        for closed, shape in zip(self._closed, self._thin, strict=True):
            if closed is not None:
                found.append(closed.side(x, y, vx, vy))
                continue
            if shape is None or not is_point(radius, shape.size):
                found.append(0)
                continue
            close = closeness(shape.size, x, y, vx, vy, 0.0)
            found.append(shape.side(x, y, vx, vy) if shape.distance(x, y) <= close else 0)
        return found

    def after(
        self,
        sides: Sequence[int],
        met: Sequence[tuple[int, int, int]],
        support: tuple[Support, int] | None,
        flight: Flight,
        radius: float,
        t: float,
        at: tuple[float, float],
        came: tuple[float, float],
        leaves: tuple[float, float],
        contacts: Sequence[Contact],
    ) -> list[int]:
        """What to remember after a flight that ends at time t, at a place, with a velocity, and goes on with another one.

        sides, met, support: what was remembered of it, what the point met last, what it rested on and from which side; contacts:
        the walls that it meets at the end.
        """
        return [
            self._after(k, sides[k], met, support, flight, radius, t, at, came, leaves, contacts)
            for k in range(len(self._shapes))
        ]

    def wrapped(self, sides: Sequence[int], axis: int, step: int) -> list[int]:
        """What to remember of a point that has passed a periodic boundary: the sides of the images that are now where it is."""
        found = [0] * len(self._shapes)
        for k, image in enumerate(self._on[(-step, 0) if axis == 0 else (0, -step)]):
            if image >= 0:
                found[image] = sides[k]
        return found

    def _after(
        self,
        k: int,
        remembered: int,
        met: Sequence[tuple[int, int, int]],
        support: tuple[Support, int] | None,
        flight: Flight,
        radius: float,
        t: float,
        at: tuple[float, float],
        came: tuple[float, float],
        leaves: tuple[float, float],
        contacts: Sequence[Contact],
    ) -> int:
        shape, place, closed = self._thin[k], self.first + k, self._closed[k]
        if closed is not None:
            return remembered or closed.side(*flight[:4])
        if shape is None or not is_point(radius, shape.size):
            return 0
        close = closeness(shape.size, *at, *came, t)
        distance = shape.distance(*at)
        if not distance <= CORNER * close:
            return 0
        before = next((last[1] for last in met if last[0] == -1 - place), 0) or remembered
        if before != 0:
            before = 1 if before > 0 else -1
        elif support is not None and isinstance(shape, Face) and shape.lies_on(support[0].face):
            before = side_in_line(shape, support[0].face, support[1])
        else:
            before = -moved_to(shape, -shape.side(*flight[:4]), *at, *came)  # from afar: it comes from behind
        side = shape.side(*at, *came)
        if distance <= close:
            side = shape.side_after(before, remembered, *flight, radius, *at, *came)
        for wall, from_side in contacts:
            if wall == place:
                return 2 * from_side if self._in_corner(k, shape, from_side, at, CORNER * close) else from_side
        if not contacts:  # a corner is not left on the spot
            return 2 * side if abs(remembered) == 2 else side
        for wall, from_side in contacts:
            side = self._next_to(k, shape, side, wall, from_side, at, leaves, CORNER * close)
        return side

    def _in_corner(self, k: int, shape: Thin, side: int, at: tuple[float, float], close: float) -> bool:
        """Whether a point at the k-th shape, on a side of it, is where another one makes a corner with it."""
        first, second = self._corners[k][side < 0], self._corners[k][2 + (side < 0)]
        at_first = first != 0 and is_near(shape.x, shape.y, *at, close)
        return at_first or (second != 0 and is_near(shape.x1, shape.y1, *at, close))

    def _next_to(
        self,
        k: int,
        shape: Thin,
        side: int,
        wall: int,
        from_side: int,
        at: tuple[float, float],
        leaves: tuple[float, float],
        close: float,
    ) -> int:
        """The side of the k-th shape, where the point meets another wall, maybe at an end that both share."""
        met = None if wall < self.first else self._shapes[wall - self.first]
        if isinstance(met, Post):
            return moved_to(shape, side, *at, *leaves) if ends_at(shape, met.x, met.y) else side
        if isinstance(met, Face) and isinstance(shape, Face) and shape.lies_on(met):
            return side_in_line(shape, met, from_side)
        other = None if met is None else self._thin[wall - self.first]
        if other is not None:
            for second in (False, True):
                x, y = (other.x1, other.y1) if second else (other.x, other.y)
                if is_near(x, y, *at, close) and ends_at(shape, x, y):
                    corner = self._corners[wall - self.first][2 * second + (from_side < 0)]
                    if abs(corner) == k + 1:
                        return 2 if corner > 0 else -2
                    return moved_to(shape, side, *at, *leaves)
        for second in (False, True):
            x, y = (shape.x1, shape.y1) if second else (shape.x, shape.y)
            if end_of(shape.ends, second, 1)[1] and is_near(x, y, *at, close):
                far_x, far_y = (shape.x, shape.y) if second else (shape.x1, shape.y1)
                if other is not None and other.side(far_x, far_y, 0.0, 0.0) != from_side:
                    return moved_to(shape, side, *at, *leaves)
                return 2 * side
        return side


def moved_to(shape: Thin, side: int, x: float, y: float, u: float, w: float) -> int:
    """The side that a velocity leads to; the given one along the wall."""
    rate = shape.rate(x, y, u, w)
    return 1 if rate > 0.0 else -1 if rate < 0.0 else side


def ends_at(shape: Thin, x: float, y: float) -> bool:
    """Whether a wall ends at a point."""
    return (shape.x == x and shape.y == y) or (shape.x1 == x and shape.y1 == y)
