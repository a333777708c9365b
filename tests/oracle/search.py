"""When does a disk meet something: contact times as roots, and the decisions that they hang on.

A contact is the earliest time at which a gap is 0 or less and falls.  Three gaps do: that of a line (a polynomial of
degree 1 or 2 in time), that of a circle from outside and from inside (degree 2, or 4 where the relative motion is a
parabola).

Besides the meeting a search tells its *calls*: the close decisions on the way to it, each a length that must not
change its sign (a disk passes another one by so much; a point passes the end of a wall by so much).  `doubt` knows
whether floats can tell.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from decimal import Decimal
from typing import NamedTuple

from tests.oracle.digits import HALF, ONE, ZERO, exact, sign
from tests.oracle.roots import Polynomial, survey
from tests.oracle.table import TOUCHING, Bow, Line, Oval, Ring, Shape, Table, Tip, Vector, across, along, ends_of

NEAR = 1e-2
"""A miss by more than this part of the scene's size is no close call: errors as large end the judging before."""

NONE = 1e-14
"""A smaller component of a vector of length 1 is rounding."""

CORNER = 1e-4
"""A flight that begins so much nearer still to the end of an arc begins in the corner there."""

FAR = 1.001
"""So many times as far as that a miss is seen by floats."""

LAPS = 1.5
"""Images are looked for as far as a disk flies through so many periods; then again."""


@dataclass(slots=True)
class Flight:
    """A disk between two events: where it was at `time`, its velocity and its acceleration there.

    touch: what it touches at that instant, with a gap that is exactly 0: (shape or pair key, side) -> whether it
    neither approaches nor recedes. skip: shapes that this flight cannot meet (it glides or rests on them).  held: the
    line that it rests on and its side. count: how many flights the disk had before.
    """

    time: Decimal
    x: Decimal
    y: Decimal
    u: Decimal
    w: Decimal
    ax: Decimal
    ay: Decimal
    touch: dict[tuple[int, ...], bool] = field(default_factory=dict)
    skip: frozenset[int] = frozenset()
    held: tuple[int, int] | None = None
    count: int = 0
    _asked: Decimal | None = None
    _answer: tuple[Decimal, Decimal, Decimal, Decimal] = (ZERO, ZERO, ZERO, ZERO)

    def at(self, time: Decimal) -> tuple[Decimal, Decimal, Decimal, Decimal]:
        """Place and velocity at a time; the last answer is kept."""
        if time == self.time:
            return self.x, self.y, self.u, self.w
        if time != self._asked:
            t = time - self.time
            half = HALF * t
            self._asked, self._answer = (
                time,
                (
                    self.x + t * (self.u + half * self.ax),
                    self.y + t * (self.w + half * self.ay),
                    self.u + t * self.ax,
                    self.w + t * self.ay,
                ),
            )
        return self._answer


class Call(NamedTuple):
    """A decision: at `time` the length `margin` has a sign that counts.

    pull: the change of that length with the place of the disk a (of b: the negative).
    """

    time: Decimal
    margin: float
    pull: tuple[float, float]


IMPACT, PRESSED, LEAVE, REST, LOOK = "impact", "pressed", "leave", "rest", "look"


@dataclass(slots=True, eq=False)
class Meeting:
    """A contact ahead: when, of whom (b: another disk or -1; shape: -1 for a pair), in which image, from which side,
    and how.

    at_end: a point meets the very end of a wall.
    """

    time: Decimal
    a: int
    b: int
    shape: int
    image: tuple[int, int] = (0, 0)
    side: int = 0
    how: str = IMPACT
    at_end: bool = False

    @property
    def disks(self) -> tuple[int, ...]:
        """The disks that take part."""
        return (self.a,) if self.b < 0 else (self.a, self.b)


class Found(NamedTuple):
    """What a search found: the first meeting, if any, and the close calls before it."""

    meeting: Meeting | None
    calls: list[Call]


def pair_key(a: int, b: int, image: tuple[int, int]) -> tuple[int, ...]:
    """How touching disks are remembered by disk a."""
    return (-1, b, *image)


