"""Contacts are resolved: a single one by the pair or wall formula, several that share disks jointly."""

from __future__ import annotations

import math
from typing import Any, TypeAlias

import numpy as np

from eventsim.engines.base import Counters
from eventsim.engines.collapse import remedy
from eventsim.engines.reference.calendar import Event
from eventsim.engines.reference.state import EngineState
from eventsim.formulas.careful_impulse import careful_pair_update, careful_wall_update
from eventsim.formulas.impulse import (
    contact_restitution,
    flat_update,
    mass_fractions,
    pair_update,
    reduced_mass,
    wall_update,
)
from eventsim.formulas.real import Real, sqrt
from eventsim.formulas.rest import AT_ONCE, LEFT, SUPPORTED, held_by, is_still, resting_place, slope
from eventsim.formulas.simultaneous import JointContact, Outcome, resolve_together
from eventsim.formulas.walls.face import Face, face_normal
from eventsim.formulas.walls.round import round_normal
from eventsim.record.events import Kind
from eventsim.scene.stage import Stage

Row: TypeAlias = tuple[Any, ...]
MISSING = math.nan

AT_ONCE_ELASTIC, AT_ONCE_INELASTIC = 100_000, 100
"""Contacts of one disk at one instant that are too many.  Elastic sequences end, if late; inelastic ones of this length are a
collapse."""

BETWEEN_HEAVY, MOST_AT_ONCE = 8.0, 1 << 30
"""A light disk between a heavy one and a wall has up to pi sqrt(M/m) contacts, all at one instant where the clock cannot tell
them apart: so many roots of the mass ratio are not too many.  The fast engine counts in int32."""

AT_ONCE_SQUEEZED = 2.0**-32
"""As AT_ONCE, where energy has no bound: between moving immovable disks, or as a tracer, a disk can be driven to ever faster
contacts, whose number would be the inverse root of AT_ONCE before the clock stands still."""


def instant_of(stage: Stage) -> tuple[float, int]:
    """(share of the clock, number): contacts of a disk closer than this are at one instant, and so many of them too many."""
    if not (stage.pair_restitution == 1.0 and stage.wall_restitution == 1.0):
        return AT_ONCE, AT_ONCE_INELASTIC
    most = AT_ONCE_ELASTIC
    if stage.mass is not None:
        driven = np.isinf(stage.mass) & ((stage.vx != 0.0) | (stage.vy != 0.0))
        if np.any(driven | (stage.mass == 0.0)):
            return AT_ONCE_SQUEEZED, most
        most = int(min(max(most, BETWEEN_HEAVY * math.sqrt(stage.mass_ratio)), MOST_AT_ONCE))
    return AT_ONCE, most


class TwoSupportsError(Exception):
    """A disk comes to rest on two walls: how they share its weight is no question of impulses."""

    def __init__(self, disk: int, walls: list[str], stage: Stage) -> None:
        # with a contact duration there is rest only of disks that lie on a wall at the start, however long it is
        then = f"; {remedy(stage)}" if stage.contact_duration is None else ", whatever the contact_duration"
        super().__init__(
            f"disk {disk} comes to rest on two walls, {' and '.join(walls)}: only rest on one straight wall is modelled{then}"
        )


