"""The flight of one disk, followed from row to row as the engine followed it."""

from __future__ import annotations

import math
from typing import TypeAlias

from eventsim.errors import LogError
from eventsim.formulas.crossing import crossing_delay
from eventsim.formulas.low_place import Fine, Low, low_position, settled
from eventsim.formulas.motion import position, velocity
from eventsim.formulas.real import NEVER, Acceleration
from eventsim.formulas.rest import NOT_LAST, SUPPORTED, Held, has_struck, held_by
from eventsim.replay.clock_windows import Windows
from eventsim.scene.sides import Sides
from eventsim.scene.stage import Stage

Met: TypeAlias = tuple[tuple[int, int, int], ...]
"""Whom a disk met last: (disk, image kx, ky), or (-1 - place of the wall shape, side, STRUCK, SUPPORTED or LEFT)."""


class DiskFlight:
    """A free flight, and what the next contact of its disk depends on besides.

    window, t: where the clock stood at the anchor x, y, vx, vy. low, low_place: the low parts of the velocity, and of the
    place where places have such. wraps: passages of
    periodic boundaries along x and y. met: whom it met last; held: the wall that it rests on or left at its end.
    contact_time: when that was, a remainder in the present window; -inf: never.
    """

    __slots__ = (
        "_boundaries", "_free", "_supports", "_walls", "contact_time", "gx", "gy", "held", "low", "low_place", "met",
        "radius", "sides", "t", "vx", "vy", "window", "wraps", "x", "y",
    )  # fmt: skip

    def __init__(self, stage: Stage, number: int, immovable: bool, walls: Sides | None) -> None:
        self.window, self.t = 0, 0.0
        self.x, self.y = float(stage.x[number]), float(stage.y[number])
        self.vx, self.vy = float(stage.vx[number]), float(stage.vy[number])
        self.low = 0.0, 0.0
        self.low_place: Low = (0.0, 0.0) if stage.low_places else None
        self.radius = float(stage.radius[number])
        self.gx: Acceleration = None
        self.gy: Acceleration = None
        if stage.gravity is not None:
            self.gx, self.gy = (0.0, 0.0) if immovable else stage.gravity
        self.wraps = [0, 0]
        self._free, self._supports, self._boundaries = (self.gx, self.gy), stage.supports, len(stage.boundaries)
        self.met: Met = ()
        self.held: Held | None = None
        self.contact_time = -math.inf
        self._walls = walls
        self.sides: list[int] | None = None
        if self._walls is not None:
            self.sides = self._walls.at_start(self.x, self.y, self.vx, self.vy, self.radius)

    def place(self, t: float) -> tuple[float, float]:
        """Return the centre at remainder t of the present window."""
        lag = t - self.t
        return position(self.x, self.vx, lag, self.gx), position(self.y, self.vy, lag, self.gy)

    def low_place_at(self, t: float) -> Low:
        """Return the low parts of `place`; None where places have none."""
        if self.low_place is None:
            return None
        lag, (low_x, low_y) = t - self.t, self.low_place
        return low_position(self.x, low_x, self.vx, lag), low_position(self.y, low_y, self.vy, lag)

    def settle(self, t: float) -> None:
        """Begin the flight anew with the high parts of its place rounded to nearest, where places have low parts."""
        low = self.low_place_at(t)
        if low is not None:
            x, y = self.place(t)
            (x, low_x), (y, low_y) = settled(x, low[0]), settled(y, low[1])
            self.anchor(t, (x, y), (self.vx, self.vy))
            self.low_place = low_x, low_y

    def fine(self) -> Fine:
        """Return what a contact time in a wide domain is a function of."""
        assert self.low_place is not None
        return *self.anchored(), *self.low_place

    def anchored(self) -> tuple[float, float, float, float, float, float]:
        """Return (x, y, vx, vy, t, radius), what a contact time of a straight flight is a function of."""
        return self.x, self.y, self.vx, self.vy, self.t, self.radius

    def speed(self, t: float) -> tuple[float, float]:
        """Return the velocity at remainder t of the present window."""
        lag = t - self.t
        return velocity(self.vx, lag, self.gx), velocity(self.vy, lag, self.gy)

    def anchor(self, t: float, place: tuple[float, float], speed: tuple[float, float]) -> None:
        """Begin a new flight."""
        self.t = t
        self.x, self.y = place
        self.vx, self.vy = speed

    def keep_sides(
        self,
        t: float,
        at: tuple[float, float],
        leaves: tuple[float, float],
        contacts: tuple[tuple[int, int], ...] = (),
    ) -> None:
        """Before the flight ends at a place, to go on with a velocity: keep on which sides of walls a point is."""
        if self._walls is None or self.sides is None:
            return
        on = None
        if self.held is not None and self.held.how == SUPPORTED and self._supports is not None:
            support = self._supports[self.held.place]
            on = None if support is None else (support, self.held.side)
        flight = self.x, self.y, self.vx, self.vy, self.gx, self.gy
        came = self.speed(t)
        self.sides = self._walls.after(self.sides, self.met, on, flight, self.radius, t, at, came, leaves, contacts)

    def side_beside(self, number: int) -> int | None:
        """Return what a point close to a wall shape remembers of its side; None where no disk is a point."""
        return None if self.sides is None or self._walls is None else self.sides[number - self._walls.first]

    def meet(self, met: Met) -> None:
        """Remember whom it met; what it rests on takes a part of its gravity, and anything else frees it."""
        self.met = met
        if self._supports is not None:
            self.held = held_by(met)
            rests = self.held is not None and self.held.how == SUPPORTED
            support = self._supports[self.held.place] if self.held is not None and rests else None
            self.gx, self.gy = self._free if support is None else (support.ax, support.ay)

    def since_met(self, wall: int) -> float:
        """Return how long before the flight began a wall, -1 - its place, or one in line with it, was struck; else NOT_LAST."""
        return self.t - self.contact_time if has_struck(self._supports, self.met, -1 - wall) else NOT_LAST

    def fly(self, period: tuple[float | None, float | None], windows: Windows, window: int, remainder: float) -> None:
        """Follow the flight to (window, remainder): the last wrap or turnover before it becomes the anchor.

        Raises LogError where that would lead back in time.
        """
        periodic = period != (None, None)
        if (window, remainder) < (self.window, self.t):
            raise LogError("the log does not fit its scene: a disk's events run backwards in time")
        while True:
            behind = self.window < window
            limit = windows.end[self.window] if behind else remainder
            if periodic:
                due, axis, step = self._next_wrap(period)
                if due < limit or (due == limit and not behind):
                    self._wrap(due, axis, step, period)
                    continue
            if not behind:
                return
            self.window += 1
            begin = windows.begin[self.window]
            self.low_place = self.low_place_at(limit)
            self.keep_sides(limit, self.place(limit), self.speed(limit))
            self.anchor(begin, self.place(limit), self.speed(limit))
            self.contact_time -= limit - begin

    def _next_wrap(self, period: tuple[float | None, float | None]) -> tuple[float, int, int]:
        """Return when the disk next passes a periodic boundary: (remainder, axis, direction)."""
        first = NEVER, 0, 0
        for axis, length in enumerate(period):
            if length is None:
                continue
            x, v, g = (self.x, self.vx, self.gx) if axis == 0 else (self.y, self.vy, self.gy)
            for step, target in ((-1, 0.0), (1, length)):
                due = self.t + crossing_delay(x, v, g, target, -step)
                if due < first[0]:
                    first = due, axis, step
        return first

    def _wrap(self, t: float, axis: int, step: int, period: tuple[float | None, float | None]) -> None:
        length = period[axis]
        assert length is not None
        place, low = list(self.place(t)), self.low_place_at(t)
        if low is not None:
            beyond = place[axis] - (length if step > 0 else 0.0)
            self.low_place = (low[0] + beyond, low[1]) if axis == 0 else (low[0], low[1] + beyond)
        place[axis] = length if step > 0 else 0.0
        self.keep_sides(t, (place[0], place[1]), self.speed(t))
        if self._walls is not None and self.sides is not None:
            self.sides = self._walls.wrapped(self.sides, axis, step)
        place[axis] = 0.0 if step > 0 else length
        self.anchor(t, (place[0], place[1]), self.speed(t))
        self.wraps[axis] += step
        if self.held is None or self.held.how != SUPPORTED:
            self.meet(tuple(met for met in self.met if met[0] >= -self._boundaries))  # that shape can now be met again
