"""Contacts are resolved: a single one by the pair or wall formula, several that share disks jointly."""

from __future__ import annotations

import math

from eventsim.engines.base import Counters
from eventsim.engines.exact_state import ExactState
from eventsim.engines.reference.calendar import Event
from eventsim.engines.reference.generation import disks_of
from eventsim.engines.reference.instants import Instants
from eventsim.engines.reference.ledger import Ledger, Row
from eventsim.engines.reference.masses import Masses
from eventsim.engines.reference.rests import Rests
from eventsim.engines.reference.unresolvable import grazed_at_once, joint_under, lawful, rough_joint
from eventsim.formulas.careful_impulse import careful_pair_update, careful_wall_update
from eventsim.formulas.chance import flux
from eventsim.formulas.doubt import AT_ONCE, contact_doubt, round_size
from eventsim.formulas.impulse import along, approach_speed, flat_update, heated, pair_update, wall_update
from eventsim.formulas.laws import Own, Treatment
from eventsim.formulas.real import NEVER, Real, sqrt
from eventsim.formulas.rest import has_struck, launch, rebound
from eventsim.formulas.rough import SMOOTH, Roughness, grip_strength, gripped, heated_spin, pair_grip, wall_grip
from eventsim.formulas.simultaneous import JointContact, Outcome, are_apart, resolve_together
from eventsim.formulas.walls.point import is_still_rising
from eventsim.record.events import Kind
from eventsim.scene.stage import Stage


