"""Points that come to the end of a wall: whether wraps and turns of the clock have changed on which side they pass it.

A point passes an end on the left or on the right as the exact sign of its flight tells.  Until something strikes or kicks it, it
flies as the scene says.  But a wrap and a turn of the clock write its flight anew, with a rounded place.  Where that has changed
the sign, or made a sign of an exact hit, a run stops.
"""

from __future__ import annotations

from fractions import Fraction

from eventsim.engines.exact_state import ExactState
from eventsim.engines.exact_times import ExactTimes
from eventsim.engines.reference.calendar import Event
from eventsim.engines.reference.generation import disks_of
from eventsim.formulas.roots import Line
from eventsim.formulas.walls.boundary import Boundary
from eventsim.formulas.walls.point import closeness, hand, is_near, is_point
from eventsim.formulas.walls.post import Post
from eventsim.formulas.walls.shape import Thin
from eventsim.scene.stage import Stage


class Aimed:
    """Looks at the first contact of each point of a run."""

    def __init__(self, stage: Stage, state: ExactState) -> None:
        self._state = state
        self._radius = stage.radius.tolist()
        self._surfaces = stage.surfaces
        self._moments = ExactTimes(stage, state)
        ends: dict[tuple[float, float], float] = {}
        for feature in stage.features if stage.points else ():
            shape = feature.shape
            if isinstance(shape, Post):
                ends[shape.x, shape.y] = shape.size
            elif isinstance(shape, Thin):
                ends[shape.x, shape.y] = ends[shape.x1, shape.y1] = shape.size
        self._ends = list(ends.items())

    def reason(self, generation: list[Event]) -> str | None:
        """Why contacts of an instant cannot be resolved: a sentence on the first point that may have passed an end; else None."""
        if self._ends:
            for event in generation:
                for i in disks_of(event):
                    if self._is_rounded(i) and (end := self._doubtful_end(i, event)) is not None:
                        return _sentence(i, end)
        return None

    def _is_rounded(self, i: int) -> bool:
        """Whether disk i has met nothing yet, but its flight was written anew."""
        state = self._state
        return state.is_as_at_start(i) and bool(state.epoch > 0 or state.wraps_x[i] != 0 or state.wraps_y[i] != 0)

    def _doubtful_end(self, i: int, event: Event) -> tuple[float, float] | None:
        """The end of a wall that disk i passes until a contact on another side than in its exact flight; None without.

        An end on a side of the domain does not matter to who meets that side there.
        """
        s, t = self._state, event.time
        at_border = event.b < 0 and isinstance(self._surfaces[-1 - event.b], Boundary)
        flight = s.x[i], s.y[i], s.vx[i], s.vy[i], s.gravity_x[i], s.gravity_y[i]
        (x, y), (u, w) = s.place(i, t), s.speed(i, t)
        lines = self._moments.lines(i)
        for (px, py), size in self._ends:
            close = closeness(size, x, y, u, w, t)
            if not is_point(self._radius[i], size) or not _is_between(flight, (x, y), (px, py), close):
                continue
            if at_border and is_near(px, py, x, y, close):
                continue
            told = hand(*flight, px, py, u, w)
            if _sign(told) != _exact_hand(lines, px, py, u, w):
                return px, py
        return None


def _is_between(flight: tuple[float, ...], at: tuple[float, float], end: tuple[float, float], close: float) -> bool:
    """Whether a point may be on a flight to a place: along gravity a flight may be longer than straight."""
    x, y, _, _, gx, gy = flight
    falls = (gx or 0.0) != 0.0, (gy or 0.0) != 0.0
    return all(
        bend or min(begin, now) - close <= p <= max(begin, now) + close
        for begin, now, p, bend in zip((x, y), at, end, falls, strict=True)
    )


def _exact_hand(lines: tuple[Line, Line], px: float, py: float, u: float, w: float) -> int:
    """`formulas.walls.point.hand` of an exact flight: its sign."""
    (x, vx, half_x), (y, vy, half_y) = lines
    dx, dy, gx, gy = Fraction(px) - x, Fraction(py) - y, 2 * half_x, 2 * half_y
    if gx == 0 and gy == 0:
        return _sign(vx * dy - vy * dx)
    turn, across = vx * gy - vy * gx, dx * gy - dy * gx
    if turn == 0:
        return -_sign(across) if u * gx + w * gy > 0 else _sign(across)
    along, rate = dx * gx + dy * gy, vx * gx + vy * gy
    inside = (along * turn - rate * across) * turn - (gx * gx + gy * gy) / 2 * across * across
    return _sign(turn) * _sign(inside)


def _sign(x: float | Fraction) -> int:
    return (x > 0) - (x < 0)


def _sentence(i: int, end: tuple[float, float]) -> str:
    return (
        f"disk {i}, a point, comes so close to the end of a wall at ({end[0]:.9g}, {end[1]:.9g}) that what wraps and turns of "
        "the clock have rounded since the start decides on which side it passes, or whether it hits; a start nearer to that "
        "end, or an aim beside it, can be told"
    )
