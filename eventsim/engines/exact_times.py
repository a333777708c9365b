"""When contacts come, exactly: as roots of polynomials in rationals, from the flights and the numbers of the scene.

A disk that nothing has struck yet flies as the scene says, whatever wraps and turnovers of the clock have rounded since.
"""

from __future__ import annotations

from fractions import Fraction

from eventsim.engines.exact_state import ExactState
from eventsim.formulas.rest import STRUCK
from eventsim.formulas.roots import Line, Moment, Quartic, falls_to, less_number, order_of, rational, reaches
from eventsim.formulas.walls.boundary import Boundary
from eventsim.scene.stage import Stage

ZERO = Fraction(0)


class ExactTimes:
    """The exact times of contacts in one stage, in the state of a run."""

    def __init__(self, stage: Stage, state: ExactState) -> None:
        self._stage = stage
        self._state = state

    def of(self, a: int, b: int, image: tuple[int, int], time: float) -> Moment:
        """The exact time of a contact whose float time is `time`; that itself where it is no root of a polynomial.

        b: the other disk, image: of it, (kx, ky); or -1 - place of a wall, and (side, how).  No root: coming to rest, sliding
        over the end of a wall, a float that is none of its quartic (a graze).
        """
        disks = (a,) if b < 0 else (a, b)
        moment = self._root(a, b, image)
        if isinstance(moment, Quartic):
            moment = moment.root_near(time)
        if moment is None:
            return rational(time)
        begin = rational(max(self._state.t[i] for i in disks))
        return begin if order_of(moment, begin) < 0 else moment  # an overlap is due now

    def grazes(self, a: int, b: int, image: tuple[int, int]) -> bool:
        """Whether round things only touch in passing, from outside: the quadratic has a double root, so nothing approaches."""
        if b < 0 and not self._is_round(-1 - b, image[0], a):
            return False
        moment = self._root(a, b, image)
        return isinstance(moment, Moment) and moment.square == 0

    def _is_round(self, number: int, side: int, i: int) -> bool:
        """Whether a wall is round where disk i meets it on that side; a post is none for a point, which hits it exactly."""
        stage = self._stage
        return stage.is_round_outside(number, side) and not stage.is_exact_hit(number, float(stage.radius[i]))

    def _root(self, a: int, b: int, image: tuple[int, int]) -> Moment | Quartic | None:
        """The time of a contact as a root; None where it is none."""
        if b < 0:
            return self._of_wall(-1 - b, image, float(self._stage.radius[a]), a)
        reach = Fraction(float(self._stage.radius[a])) + Fraction(float(self._stage.radius[b]))
        return self._of_pair(image, reach, a, b)

    def _of_pair(self, image: tuple[int, int], reach: Fraction, a: int, b: int) -> Moment | Quartic | None:
        apart: list[Line] = []
        for one, other, k, length in zip(self.lines(a), self.lines(b), image, self._stage.period, strict=True):
            line = _less(one, other)
            apart.append(less_number(line, k * length) if k and length is not None else line)
        return reaches(apart[0], apart[1], reach, -1)

    def _of_wall(self, number: int, image: tuple[int, int], radius: float, i: int) -> Moment | Quartic | None:
        stage, (side, how) = self._stage, image
        if how != STRUCK:
            return None
        lines = self.lines(i)
        surface = stage.surfaces[number]
        if not isinstance(surface, Boundary):
            return surface.shape.moment(*lines, side, radius)
        return falls_to(lines[surface.axis], surface.target(radius), side)

    def lines(self, i: int) -> tuple[Line, Line]:
        """The flight of disk i in the present epoch."""
        state, stage = self._state, self._stage
        gx, gy = state.gravity_x[i], state.gravity_y[i]
        if not state.is_as_at_start(i):
            t = Fraction(state.t[i])
            return _line(state.x[i], state.vx[i], gx, t), _line(state.y[i], state.vy[i], gy, t)
        begun = -state.epoch * Fraction(state.epoch_length)
        lines = (
            _line(float(stage.x[i]), float(stage.vx[i]), gx, begun),
            _line(float(stage.y[i]), float(stage.vy[i]), gy, begun),
        )
        wraps = state.wraps_x[i], state.wraps_y[i]
        return (
            _behind_wraps(lines[0], wraps[0], stage.period[0]),
            _behind_wraps(lines[1], wraps[1], stage.period[1]),
        )


def _behind_wraps(line: Line, wraps: int, length: float | None) -> Line:
    return line if length is None else less_number(line, int(wraps) * Fraction(length))


def _line(x: float, v: float, g: float | None, t: Fraction) -> Line:
    speed = Fraction(v)
    if not g:
        return Fraction(x) - speed * t, speed, ZERO
    half = Fraction(g) / 2
    return Fraction(x) - speed * t + half * t * t, speed - 2 * half * t, half


def _less(one: Line, other: Line) -> Line:
    return one[0] - other[0], one[1] - other[1], one[2] - other[2]
