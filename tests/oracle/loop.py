"""The oracle's run: the earliest contact of all, resolved, then the next; every row with how far floats may be from it.

`story(scene, ...)` follows a scene until its stop, or until floats can no longer tell what comes next.  Nothing here
is fast, clever or shared with the engines: all pairs, all walls, decimals.

The rules are those that the scene format promises:

* Contacts that share disks and come at exactly the same time are resolved together; what approaches after that is a
new contact, due now.
* Under gravity a disk that bounces on a straight wall with restitution e < 1 is at rest there after a time 2 v / (g
(1 - e)), v being its
  speed across the wall after a bounce.  So do disks that lie on a straight wall at the start.  Walls in line are one.
  It then slides without friction, until an impulse or the end of the wall.
* What would come to rest on a round wall, on another disk or on two walls has no answer: the run must stop with a
reason.
* A disk that touches a wall at the start, but for rounding, and moves along it glides on it and on what is in line
with it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from decimal import Decimal
from typing import Any

import numpy as np

from tests.oracle.digits import ONE, ROUNDS, UNIT, ZERO, TooFewDigitsError, exact, is_float, root, sign, working_with
from tests.oracle.doubt import SAFE, Doubt, NoDoubt, contact_map, last_bits, leave_map, rest_map
from tests.oracle.impact import MOST_TOGETHER, SqueezedError, Together, lightness, parted, shares
from tests.oracle.search import (
    LEAVE,
    LOOK,
    PRESSED,
    REST,
    Call,
    Flight,
    Found,
    Meeting,
    Search,
    pair_key,
    wall_key,
)
from tests.oracle.table import TOUCHING, Bow, Line, Oval, Ring, Table, Tip, Vector, across, along, names_of, table_of

PAIR, WALL, KICK = "pair", "wall", "kick"
"""Kinds of rows, beside `rest`."""

LOST = 1e-4
"""Errors of this part of the scene's size are no small deviations any more."""

IDLE = 64.0
"""An engine's clock begins anew after a spell without contacts that is so many times longer than what it has counted.
"""

FLOOR = 1.0
"""The oracle ends a series of bounces where the next flight is this part of the one that rounding keeps up."""

ENDED = 30.0
"""An engine may end a series where the next flight is so many times the one that rounding keeps up: the error of its
end is that here.
"""

Vector2 = tuple[float, float]

NONE = Decimal("1e-40")
"""What is below this part of a velocity, in the digits of the first round, is nothing where the reason is known."""

ROUND, ENDLESS = 20, Decimal("1e-250")
"""So many contacts within such a part of the time are taken for the end of infinitely many."""

STILL = Decimal(2) ** -46
"""A velocity across a touched wall, as a part of the speed, that is rounding."""


@dataclass(frozen=True, slots=True)
class Kick:
    """A velocity set from outside: at a time, or at the instant of a disk's contact number `after` (0: its first
    one).
    """

    disk: int
    velocity: tuple[float, float]
    time: float | None = None
    after: int | None = None


@dataclass(slots=True)
class Part:
    """A disk in a row: where it is, its velocity afterwards, and how far floats may be from both."""

    disk: int
    place: Vector
    velocity: Vector
    place_error: float
    velocity_error: float


@dataclass(slots=True)
class Row:
    """One impulse, as a log would have it.

    group: rows of one number are of one instant's cluster and come in any order.  walls: the names that a log may give.
    loose: of the rows of this group some may be missing (their impulses are not unique).  may_refuse: stopping here
    is as right. idle: it changes no velocity by more than rounding.  flight: what follows of a series of bounces: the
    time of the next one, and below which length rounding keeps flights up; 0 where it is no series.
    """

    group: int
    time: Decimal
    kind: str
    parts: tuple[Part, ...]
    walls: frozenset[str]
    time_error: float
    loose: bool = False
    may_refuse: bool = False
    idle: bool = False
    flight: float = 0.0
    floor: float = 0.0


@dataclass(slots=True)
class Story:
    """All rows that floats determine, and how it goes on.

    ending: `until`, `events`, `quiet` (nothing ahead), `collapse` (no answer from `time` on: the run must stop with a
    reason there), or `beyond` (floats do not determine what comes next).  why: a word on that.  free_time: between
    two contacts of a disk, the median. state(time): places and velocities at a time after the last row.
    """

    table: Table
    rows: list[Row]
    ending: str
    why: str
    time: Decimal
    free_time: float
    state: Callable[[Decimal], list[Part]]


def story(
    scene: Any,
    until: float | None = None,
    events: int | None = None,
    kicks: Sequence[Kick] = (),
    rounds: Sequence[int] = ROUNDS,
    judged: bool = True,
) -> Story:
    """Follow a scene with as many digits as its decisions need.

    until, events: instead of the scene's.  rounds: the digits to try.  judged: False follows it without asking what
    floats can tell.
    """
    for digits in rounds:
        try:
            with working_with(digits):
                return _Run(scene, until, events, kicks, judged).run()
        except TooFewDigitsError:
            if digits == rounds[-1]:
                raise
    raise AssertionError("no rounds")


class _BeyondError(Exception):
    """Floats do not determine what comes next."""


class _CollapseError(Exception):
    """There is no answer from here on."""


