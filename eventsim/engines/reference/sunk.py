"""Gaps below the digits: contacts that only the last bits of rounded places predict.

A contact that takes energy leaves disks slow and close.  The gap to what comes next is a difference of places.  Once it has sunk
to their last bits, nobody knows when that contact comes, or whether another one comes first.  Then a run stops.  So it does where
a disk hops along a round wall lower than that, and where two disks meet whose reach is below them.
"""

from __future__ import annotations

import math

from eventsim.engines.collapse import SQUEEZED, named
from eventsim.engines.exact_state import ExactState
from eventsim.engines.reference.calendar import Event
from eventsim.engines.reference.generation import disks_of
from eventsim.formulas.doubt import AT_ONCE, BELOW, SLOWLY, is_sunk, is_too_small, piled_up
from eventsim.formulas.real import Real
from eventsim.formulas.rest import SUPPORTED
from eventsim.formulas.walls.boundary import Boundary
from eventsim.formulas.walls.post import Post
from eventsim.scene.settling import remedy_of
from eventsim.scene.stage import Stage

ALONG = 2.0**-20
"""Who approaches a wall at less than this part of its speed moves along it."""

TINY = 2.0**-30
"""Where all reaches are above this part of the coordinates at the start, no place is so far out that they are below its bits."""


class Sunk:
    """Knows which contacts of one run close a gap that is below the digits.

    sank: whether the last reason is such a gap, and not a reach that is too small.
    """

    def __init__(self, stage: Stage, state: ExactState) -> None:
        self._stage = stage
        self._state = state
        self._looks, self._creeps, self._shrinks = can_sink(stage), can_creep(stage), can_be_too_small(stage)
        self._pile, self._slowly = piled_up(stage.law.loss()), SLOWLY * stage.epoch_length
        self.sank = False
        self._start = list(zip(stage.x.tolist(), stage.y.tolist(), strict=True))

    def reason(self, generation: list[Event]) -> str | None:
        """Why contacts of an instant cannot be resolved: a sentence on the first gap below the digits; None where they can."""
        for event in generation:
            self.sank = False
            if self._shrinks and event.b >= 0 and (place := self._place_too_small_for(event)) is not None:
                return self._word_on_reach(event.a, event.b, "meet at", place)
            if self._shrinks and event.b < 0 and event.image[1] == SUPPORTED and (j := self._met_on_its_line(event)) is not None:
                return self._word_on_reach(event.a, j, "slide into each other from", self._state.place(event.a, event.time))
            self.sank = True
            if self._looks and (gap := self._gap(event)) is not None:
                return self._sentence(event, gap)
            if self._creeps and (gap := self._hop(event)) is not None:
                return self._word_on_hops(event, gap)
        return None

    def _gap(self, event: Event) -> float | None:
        """The gap that a contact closes, as it was when the later of the flights began; None where it is known.

        It is known where no contact has taken energy from the later flight, and where both places are still those of the start.
        So it is where two disks met when that flight began, and one was kicked back into the other; and where a disk in a corner
        meets one wall at the instant at which it has met the other one.
        """
        state, disks = self._state, disks_of(event)
        begin = max(state.t[i] for i in disks)
        if not any(state.t[i] == begin and self._has_lost(i) for i in disks):
            return None
        if all((state.x[i], state.y[i]) == self._start[i] for i in disks):
            return None
        if event.b >= 0 and all(state.t[i] == begin for i in disks) and self._have_just_met(event):
            return None
        lag = event.time - begin
        if event.b < 0 and lag <= AT_ONCE * event.time and all(met[0] < 0 for met in state.met[event.a]):
            return None  # it is in a corner: it meets what it approaches, and whatever the gap, at this instant
        if event.b < 0 and self._stage.gravity is not None:
            return None  # disks come to rest there
        approach, size = self._of_pair(event) if event.b >= 0 else self._of_wall(event)
        return approach * lag if is_sunk(approach, lag, size, self._pile, self._slowly) else None

    def _hop(self, event: Event) -> float | None:
        """The gap that closes where a disk that moves along a round wall meets it; None where it is known.

        It comes from there, or from a place next to it at the start or at a kick.
        """
        state, i = self._state, event.a
        if event.b >= 0 or not is_hollow(self._stage, -1 - event.b):
            return None
        if state.met[i] and (self._stage.settles or all(met[0] != event.b for met in state.met[i])):
            return None  # where disks settle, a flight that begins on contact is known to
        (approach, size), lag = self._of_wall(event), float(event.time - state.t[i])
        speed = math.hypot(*state.speed(i, event.time))
        if not (is_sunk(approach, lag, size, BELOW, self._slowly) and approach < ALONG * speed):
            return None
        return approach * lag

    def _place_too_small_for(self, event: Event) -> tuple[Real, Real] | None:
        """Where two disks meet whose reach is below the last bits of their places; None where it is above them."""
        place = self._state.place(event.a, event.time)
        return place if self._is_too_small(event.a, event.b, place, event.time) else None

    def _met_on_its_line(self, event: Event) -> int | None:
        """Whom a disk, which comes to rest on a line, slides towards there, if places cannot tell that they meet."""
        state, t = self._state, event.time
        supports = state.supports
        assert supports is not None
        line = supports[-1 - event.b]
        assert line is not None
        (x, y), (u, w) = state.place(event.a, t), state.speed(event.a, t)
        for j in range(state.n):
            other = state.support_of(j)
            if j == event.a or other is None or other.line != line.line:
                continue
            (xj, yj), (uj, wj) = state.place(j, t), state.speed(j, t)
            approach = (x - xj) * (u - uj) + (y - yj) * (w - wj)
            if approach < 0.0 and self._is_too_small(event.a, j, (x, y), t):
                return j
        return None

    def _is_too_small(self, a: int, b: int, place: tuple[Real, Real], t: Real) -> bool:
        reach = float(self._stage.radius[a] + self._stage.radius[b])
        return bool(is_too_small(reach, max(abs(c) for c in (*place, *self._state.place(b, t)))))

    def _have_just_met(self, event: Event) -> bool:
        """Whether one of two disks remembers their contact, at which its flight began."""
        state, a, b = self._state, event.a, event.b
        kx = event.image[0] + state.wraps_x[a] - state.wraps_x[b]
        ky = event.image[1] + state.wraps_y[a] - state.wraps_y[b]
        return any(
            state.contact_time[i] == state.t[i] and met in state.met[i] for i, met in ((a, (b, kx, ky)), (b, (a, -kx, -ky)))
        )

    def _has_lost(self, i: int) -> bool:
        """Whether the flight of disk i began at a contact that took energy."""
        state = self._state
        if state.contact_time[i] != state.t[i]:
            return False
        return any(self._stage.usual(i, met[0]) < 1.0 for met in state.met[i])

    def _of_pair(self, event: Event) -> tuple[float, float]:
        """(approach, size): the speed at which the gap of two disks closes, and the size of what it is the difference of."""
        state, radius = self._state, self._stage.radius
        a, b, t = event.a, event.b, event.time
        if state.gravity_x[a] != state.gravity_x[b] or state.gravity_y[a] != state.gravity_y[b]:
            return math.inf, 0.0  # gravity opens and closes gaps of its own
        (xa, ya), (xb, yb) = state.place(a, t), state.place(b, t)
        (ua, wa), (ub, wb) = state.speed(a, t), state.speed(b, t)
        shift_x, shift_y = self._stage.shifts(event.image)
        dx, dy = (xa - xb) - shift_x, (ya - yb) - shift_y
        distance = math.hypot(dx, dy)
        size = abs(dx) * max(abs(xa), abs(xb)) + abs(dy) * max(abs(ya), abs(yb))
        return -(dx * (ua - ub) + dy * (wa - wb)) / distance, size / distance + float(radius[a] + radius[b])

    def _of_wall(self, event: Event) -> tuple[float, float]:
        """The same of a disk and a wall."""
        i, surface = event.a, -1 - event.b
        x, y = self._state.place(i, event.time)
        u, w = self._state.speed(i, event.time)
        nx, ny = self._stage.normal(surface, event.image[0], x, y)
        length = math.hypot(nx, ny)
        if not length > 0.0:
            return math.inf, 0.0  # a point on a post
        return -(nx * u + ny * w) / length, (abs(nx * x) + abs(ny * y)) / length + float(self._stage.radius[i])

    def _sentence(self, event: Event, gap: float) -> str:
        wall = self._stage.wall_names[self._stage.surfaces[-1 - event.b].wall] if event.b < 0 else None
        who = named(disks_of(event)) if wall is None else f"disk {event.a} and {wall}"
        remedy = SQUEEZED if self._is_squeezed(event) else remedy_of(self._stage)
        return (
            f"the gap of {who} has sunk to {gap:.2g}, the last bits of their places, behind contacts that take energy: which "
            f"contact comes next, and when, float64 cannot tell any more; {remedy}"
        )

    def _is_squeezed(self, event: Event) -> bool:
        """Whether what a disk cannot deflect presses it to something else of that kind, one of which moves."""
        for i, other in ((event.a, event.b), (event.b, event.a)):
            last = {met[0] for met in self._state.met[i]} if i >= 0 else ()
            for one in last:
                pressed = one != other and self._is_firm(i, one) and self._is_firm(i, other)
                if pressed and any(j >= 0 and any(self._state.speed(j, event.time)) for j in (one, other)):
                    return True
        return False

    def _is_firm(self, i: int, other: int) -> bool:
        """Whether disk i cannot deflect another one, or a wall, which deflects it."""
        mass = self._stage.mass
        if mass is None:
            return other < 0
        return not math.isinf(mass[i]) and (other < 0 or math.isinf(mass[other]) or mass[i] == 0.0)

    def _word_on_reach(self, a: int, b: int, how: str, place: tuple[Real, Real]) -> str:
        (x, y), (left, low) = place, self._stage.corner
        reach = float(self._stage.radius[a] + self._stage.radius[b])
        return (
            f"disks {a} and {b} {how} ({x + left:.6g}, {y + low:.6g}), and their reach of {reach:.2g} is below the "
            "last bits of places there: on which side, float64 cannot tell; larger disks can be told, points do not meet"
        )

    def _word_on_hops(self, event: Event, gap: float) -> str:
        wall = self._stage.wall_names[self._stage.surfaces[-1 - event.b].wall]
        return (
            f"disk {event.a} creeps along {wall} in hops that open gaps of {max(gap, 0.0):.2g}, the last bits of its place: when "
            "they end, float64 cannot tell; a start further from the wall, or less along it, has hops that can be told"
        )


def is_hollow(stage: Stage, surface: int) -> bool:
    """Whether a surface is round, so that a disk may creep along it from contact to contact."""
    found = stage.surfaces[surface]
    return not isinstance(found, Boundary) and found.shape.line() is None and not isinstance(found.shape, Post)


def can_creep(stage: Stage) -> bool:
    """Whether there are round walls, along which hops may sink below the digits."""
    return any(is_hollow(stage, k) for k in range(len(stage.surfaces)))


def can_be_too_small(stage: Stage) -> bool:
    """Whether there may be two disks whose reach is below the last bits of their places."""
    if len(stage.radius) < 2:
        return False
    one, other = sorted(stage.radius.tolist())[:2]
    least = one + other or float(min((r for r in stage.radius if r > 0.0), default=math.inf))
    return bool(least <= TINY * stage.extent)


def can_sink(stage: Stage) -> bool:
    """Whether contacts take energy however fast they follow each other, so that gaps can sink below the digits."""
    return stage.law.comes_to_rest()