def wall_key(shape: int, image: tuple[int, int], side: int) -> tuple[int, ...]:
    """How a touched wall is remembered."""
    return (shape, *image, side)


class Search:
    """Looks for the next meeting of two flights, or of a flight and a shape, at a table."""

    def __init__(self, table: Table) -> None:
        self.table = table
        self.near = NEAR * (table.largest or 1.0)
        self._boxes = [_box(shape) for shape in table.shapes]

    def pair(self, a: int, b: int, fa: Flight, fb: Flight, now: Decimal) -> list[Found]:
        """The meetings of two disks, one for each image that they may meet before the search is repeated."""
        table = self.table
        reach = table.radius[a] + table.radius[b]
        if (
            reach == 0
            or (table.mass[a] is None and table.mass[b] is None)
            or (table.mass[a] == 0 and table.mass[b] == 0)
        ):
            return []
        xa, ya, ua, wa = fa.at(now)
        xb, yb, ub, wb = fb.at(now)
        x, y, u, w, ax, ay = xa - xb, ya - yb, ua - ub, wa - wb, fa.ax - fb.ax, fa.ay - fb.ay
        at_once = fa.time == now and fb.time == now
        found: list[Found] = []
        images, again = self._images((0.0, 0.0, 0.0, 0.0), x, y, u, w, ax, ay, float(reach))
        for image in images:
            px, py = self.shift(image)
            key = pair_key(a, b, image)
            touch = fa.touch.get(key) if at_once else None
            one = _round((x - px, y - py), (u, w), (ax, ay), reach, 1, touch, now, self.near)
            if one is not None:
                found.append(_found(one, now, a, b, -1, image, 0))
        if again is not None:
            found.append(Found(Meeting(now + again, a, b, -1, how=LOOK), []))
        return found

    def wall(self, a: int, k: int, flight: Flight, now: Decimal) -> list[Found]:
        """The same for a disk and a shape."""
        if k in flight.skip:
            return []
        shape = self.table.shapes[k]
        radius = self.table.radius[a]
        if isinstance(shape, Tip) and radius == 0:
            return []
        x, y, u, w = flight.at(now)
        images, again = [(0, 0)], None
        if not (isinstance(shape, Line) and shape.length2 is None):
            images, again = self._images(self._boxes[k], x, y, u, w, flight.ax, flight.ay, float(radius))
        found: list[Found] = []
        for image in images:
            px, py = self.shift(image)
            place, touch = (x - px, y - py), flight.touch if flight.time == now else {}
            found += self._meet(a, k, shape, place, (u, w), (flight.ax, flight.ay), radius, image, touch, now)
        if again is not None:
            found.append(Found(Meeting(now + again, a, -1, k, how=LOOK), []))
        return found

    def slide(self, a: int, flight: Flight, now: Decimal) -> Found | None:
        """When a disk that rests on lines comes to their end."""
        assert flight.held is not None
        k, side = flight.held
        one = self.table.shapes[k]
        assert isinstance(one, Line)
        if one.length2 is None:
            return None
        low, high = self.extent(k)
        x, y, u, w = flight.at(now)
        s = (
            along(one, (x, y)),
            one.along[0] * u + one.along[1] * w,
            (one.along[0] * flight.ax + one.along[1] * flight.ay) / 2,
        )
        best: Meeting | None = None
        for gap in ((s[0] - low, s[1], s[2]), (high - s[0], -s[1], -s[2])):
            for crossing in survey(gap)[0]:
                if crossing.falls and (best is None or now + crossing.time < best.time):
                    best = Meeting(now + crossing.time, a, -1, k, side=side, how=LEAVE)
        return None if best is None else Found(best, [])

    def extent(self, k: int) -> tuple[Decimal, Decimal]:
        """From where to where the lines in line with line k go, in terms of `along`."""
        one = self.table.shapes[k]
        assert isinstance(one, Line)
        feet = [along(one, end) for j in self.table.supports[k] for end, _ in ends_of(self.table.shapes[j])]
        return min(feet), max(feet)

    def shift(self, image: tuple[int, int]) -> Vector:
        px, py = self.table.period
        return (ZERO if px is None else image[0] * px, ZERO if py is None else image[1] * py)

    def _images(
        self,
        box: tuple[float, float, float, float],
        x: Decimal,
        y: Decimal,
        u: Decimal,
        w: Decimal,
        ax: Decimal,
        ay: Decimal,
        reach: float,
    ) -> tuple[list[tuple[int, int]], Decimal | None]:
        """The images of a shape (or of the origin) near the path ahead, and when to look again."""
        period = self.table.period
        if period == (None, None):
            return [(0, 0)], None
        lengths = [None if p is None else float(p) for p in period]
        speed, pull = (float(u), float(w)), (float(ax), float(ay))
        ahead = math.inf
        for length, v, g in zip(lengths, speed, pull, strict=True):
            if length is not None:
                far = LAPS * length
                if v != 0.0:
                    ahead = min(ahead, far / abs(v))
                if g != 0.0:
                    ahead = min(ahead, math.sqrt(far / abs(g)))
        spans = []
        for axis, (start, v, g, length) in enumerate(zip((float(x), float(y)), speed, pull, lengths, strict=True)):
            if length is None:
                spans.append(range(1))
                continue
            way = 0.0 if ahead == math.inf else abs(v) * ahead + 0.5 * abs(g) * ahead * ahead
            room = way + reach + 1e-6 * length
            spans.append(
                range(
                    math.ceil((start - room - box[2 + axis]) / length),
                    math.floor((start + room - box[axis]) / length) + 1,
                )
            )
        return [(i, j) for i in spans[0] for j in spans[1]], None if ahead == math.inf else exact(ahead)

    def _meet(
        self,
        a: int,
        k: int,
        shape: Shape,
        place: Vector,
        speed: Vector,
        pull: Vector,
        radius: Decimal,
        image: tuple[int, int],
        touch: dict[tuple[int, ...], bool],
        now: Decimal,
    ) -> list[Found]:
        if isinstance(shape, Line):
            return self._line(a, k, shape, place, speed, pull, radius, image, touch, now)
        from_centre = place[0] - _centre(shape)[0], place[1] - _centre(shape)[1]
        found: list[Found] = []
        if isinstance(shape, Bow):
            return self._bow(a, k, shape, from_centre, speed, pull, radius, image, touch, now)
        if isinstance(shape, Oval):
            return self._oval(a, k, shape, from_centre, speed, image, touch, now)
        inside = isinstance(shape, Ring)
        reach = shape.radius - radius if isinstance(shape, Ring) else radius
        side = -1 if inside else 1
        one = _round(from_centre, speed, pull, reach, side, touch.get(wall_key(k, image, side)), now, self.near)
        if one is not None:
            found.append(_found(one, now, a, -1, k, image, side))
        return found

    def _line(
        self,
        a: int,
        k: int,
        one: Line,
        place: Vector,
        speed: Vector,
        pull: Vector,
        radius: Decimal,
        image: tuple[int, int],
        touch: dict[tuple[int, ...], bool],
        now: Decimal,
    ) -> list[Found]:
        nx, ny = one.normal
        s = across(one, place), nx * speed[0] + ny * speed[1], (nx * pull[0] + ny * pull[1]) / 2
        width = radius * one.norm
        touched = next((side for side in one.sides if wall_key(k, image, side) in touch), 0)
        own = touched or self._own_side(one, s, place, radius)
        shut = self.shut_ends(k, one, place, touch, image) if radius == 0 and touch else []
        best: tuple[Decimal, int, str, bool] | None = None
        calls: list[Call] = []
        for side in one.sides:
            c, b, q = side * s[0] - width, side * s[1], side * s[2]
            is_on = touched == side or (touched != 0 and radius == 0)
            gap: Polynomial = (c, b, q)
            if is_on:
                still = touch[wall_key(k, image, touched)]
                rate = 0 if still else sign(b, _rate_size(one, speed))
                if side == touched and rate <= 0 and (rate < 0 or q < 0):
                    at_end = self._foot(one, place, speed, pull, ZERO, radius, now, calls, shut)
                    if at_end is not None:
                        return [
                            Found(Meeting(now, a, -1, k, image, side, IMPACT if rate < 0 else PRESSED, at_end), calls)
                        ]
                gap = (q,) if rate == 0 else (b, q)
            elif side == own and c <= 0 and radius > 0 and b < 0:
                at_end = self._foot(one, place, speed, pull, ZERO, radius, now, calls, shut)
                if at_end is not None:
                    return [Found(Meeting(now, a, -1, k, image, side, IMPACT, at_end), calls)]
            crossings, turns = survey(gap)
            if not is_on:
                for turn in turns:
                    margin = float(abs(turn.value) / one.norm)
                    from_there = turn.value > 0 or c > 0  # else it is behind that side, and only comes nearer again
                    if turn.is_minimum and from_there and margin < self.near:
                        n = float(one.norm)
                        calls.append(Call(now + turn.time, margin, (side * float(nx) / n, side * float(ny) / n)))
            for crossing in crossings:
                if not crossing.falls or (best is not None and crossing.time >= best[0]):
                    continue
                soon = self._is_soon(speed, pull, crossing.time) and not touched
                at_end = self._foot(one, place, speed, pull, crossing.time, radius, now, calls, shut if soon else [])
                if at_end is not None:
                    best = crossing.time, side, IMPACT, at_end
                    break
        if best is None:
            return [Found(None, calls)] if calls else []
        t, side, how, at_end = best
        return [Found(Meeting(now + t, a, -1, k, image, side, how, at_end), calls)]

    def shut_ends(
        self, k: int, shape: Line | Bow, place: Vector, touch: dict[tuple[int, ...], bool], image: tuple[int, int]
    ) -> list[Vector]:
        """The ends of a wall that a point cannot pass, since its flight begins on what makes a corner with it there.

        In a corner of less than half a turn it meets the wall, wherever its flight begins, or not at all.  place: where that
        is; on an arc it must be next to the end.
        """
        shut = []
        for end, arm in ends_of(shape):
            for j, *at, side in touch:
                if j < 0 or j == k or tuple(at) != image:
                    continue
                normal = self._normal_at(self.table.shapes[j], end, place)
                if normal is not None and side * (normal[0] * arm[0] + normal[1] * arm[1]) > 0:
                    shut.append(end)
        return shut

    def _is_soon(self, speed: Vector, pull: Vector, t: Decimal) -> bool:
        """Whether a flight is straight until a contact, or so short that it comes back to nothing before it."""
        way = t * (abs(speed[0]) + abs(speed[1]) + t * (abs(pull[0]) + abs(pull[1])))
        return pull == (0, 0) or way <= CORNER * self.near

    def _normal_at(self, shape: Shape, end: Vector, place: Vector) -> Vector | None:
        """The normal of a wall at a point, if that is an end of it, or on a side of the domain."""
        if isinstance(shape, Line):
            is_there = across(shape, end) == 0 and (shape.length2 is None or end in (shape.start, shape.end))
            return shape.normal if is_there else None
        if (
            not isinstance(shape, Bow)
            or end not in (shape.start, shape.end)
            or _distance(place, end) > CORNER * self.near
        ):
            return None
        return end[0] - shape.centre[0], end[1] - shape.centre[1]

    def _own_side(self, one: Line, s: tuple[Decimal, Decimal, Decimal], place: Vector, radius: Decimal) -> int:
        """The side of a line that a disk is on; a point exactly on it is on the side that it moves to."""
        if len(one.sides) == 1:
            return one.sides[0]
        if radius > 0:
            return 1 if s[0] > 0 else -1
        size = abs(one.normal[0]) * (abs(place[0]) + abs(one.start[0])) + abs(one.normal[1]) * (
            abs(place[1]) + abs(one.start[1])
        )
        side = sign(s[0], size)
        for more in s[1:]:
            if side == 0 and more != 0:
                side = 1 if more > 0 else -1
        return side

    def _foot(
        self,
        one: Line,
        place: Vector,
        speed: Vector,
        pull: Vector,
        t: Decimal,
        radius: Decimal,
        now: Decimal,
        calls: list[Call],
        shut: list[Vector],
    ) -> bool | None:
        """Whether a contact after the delay t is on the line: None if it is not, True if a point meets its very end,
        else False.

        shut: the ends that are no close calls.
        """
        if one.length2 is None:
            return False
        x = place[0] + t * (speed[0] + t * pull[0] / 2)
        y = place[1] + t * (speed[1] + t * pull[1] / 2)
        foot = along(one, (x, y))
        rest = one.length2 - foot
        if radius > 0:
            return None if foot < 0 or rest < 0 else False
        ex, ey = one.along
        n = float(one.norm)
        size = abs(ex) * (abs(x) + abs(place[0]) + abs(one.start[0])) + abs(ey) * (abs(y) + abs(place[1]) + abs(one.start[1]))
        ends = sign(foot, size), sign(rest, size)
        margin = float(min(abs(foot), abs(rest))) / n
        if margin < self.near and (one.start if abs(foot) < abs(rest) else one.end) not in shut:
            # the foot is where the point is when its distance is 0: it moves along while the distance closes
            u, w = float(speed[0] + t * pull[0]), float(speed[1] + t * pull[1])
            fx, fy, mx, my = float(ex) / n, float(ey) / n, float(one.normal[0]) / n, float(one.normal[1]) / n
            rate = mx * u + my * w
            share = (fx * u + fy * w) / rate if rate != 0.0 else 0.0
            calls.append(Call(now + t, margin, _cleaned(fx - share * mx, fy - share * my)))
        if min(ends) < 0:
            end = one.start if ends[0] < 0 else one.end
            return False if end in self.table.sealed and -min(foot, rest) <= _last_bits(end) * one.norm else None
        return min(ends) == 0

    def _bow(
        self,
        a: int,
        k: int,
        shape: Bow,
        d: Vector,
        speed: Vector,
        pull: Vector,
        radius: Decimal,
        image: tuple[int, int],
        touch: dict[tuple[int, ...], bool],
        now: Decimal,
    ) -> list[Found]:
        """Contacts with an arc from both of its sides."""
        touched = next((side for side in (1, -1) if wall_key(k, image, side) in touch), 0)
        place = d[0] + shape.centre[0], d[1] + shape.centre[1]
        shut = self.shut_ends(k, shape, place, touch, image) if radius == 0 and touch else []
        best: Meeting | None = None
        calls: list[Call] = []
        for side in (1, -1):
            reach = shape.radius + side * radius
            if reach <= 0:
                continue
            here: bool | None = None
            other = touched != 0 and side != touched and radius == 0
            if touched == side or other:
                here = touch[wall_key(k, image, touched)]
            outcome = _round(d, speed, pull, reach, side, here, now, self.near, every=True, departing=other)
            if outcome is None:
                continue
            times, how, near = outcome
            calls += near
            for t in times:
                if best is not None and now + t >= best.time:
                    break
                soon = t == 0 or (self._is_soon(speed, pull, t) and not touched)
                at_end = self._on_bow(shape, d, speed, pull, t, radius, now, calls, shut if soon else [])
                if at_end is not None:
                    best = Meeting(now + t, a, -1, k, image, side, how, at_end)
                    break
        return [Found(best, calls)] if best is not None or calls else []

    def _oval(
        self,
        a: int,
        k: int,
        shape: Oval,
        d: Vector,
        speed: Vector,
        image: tuple[int, int],
        touch: dict[tuple[int, ...], bool],
        now: Decimal,
    ) -> list[Found]:
        """Contacts of a point that flies straight with an ellipse: with the circle that it is in its own frame."""
        touched = next((side for side in (1, -1) if wall_key(k, image, side) in touch), 0)
        best: Meeting | None = None
        calls: list[Call] = []
        for side in (1, -1):
            here = touch[wall_key(k, image, touched)] if touched else None
            away = touched != 0 and side != touched
            place, velocity = shape.scaled(d), shape.scaled(speed)
            outcome = _round(place, velocity, (ZERO, ZERO), ONE, side, here, now, self.near, every=True, departing=away)
            if outcome is None:
                continue
            times, how, near = outcome
            for call in near:
                pull = shape.gradient((exact(call.pull[0]), exact(call.pull[1])))
                calls.append(Call(call.time, call.margin, (float(pull[0]), float(pull[1]))))
            if times and (best is None or now + times[0] < best.time):
                best = Meeting(now + times[0], a, -1, k, image, side, how)
        return [Found(best, calls)] if best is not None or calls else []

    def _on_bow(
        self,
        shape: Bow,
        d: Vector,
        speed: Vector,
        pull: Vector,
        t: Decimal,
        radius: Decimal,
        now: Decimal,
        calls: list[Call],
        shut: list[Vector],
    ) -> bool | None:
        """As _foot, for an arc: its foot on the circle is beyond the chord."""
        x = d[0] + t * (speed[0] + t * pull[0] / 2)
        y = d[1] + t * (speed[1] + t * pull[1] / 2)
        square = x * x + y * y
        if square == 0:
            return None
        scale = shape.radius / square.sqrt()
        fx = shape.centre[0] + x * scale - shape.start[0]
        fy = shape.centre[1] + y * scale - shape.start[1]
        cx, cy = shape.chord
        beyond = shape.bulge * (cx * fy - cy * fx)
        if radius > 0:
            return None if beyond < 0 else False
        size = abs(cx) * (abs(fy) + abs(cy)) + abs(cy) * (abs(fx) + abs(cx))
        side = sign(beyond, size)
        # how far the foot may move along the circle before it passes an end
        at_start, at_end = _distance((fx, fy), (ZERO, ZERO)), _distance((fx, fy), shape.chord)
        away = min(at_start, at_end)
        if away < self.near and (shape.start if at_start < at_end else shape.end) not in shut:
            u, w = float(speed[0] + t * pull[0]), float(speed[1] + t * pull[1])
            r = float(square.sqrt())
            mx, my = float(x) / r, float(y) / r
            rate = mx * u + my * w
            share = (-my * u + mx * w) / rate if rate != 0.0 else 0.0
            calls.append(Call(now + t, away, _cleaned(-my - share * mx, mx - share * my)))
        if side < 0:
            end = shape.start if at_start < at_end else shape.end
            return False if end in self.table.sealed and away <= _last_bits(end) else None
        return side == 0