class Resolver:
    """Resolves the contacts of one stage; counts them, books momentum, and keeps their rows if asked to."""

    at_once: float | None = None
    """Share of the clock within which contacts are at one instant; None: what suits the scene."""

    def __init__(self, stage: Stage, state: EngineState, counters: Counters, keep_rows: bool) -> None:
        self._stage = stage
        self._state = state
        self._counters = counters
        self._radius: list[Real] = stage.radius.tolist()
        self._mass: list[float] | None = None if stage.mass is None else stage.mass.tolist()
        self._same_mass: float = stage.common_mass
        self._keep_rows = keep_rows
        self.rows: list[Row] = []
        share, self.at_once_limit = instant_of(stage)
        self._instant = share if self.at_once is None else self.at_once
        self._settles = stage.settles and self.at_once is None

    def resolve(self, component: list[Event]) -> list[int]:
        """Resolve contacts of one time that are connected through shared disks; the disks that it changed."""
        if self._state.supports is not None:
            rests = [event for event in component if event.b < 0 and event.image[1]]
            if rests:
                return self._resolve_and_rest([event for event in component if event not in rests], rests)
        if len(component) > 1:
            return self._joint(component)
        event = component[0]
        if event.b >= 0:
            return self._pair(event)
        return self._wall(event)

    def _resolve_and_rest(self, contacts: list[Event], rests: list[Event]) -> list[int]:
        """Resolve contacts; then the disks that these leave untouched come to rest, or slide over the end of their wall."""
        changed = self.resolve(contacts) if contacts else []
        for event in rests:
            if event.a not in changed:
                self._rest(event) if event.image[1] == SUPPORTED else self._leave(event)
                changed.append(event.a)
        return changed

    def _rest(self, event: Event) -> None:
        """Let a disk rest on a wall; it may have rested on another one, which this one takes it from.

        Raises TwoSupportsError where it would lie on both.
        """
        state = self._state
        t, i, place, side = event.time, event.a, -1 - event.b, event.image[0]
        assert state.supports is not None
        support = state.supports[place]
        assert support is not None
        self._check_single(i, place)
        self._free(i, t)
        x, y = state.place(i, t)
        u, w = before = state.speed(i, t)
        x, y = resting_place(support.face, side, x, y, self._radius[i])
        still = self._is_still(i, t)
        u, w = slope(support.face, u, w)
        state.anchor(i, t, x, y, u, w)
        state.meet(i, ((event.b, side, SUPPORTED),))
        self._book_support(i, t, 1.0)
        self._note_time(i, t, False, still)
        impulse = self._book_wall(self._mass_of(i), u - before[0], w - before[1])
        self._counters.rests += 1
        self._row(t, Kind.REST, i, -1, self._wall_number(place), impulse, -1)

    def _check_single(self, i: int, place: int) -> None:
        """Raise TwoSupportsError where disk i, which comes to rest on one wall, stays pressed onto the one that it rests on."""
        state = self._state
        held = held_by(state.met[i])
        if held is None or held.how != SUPPORTED or state.supports is None:
            return
        old, new = state.supports[held.place], state.supports[place]
        assert old is not None
        assert new is not None
        if held.side * (old.face.nx * new.ax + old.face.ny * new.ay) < 0.0:
            walls = [self._stage.wall_names[self._wall_number(k)] for k in (held.place, place)]
            raise TwoSupportsError(i, walls, self._stage)

    def _leave(self, event: Event) -> None:
        """Let a disk that slid over the end of its wall fly on; a row without an impulse."""
        state = self._state
        t, i = event.time, event.a
        x, y = state.place(i, t)
        u, w = state.speed(i, t)
        self._free(i, t)
        state.anchor(i, t, x, y, u, w)
        state.meet(i, ((event.b, event.image[0], LEFT),))
        self._note_time(i, t, False, False)
        self._counters.wall_contacts += 1
        self._row(t, Kind.WALL, i, -1, self._wall_number(-1 - event.b), 0.0, -1)

    def _free(self, i: int, t: Real) -> None:
        """Book what a wall has given to disk i until now, if it rested there; the impulse that comes frees it."""
        if self._state.supports is not None:
            self._book_support(i, t, -1.0)

    def _book_support(self, i: int, t: Real, sign: float) -> None:
        """Note that a wall begins (+1) or ceases (-1) to support disk i, if it rests on one."""
        support, gravity = self._state.support_of(i), self._stage.gravity
        if support is None or gravity is None:
            return
        passed = self._state.epoch * self._stage.epoch_length + float(t)
        total = self._counters.support_force
        for axis, (along, whole) in enumerate(zip((support.ax, support.ay), gravity, strict=True)):
            force = sign * (self._mass_of(i) * (along - whole))
            total[axis] += force
            self._counters.outer_momentum[axis] -= force * passed

    def kick(self, i: int, vx: float, vy: float) -> None:
        """Set the velocity of disk i from outside, at the present time; a row of its own."""
        state = self._state
        t = state.now
        x, y = state.place(i, t)
        before = state.speed(i, t)
        self._free(i, t)
        state.anchor(i, t, x, y, vx, vy)
        state.forget_low_parts(i)
        state.meet(i, ())
        mass = self._mass_of(i)
        if math.isfinite(mass):
            self._book(mass * (vx - before[0]), mass * (vy - before[1]))
        self._counters.kicks += 1
        strength = mass * math.hypot(vx - before[0], vy - before[1]) if math.isfinite(mass) else MISSING
        self._row(t, Kind.KICK, i, -1, -1, strength, -1)

    def _pair(self, event: Event) -> list[int]:
        state = self._state
        t, a, b = event.time, event.a, event.b
        xa, ya = state.place(a, t)
        xb, yb = state.place(b, t)
        dx, dy = self._apart(event, xa, ya, xb, yb)
        still = self._is_still(a, t) and self._is_still(b, t)
        if state.low_parts:
            ua, wa, ub, wb, q = self._careful_pair(a, b, dx, dy)
        else:
            ua, wa = state.speed(a, t)
            ub, wb = state.speed(b, t)
            share_a, share_b = self._shares(a, b)
            restitution = self._restitution(self._stage.pair_restitution, t, a, b)
            ua, wa, ub, wb, q = pair_update(dx, dy, ua, wa, ub, wb, share_a, share_b, restitution)
        self._free(a, t)
        self._free(b, t)
        state.anchor(a, t, xa, ya, ua, wa)
        state.anchor(b, t, xb, yb, ub, wb)
        kx = event.image[0] + state.wraps_x[a] - state.wraps_x[b]
        ky = event.image[1] + state.wraps_y[a] - state.wraps_y[b]
        state.meet(a, ((b, kx, ky),))
        state.meet(b, ((a, -kx, -ky),))
        self._note_time(a, t, q == 0.0, still)
        self._note_time(b, t, q == 0.0, still)
        reduced = self._reduced(a, b)
        distance = sqrt(dx * dx + dy * dy)
        self._note_overlap(a, b, distance)
        self._book_pair(a, b, -(q * reduced) * dx, -(q * reduced) * dy)
        self._counters.pair_contacts += 1
        self._row(t, Kind.PAIR, a, b, -1, -(q * reduced) * distance, -1)
        return [a, b]

    def _careful_pair(self, a: int, b: int, dx: Real, dy: Real) -> tuple[Real, Real, Real, Real, Real]:
        """Velocities after contact, and q, as from `pair_update`; their low parts are set."""
        state = self._state
        low_x, low_y = state.low_vx, state.low_vy
        speeds = state.vx[a], state.vy[a], state.vx[b], state.vy[b]
        masses = self._mass_of(a), self._mass_of(b)
        ua, wa, ub, wb, low_x[a], low_y[a], low_x[b], low_y[b], q = careful_pair_update(
            dx, dy, *speeds, low_x[a], low_y[a], low_x[b], low_y[b], *masses
        )
        return ua, wa, ub, wb, q

    def _wall(self, event: Event) -> list[int]:
        state, stage = self._state, self._stage
        t, i, place, side = event.time, event.a, -1 - event.b, event.image[0]
        x, y = state.place(i, t)
        u, w = state.speed(i, t)
        before = u, w
        # A series on one straight wall is over when it is, and may well be lower than the last bits before.
        still = not self._series(i, place) and self._is_still(i, t)
        restitution = self._restitution(stage.wall_restitution, t, i, i)
        if state.low_parts:
            u, w = self._careful_wall(i, *self._normal(place, side, x, y))
        elif place >= len(stage.boundaries):
            u, w, _ = wall_update(*self._normal(place, side, x, y), u, w, restitution)
        elif stage.boundaries[place].axis == 0:
            u, _ = flat_update(u, stage.boundaries[place].side, restitution)
        else:
            w, _ = flat_update(w, stage.boundaries[place].side, restitution)
        x, y = self._on_boundary(place, i, x, y)
        self._free(i, t)
        state.anchor(i, t, x, y, u, w)
        state.meet(i, ((event.b, side, 0),))
        self._note_time(i, t, (u, w) == before, still)
        mass = self._mass_of(i)
        impulse = self._book_wall(mass, u - before[0], w - before[1])
        self._counters.wall_contacts += 1
        self._row(t, Kind.WALL, i, -1, self._wall_number(place), impulse, -1)
        return [i]

    def _careful_wall(self, i: int, nx: Real, ny: Real) -> tuple[Real, Real]:
        """The velocity of disk i after contact with a wall; its low part is set."""
        state = self._state
        low = state.low_vx[i], state.low_vy[i]
        u, w, state.low_vx[i], state.low_vy[i], _ = careful_wall_update(nx, ny, state.vx[i], state.vy[i], *low)
        return u, w

    def _joint(self, component: list[Event]) -> list[int]:
        """A cluster: the velocities after it from the law of simultaneous contacts; disks that get no impulse fly on."""
        state, stage = self._state, self._stage
        t = component[0].time
        disks = sorted({i for event in component for i in (event.a, event.b) if i >= 0})
        number = {disk: k for k, disk in enumerate(disks)}
        at = [state.place(i, t) for i in disks]
        before = [state.speed(i, t) for i in disks]
        contacts = []
        for event in component:
            xa, ya = at[number[event.a]]
            if event.b >= 0:
                dx, dy = self._apart(event, xa, ya, *at[number[event.b]])
                e = self._restitution(stage.pair_restitution, t, event.a, event.b)
                contacts.append(JointContact(number[event.a], number[event.b], dx, dy, e))
            else:
                nx, ny = self._normal(-1 - event.b, event.image[0], xa, ya)
                e = self._restitution(stage.wall_restitution, t, event.a, event.a)
                contacts.append(JointContact(number[event.a], None, nx, ny, e))
        outcome = self._together(contacts, before, [self._mass_of(i) for i in disks])
        active = [k for k, taken in enumerate(outcome.active) if taken]
        if not active and stage.gravity is not None:
            return self.resolve(component[:1])  # gravity closes these gaps: they are met, one by one
        changed = sorted({i for k in active for i in component[k][2:4] if i >= 0})
        still = all(self._is_still(i, t) for i in changed)
        for i in changed:
            x, y = at[number[i]]
            for k in active:
                if component[k].a == i and component[k].b < 0:
                    x, y = self._on_boundary(-1 - component[k].b, i, x, y)
            self._free(i, t)
            state.anchor(i, t, x, y, *outcome.velocities[number[i]])
            state.forget_low_parts(i)
            state.meet(i, tuple(self._met(component[k], i) for k in active if i in component[k][2:4]))
            self._note_time(i, t, False, still)
        first = self._counters.events
        for k in active:
            self._note_joint(component[k], contacts[k], outcome.impulses[k], first)
        self._counters.clusters += 1
        return changed

    def _together(self, contacts: list[JointContact], before: list[tuple[Real, Real]], masses: list[float]) -> Outcome:
        """The law of simultaneous contacts in the engine's numbers."""
        return resolve_together(contacts, before, masses)

    def _note_joint(self, event: Event, contact: JointContact, impulse: float, first: int) -> None:
        """Book and log one contact of a cluster that is resolved."""
        distance = math.hypot(contact.dx, contact.dy)
        jx, jy = impulse * (contact.dx / distance), impulse * (contact.dy / distance)
        if event.b >= 0:
            self._note_overlap(event.a, event.b, distance)
            self._book_pair(event.a, event.b, jx, jy)
            self._counters.pair_contacts += 1
            self._row(event.time, Kind.PAIR, event.a, event.b, -1, impulse, first)
        else:
            self._book(jx, jy)
            self._counters.wall_contacts += 1
            self._row(event.time, Kind.WALL, event.a, -1, self._wall_number(-1 - event.b), impulse, first)

    def _met(self, event: Event, i: int) -> tuple[int, int, int]:
        """What disk i remembers of a contact."""
        if event.b < 0:
            return event.b, event.image[0], 0
        state = self._state
        kx = event.image[0] + state.wraps_x[event.a] - state.wraps_x[event.b]
        ky = event.image[1] + state.wraps_y[event.a] - state.wraps_y[event.b]
        return (event.b, kx, ky) if i == event.a else (event.a, -kx, -ky)

    def _apart(self, event: Event, xa: Real, ya: Real, xb: Real, yb: Real) -> tuple[Real, Real]:
        """The vector from b (its image) to a."""
        (kx, ky), (length_x, length_y) = event.image, self._stage.period
        dx, dy = xa - xb, ya - yb
        if kx:
            dx = dx - kx * length_x  # type: ignore[operator]
        if ky:
            dy = dy - ky * length_y  # type: ignore[operator]
        return dx, dy

    def _normal(self, place: int, side: int, x: Real, y: Real) -> tuple[Real, Real]:
        """The normal, of any length, of a wall shape, towards a disk at (x, y)."""
        boundaries = self._stage.boundaries
        if place < len(boundaries):
            boundary = boundaries[place]
            return (boundary.side, 0.0) if boundary.axis == 0 else (0.0, boundary.side)
        shape = self._stage.features[place - len(boundaries)].shape
        if isinstance(shape, Face):
            return face_normal(shape, side)
        return round_normal(shape, side, x, y)

    def _on_boundary(self, place: int, i: int, x: Real, y: Real) -> tuple[Real, Real]:
        """The place of disk i, set exactly onto a boundary of the domain that it meets."""
        if place >= len(self._stage.boundaries):
            return x, y
        boundary = self._stage.boundaries[place]
        target = boundary.position + boundary.side * self._radius[i]
        return (target, y) if boundary.axis == 0 else (x, target)

    def _wall_number(self, place: int) -> int:
        boundaries = self._stage.boundaries
        return boundaries[place].wall if place < len(boundaries) else self._stage.features[place - len(boundaries)].wall

    def _restitution(self, restitution: float, t: Real, a: int, b: int) -> Real:
        duration = self._stage.contact_duration
        if duration is None:
            return restitution
        state = self._state
        return contact_restitution(restitution, duration, t - state.contact_time[a], t - state.contact_time[b])

    def _is_still(self, i: int, t: Real) -> bool:
        """Whether disk i has not come further, since its flight began, than the last bits of its place."""
        state = self._state
        if not self._settles:
            return False
        return is_still(*state.place(i, t), state.vx[i], state.vy[i], *state.speed(i, t), t - state.t[i])

    def _series(self, i: int, place: int) -> bool:
        """Whether disk i met that straight wall already last."""
        state = self._state
        if state.supports is None or state.supports[place] is None:
            return False
        return len(state.met[i]) == 1 and state.met[i][0][0] == -1 - place

    def _note_time(self, i: int, t: Real, idle: bool, still: bool) -> None:
        """Note a contact of disk i; of idle ones, which change nothing, a third at the same instant is too many.

        still: it is as good as at the instant of the one before, because the disk did not move in between.
        """
        state = self._state
        weight = self.at_once_limit // 3 + 1 if idle else 1
        again = still or t - state.contact_time[i] <= self._instant * t
        state.at_once[i] = state.at_once[i] + weight if again else weight
        state.contact_time[i] = t

    def _note_overlap(self, a: int, b: int, distance: Real) -> None:
        reach = self._radius[a] + self._radius[b]
        overlap = (reach - distance) / reach
        if overlap > self._counters.deepest_overlap and self._finite(a) and self._finite(b):
            self._counters.deepest_overlap = overlap

    def _mass_of(self, i: int) -> float:
        return self._same_mass if self._mass is None else self._mass[i]

    def _finite(self, i: int) -> bool:
        return 0.0 < self._mass_of(i) < math.inf

    def _shares(self, a: int, b: int) -> tuple[Real, Real]:
        """Of the sum of two masses."""
        return (0.5, 0.5) if self._mass is None else mass_fractions(self._mass[a], self._mass[b])

    def _reduced(self, a: int, b: int) -> float:
        return 0.5 * self._same_mass if self._mass is None else reduced_mass(self._mass[a], self._mass[b])

    def _book(self, jx: Real, jy: Real) -> None:
        """Note momentum that came from outside the disks of finite mass."""
        momentum = self._counters.outer_momentum
        momentum[0] += jx
        momentum[1] += jy

    def _book_pair(self, a: int, b: int, jx: Real, jy: Real) -> None:
        """Note the momentum that an immovable disk gave to the other one; (jx, jy) is what a received."""
        if self._mass is None:
            return
        if math.isinf(self._mass[b]):
            self._book(jx, jy)
        elif math.isinf(self._mass[a]):
            self._book(-jx, -jy)

    def _book_wall(self, mass: float, du: Real, dw: Real) -> Real:
        """Note the momentum that a wall gave; its magnitude.  An immovable disk has none to speak of."""
        if math.isinf(mass):
            return MISSING
        self._book(mass * du, mass * dw)
        return mass * (abs(du) if dw == 0.0 else abs(dw) if du == 0.0 else sqrt(du * du + dw * dw))

    def _row(self, t: Real, kind: Kind, a: int, b: int, wall: int, impulse: Real, joint: int) -> None:
        """Count an event, and keep its row if rows are kept."""
        state, counters = self._state, self._counters
        if self._keep_rows:
            other: tuple[Any, ...] = (MISSING, MISSING, MISSING, MISSING)
            if b >= 0:
                other = (state.x[b], state.y[b], state.vx[b], state.vy[b])
            flight = (state.x[a], state.y[a], state.vx[a], state.vy[a])
            self.rows.append((counters.events, 0.0, kind, a, b, wall, *flight, *other, impulse, joint, state.epoch, t))
        counters.events += 1
        state.window_rows += 1
