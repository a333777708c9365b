"""The state of a run: what changes while time passes, and how a flight ends and begins."""

from __future__ import annotations

import math
from collections.abc import Sequence
from decimal import ROUND_FLOOR, Decimal
from typing import Any

from tests.oracle.digits import UNIT, ZERO, exact, is_float, root
from tests.oracle.doubt import Doubt, NoDoubt, last_bits
from tests.oracle.search import Flight, Found, Meeting, Search, wall_key
from tests.oracle.story import Kick, Part, Row
from tests.oracle.table import Bow, Line, Oval, Ring, Tip, Vector, across, ends_of, names_of, table_of

NOTHING = 1e-40
"""A smaller part of a change of velocity is 0, but for the digits of a round."""

IDLE = 64.0
"""An engine's clock begins anew after a spell without contacts that is so many times longer than what it has counted.
"""


class State:
    """A scene in mid-run: flights, what is known to be ahead, doubt, rows.

    now, last, begun: the present, the last row, when an engine's clock began anew.  ahead: what searches found, by (disk, other
    disk or -1 - shape).  rest_due: the rest of disks whose series of bounces is over.  series: how far its end may be off.
    met, contacts: the last contact of each disk, and how many it had.
    """

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

    def normal(self, m: Meeting) -> Vector:
        """The unit normal of a meeting, pointing to disk a."""
        if m.b < 0 and isinstance(shape := self.table.shapes[m.shape], Line):
            return m.side * shape.normal[0] / shape.norm, m.side * shape.normal[1] / shape.norm
        dx, dy = self.towards(m)
        length = root(dx * dx + dy * dy)
        return dx / length, dy / length

    def towards(self, m: Meeting) -> Vector:
        """The same of any length."""
        x, y, _, _ = self.flights[m.a].at(m.time)
        px, py = self.search.shift(m.image)
        if m.b >= 0:
            xb, yb, _, _ = self.flights[m.b].at(m.time)
            dx, dy = x - xb - px, y - yb - py
        else:
            shape = self.table.shapes[m.shape]
            if isinstance(shape, Line):
                return m.side * shape.normal[0], m.side * shape.normal[1]
            centre = shape.place if isinstance(shape, Tip) else shape.centre
            dx, dy = m.side * (x - px - centre[0]), m.side * (y - py - centre[1])
            if isinstance(shape, Oval):
                dx, dy = shape.gradient(shape.scaled((dx, dy)))
        return dx, dy

    def bend(self, m: Meeting) -> float:
        """How the normal turns with the place: 1 over the distance from the centre, negative inside; 0 on a line."""
        if m.b >= 0:
            return 1.0 / float(self.table.radius[m.a] + self.table.radius[m.b])
        shape, r = self.table.shapes[m.shape], float(self.table.radius[m.a])
        if isinstance(shape, Line):
            return 0.0
        if isinstance(shape, Tip):
            return 1.0 / r
        if isinstance(shape, Oval):
            x, y, _, _ = self.flights[m.a].at(m.time)
            px, py = self.search.shift(m.image)
            steep = math.hypot(
                *floats(shape.gradient(shape.scaled((x - px - shape.centre[0], y - py - shape.centre[1]))))
            )
            return m.side / (float(shape.semi_axes[0] * shape.semi_axes[1]) ** 2 * steep**3)
        return m.side / (float(shape.radius) + m.side * r)

    def closing(self, m: Meeting) -> tuple[float, float, float]:
        """The normal at a meeting, in floats, and the rate at which the gap closes (negative)."""
        nx, ny = self.towards(m)
        _, _, u, w = self.flights[m.a].at(m.time)
        if m.b >= 0:
            _, _, ub, wb = self.flights[m.b].at(m.time)
            u, w = u - ub, w - wb
        x, y = float(nx), float(ny)
        length = math.hypot(x, y)
        return x / length, y / length, float(nx * u + ny * w) / length

    def closing_rate(self, m: Meeting, normal: Vector, velocity: dict[int, Vector]) -> Decimal:
        u, w = velocity[m.a]
        if m.b >= 0:
            u, w = u - velocity[m.b][0], w - velocity[m.b][1]
        return normal[0] * u + normal[1] * w

    def tick(self) -> float:
        """How far an engine's clock has come at this row, since it began anew."""
        if float(self.now - self.last) > IDLE * float(self.last - self.begun):
            self.begun = self.now
        return float(self.now - self.begun)

    def fly_to_now(
        self, i: int, clock: float, sides: tuple[int, ...] = (), terms: float = 0.0
    ) -> tuple[Vector, Vector]:
        """Move disk i to the present in flight and doubt; its place and velocity, without a new flight yet.

        clock: what an engine's clock shows.  sides: axes along which the place is exact, since a side of the domain
        is met.  terms: the size of what is added up where the place is compared with what is met.
        """
        f = self.flights[i]
        x, y, u, w = f.at(self.now)
        delay = float(self.now - f.time)
        self.doubt.fly(i, delay)
        corner = self.table.corner
        on_clock = self.is_on_clock(i)
        sigma = []
        for axis, (place, start, v, c) in enumerate(((x, f.x, u, corner[0]), (y, f.y, w, corner[1]))):
            kept = axis in sides or (is_float(place - c) and (place == start or on_clock))
            way = abs(float(place - start)) + abs(float(v)) * (abs(delay) + clock)
            sigma.append(0.0 if kept else UNIT * (max(self.place_size(place, c), terms) + way))
        for v, start in ((u, f.u), (w, f.w)):
            sigma.append(0.0 if v == start or is_float(v) else last_bits(v, v - start))
        self.doubt.round(i, sigma)
        return (x, y), (u, w)

    def is_on_clock(self, i: int) -> bool:
        """Whether the present is a float, and so were the times at which disk i has been wrapped since its flight began."""
        f = self.flights[i]
        if not is_float(self.now):
            return False
        ways = zip((f.x, f.y), f.at(self.now), (f.u, f.w), (f.ax, f.ay), self.table.period, self.table.corner, strict=False)
        for start, place, v, a, period, corner in ways:
            if period is None:
                continue
            first, last = sorted(((at - corner) / period).to_integral_value(ROUND_FLOOR) for at in (start, place))
            if first != last and a != 0:
                return False
            for border in range(int(first) + 1, int(last) + 1):
                if not is_float(f.time + (corner + border * period - start) / v):
                    return False
        return True

    def place_size(self, place: Decimal, corner: Decimal) -> float:
        """The size of a coordinate as engines have it: from the corner, inside the period."""
        size = abs(float(place - corner))
        if self.table.period != (None, None):
            size = min(size, self.large)
        return size

    def terms_of(self, m: Meeting) -> float:
        """The size of what is added up where a gap is calculated: the reach, and the place of the wall."""
        if m.b >= 0:
            return float(self.table.radius[m.a] + self.table.radius[m.b])
        shape, r = self.table.shapes[m.shape], float(self.table.radius[m.a])
        places = [shape.place] if isinstance(shape, Tip) else ends_or_centre(shape)
        return r + max(abs(float(p - c)) for place in places for p, c in zip(place, self.table.corner, strict=True))

    def begin_flight(
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

    def round_velocity(self, i: int, before: Vector, after: Vector, clock: float) -> None:
        """What an engine's rounding adds at a contact: of the new velocity, and of the time through the change of
        velocity.
        """
        change = math.hypot(float(after[0] - before[0]), float(after[1] - before[1]))
        sigma = [0.0, 0.0]
        late = 0.0 if self.is_on_clock(i) else UNIT * clock
        sigma = [late * abs(float(a - b)) for a, b in zip(after, before, strict=True)]
        for a, b in zip(after, before, strict=True):
            is_exact = a == b or is_float(a) or abs(float(a)) <= NOTHING * change
            sigma.append(0.0 if is_exact else UNIT * (change + abs(float(a))))
        self.doubt.round(i, sigma)

    def part(self, i: int, time: Decimal) -> Part:
        """A disk at a time, with its errors."""
        f = self.flights[i]
        x, y, u, w = f.at(time)
        delay = float(time - f.time)
        error = self.doubt.error(i, delay) + UNIT * (
            float(abs(x)) + float(abs(y)) + math.hypot(float(u), float(w)) * delay
        )
        return Part(i, (x, y), (u, w), error, self.doubt.speed_error(i) + UNIT * math.hypot(float(u), float(w)))

    def parts(self, time: Decimal) -> list[Part]:
        """All disks at a time after the last row."""
        return [self.part(i, time) for i in range(self.n)]

    def add_row(self, kind: str, disks: Sequence[int], walls: frozenset[str], time_error: float, **more: Any) -> None:
        """Tell a row."""
        parts = tuple(self.part(i, self.now) for i in disks)
        self.rows.append(Row(self.group, self.now, kind, parts, walls, time_error, **more))

    def is_in_corner(self, m: Meeting) -> bool:
        """Whether a point meets, at the end of what it slides on, what makes a corner of less than half a turn with it there."""
        f, shape = self.flights[m.a], self.table.shapes[m.shape]
        if f.held is None or not isinstance(shape, Line | Bow):
            return False
        if isinstance(shape, Line) and shape.length2 is None:
            held = self.table.shapes[f.held[0]]
            return any(across(shape, end) == 0 for end, _ in ends_of(held))
        along = {wall_key(f.held[0], (0, 0), f.held[1]): True}
        return bool(self.search.shut_ends(m.shape, shape, (f.x, f.y), along, m.image))

    def kin(self, shape: int) -> set[int]:
        """The shapes that continue a shape: its ends, and what is in line with it."""
        return set(self.table.bonds[shape]) | set(self.table.supports.get(shape, ()))

    def lines_and_ends(self, k: int) -> frozenset[int]:
        """A line, those in line with it, and the ends between and behind them."""
        lines = set(self.table.supports[k])
        return frozenset(
            lines | {j for line in lines for j in self.table.bonds[line] if isinstance(self.table.shapes[j], Tip)}
        )

    def line_names(self, k: int) -> frozenset[str]:
        """The names of all lines in line with one."""
        return frozenset(name for j in self.table.supports[k] for name in names_of(self.table.shapes[j]))

    def images_around(self) -> list[tuple[int, int]]:
        """The images next to a disk."""
        px, py = self.table.period
        return [(i, j) for i in ((0,) if px is None else (-1, 0, 1)) for j in ((0,) if py is None else (-1, 0, 1))]


def ends_or_centre(shape: Line | Ring | Bow | Oval) -> list[Vector]:
    """Places that tell where a wall is; the centre of a flat arc is far away, and not used."""
    return [shape.centre] if isinstance(shape, Ring | Oval) else [shape.start, shape.end]


def size(velocity: Vector) -> float:
    """The speed."""
    return math.hypot(float(velocity[0]), float(velocity[1]))


def floats(pair: Vector) -> tuple[float, float]:
    """A vector in floats."""
    return float(pair[0]), float(pair[1])