def _round(
    d: Vector,
    v: Vector,
    g: Vector,
    reach: Decimal,
    side: int,
    touch: bool | None,
    now: Decimal,
    near: float,
    every: bool = False,
    departing: bool = False,
) -> tuple[list[Decimal], str, list[Call]] | None:
    """When a circle of radius `reach` is met from outside (side 1) or inside (-1): delays, how, close calls; None for
    never.

    touch: None, or that the gap is exactly 0 now, and whether it neither closes nor opens.  every: all such times,
    not the first alone. departing: the gap is 0 because the other side of the circle is touched.
    """
    (x, y), (u, w), (gx, gy) = d, v, g
    b = x * u + y * w
    straight = gx == 0 and gy == 0
    if straight and side > 0 and touch is None and b >= 0:
        return None
    if straight and side > 0 and touch is None and _misses(x, y, u, w, float(reach) + near):
        return None
    c = x * x + y * y - reach * reach
    a = u * u + w * w
    if straight:
        if a == 0:
            return None
        poly: Polynomial = (side * c, side * 2 * b, side * a)
    else:
        poly = (
            side * c,
            side * 2 * b,
            side * (a + x * gx + y * gy),
            side * (u * gx + w * gy),
            side * (gx * gx + gy * gy) / 4,
        )
    calls: list[Call] = []
    if touch is not None:
        rate = 0 if touch else sign(poly[1], 2 * (abs(x * u) + abs(y * w)))
        if not departing:
            if rate < 0:
                return [ZERO], IMPACT, calls
            if (
                rate == 0
                and (pressed := sign(poly[2], a + abs(x * gx) + abs(y * gy))) <= 0
                and not (straight and side > 0)
            ):
                return ([ZERO], PRESSED, calls) if pressed < 0 else None
        poly = poly[2:] if rate == 0 else poly[1:]
    elif poly[0] <= 0 and poly[1] < 0 and not every:
        return [ZERO], IMPACT, calls
    crossings, turns = survey(poly)
    if touch is None:
        for turn in turns:
            if not turn.is_minimum or reach == 0:
                continue
            margin = float(abs(turn.value) / (2 * reach))
            if margin < near:
                t = turn.time
                tx, ty = float(x + t * (u + t * gx / 2)), float(y + t * (w + t * gy / 2))
                r = math.hypot(tx, ty) or 1.0
                calls.append(Call(now + t, margin, (tx / r, ty / r)))
    times = [crossing.time for crossing in crossings if crossing.falls]
    if not times and not calls:
        return None
    return times if every else times[:1], IMPACT, calls


