"""What changes: the free flights of all disks, whom each met last, and the clock."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np

from eventsim.engines.base import Snapshot
from eventsim.engines.turnover import Anchors
from eventsim.formulas.clock import FIRST_WINDOW, end_of_epoch, window_length
from eventsim.formulas.low_place import Fine, Low, low_position, settled
from eventsim.formulas.motion import position, velocity
from eventsim.formulas.real import Acceleration, Real
from eventsim.formulas.rest import NOT_LAST, SUPPORTED, Support, has_struck, held_by
from eventsim.scene.sides import Sides
from eventsim.scene.stage import Stage

Met: TypeAlias = tuple[tuple[int, int, int], ...]
"""Whom a disk met last: (disk, image kx, ky), or (-1 - place of the wall shape, side, STRUCK, SUPPORTED or LEFT); several after
a joint contact."""


class EngineState:
    """The flights of n disks as lists of numbers; only advance and resolve change them.

    t, x, y, vx, vy: the anchor of each flight, t a remainder in the present epoch.  count: the invalidation counts.
    wraps_x, wraps_y: how often a disk passed a periodic boundary.  met: whom it met last.  contact_time: when that was
    (a remainder; -inf: never).  at_once: its contacts at that very time, to see that an instant does not end.  number: makes
    a number of the engine's type from a float.  low_parts: whether velocities carry what their rounding at a contact left, in
    low_vx and low_vy, which are empty otherwise; numbers of another type than float need none.  low_places: the same for what
    the rounding of places left, in low_x and low_y.  window: the exponent of its length; window_end: where the window ends,
    later where it stayed open because it had no row (opened).
    """

    def __init__(self, stage: Stage, number: Any = float) -> None:
        n = stage.n
        self.n = n
        self.number = number
        self.x: list[Real] = [number(value) for value in stage.x.tolist()]
        self.y: list[Real] = [number(value) for value in stage.y.tolist()]
        self.vx: list[Real] = [number(value) for value in stage.vx.tolist()]
        self.vy: list[Real] = [number(value) for value in stage.vy.tolist()]
        self.t: list[Real] = [number(0.0)] * n
        self.count = [0] * n
        self.wraps_x = [0] * n
        self.wraps_y = [0] * n
        self.met: list[Met] = [()] * n
        self.contact_time: list[Real] = [-float("inf")] * n
        self.at_once = [0] * n
        self.low_parts = stage.low_parts and number is float
        self.low_vx = [0.0] * n if self.low_parts else []
        self.low_vy = [0.0] * n if self.low_parts else []
        self.low_places = stage.low_places and number is float
        self.low_x = [0.0] * n if self.low_places else []
        self.low_y = [0.0] * n if self.low_places else []
        self.gravity_x, self.gravity_y = _accelerations(stage)
        self._free_x, self._free_y = self.gravity_x, self.gravity_y
        self.supports, self.boundaries = stage.supports, len(stage.boundaries)
        if stage.supports is not None:
            self.gravity_x, self.gravity_y = list(self._free_x), list(self._free_y)
        self.sides: Any = None
        self._radius: list[float] = stage.radius.tolist()
        if stage.points and number is float:
            self._walls = Sides(stage)
            self.sides = [[0] * len(self._walls) for _ in range(n)]
            self.set_sides(())
        self.now: Real = number(0.0)
        self.epoch = 0
        self.epoch_length = stage.epoch_length
        self.window_rows = 0
        self.begin_window(FIRST_WINDOW)

    def place(self, i: int, t: Real) -> tuple[Real, Real]:
        """The centre of disk i at time t of its present flight."""
        lag = t - self.t[i]
        return (
            position(self.x[i], self.vx[i], lag, self.gravity_x[i]),
            position(self.y[i], self.vy[i], lag, self.gravity_y[i]),
        )

    def speed(self, i: int, t: Real) -> tuple[Real, Real]:
        """The velocity of disk i at time t of its present flight."""
        lag = t - self.t[i]
        return velocity(self.vx[i], lag, self.gravity_x[i]), velocity(self.vy[i], lag, self.gravity_y[i])

    def low_place(self, i: int, t: Real) -> Low:
        """The low parts of `place`; None where places have none."""
        if not self.low_places:
            return None
        lag = t - self.t[i]
        return (
            low_position(self.x[i], self.low_x[i], self.vx[i], lag),
            low_position(self.y[i], self.low_y[i], self.vy[i], lag),
        )

    def settle(self, i: int, t: Real) -> None:
        """Where places have low parts: begin the flight of disk i anew at time t, the high parts rounded to nearest."""
        if self.low_places:
            (x, y), low = self.place(i, t), self.low_place(i, t)
            assert low is not None
            low_x, low_y = low
            self.t[i] = t
            self.x[i], self.low_x[i] = settled(x, low_x)
            self.y[i], self.low_y[i] = settled(y, low_y)

    def fine_flight(self, i: int, radius: float) -> Fine:
        """What a contact time in a wide domain is a function of."""
        return self.x[i], self.y[i], self.vx[i], self.vy[i], self.t[i], radius, self.low_x[i], self.low_y[i]

    def anchor(self, i: int, t: Real, x: Real, y: Real, vx: Real, vy: Real) -> None:
        """Begin a new flight of disk i; all predictions that rest on the old one are stale from here on."""
        self.t[i], self.x[i], self.y[i], self.vx[i], self.vy[i] = t, x, y, vx, vy
        self.count[i] += 1

    def sides_of_all(self) -> tuple[tuple[int, ...], ...]:
        """What all disks remember of sides of walls; nothing where none is a point."""
        return () if self.sides is None else tuple(tuple(self.sides[i]) for i in range(self.n))

    def set_sides(self, sides: tuple[tuple[int, ...], ...]) -> None:
        """Let all disks remember that; nothing: what their places tell."""
        if self.sides is not None:
            for i in range(self.n):
                flight = self.x[i], self.y[i], self.vx[i], self.vy[i]
                self.sides[i] = list(sides[i]) if sides else self._walls.at_start(*flight, self._radius[i])

    def keep_sides(
        self,
        i: int,
        t: Real,
        at: tuple[Real, Real],
        leaves: tuple[Real, Real],
        contacts: tuple[tuple[int, int], ...] = (),
    ) -> None:
        """Before its flight ends at a place, to go on with a velocity: keep on which sides of walls disk i is, if it is a point.

        contacts: walls that it meets there, (place, side).
        """
        if self.sides is None:
            return
        support, held = self.support_of(i), held_by(self.met[i])
        on = None if support is None or held is None else (support, held.side)
        flight = self.x[i], self.y[i], self.vx[i], self.vy[i], self.gravity_x[i], self.gravity_y[i]
        came = self.speed(i, t)
        self.sides[i] = self._walls.after(
            self.sides[i], self.met[i], on, flight, self._radius[i], t, at, came, leaves, contacts
        )

    def keep_sides_behind(self, i: int, axis: int, step: int) -> None:
        """Keep the sides of a point that has passed a periodic boundary."""
        if self.sides is not None:
            self.sides[i] = self._walls.wrapped(self.sides[i], axis, step)

    def side_beside(self, i: int, place: int) -> int | None:
        """What disk i, if it is a point close to a wall shape, remembers of its side; None where no disk is a point."""
        return None if self.sides is None else int(self.sides[i][place - self._walls.first])

    def forget_low_parts(self, i: int) -> None:
        """From here on the velocity of disk i is a float."""
        if self.low_parts:
            self.low_vx[i] = self.low_vy[i] = 0.0

    def meet(self, i: int, met: Met) -> None:
        """Let disk i remember whom it met; what it rests on takes a part of its gravity, and anything else frees it."""
        self.met[i] = met
        if self.supports is not None:
            self._pull(i)

    def since_met(self, i: int, wall: int) -> Real:
        """How long before its flight began disk i struck a wall, -1 - its place, or one in line with it; else NOT_LAST."""
        if not has_struck(self.supports, self.met[i], -1 - wall):
            return NOT_LAST
        begun, struck = self.t[i], self.contact_time[i]
        return 0.0 if begun is struck else begun - struck

    def begins_on_contact(self, i: int) -> bool:
        """Whether the present flight of disk i began at its last contact."""
        begun, struck = self.t[i], self.contact_time[i]
        return bool(begun is struck or begun == struck)

    def _pull(self, i: int) -> None:
        support = self.support_of(i)
        free = self._free_x[i], self._free_y[i]
        self.gravity_x[i], self.gravity_y[i] = free if support is None else (support.ax, support.ay)

    def support_of(self, i: int) -> Support | None:
        """What disk i rests on; None in free flight."""
        if self.supports is None:
            return None
        held = held_by(self.met[i])
        return None if held is None or held.how != SUPPORTED else self.supports[held.place]

    def anchors(self) -> Anchors:
        """Where all flights begin, rounded."""
        t, x, y, vx, vy = (np.array(list(map(float, each))) for each in (self.t, self.x, self.y, self.vx, self.vy))
        falls = self.gravity_x[0] is not None
        gx, gy = (np.array(each, dtype=float) if falls else None for each in (self.gravity_x, self.gravity_y))
        return Anchors(t, x, y, vx, vy, gx, gy)

    def turn_over(self, end: Real, epochs: int, window: int) -> None:
        """Begin a new window some epochs later: every disk is advanced to `end`, a time in the old one.

        window: the exponent of the new one.
        """
        shift = epochs * self.epoch_length
        for i in range(self.n):
            x, y = self.place(i, end)
            vx, vy = self.speed(i, end)
            if (low := self.low_place(i, end)) is not None:
                self.low_x[i], self.low_y[i] = low
            self.keep_sides(i, end, (x, y), (vx, vy))
            self.anchor(i, end - shift, x, y, vx, vy)
            self.contact_time[i] = self.contact_time[i] - shift
        self.now = end - shift
        self.epoch += epochs
        self.begin_window(window)
        self.window_rows = 0

    def begin_window(self, exponent: int) -> None:
        """Set how long the window is, which is not open beyond its end."""
        self.window = exponent
        self.window_end = window_length(exponent, self.epoch_length)
        self.opened = False

    def stay_open(self, epochs: int | None) -> None:
        """Let the window, which had no row until its end, be open until so many epochs after its beginning, or for ever."""
        self.window_end = float("inf") if epochs is None else epochs * self.epoch_length
        self.opened = True

    def close(self) -> None:
        """Let a window in which a row has come beyond its end, end with the present epoch."""
        if self.opened or (self.window_rows and self.now >= self.window_end):
            self.window_end = end_of_epoch(float(self.now), self.epoch_length)
            self.opened = False

    def snapshot(self) -> Snapshot:
        """A copy of all that the future depends on."""
        return Snapshot(
            epoch=self.epoch,
            window=self.window,
            window_rows=self.window_rows,
            now=self.now,
            t=tuple(self.t),
            x=tuple(self.x),
            y=tuple(self.y),
            vx=tuple(self.vx),
            vy=tuple(self.vy),
            wraps_x=tuple(self.wraps_x),
            wraps_y=tuple(self.wraps_y),
            met=tuple(self.met),
            contact_time=tuple(self.contact_time),
            at_once=tuple(self.at_once),
            low_vx=tuple(self.low_vx),
            low_vy=tuple(self.low_vy),
            low_x=tuple(self.low_x),
            low_y=tuple(self.low_y),
            sides=self.sides_of_all(),
        )

    def restore(self, saved: Snapshot) -> None:
        """Go back (or on) to a snapshot; predictions made before are stale."""
        self.epoch, self.window_rows, self.now = saved.epoch, saved.window_rows, saved.now
        self.begin_window(saved.window)
        self.close()
        self.t, self.x, self.y = list(saved.t), list(saved.x), list(saved.y)
        self.vx, self.vy = list(saved.vx), list(saved.vy)
        self.wraps_x, self.wraps_y = list(saved.wraps_x), list(saved.wraps_y)
        self.met, self.contact_time, self.at_once = list(saved.met), list(saved.contact_time), list(saved.at_once)
        self.low_vx, self.low_vy = list(saved.low_vx), list(saved.low_vy)
        self.low_x, self.low_y = list(saved.low_x), list(saved.low_y)
        self.set_sides(saved.sides)
        self.count = [count + 1 for count in self.count]
        if self.supports is not None:
            for i in range(self.n):
                self._pull(i)


def _accelerations(stage: Stage) -> tuple[list[Acceleration], list[Acceleration]]:
    """Each disk's own gravity: None without, 0 for immovable disks."""
    if stage.gravity is None:
        return [None] * stage.n, [None] * stage.n
    gx, gy = stage.gravity
    fixed = [False] * stage.n if stage.mass is None else [mass == float("inf") for mass in stage.mass.tolist()]
    return [0.0 if held else gx for held in fixed], [0.0 if held else gy for held in fixed]