class _Run:
    def __init__(
        self, scene: Any, until: float | None, events: int | None, kicks: Sequence[Kick], judged: bool
    ) -> None:
        until = scene.until if until is None else until
        self.table = table = table_of(scene)
        self.until = None if until is None else exact(until) - table.start_time
        self.events = scene.events if events is None else events
        self.n = len(table.radius)
        self.search = Search(table)
        self.doubt = Doubt(self.n) if judged else NoDoubt(self.n)
        self.now = ZERO
        self.begun = ZERO  # when an engine's clock began
        self.last = ZERO  # the last row
        self.rows: list[Row] = []
        self.group = 0
        self.met = [ZERO - 10**30] * self.n  # the last contact of each disk, for the TC model
        self.contacts = [0] * self.n
        self.flights = [
            Flight(ZERO, *place, *speed, *pull) for (place, speed), pull in zip(table.start, table.pull, strict=True)
        ]
        self.ahead: dict[tuple[int, int], list[Found]] = {}
        self.rest_due: dict[int, Meeting] = {}
        self.series: dict[int, float] = {}  # of disks whose bounces are nearly over: how far their end may be off
        self.timed = sorted((k for k in kicks if k.time is not None), key=lambda k: k.time or 0.0)
        self.hooked = [k for k in kicks if k.after is not None]
        self.large = table.largest or 1.0

    # ---- the loop

    def run(self) -> Story:
        ending, why = "", ""
        try:
            self._touch_at_start()
            self._predict(range(self.n))
            ending = self._loop()
        except _BeyondError as beyond:
            ending, why = "beyond", str(beyond)
            self.now = self.last
        except _CollapseError as collapse:
            ending, why = "collapse", str(collapse)
        except SqueezedError:
            ending, why = "collapse", "squeezed"
        return Story(self.table, self.rows, ending, why, self.now, self._free_time(), self._state)

    def _state(self, time: Decimal) -> list[Part]:
        return [self._part(i, time) for i in range(self.n)]

    def _loop(self) -> str:
        while True:
            if self.events is not None and len(self.rows) >= self.events:
                return "events"
            first = self._first()
            kick = self.timed[0] if self.timed else None
            limits = [
                t
                for t in (self.until, None if kick is None or kick.time is None else exact(kick.time))
                if t is not None
            ]
            stop = min(limits) if limits else None
            if first is None and stop is None:
                return "quiet"
            if first is None or (stop is not None and first.time > stop):
                assert stop is not None
                self._demand_clear(stop, first)
                if kick is not None and kick.time is not None and exact(kick.time) == stop:
                    self.now = stop
                    self.timed.pop(0)
                    self._kick(kick)
                    continue
                self.now = stop
                return "quiet" if first is None and not self._wraps_ahead() else "until"
            self._demand_calls(first.time)
            self.now = first.time
            if first.how == LOOK:
                self._look(first)
                continue
            if stop is not None and first.time != stop:
                self._demand_before(first, stop)
            cluster = self._cluster(first)
            if cluster[0].how == LEAVE:
                self._leave(first)
            elif cluster[0].how == REST:
                self._rest(first)
            elif len(cluster) == 1 and cluster[0].how == PRESSED:
                self._press(first)
            else:
                self._contact(cluster)

    def _first(self) -> Meeting | None:
        first: Meeting | None = None
        for found in self.ahead.values():
            for one in found:
                if one.meeting is not None and (first is None or one.meeting.time < first.time):
                    first = one.meeting
        for meeting in self.rest_due.values():
            if first is None or meeting.time <= first.time:
                first = meeting
        return first

    def _meetings_of(self, disks: set[int]) -> list[Meeting]:
        found = [
            one.meeting
            for pair, several in self.ahead.items()
            if pair[0] in disks or pair[1] in disks
            for one in several
            if one.meeting is not None and one.meeting.how != LOOK
        ]
        return found + [m for i, m in self.rest_due.items() if i in disks]

    # ---- predictions

    def _predict(self, disks: Sequence[int] | range) -> None:
        """Look anew for what these disks meet."""
        fresh = set(disks)
        for key in [key for key in self.ahead if key[0] in fresh or key[1] in fresh]:
            del self.ahead[key]
        for i in fresh:
            for j in range(self.n):
                if j != i and not (j in fresh and j < i):
                    self._look_at(min(i, j), max(i, j))
            for k in range(len(self.table.shapes)):
                self._look_at(i, -1 - k)
            if self.flights[i].held is not None:
                slide = self.search.slide(i, self.flights[i], self.now)
                if slide is not None:
                    self.ahead[i, -1 - len(self.table.shapes)] = [slide]

    def _look_at(self, a: int, b: int) -> None:
        flight = self.flights[a]
        found = (
            self.search.pair(a, b, flight, self.flights[b], self.now)
            if b >= 0
            else self.search.wall(a, -1 - b, flight, self.now)
        )
        kept = []
        for one in found:
            calls = [call for call in one.calls if self._is_doubtful(call, a, b)]
            if one.meeting is not None or calls:
                kept.append(Found(one.meeting, calls))
        if kept:
            self.ahead[a, b] = kept
        else:
            self.ahead.pop((a, b), None)

    def _look(self, meeting: Meeting) -> None:
        self._look_at(meeting.a, meeting.b if meeting.b >= 0 else -1 - meeting.shape)

    def _is_doubtful(self, call: Call, a: int, b: int) -> bool:
        delay = float(call.time - self.flights[a].time)
        bound = self.doubt.error(a, delay)
        terms = [(a, delay, *call.pull)]
        if b >= 0:
            delay_b = float(call.time - self.flights[b].time)
            bound += self.doubt.error(b, delay_b)
            terms.append((b, delay_b, -call.pull[0], -call.pull[1]))
        size = max(1.0, math.hypot(*call.pull))
        if SAFE * bound * size <= call.margin:
            return False
        return SAFE * self.doubt.spread(terms) > call.margin

    # ---- what floats can tell

    def _demand_calls(self, time: Decimal) -> None:
        """Stop the judging where a close decision before `time` could have been another one."""
        for found in self.ahead.values():
            for one in found:
                for call in one.calls:
                    if call.time <= time and (one.meeting is None or call.time <= one.meeting.time):
                        raise _BeyondError("a graze, or the end of a wall")

    def _time_terms(self, m: Meeting) -> list[tuple[int, float, float, float]]:
        """The meeting's time as a linear function of the deviations: minus the gap's over its rate."""
        if m.how in (LOOK, REST):
            return []
        if m.how == LEAVE:
            one = self.table.shapes[m.shape]
            assert isinstance(one, Line)
            f = self.flights[m.a]
            _, _, u, w = f.at(m.time)
            ex, ey = float(one.along[0] / one.norm), float(one.along[1] / one.norm)
            rate = ex * float(u) + ey * float(w)
            return [(m.a, float(m.time - f.time), -ex / rate, -ey / rate)] if rate != 0.0 else []
        nx, ny, rate = self._closing(m)
        if rate == 0.0:
            return []
        f = self.flights[m.a]
        terms = [(m.a, float(m.time - f.time), -nx / rate, -ny / rate)]
        if m.b >= 0:
            terms.append((m.b, float(m.time - self.flights[m.b].time), nx / rate, ny / rate))
        return terms

    def _closing(self, m: Meeting) -> tuple[float, float, float]:
        """The normal at a meeting, in floats, and the rate at which the gap closes (negative)."""
        nx, ny = self._normal(m)
        _, _, u, w = self.flights[m.a].at(m.time)
        if m.b >= 0:
            _, _, ub, wb = self.flights[m.b].at(m.time)
            u, w = u - ub, w - wb
        return float(nx), float(ny), float(nx * u + ny * w)

    def _demand_before(self, first: Meeting, stop: Decimal) -> None:
        """Stop the judging where a meeting may be before or after a stop."""
        terms = self._time_terms(first)
        if terms and SAFE * self.doubt.spread(terms) > abs(float(stop - first.time)):
            raise _BeyondError("a contact at the very time of a stop")

    def _demand_clear(self, stop: Decimal, first: Meeting | None) -> None:
        self._demand_calls(stop)
        if first is not None and first.how != LOOK:
            self._demand_before(first, stop)

    def _demand_ends(self) -> None:
        """Where doubt is put aside: rounds of contacts that no number of digits can tell apart do not end."""
        if not isinstance(self.doubt, NoDoubt) or len(self.rows) <= ROUND:
            return
        if 0 < self.now - self.rows[-ROUND].time < ENDLESS * self.now:
            raise _CollapseError("rounds of contacts that do not end")

    def _demand_small(self, disks: Sequence[int]) -> None:
        """Stop the judging where errors are no small deviations any more."""
        for i in disks:
            speed = max(_size((self.flights[i].u, self.flights[i].w)), 1e-300)
            late = self.doubt.speed_error(i) / speed
            if not (SAFE * self.doubt.error(i, 0.0) <= LOST * self.large and SAFE * late < 1e100):
                raise _BeyondError("growth")

    def _cluster(self, first: Meeting) -> list[Meeting]:
        """The meetings at exactly that time that are connected with the first one through disks; stops where floats
        cannot tell which.
        """
        cluster, disks = [first], set(first.disks)
        if first.how in (LEAVE, REST):
            self._demand_order(first, disks, cluster)
            return cluster
        grown = True
        while grown:
            grown = False
            for other in self._meetings_of(disks):
                if other in cluster or other.how in (LEAVE, REST) or self._is_same(other, cluster):
                    continue
                if (
                    sign(other.time - first.time, abs(first.time) + abs(self.flights[other.a].time)) == 0
                    if self._may_tie(other, first)
                    else False
                ):
                    cluster.append(other)
                    disks |= set(other.disks)
                    grown = True
        self._demand_order(first, disks, cluster)
        return cluster

    def _may_tie(self, other: Meeting, first: Meeting) -> bool:
        gap = other.time - first.time
        return gap <= abs(first.time) * Decimal("1e-30") + Decimal("1e-300")

    def _is_same(self, other: Meeting, cluster: list[Meeting]) -> bool:
        """Whether a contact is with what continues a wall of the cluster, in the same direction: one contact with two
        names.
        """
        if other.b >= 0 or other.how in (LEAVE, REST):
            return False
        for one in cluster:
            if one.b < 0 and one.a == other.a and one.image == other.image and other.shape in self._kin(one.shape):
                (nx, ny), (mx, my) = self._normal(one), self._normal(other)
                if nx * mx + ny * my > 0 and abs(nx * my - ny * mx) < Decimal("1e-5"):
                    return True
        return False

    def _kin(self, shape: int) -> set[int]:
        return set(self.table.bonds[shape]) | set(self.table.supports.get(shape, ()))

    def _demand_order(self, first: Meeting, disks: set[int], cluster: list[Meeting]) -> None:
        """Stop the judging where another contact of these disks may come first, or a tie may be none."""
        mine = self._time_terms(first)
        for other in self._meetings_of(disks):
            if other is first or self._is_same(other, [first]):
                continue
            later = float(other.time - first.time)
            theirs = self._time_terms(other)
            both = mine + [(i, t, -hx, -hy) for i, t, hx, hy in theirs]
            bound = sum((abs(hx) + abs(hy)) * self.doubt.error(i, t) for i, t, hx, hy in both)
            if SAFE * bound <= later or bound == 0.0:
                continue
            spread = self.doubt.spread(_merged(both))
            if other in cluster:
                if spread > 4 * UNIT * bound and not self._at_right_angles(first, other):
                    raise _BeyondError("a tie of what has been rounded")
            elif SAFE * spread > later and spread > 0.0:
                raise _BeyondError("order")

    def _at_right_angles(self, one: Meeting, other: Meeting) -> bool:
        """Whether two walls are along the axes, and at right angles: their contacts do not feel each other."""
        if one.b >= 0 or other.b >= 0:
            return False
        (nx, ny), (mx, my) = self._normal(one), self._normal(other)
        return nx * mx + ny * my == 0

    # ---- contacts

    def _normal(self, m: Meeting) -> Vector:
        """The unit normal of a meeting, pointing to disk a."""
        x, y, _, _ = self.flights[m.a].at(m.time)
        px, py = self.search._shift(m.image)
        if m.b >= 0:
            xb, yb, _, _ = self.flights[m.b].at(m.time)
            dx, dy = x - xb - px, y - yb - py
        else:
            shape = self.table.shapes[m.shape]
            if isinstance(shape, Line):
                return m.side * shape.normal[0] / shape.norm, m.side * shape.normal[1] / shape.norm
            centre = shape.place if isinstance(shape, Tip) else shape.centre
            dx, dy = m.side * (x - px - centre[0]), m.side * (y - py - centre[1])
            if isinstance(shape, Oval):
                dx, dy = shape.gradient(shape.scaled((dx, dy)))
        length = root(dx * dx + dy * dy)
        return dx / length, dy / length

    def _bend(self, m: Meeting) -> float:
        if m.b >= 0:
            return 1.0 / float(self.table.radius[m.a] + self.table.radius[m.b])
        shape, r = self.table.shapes[m.shape], float(self.table.radius[m.a])
        if isinstance(shape, Line):
            return 0.0
        if isinstance(shape, Tip):
            return 1.0 / r
        if isinstance(shape, Oval):
            x, y, _, _ = self.flights[m.a].at(m.time)
            px, py = self.search._shift(m.image)
            steep = math.hypot(
                *_floats(shape.gradient(shape.scaled((x - px - shape.centre[0], y - py - shape.centre[1]))))
            )
            return m.side / (float(shape.semi_axes[0] * shape.semi_axes[1]) ** 2 * steep**3)
        return m.side / (float(shape.radius) + m.side * r)

    def _restitution(self, m: Meeting) -> Decimal:
        e = self.table.pair_restitution if m.b >= 0 else self.table.wall_restitution
        duration = self.table.contact_duration
        if duration is None or e == 1:
            return e
        for i in m.disks:
            since = m.time - self.met[i]
            margin = float(abs(since - duration))
            if SAFE * (self._late(m) + UNIT * float(m.time - self.begun)) > margin:
                raise _BeyondError("the contact duration")
            if since < duration:
                e = ONE
        return e

    def _late(self, m: Meeting) -> float:
        return self.doubt.spread(_merged(self._time_terms(m)))

    def _fly_to_now(self, i: int, clock: float, sides: tuple[int, ...] = ()) -> tuple[Vector, Vector]:
        """Move disk i to the present in flight and doubt; its place and velocity, without a new flight yet.

        clock: what an engine's clock shows.  sides: axes along which the place is exact, since a side of the domain
        is met.
        """
        f = self.flights[i]
        x, y, u, w = f.at(self.now)
        delay = float(self.now - f.time)
        self.doubt.fly(i, delay)
        corner = self.table.corner
        on_clock = is_float(self.now)
        sigma = []
        for axis, (place, start, v, c) in enumerate(((x, f.x, u, corner[0]), (y, f.y, w, corner[1]))):
            kept = axis in sides or (is_float(place - c) and (place == start or on_clock))
            way = abs(float(place - start)) + abs(float(v)) * (abs(delay) + clock)
            sigma.append(0.0 if kept else UNIT * (self._scale(place, c) + way))
        for v, start in ((u, f.u), (w, f.w)):
            sigma.append(0.0 if v == start or is_float(v) else last_bits(v, v - start))
        self.doubt.round(i, sigma)
        return (x, y), (u, w)

    def _scale(self, place: Decimal, corner: Decimal) -> float:
        size = abs(float(place - corner))
        if self.table.period != (None, None):
            size = min(size, self.large)
        return size

    def _begin(
        self,
        i: int,
        place: Vector,
        velocity: Vector,
        touch: dict[tuple[int, ...], bool],
        pull: Vector | None = None,
        held: tuple[int, int] | None = None,
    ) -> None:
        """A new flight of disk i."""
        old = self.flights[i]
        if old.time == self.now and old.count:
            touch = {**dict.fromkeys(old.touch, False), **touch}
        pull = self.table.pull[i] if pull is None else pull
        self.flights[i] = Flight(self.now, *place, *velocity, *pull, touch=touch, held=held, count=old.count + 1)

    def _round_velocity(self, i: int, before: Vector, after: Vector, clock: float) -> None:
        """What an engine's rounding adds at a contact: of the new velocity, and of the time through the change of
        velocity.
        """
        change = math.hypot(float(after[0] - before[0]), float(after[1] - before[1]))
        sigma = [0.0, 0.0]
        late = 0.0 if is_float(self.now) else UNIT * clock
        sigma = [late * abs(float(a - b)) for a, b in zip(after, before, strict=True)]
        for a, b in zip(after, before, strict=True):
            sigma.append(0.0 if a == b or is_float(a) else UNIT * (change + abs(float(a))))
        self.doubt.round(i, sigma)

    def _tick(self) -> float:
        """How far an engine's clock has come at this row, since it began anew."""
        if float(self.now - self.last) > IDLE * float(self.last - self.begun):
            self.begun = self.now
        return float(self.now - self.begun)

    def _contact(self, cluster: list[Meeting]) -> None:
        cluster = self._without_doubles(cluster)
        es = [self._restitution(m) for m in cluster]
        normals = [self._normal(m) for m in cluster]
        clock = self._tick()
        delay = max(float(self.now - self.flights[i].time) for i in cluster[0].disks)
        late = self._late(cluster[0]) + UNIT * (clock + delay)
        disks = sorted({i for m in cluster for i in m.disks})
        pulls = {i: (self.flights[i].ax, self.flights[i].ay) for i in disks}
        states = {i: self._fly_to_now(i, clock, self._sides_met(i, cluster)) for i in disks}
        before = {i: states[i][1] for i in disks}
        may_refuse = False
        if len(cluster) == 1:
            m, e = cluster[0], es[0]
            if m.at_end and self._is_convex(m.a, [m], before[m.a]):
                after, impulses, unique, may_refuse = {m.a: _turned(before[m.a], e)}, [ONE], True, True
            else:
                after, impulses, unique = self._single(m, normals[0], before, e)
            self._map_contact(m, normals[0], before, after, pulls, e)
        elif (
            all(m.at_end for m in cluster) and len(disks) == 1 and self._is_convex(disks[0], cluster, before[disks[0]])
        ):
            i = disks[0]
            after, impulses, unique, may_refuse = {i: _turned(before[i], es[0])}, [ONE] * len(cluster), False, True
        else:
            if any(self.table.mass[i] == 0 for i in disks):
                raise _BeyondError("a cluster with tracers")
            together = [Together(m.a, m.b, n, e) for m, n, e in zip(cluster, normals, es, strict=True)]
            if len(together) > MOST_TOGETHER:
                raise _BeyondError("a large cluster")
            after, impulses, unique = parted(together, before, self.table.mass)
            self._map_cluster(cluster, normals, es, before, after, impulses, pulls)
        self.group += 1
        touches: dict[int, dict[tuple[int, ...], bool]] = {i: {} for i in disks}
        for m, e in zip(cluster, es, strict=True):
            still = e == 0 and len(cluster) == 1
            if m.b >= 0:
                touches[m.a][pair_key(m.a, m.b, m.image)] = still
                touches[m.b][pair_key(m.b, m.a, (-m.image[0], -m.image[1]))] = still
            else:
                touches[m.a][wall_key(m.shape, m.image, m.side)] = still
        for i in disks:
            self._round_velocity(i, before[i], after[i], clock)
            held = self.flights[i].held
            if held is not None:
                touches[i].setdefault(wall_key(held[0], (0, 0), held[1]), self._is_along(held[0], after[i]))
            self._begin(i, states[i][0], after[i], touches[i])
            self.rest_due.pop(i, None)
        for m, q in zip(cluster, impulses, strict=True):
            if q == 0 and len(cluster) > 1:
                continue
            walls = self._names(m, cluster) if m.b < 0 else frozenset()
            kind = WALL if m.b < 0 else PAIR
            idle = all(_change(before[i], after[i]) <= 1e-13 * (1e-300 + _size(before[i])) for i in m.disks)
            self._row(kind, m.disks, walls, late, loose=not unique, may_refuse=may_refuse, idle=idle)
        for i in disks:
            self.met[i] = self.now
        self.last = self.now
        self._demand_small(disks)
        self._demand_ends()
        settled = [m.a for m in cluster if m.b < 0 and len(cluster) == 1 and self._settle(m, es[0])]
        self._predict([i for i in disks if i not in settled])
        for i in settled:
            self._predict([i])
        for i in disks:
            self.contacts[i] += 1
            for kick in [k for k in self.hooked if k.disk == i and k.after == self.contacts[i] - 1]:
                self.hooked.remove(kick)
                self._kick(kick)

    def _sides_met(self, i: int, cluster: list[Meeting]) -> tuple[int, ...]:
        """The axes along which a disk meets sides of the domain: there its place is exact."""
        sides = [self.table.shapes[m.shape] for m in cluster if m.b < 0 and m.a == i]
        return tuple(
            0 if side.normal[1] == 0 else 1 for side in sides if isinstance(side, Line) and side.length2 is None
        )

    def _map_contact(
        self,
        m: Meeting,
        normal: Vector,
        before: dict[int, Vector],
        after: dict[int, Vector],
        pulls: dict[int, Vector],
        e: Decimal,
    ) -> None:
        """Let the deviations of a contact's disks go through it."""
        if isinstance(self.doubt, NoDoubt) or self._closing_rate(m, normal, before) == 0:
            return
        velocities = [(_floats(before[i]), _floats(after[i])) for i in m.disks]
        accelerations = [(_floats(pulls[i]), _floats(self.table.pull[i])) for i in m.disks]
        parts = [1.0] if m.b < 0 else [float(s) for s in shares(self.table.mass[m.a], self.table.mass[m.b])]
        with np.errstate(all="ignore"):  # what has grown so far ends the judging
            matrix = contact_map(_floats(normal), self._bend(m), velocities, accelerations, parts, float(e))
        self.doubt.map(m.disks, matrix)

    def _is_along(self, k: int, velocity: Vector) -> bool:
        """Whether a disk that rested on a line still moves along it, as after a contact with another one that rests there."""
        one = self.table.shapes[k]
        assert isinstance(one, Line)
        rate = abs(one.normal[0] * velocity[0] + one.normal[1] * velocity[1])
        return rate <= NONE * one.norm * (abs(velocity[0]) + abs(velocity[1]))

    def _closing_rate(self, m: Meeting, normal: Vector, velocity: dict[int, Vector]) -> Decimal:
        u, w = velocity[m.a]
        if m.b >= 0:
            u, w = u - velocity[m.b][0], w - velocity[m.b][1]
        return normal[0] * u + normal[1] * w

    def _single(
        self, m: Meeting, normal: Vector, before: dict[int, Vector], e: Decimal
    ) -> tuple[dict[int, Vector], list[Decimal], bool]:
        rate = self._closing_rate(m, normal, before)
        nx, ny = normal
        q = (1 + e) * rate
        if m.b < 0:
            u, w = before[m.a]
            shape = self.table.shapes[m.shape]
            if isinstance(shape, Line):  # without the root in the normal's length
                mx, my = shape.normal
                q = (1 + e) * (mx * u + my * w) / (mx * mx + my * my)
                return {m.a: (u - q * mx, w - q * my)}, [ONE], True
            return {m.a: (u - q * nx, w - q * ny)}, [ONE], True
        share_a, share_b = shares(self.table.mass[m.a], self.table.mass[m.b])
        (ua, wa), (ub, wb) = before[m.a], before[m.b]
        return (
            {
                m.a: (ua - q * share_a * nx, wa - q * share_a * ny),
                m.b: (ub + q * share_b * nx, wb + q * share_b * ny),
            },
            [ONE],
            True,
        )

    def _without_doubles(self, cluster: list[Meeting]) -> list[Meeting]:
        """One contact of each disk with walls that continue each other in line."""
        kept: list[Meeting] = []
        for m in cluster:
            if not self._is_same(m, kept):
                kept.append(m)
        return kept

    def _names(self, m: Meeting, cluster: list[Meeting]) -> frozenset[str]:
        """The names that a log may give: of the wall, and of what continues it there."""
        shape = self.table.shapes[m.shape]
        names = set(names_of(shape))
        x, y, _, _ = self.flights[m.a].at(self.now)
        for k in self._kin(m.shape):
            other = self.table.shapes[k]
            if isinstance(shape, Line | Bow) and isinstance(other, Tip):
                foot = self._foot_distance(shape, other, (x, y))
                if foot <= 1e-6 * self.large:
                    names |= other.names
        return frozenset(names)

    def _foot_distance(self, shape: Line | Bow, tip: Tip, place: Vector) -> float:
        px, py = place[0] - tip.place[0], place[1] - tip.place[1]
        if isinstance(shape, Line):
            return abs(float((shape.along[0] * px + shape.along[1] * py) / shape.norm))
        dx, dy = place[0] - shape.centre[0], place[1] - shape.centre[1]
        scale = shape.radius / root(dx * dx + dy * dy)
        return math.hypot(
            float(shape.centre[0] + dx * scale - tip.place[0]), float(shape.centre[1] + dy * scale - tip.place[1])
        )

    def _is_convex(self, i: int, cluster: list[Meeting], velocity: Vector) -> bool:
        """Whether a point that meets the very end of walls is outside a corner that they make: it is turned round
        there.

        Seen from the end the point comes from -v.  The walls that bound the sector which it comes from make a concave
        corner where that sector is narrower than half a turn.
        """
        x, y, _, _ = self.flights[i].at(self.now)
        tips = [
            shape
            for k in self.table.bonds[cluster[0].shape]
            if isinstance(shape := self.table.shapes[k], Tip)
            and math.hypot(float(shape.place[0] - x), float(shape.place[1] - y)) <= 1e-20 * self.large
        ]
        if not tips:
            return True
        u, w = velocity
        back = math.atan2(-float(w), -float(u))
        turns = sorted((math.atan2(float(ty), float(tx)) - back) % math.tau for tx, ty in tips[0].arms)
        return turns[0] + math.tau - turns[-1] > math.pi + 1e-12

    def _map_cluster(
        self,
        cluster: list[Meeting],
        normals: list[Vector],
        es: list[Decimal],
        before: dict[int, Vector],
        after: dict[int, Vector],
        impulses: list[Decimal],
        pulls: dict[int, Vector],
    ) -> None:
        """The map of deviations that keep the tie: impulses with the same active contacts, normals that turn with the
        places.
        """
        disks = sorted(before)
        index = {i: 4 * k for k, i in enumerate(disks)}
        size = 4 * len(disks)
        active = [k for k, q in enumerate(impulses) if q != 0]
        if not active:
            return
        light = {i: float(lightness(self.table.mass[i])) for i in disks}
        v = np.array([[float(c) for c in before[i]] for i in disks]).ravel()
        rate = float(self._closing_rate(cluster[0], normals[0], before))
        late = np.zeros(size)
        n0 = np.array([float(c) for c in normals[0]])
        for i, s in zip(cluster[0].disks, (1.0, -1.0), strict=False):
            late[index[i] : index[i] + 2] = -s * n0 / rate
        base = np.array([[float(c) for c in normals[k]] for k in active])

        def change(ns: Any, velocity: Any) -> Any:
            rows = np.zeros((len(active), 2 * len(disks)))
            for r, k in enumerate(active):
                for i, s in zip(cluster[k].disks, (1.0, -1.0), strict=False):
                    rows[r, index[i] // 2 : index[i] // 2 + 2] = s * ns[r]
            inverse = np.array([light[i] for i in disks for _ in range(2)])
            wanted = -np.array([1.0 + float(es[k]) for k in active]) * (rows @ velocity)
            q = np.linalg.lstsq((rows * inverse) @ rows.T, wanted, rcond=None)[0]
            return inverse * (rows.T @ q)

        matrix = np.eye(size)
        step = 1e-6
        scale = np.abs(v).max() or 1.0
        for column in range(size):
            unit = np.zeros(size)
            unit[column] = 1.0
            dt = float(late @ unit)
            dv = np.array([unit[index[i] + 2 + axis] for i in disks for axis in range(2)])
            dn = np.zeros_like(base)
            for r, k in enumerate(active):
                shift = np.zeros(2)
                for i, s in zip(cluster[k].disks, (1.0, -1.0), strict=False):
                    shift += s * (unit[index[i] : index[i] + 2] + dt * np.array([float(c) for c in before[i]]))
                dn[r] = self._bend(cluster[k]) * (shift - base[r] * (base[r] @ shift))
            h = step / max(1.0, np.abs(dn).max(initial=0.0), np.abs(dv).max() / scale)
            new = dv + (change(base + h * dn, v + h * dv) - change(base - h * dn, v - h * dv)) / (2 * h)
            for k, i in enumerate(disks):
                gap = np.array([float(b - a) for b, a in zip(before[i], after[i], strict=True)])
                matrix[index[i] : index[i] + 2, column] = unit[index[i] : index[i] + 2] + gap * dt
                matrix[index[i] + 2 : index[i] + 4, column] = new[2 * k : 2 * k + 2]
        self.doubt.map(disks, matrix)

    # ---- rest

    def _touch_at_start(self) -> None:
        """What overlaps at the start, within rounding, touches; what touches and moves along glides or rests."""
        table = self.table
        for a in range(self.n):
            for b in range(a + 1, self.n):
                self._touch_pair(a, b)
        for i in range(self.n):
            for k, shape in enumerate(table.shapes):
                if isinstance(shape, Line):
                    self._touch_line(i, k, shape)
                elif not isinstance(shape, Oval) and not (isinstance(shape, Tip) and table.radius[i] == 0):
                    self._touch_round(i, k, shape)

    def _touch_pair(self, a: int, b: int) -> None:
        fa, fb, reach = self.flights[a], self.flights[b], self.table.radius[a] + self.table.radius[b]
        for image in self._images_around():
            px, py = self.search._shift(image)
            dx, dy = fa.x - fb.x - px, fa.y - fb.y - py
            c = dx * dx + dy * dy - reach * reach
            if reach > 0 and c <= 0 and sign(c, dx * dx + dy * dy + reach * reach) <= 0:
                fa.touch[pair_key(a, b, image)] = False
                fb.touch[pair_key(b, a, (-image[0], -image[1]))] = False

    def _images_around(self) -> list[tuple[int, int]]:
        px, py = self.table.period
        return [(i, j) for i in ((0,) if px is None else (-1, 0, 1)) for j in ((0,) if py is None else (-1, 0, 1))]

    def _touch_line(self, i: int, k: int, one: Line) -> None:
        table, f = self.table, self.flights[i]
        for image in self._images_around():
            px, py = self.search._shift(image)
            place = f.x - px, f.y - py
            s = across(one, place)
            side = 1 if s > 0 or len(one.sides) == 1 else -1
            gap = side * s - table.radius[i] * one.norm
            slack = (
                TOUCHING
                * one.norm
                * max(abs(f.x), abs(f.y), *(abs(c) for c in (*one.start, *one.end)), table.radius[i])
            )
            foot = along(one, place)
            if abs(gap) > slack or (one.length2 is not None and not -slack <= foot <= one.length2 + slack):
                continue
            if table.radius[i] == 0 and s == 0:
                rate0 = one.normal[0] * f.u + one.normal[1] * f.w
                pull0 = one.normal[0] * f.ax + one.normal[1] * f.ay
                side = one.sides[0] if len(one.sides) == 1 else 1 if (rate0 or pull0) > 0 else -1
            rate = side * (one.normal[0] * f.u + one.normal[1] * f.w)
            fall = side * (one.normal[0] * f.ax + one.normal[1] * f.ay)
            speed = root(f.u * f.u + f.w * f.w)
            is_along = abs(rate) <= STILL * one.norm * speed
            if fall < 0 and is_along and image == (0, 0):
                if k not in f.skip:
                    self._lie(i, k, side, self.now)
            elif is_along and fall == 0 and speed > 0:
                self._glide(i, k)
            elif gap <= 0:
                f.touch[wall_key(k, image, side)] = False

    def _touch_round(self, i: int, k: int, shape: Ring | Bow | Tip) -> None:
        f, r = self.flights[i], self.table.radius[i]
        centre = shape.place if isinstance(shape, Tip) else shape.centre
        for image in self._images_around():
            px, py = self.search._shift(image)
            d2 = (f.x - px - centre[0]) ** 2 + (f.y - py - centre[1]) ** 2
            if isinstance(shape, Tip):
                cases = [(1, r)]
            elif isinstance(shape, Ring):
                cases = [(-1, shape.radius - r)]
            else:
                cases = [(1 if d2 > shape.radius**2 else -1, shape.radius + (r if d2 > shape.radius**2 else -r))]
            for side, reach in cases:
                slack = TOUCHING * max(abs(f.x), abs(f.y), reach, *(abs(c) for c in centre))
                gap = side * (d2 - reach * reach)
                if gap <= 0 and -gap <= 2 * slack * (reach + slack) and sign(gap, d2 + reach * reach) <= 0:
                    f.touch[wall_key(k, image, side)] = False

    def _group(self, k: int) -> frozenset[int]:
        """A line, those in line with it, and the ends between and behind them."""
        lines = set(self.table.supports[k])
        return frozenset(
            lines | {j for line in lines for j in self.table.bonds[line] if isinstance(self.table.shapes[j], Tip)}
        )

    def _glide(self, i: int, k: int) -> None:
        f = self.flights[i]
        f.skip = f.skip | self._group(k)

    def _lie(self, i: int, k: int, side: int, due: Decimal) -> None:
        """Let a disk slide on a line from here on; the row comes at `due`."""
        one = self.table.shapes[k]
        assert isinstance(one, Line)
        f = self.flights[i]
        x, y, u, w = f.at(self.now)
        (ex, ey), (nx, ny), norm2 = one.along, one.normal, one.norm * one.norm
        gap = (side * across(one, (x, y)) - self.table.radius[i] * one.norm) / norm2
        x, y = x - gap * side * nx, y - gap * side * ny
        share = (u * ex + w * ey) / norm2
        pull = (f.ax * ex + f.ay * ey) / norm2
        if self.now > f.time:
            raise AssertionError("only a flight that begins can end on a line")
        self.doubt.map([i], rest_map((float(ex / one.norm), float(ey / one.norm))))
        self.flights[i] = Flight(
            self.now,
            x,
            y,
            share * ex,
            share * ey,
            pull * ex,
            pull * ey,
            skip=self._group(k),
            held=(k, side),
            count=f.count + 1,
        )
        self.rest_due[i] = Meeting(due, i, -1, k, side=side, how=REST)

    def _settle(self, m: Meeting, e: Decimal) -> bool:
        """Whether a bounce was the last that floats can tell; then the disk comes to rest at the end of the series."""
        one, i = self.table.shapes[m.shape], m.a
        f = self.flights[i]
        if e >= 1 or self.table.contact_duration is not None or m.image != (0, 0):
            return False
        nx, ny = self._normal(m)
        rate, slip = nx * f.u + ny * f.w, nx * f.w - ny * f.u
        fall = nx * f.ax + ny * f.ay
        if not isinstance(one, Line):  # what slips along a round wall leaves it, or is pressed onto it from inside
            fall += slip * slip * exact(self._bend(m))
        if fall >= 0 or rate < 0:
            return False
        flight = 2 * rate / -fall
        loss = float(1 - e)
        place = max(
            abs(float(f.x - self.table.corner[0])), abs(float(f.y - self.table.corner[1])), float(self.table.radius[i])
        )
        floor = math.sqrt(2.0 * 2.0**-52 * place / (float(-fall) * loss))
        self.rows[-1].flight, self.rows[-1].floor = float(flight), floor
        if float(flight) > ENDED * floor:
            self.series.pop(i, None)
        elif i not in self.series:
            self.series[i] = self._end_error(i, (float(nx), float(ny)), float(rate), float(-fall), float(e))
        if float(flight) > FLOOR * floor:
            return False
        if not isinstance(one, Line):
            self.now += flight / (1 - e)
            raise _CollapseError("bounces on something round that end in rest")
        self._lie(i, m.shape, m.side, self.now + (flight / (1 - e)))
        return True

    def _end_error(self, i: int, normal: Vector2, rate: float, fall: float, e: float) -> float:
        """How far the end of a series of bounces may be off: of the gap g and the rate r, (1 + e)/(1 - e) dg / r +
        2/(1 - e) dr / fall.
        """
        row = 4 * i
        gap, closing = (1 + e) / ((1 - e) * rate), 2 / ((1 - e) * fall)
        h = np.array([gap * normal[0], gap * normal[1], closing * normal[0], closing * normal[1]])
        return math.sqrt(max(0.0, h @ self.doubt.p[row : row + 4, row : row + 4] @ h))

    def _press(self, m: Meeting) -> None:
        """What touches and is pressed on without a velocity: at rest on a line, else there is no answer."""
        if m.b >= 0 or not isinstance(self.table.shapes[m.shape], Line) or m.image != (0, 0):
            raise _CollapseError("pressed onto something round")
        i = m.a
        held = self.flights[i].held
        if held is not None and held[0] != m.shape:
            self._demand_single(i, m)
        place, velocity = self._fly_to_now(i, self._tick())
        self._begin(i, place, velocity, {})
        self._lie(i, m.shape, m.side, self.now)
        self._predict([i])

    def _demand_single(self, i: int, m: Meeting) -> None:
        """Stop where a disk would rest on two walls."""
        held = self.flights[i].held
        assert held is not None
        old, new = self.table.shapes[held[0]], self.table.shapes[m.shape]
        assert isinstance(old, Line)
        assert isinstance(new, Line)
        gx, gy = self.table.pull[i]
        share = gx * new.along[0] + gy * new.along[1]
        if held[1] * share * (old.normal[0] * new.along[0] + old.normal[1] * new.along[1]) < 0:
            raise _CollapseError("rest on two walls")

    def _rest(self, m: Meeting) -> None:
        """The row of a disk that has come to rest."""
        i = m.a
        clock = self._tick()
        place, velocity = self._fly_to_now(i, clock)
        f = self.flights[i]
        self._begin(i, place, velocity, {}, (f.ax, f.ay), f.held)
        self.flights[i].skip = f.skip
        del self.rest_due[i]
        self.group += 1
        self._row(REST, (i,), self._line_names(m.shape), UNIT * clock + self.series.pop(i, 0.0))
        self.last = self.now
        self._predict([i])

    def _line_names(self, k: int) -> frozenset[str]:
        return frozenset(name for j in self.table.supports[k] for name in names_of(self.table.shapes[j]))

    def _leave(self, m: Meeting) -> None:
        """A disk slides over the end of what it rests on."""
        i = m.a
        one = self.table.shapes[m.shape]
        assert isinstance(one, Line)
        f = self.flights[i]
        clock = self._tick()
        late = self._late(m) + UNIT * clock
        place, velocity = self._fly_to_now(i, clock)
        ex, ey = float(one.along[0] / one.norm), float(one.along[1] / one.norm)
        speed = ex * float(velocity[0]) + ey * float(velocity[1])
        pull = self.table.pull[i]
        if speed == 0.0:
            raise _BeyondError("a slide that ends at the very end of a wall")
        self.doubt.map([i], leave_map((ex, ey), speed, (float(f.ax - pull[0]), float(f.ay - pull[1]))))
        ends = {
            j: True
            for j in self._group(m.shape)
            if isinstance(tip := self.table.shapes[j], Tip)
            and math.hypot(float(tip.place[0] - place[0]), float(tip.place[1] - place[1]))
            <= float(self.table.radius[i]) * (1 + 1e-9)
        }
        touch: dict[tuple[int, ...], bool] = (
            {wall_key(j, (0, 0), 1): True for j in ends} if self.table.radius[i] > 0 else {}
        )
        self._begin(i, place, velocity, touch)
        self.flights[i].skip = frozenset(self.table.supports[m.shape])
        self.group += 1
        self._row(WALL, (i,), self._line_names(m.shape), late)
        self.last = self.now
        self._predict([i])

    # ---- kicks

    def _kick(self, kick: Kick) -> None:
        i = kick.disk
        before = self.flights[i]
        clock = self._tick()
        place, velocity = self._fly_to_now(i, clock)
        if self.doubt.p.any():
            late = 0.0 if kick.time is not None else UNIT * clock
            self.doubt.round(i, [late * abs(float(v)) for v in velocity] + [0.0, 0.0])
            k = 4 * i
            self.doubt.p[k + 2 : k + 4] = 0.0
            self.doubt.p[:, k + 2 : k + 4] = 0.0
        touch = dict.fromkeys(before.touch, False) if before.time == self.now else {}
        if before.held is not None:
            touch[wall_key(before.held[0], (0, 0), before.held[1])] = False
        self.rest_due.pop(i, None)
        self._begin(i, place, (exact(kick.velocity[0]), exact(kick.velocity[1])), touch)
        self.group += 1
        self._row(KICK, (i,), frozenset(), UNIT * clock)
        self.last = self.now
        self._predict([i])

    # ---- rows

    def _part(self, i: int, time: Decimal) -> Part:
        f = self.flights[i]
        x, y, u, w = f.at(time)
        delay = float(time - f.time)
        error = self.doubt.error(i, delay) + UNIT * (
            float(abs(x)) + float(abs(y)) + math.hypot(float(u), float(w)) * delay
        )
        return Part(i, (x, y), (u, w), error, self.doubt.speed_error(i) + UNIT * math.hypot(float(u), float(w)))

    def _row(self, kind: str, disks: Sequence[int], walls: frozenset[str], time_error: float, **more: Any) -> None:
        parts = tuple(self._part(i, self.now) for i in disks)
        self.rows.append(Row(self.group, self.now, kind, parts, walls, time_error, **more))

    def _free_time(self) -> float:
        """The median time between two rows of a disk."""
        last = [ZERO] * self.n
        flights = []
        for row in self.rows:
            for part in row.parts:
                flights.append(row.time - last[part.disk])
                last[part.disk] = row.time
        return float(sorted(flights)[len(flights) // 2]) if flights else 0.0

    def _wraps_ahead(self) -> bool:
        """Whether a disk moves through periods for ever."""
        return any(
            period is not None and any((f.u, f.w)[axis] != 0 or (f.ax, f.ay)[axis] != 0 for f in self.flights)
            for axis, period in enumerate(self.table.period)
        )


def _merged(terms: list[tuple[int, float, float, float]]) -> list[tuple[int, float, float, float]]:
    """Terms of one disk added up, so that what cancels cancels."""
    total: dict[tuple[int, float], list[float]] = {}
    for i, t, hx, hy in terms:
        one = total.setdefault((i, t), [0.0, 0.0])
        one[0] += hx
        one[1] += hy
    rows: list[tuple[int, float, float, float]] = [(i, t, h[0], h[1]) for (i, t), h in total.items()]
    return rows


def _turned(velocity: Vector, e: Decimal) -> Vector:
    return -e * velocity[0], -e * velocity[1]


def _change(before: Vector, after: Vector) -> float:
    return math.hypot(float(after[0] - before[0]), float(after[1] - before[1]))


def _size(velocity: Vector) -> float:
    return math.hypot(float(velocity[0]), float(velocity[1]))


def _floats(pair: Vector) -> tuple[float, float]:
    return float(pair[0]), float(pair[1])