def _misses(x: Decimal, y: Decimal, u: Decimal, w: Decimal, reach: float) -> bool:
    """Whether a straight flight passes the origin at more than `reach`, as floats can tell."""
    dx, dy, du, dw = float(x), float(y), float(u), float(w)
    speed, distance = math.hypot(du, dw), math.hypot(dx, dy)
    if not 1e-100 < speed < 1e100 or not distance < 1e100:
        return False
    return abs(dx * (dw / speed) - dy * (du / speed)) > FAR * reach + 1e-9 * distance


def _found(
    one: tuple[list[Decimal], str, list[Call]],
    now: Decimal,
    a: int,
    b: int,
    shape: int,
    image: tuple[int, int],
    side: int,
) -> Found:
    times, how, calls = one
    return Found(Meeting(now + times[0], a, b, shape, image, side, how) if times else None, calls)


def _cleaned(x: float, y: float) -> tuple[float, float]:
    """A vector of length 1 or more without what rounding left of a component that is 0."""
    return (0.0 if abs(x) < NONE else x, 0.0 if abs(y) < NONE else y)


def _centre(shape: Shape) -> Vector:
    assert not isinstance(shape, Line)
    return shape.place if isinstance(shape, Tip) else shape.centre


def _rate_size(one: Line, speed: Vector) -> Decimal:
    return abs(one.normal[0] * speed[0]) + abs(one.normal[1] * speed[1])


def _last_bits(end: Vector) -> Decimal:
    """How far a sealed end of a wall goes on, for points: nothing passes between it and what it lies on."""
    return TOUCHING * max(abs(end[0]), abs(end[1]))


def _distance(p: Vector, q: Vector) -> float:
    return math.hypot(float(p[0] - q[0]), float(p[1] - q[1]))


def _box(shape: Shape) -> tuple[float, float, float, float]:
    """A rectangle around a shape: x0, y0, x1, y1."""
    if isinstance(shape, Line):
        points = [shape.start, shape.end]
    elif isinstance(shape, Tip):
        points = [shape.place]
    else:
        (x, y), r = shape.centre, max(shape.semi_axes) if isinstance(shape, Oval) else shape.radius
        points = [(x - r, y - r), (x + r, y + r)]
    xs, ys = [float(p[0]) for p in points], [float(p[1]) for p in points]
    return min(xs), min(ys), max(xs), max(ys)


__all__ = [
    "IMPACT",
    "LEAVE",
    "LOOK",
    "ONE",
    "PRESSED",
    "REST",
    "Call",
    "Flight",
    "Found",
    "Meeting",
    "Search",
    "pair_key",
    "wall_key",
]
