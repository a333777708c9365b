"""When contacts come, exactly: as roots of quadratics in rationals, from the flights and the numbers of the scene."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import TypeAlias

from eventsim.formulas.real import Acceleration
from eventsim.formulas.rest import STRUCK
from eventsim.formulas.roots import Line, Moment, falls_to, less_number, order_of, rational, reaches
from eventsim.formulas.walls.boundary import Boundary
from eventsim.scene.stage import Stage

Flight: TypeAlias = tuple[float, float, float, float, float, Acceleration, Acceleration]
"""A free flight: t, x, y, vx, vy, and its acceleration."""

ZERO = Fraction(0)


class ExactTimes:
    """The exact times of contacts in one stage; flight(i): the present flight of disk i."""

    def __init__(self, stage: Stage, flight: Callable[[int], Flight]) -> None:
        self._stage = stage
        self._flight = flight

    def of(self, a: int, b: int, image: tuple[int, int], time: float) -> Moment:
        """The exact time of a contact whose float time is `time`; that itself where it is no root of a quadratic.

        b: the other disk, image: of it, (kx, ky); or -1 - place of a wall, and (side, how).  No root: a parabola against a
        round thing, coming to rest, sliding over the end of a wall.
        """
        flights = [self._flight(i) for i in ((a,) if b < 0 else (a, b))]
        if b >= 0:
            reach = Fraction(float(self._stage.radius[a])) + Fraction(float(self._stage.radius[b]))
            moment = self._of_pair(image, reach, flights)
        else:
            moment = self._of_wall(-1 - b, image, float(self._stage.radius[a]), flights[0])
        if moment is None:
            return rational(time)
        begin = rational(max(flight[0] for flight in flights))
        return begin if order_of(moment, begin) < 0 else moment  # an overlap is due now

    def _of_pair(self, image: tuple[int, int], reach: Fraction, flights: list[Flight]) -> Moment | None:
        apart: list[Line] = []
        for one, other, k, length in zip(*map(_lines, flights), image, self._stage.period, strict=True):
            line = _less(one, other)
            apart.append(less_number(line, k * length) if k and length is not None else line)
        return reaches(apart[0], apart[1], reach, -1)

    def _of_wall(self, number: int, image: tuple[int, int], radius: float, flight: Flight) -> Moment | None:
        stage, (side, how) = self._stage, image
        if how != STRUCK:
            return None
        lines = _lines(flight)
        surface = stage.surfaces[number]
        if not isinstance(surface, Boundary):
            return surface.shape.moment(*lines, side, radius)
        return falls_to(lines[surface.axis], surface.target(radius), side)


def _lines(flight: Flight) -> tuple[Line, Line]:
    t, x, y, vx, vy, gx, gy = flight
    return _line(x, vx, gx, Fraction(t)), _line(y, vy, gy, Fraction(t))


def _line(x: float, v: float, g: float | None, t: Fraction) -> Line:
    speed = Fraction(v)
    if not g:
        return Fraction(x) - speed * t, speed, ZERO
    half = Fraction(g) / 2
    return Fraction(x) - speed * t + half * t * t, speed - 2 * half * t, half


def _less(one: Line, other: Line) -> Line:
    return one[0] - other[0], one[1] - other[1], one[2] - other[2]
