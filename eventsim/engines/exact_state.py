"""What every exact engine holds of a run: the free flights of all disks, whom each met last, and the clock."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import MutableSequence
from typing import Any, TypeAlias

from eventsim.engines.base import Snapshot
from eventsim.engines.turnover import Anchors
from eventsim.formulas.clock import end_of_epoch, window_length
from eventsim.formulas.motion import position, velocity
from eventsim.formulas.real import Real
from eventsim.formulas.rest import AS_AT_START, NOT_LAST, SUPPORTED, Support, has_struck, held_by
from eventsim.scene.sides import Sides

LONG_AGO = -1e300
"""The time of the last contact of a disk that has met nothing, but has been kicked."""

Met: TypeAlias = tuple[tuple[int, int, int], ...]
"""Whom a disk met last: (disk, image kx, ky), or (-1 - number of the surface, side, STRUCK, SUPPORTED or LEFT); several after a
joint contact."""


class ExactState(ABC):
    """The flights of n disks, by their numbers in the scene; only advance and resolve change them.

    t, x, y, vx, vy: the anchor of each flight, t a remainder in the present epoch.  count: the invalidation counts. wraps_x,
    wraps_y: how often a disk passed a periodic boundary.  met: whom it met last.  contact_time: when that was (a remainder;
    -inf: never, LONG_AGO: never, but it was kicked).  at_once: its contacts at that very time, to see that an instant does
    not end.  number: makes a number of the engine's type from a float.  low_parts: whether velocities carry what their
    rounding at a contact left, in low_vx and low_vy, which are empty otherwise; numbers of another type than float need none.
    spin: angular velocities, None where disks have none; contacts change them.  contacts: how many each disk has had, None where
    no chance hangs on that.
    gravity_x, gravity_y: the acceleration of each disk, None without gravity.  sides: of walls that points are on, None where
    no disk is one.  window: the exponent of its length; window_end: where the window ends, later where it stayed open because
    it had no row (opened).
    """

    n: int
    number: Any
    now: Real
    epoch: int
    epoch_length: float
    window: int
    window_end: Real
    window_rows: int
    opened: bool
    t: MutableSequence[Real]
    x: MutableSequence[Real]
    y: MutableSequence[Real]
    vx: MutableSequence[Real]
    vy: MutableSequence[Real]
    wraps_x: MutableSequence[int]
    wraps_y: MutableSequence[int]
    count: MutableSequence[int]
    at_once: MutableSequence[int]
    contact_time: MutableSequence[Real]
    met: MutableSequence[Met]
    low_parts: bool
    low_vx: MutableSequence[float]
    low_vy: MutableSequence[float]
    spin: Any = None
    contacts: Any = None
    gravity_x: Any
    gravity_y: Any
    supports: Any
    sides: Any
    _radius: list[float]
    _walls: Sides

    @property
    @abstractmethod
    def last_begun(self) -> Real:
        """When the last of all flights began."""

    @abstractmethod
    def anchors(self) -> Anchors:
        """Where all flights begin, rounded."""

    @abstractmethod
    def meet(self, i: int, met: Met) -> None:
        """Let disk i remember whom it met; what it rests on takes a part of its gravity, and anything else frees it."""

    @abstractmethod
    def snapshot(self) -> Snapshot:
        """A copy of all that the future depends on."""

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

    def since_met(self, i: int, wall: int) -> Real:
        """How long before its flight began disk i struck a wall, -1 - its place, or one in line with it; else NOT_LAST.

        AS_AT_START where it has met nothing yet.
        """
        if self.is_as_at_start(i):
            return AS_AT_START
        if not has_struck(self.supports, self.met[i], -1 - wall):
            return NOT_LAST
        return self.since_contact(i)

    def since_contact(self, i: int) -> Real:
        """How long before its flight began disk i had its last contact."""
        begun, struck = self.t[i], self.contact_time[i]
        return 0.0 if begun is struck else begun - struck

    def is_as_at_start(self, i: int) -> bool:
        """Whether nothing has changed the velocity of disk i, but gravity: so it flies as the scene says."""
        return bool(self.contact_time[i] == -float("inf"))

    def note_kick(self, i: int) -> None:
        """Remember that disk i does not fly as at the start any more."""
        if self.is_as_at_start(i):
            self.contact_time[i] = LONG_AGO

    def begins_on_contact(self, i: int) -> bool:
        """Whether the present flight of disk i began at its last contact."""
        begun, struck = self.t[i], self.contact_time[i]
        return bool(begun is struck or begun == struck)

    def support_of(self, i: int) -> Support | None:
        """What disk i rests on; None in free flight."""
        if self.supports is None:
            return None
        held = held_by(self.met[i])
        return None if held is None or held.how != SUPPORTED else self.supports[held.place]

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