class Resolver:
    """Resolves the contacts of one stage; counts them, books momentum, and keeps their rows if asked to."""

    at_once: float | None = None
    """Share of the clock within which contacts are at one instant; None: what suits the scene."""
    ledger: type[Ledger] = Ledger

    def __init__(self, stage: Stage, state: ExactState, counters: Counters, keep_rows: bool) -> None:
        self._stage = stage
        self._state = state
        self._counters = counters
        self._radius: list[Real] = [state.number(radius) for radius in stage.radius.tolist()]
        self._masses = Masses(stage)
        self._moment: list[float] = [] if stage.moment is None else stage.moment.tolist()
        self._grips, self._rough = stage.law.grips, stage.law.rough or Roughness(SMOOTH, SMOOTH)
        self._ledger = self.ledger(stage, state, self._masses, counters, keep_rows)
        self._instants = Instants(stage, state, self.at_once)
        self._rests = Rests(stage, state, self._radius, self._instants, self._ledger, counters)

    @property
    def at_once_limit(self) -> int:
        """So many contacts of a disk at one instant are too many."""
        return self._instants.limit

    def take_rows(self) -> list[Row]:
        """The rows since the last call."""
        rows, self._ledger.rows = self._ledger.rows, []
        return rows

    def resolve(self, component: list[Event]) -> list[int]:
        """Resolve contacts of one instant that are connected through shared disks; the disks that it changed."""
        self._rests.check_corner(component)
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
                self._rests.take_place(event)
                changed.append(event.a)
        return changed

    def kick(self, i: int, vx: float, vy: float) -> None:
        """Set the velocity of disk i from outside, at the present time; a row of its own."""
        state = self._state
        t = state.now
        x, y = state.place(i, t)
        before = state.speed(i, t)
        self._rests.free(i, t)
        state.keep_sides(i, t, (x, y), (vx, vy))
        state.anchor(i, t, x, y, vx, vy)
        state.forget_low_parts(i)
        state.note_kick(i)
        state.meet(i, ())
        strength = self._ledger.book_kick(i, vx - before[0], vy - before[1])
        self._counters.kicks += 1
        self._ledger.log(t, Kind.KICK, i, -1, -1, strength, -1)

    def _pair(self, event: Event) -> list[int]:
        state = self._state
        t, a, b = event.time, event.a, event.b
        xa, ya = state.place(a, t)
        xb, yb = state.place(b, t)
        dx, dy = self._apart(event, xa, ya, xb, yb)
        again = self._met(event, a) in state.met[a] and self._met(event, b) in state.met[b]
        still = not again and self._instants.is_still(a, t) and self._instants.is_still(b, t)
        restitution = self._restitution(event, t, dx, dy, (state.speed(a, t), state.speed(b, t)))
        if state.low_parts:
            ua, wa, ub, wb, q = self._careful_pair(a, b, dx, dy, restitution)
        else:
            ua, wa = state.speed(a, t)
            ub, wb = state.speed(b, t)
            share_a, share_b = self._shares(a, b)
            ua, wa, ub, wb, q = pair_update(dx, dy, ua, wa, ub, wb, share_a, share_b, restitution)
        k: Real = 0.0
        if self._grips[0]:
            before = (*state.speed(a, t), *state.speed(b, t))
            k = self._turn_pair(a, b, dx, dy, before)
            ua, wa, ub, wb = gripped(dx, dy, ua, wa, ub, wb, *self._shares(a, b), k)
        self._rests.free(a, t)
        self._rests.free(b, t)
        state.keep_sides(a, t, (xa, ya), (ua, wa))
        state.keep_sides(b, t, (xb, yb), (ub, wb))
        state.anchor(a, t, xa, ya, ua, wa)
        state.anchor(b, t, xb, yb, ub, wb)
        state.meet(a, (self._met(event, a),))
        state.meet(b, (self._met(event, b),))
        self._instants.note(a, t, q == 0.0, still)
        self._instants.note(b, t, q == 0.0, still)
        reduced = self._masses.reduced(a, b)
        distance = sqrt(dx * dx + dy * dy)
        self._ledger.note_overlap(a, b, distance, self._radius[a] + self._radius[b])
        jx, jy, strength = -(q * reduced) * dx, -(q * reduced) * dy, -(q * reduced) * distance
        if self._grips[0]:
            jx, jy = jx + (k * reduced) * dy, jy - (k * reduced) * dx
            strength = grip_strength(q, k, reduced, distance)
        self._ledger.book_pair(a, b, jx, jy)
        self._counters.pair_contacts += 1
        self._count(a, b)
        self._ledger.log(t, Kind.PAIR, a, b, -1, strength, -1)
        return [a, b]

    def _count(self, *disks: int) -> None:
        """Count a contact of these disks, where chance hangs on the number of contacts."""
        if self._state.contacts is not None:
            for i in disks:
                self._state.contacts[i] += 1

    def _turn_pair(self, a: int, b: int, dx: Real, dy: Real, before: tuple[Real, Real, Real, Real]) -> Real:
        """Let two disks, with these velocities before their contact, turn each other; k as from `pair_grip`."""
        spin, radius, moment = self._state.spin, self._radius, self._moment
        ua, wa, ub, wb = before
        about = (*self._shares(a, b), radius[a], radius[b], moment[a], moment[b], self._rough.pair)
        spin[a], spin[b], k = pair_grip(dx, dy, ua - ub, wa - wb, spin[a], spin[b], *about)
        return k

    def _turn_at_wall(self, i: int, nx: Real, ny: Real, u: Real, w: Real) -> Real:
        """Let a wall turn disk i, whose velocity was (u, w); k as from `wall_grip`.  It does not turn what it cannot deflect."""
        spin = self._state.spin
        if self._masses.is_immovable(i):
            return 0.0
        spin[i], k = wall_grip(nx, ny, u, w, spin[i], self._radius[i], self._moment[i], self._rough.wall)
        return k

    def _shares(self, a: int, b: int) -> tuple[Real, Real]:
        """Of the sum of two masses, in the engine's numbers."""
        return self._masses.shares(a, b)

    def _careful_pair(
        self, a: int, b: int, dx: Real, dy: Real, restitution: Real
    ) -> tuple[Real, Real, Real, Real, Real]:
        """Velocities after contact, and q, as from `pair_update`; their low parts are set."""
        state = self._state
        low_x, low_y = state.low_vx, state.low_vy
        speeds = state.vx[a], state.vy[a], state.vx[b], state.vy[b]
        masses = self._masses.of(a), self._masses.of(b)
        ua, wa, ub, wb, low_x[a], low_y[a], low_x[b], low_y[b], q = careful_pair_update(
            dx, dy, *speeds, low_x[a], low_y[a], low_x[b], low_y[b], *masses, restitution
        )
        return ua, wa, ub, wb, q

    def _wall(self, event: Event) -> list[int]:
        state, stage = self._state, self._stage
        t, i, place, side = event.time, event.a, -1 - event.b, event.image[0]
        x, y = state.place(i, t)
        u, w = state.speed(i, t)
        before = u, w
        # A series on one wall is over when it is, and may well be lower than the last bits before.
        series = self._instants.is_series(i, place)
        still = not series and self._instants.is_still(i, t)
        done = stage.law.treatment(stage.surfaces[place].wall) if stage.law.drives else None
        asks = stage.law.by_speed or done is not None
        nx, ny = self._towards(event, x, y, u, w) if asks else (0.0, 0.0)
        shift_x = shift_y = 0.0
        if done is not None and done.shaking:
            shift_x, shift_y = along(nx, ny, done.shaking)
            u, w = u - shift_x, w - shift_y
        restitution = self._restitution(event, t, nx, ny, ((u, w),))
        again = self._launched(i, place, side)
        if stage.is_exact_hit(place, self._radius[i]):
            x, y = self._place_on(place, side, i, x, y)
            u, w = self._turned_round(i, x, y, u, w, restitution)
        elif again > 0.0:
            u, w = rebound(*stage.normal(place, side, x, y), u, w, restitution * again)
        elif state.low_parts:
            u, w = self._careful_wall(i, *stage.normal(place, side, x, y), restitution)
        elif (boundary := stage.boundary(place)) is None:
            u, w, _ = wall_update(*stage.normal(place, side, x, y), u, w, restitution)
        elif boundary.axis == 0:
            u, _ = flat_update(u, boundary.side, restitution)
        else:
            w, _ = flat_update(w, boundary.side, restitution)
        if self._grips[1] and (done is None or done.temperature is None):
            mx, my = stage.normal(place, side, x, y)
            slide_x, slide_y = self._slide(done, place, side, mx, my)
            k = self._turn_at_wall(i, mx, my, before[0] - slide_x, before[1] - slide_y)
            u, w = u + k * my, w - k * mx
        if done is not None and done.shaking:
            u, w = u + shift_x, w + shift_y
        if done is not None and done.temperature is not None:
            u, w = self._heated(i, done.temperature, done.velocity, place, side, nx, ny)
        x, y = self._place_on(place, side, i, x, y)
        self._rests.free(i, t)
        state.keep_sides(i, t, (x, y), (u, w), ((place, side),))
        state.anchor(i, t, x, y, u, w)
        state.meet(i, (self._met(event, i),))
        self._instants.note(i, t, (u, w) == before, still, series and self._instants.ends(place))
        impulse = self._ledger.book_wall(i, u - before[0], w - before[1])
        self._counters.wall_contacts += 1
        self._count(i)
        self._ledger.log(t, Kind.WALL, i, -1, stage.surfaces[place].wall, impulse, -1)
        return [i]

    def _slide(self, done: Treatment | None, place: int, side: int, nx: Real, ny: Real) -> tuple[Real, Real]:
        """The velocity of a wall along itself."""
        if done is None or not done.velocity:
            return 0.0, 0.0
        return along(ny, -nx, (self._stage.turns[place] * side) * done.velocity)

    def _heated(
        self, i: int, temperature: float, velocity: float, place: int, side: int, nx: Real, ny: Real
    ) -> tuple[Real, Real]:
        """The velocity of disk i behind a wall that heats, and slides: drawn; so is its spin, if it has one."""
        state, stage, mass = self._state, self._stage, self._masses.of(i)
        out, sideways, other = flux((stage.seed or 0, i, state.contacts[i]))
        if state.spin is not None:
            state.spin[i] = heated_spin(other, temperature, mass, self._radius[i], self._moment[i])
        return heated(nx, ny, out, sideways, temperature, mass, (stage.turns[place] * side) * velocity)

    def _launched(self, i: int, place: int, side: int) -> Real:
        """The speed, in terms of the normal, at which disk i left the straight wall that it now falls back to; else 0."""
        state = self._state
        if state.supports is None or state.supports[place] is None or not has_struck(state.supports, state.met[i], place):
            return 0.0
        nx, ny = self._stage.normal(place, side, state.x[i], state.y[i])
        fall = nx * state.gravity_x[i] + ny * state.gravity_y[i]
        if not fall < 0.0:
            return 0.0
        return launch(nx * state.vx[i] + ny * state.vy[i], fall, state.since_met(i, -1 - place))

    def _turned_round(self, i: int, x: Real, y: Real, u: Real, w: Real, restitution: Real) -> tuple[Real, Real]:
        """The velocity of disk i, a point, after it has hit the post at (x, y)."""
        state = self._state
        if is_still_rising(state.x[i], state.y[i], state.gravity_x[i], state.gravity_y[i], x, y, u, w):
            return u, w
        if state.low_parts:
            low = state.low_vx[i], state.low_vy[i]
            state.low_vx[i], state.low_vy[i] = -(restitution * low[0]), -(restitution * low[1])
        return -(restitution * u), -(restitution * w)

    def _careful_wall(self, i: int, nx: Real, ny: Real, restitution: Real) -> tuple[Real, Real]:
        """The velocity of disk i after contact with a wall; its low part is set."""
        state = self._state
        low = state.low_vx[i], state.low_vy[i]
        u, w = state.vx[i], state.vy[i]
        u, w, state.low_vx[i], state.low_vy[i], _ = careful_wall_update(nx, ny, u, w, *low, restitution)
        return u, w

    def _time_of(self, component: list[Event]) -> Real:
        """When to resolve a cluster, whose exact times are equal: at the first float one, but in no disk's past.

        Where these are further apart than last bits, something closes so slowly that floats hardly tell when: then at that of
        the contact which closes fastest.
        """
        begun = max(self._state.t[i] for event in component for i in disks_of(event))
        times = [event.time for event in component]
        first = min(times)
        if max(times) - first > AT_ONCE * first:
            first = max(component, key=self._approach).time
        return max(begun, first)

    def _may_be_a_graze(self, event: Event) -> bool:
        """Whether a contact with something round is so tangential that rounding may have made it."""
        state, stage, a, b = self._state, self._stage, event.a, event.b
        if b < 0 and not stage.is_round_outside(-1 - b, event.image[0]):
            return False
        reach = self._radius[a] + (self._radius[b] if b >= 0 else 0.0)
        if not reach > 0.0:
            return False
        at = [(*state.place(i, event.time), *state.speed(i, event.time), event.time - state.t[i]) for i in disks_of(event)]
        size = sum(abs(x) + abs(y) + math.hypot(u, w) * lag for x, y, u, w, lag in at)
        (_, _, u, w, _), (ub, wb) = at[0], at[1][2:4] if b >= 0 else (0.0, 0.0)
        bend = ((u - ub) ** 2 + (w - wb) ** 2) / reach
        return bool(contact_doubt(round_size(size, reach, reach, 0.0), self._approach(event), bend, event.time) == NEVER)

    def _approach(self, event: Event) -> Real:
        """The speed at which the gap of a contact closes."""
        state, a, b, t = self._state, event.a, event.b, event.time
        at, (u, w) = state.place(a, t), state.speed(a, t)
        if b < 0:
            return approach_speed(*self._towards(event, *at, u, w), u, w)
        ub, wb = state.speed(b, t)
        return approach_speed(*self._apart(event, *at, *state.place(b, t)), u - ub, w - wb)

    def _joint(self, component: list[Event]) -> list[int]:
        """A cluster: the velocities after it from the law of simultaneous contacts; disks that get no impulse fly on."""
        state, stage = self._state, self._stage
        t = self._time_of(component)
        disks = sorted({i for event in component for i in (event.a, event.b) if i >= 0})
        number = {disk: k for k, disk in enumerate(disks)}
        at = [state.place(i, t) for i in disks]
        before = [state.speed(i, t) for i in disks]
        shift = self._shaken(component, at, before)
        if shift is not None:
            before = [(u - shift[0], w - shift[1]) for u, w in before]
        contacts = []
        for event in component:
            a, b = number[event.a], number[event.b] if event.b >= 0 else None
            if b is not None:
                dx, dy = self._apart(event, *at[a], *at[b])
                e = self._restitution(event, t, dx, dy, (before[a], before[b]))
                contacts.append(JointContact(a, b, dx, dy, e))
            else:
                nx, ny = self._towards(event, *at[a], *before[a])
                e = self._restitution(event, t, nx, ny, (before[a],))
                contacts.append(JointContact(a, None, nx, ny, e))
        if (stage.law.by_speed or shift is not None) and not are_apart(contacts):
            raise joint_under(stage.law.name() if shift is None else "the law of walls that heat or shake", disks)
        if any(self._grips[event.b < 0] for event in component):
            raise rough_joint(disks)
        outcome = self._together(contacts, before, [self._masses.of(i) for i in disks])
        active = [k for k, taken in enumerate(outcome.active) if taken]
        if active and state.number is float and all(map(self._may_be_a_graze, component)):
            raise grazed_at_once(disks)
        if not active and stage.gravity is not None:
            return self.resolve(component[:1])  # gravity closes these gaps: they are met, one by one
        changed = sorted({i for k in active for i in component[k][2:4] if i >= 0})
        still = all(self._instants.is_still(i, t) for i in changed)
        for i in changed:
            x, y = at[number[i]]
            for k in active:
                if component[k].a == i and component[k].b < 0:
                    x, y = self._place_on(-1 - component[k].b, component[k].image[0], i, x, y)
            self._rests.free(i, t)
            own = [component[k] for k in active if component[k].a == i and component[k].b < 0]
            if len(own) > 1:
                u, w = before[number[i]]
                reached = (abs(u) + abs(w)) * t
                x, y = stage.at_end([-1 - event.b for event in own], x, y, reached, self._radius[i])
            leaves = outcome.velocities[number[i]]
            if shift is not None:
                leaves = leaves[0] + shift[0], leaves[1] + shift[1]
            state.keep_sides(i, t, (x, y), leaves, tuple((-1 - event.b, event.image[0]) for event in own))
            state.anchor(i, t, x, y, *leaves)
            state.forget_low_parts(i)
            state.meet(i, tuple(self._met(component[k], i) for k in active if i in component[k][2:4]))
            self._instants.note(i, t, False, still)
        first = self._counters.events
        for k in active:
            self._note_joint(t, component[k], contacts[k], outcome.impulses[k], first)
        self._counters.clusters += 1
        return changed

    def _shaken(
        self, component: list[Event], at: list[tuple[Real, Real]], before: list[tuple[Real, Real]]
    ) -> tuple[Real, Real] | None:
        """The velocity of walls that shake, which one disk meets at one instant; None where none does.

        Raises UnlawfulError where one heats, or several disks are at it.
        """
        stage = self._stage
        done = [stage.law.treatment(stage.surfaces[-1 - event.b].wall) for event in component if event.b < 0]
        if not stage.law.drives or not any(one.shaking or one.temperature is not None for one in done):
            return None
        if any(one.temperature is not None for one in done) or len(at) > 1:
            disks = sorted({i for event in component for i in disks_of(event)})
            raise joint_under("the law of walls that heat or shake", disks)
        shifts = [
            along(*self._towards(event, *at[0], *before[0]), one.shaking) for event, one in zip(component, done, strict=True)
        ]
        return sum(shift[0] for shift in shifts), sum(shift[1] for shift in shifts)

    def _together(self, contacts: list[JointContact], before: list[tuple[Real, Real]], masses: list[float]) -> Outcome:
        """The law of simultaneous contacts in the engine's numbers."""
        return resolve_together(contacts, before, masses)

    def _note_joint(self, t: Real, event: Event, contact: JointContact, impulse: float, first: int) -> None:
        """Book and log one contact of a cluster that is resolved."""
        a, b = event.a, event.b
        distance = math.hypot(contact.dx, contact.dy)
        jx, jy = impulse * (contact.dx / distance), impulse * (contact.dy / distance)
        if b >= 0:
            self._ledger.note_overlap(a, b, distance, self._radius[a] + self._radius[b])
            self._ledger.book_pair(a, b, jx, jy)
            self._counters.pair_contacts += 1
            self._count(a, b)
            self._ledger.log(t, Kind.PAIR, a, b, -1, impulse, first)
        else:
            if not self._masses.is_immovable(a):  # such a disk has no momentum to speak of
                self._ledger.book(jx, jy)
            self._counters.wall_contacts += 1
            self._count(a)
            self._ledger.log(t, Kind.WALL, a, -1, self._stage.surfaces[-1 - b].wall, impulse, first)

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
        shift_x, shift_y = self._stage.shifts(event.image)
        dx, dy = xa - xb, ya - yb
        return dx - shift_x if shift_x else dx, dy - shift_y if shift_y else dy

    def _place_on(self, place: int, side: int, i: int, x: Real, y: Real) -> tuple[Real, Real]:
        """The place of disk i on the wall that it meets."""
        return self._stage.touching(place, side, x, y, self._radius[i])

    def _towards(self, event: Event, x: Real, y: Real, u: Real, w: Real) -> tuple[Real, Real]:
        """The normal of the wall that disk a meets; where a point hits a post, against its velocity."""
        if self._stage.is_exact_hit(-1 - event.b, self._radius[event.a]):
            return (-u, -w) if u or w else (0.0, 1.0)
        return self._stage.normal(-1 - event.b, event.image[0], x, y)

    def _restitution(self, event: Event, t: Real, dx: Real, dy: Real, speeds: tuple[tuple[Real, Real], ...]) -> Real:
        """The restitution of a contact along (dx, dy), whose disks have these velocities."""
        law, state, b = self._stage.law, self._state, event.a if event.b < 0 else event.b
        usual = self._stage.usual(event.a, event.b)
        if law.numbers() is None:
            return usual
        approach = mass = 0.0
        if law.by_speed:
            (u, w), (ub, wb) = speeds[0], speeds[-1] if event.b >= 0 else (0.0, 0.0)
            approach = approach_speed(dx, dy, u - ub, w - wb)
            mass = self._masses.of(event.a) if event.b < 0 else self._masses.reduced(event.a, event.b)
        since_a, since_b = t - state.contact_time[event.a], t - state.contact_time[b]
        if not isinstance(law, Own):
            return law.restitution(usual, since_a, since_b, approach, mass)
        return lawful(self._stage, law, event, since_a, since_b, approach, mass)
