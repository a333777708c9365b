"""The verdict on a run: its log, row by row, against the oracle's story.

* Every disk must have the same contacts in the same order: kind, partner, wall.  Rows of one instant's cluster come
in any order.
* Times must be right to 1e-9 mean free times, times the number of contacts that the disk has had, places and
velocities likewise, or to
  what rounding and its growth permit (`doubt`), whichever is more.
* The run must stop for the same reason.  Where there is no answer (`collapse` in the story) it must stop with a
reason there.
* A run that stops with a reason before a contact that floats determine has *refused*: honest, but the oracle knows the answer.
Floats do not determine a contact where the doubt about its time is as long as the flight that leads to it.
* What floats do not determine is not judged.  Nothing that is exact in the starting floats is excused.

A series of bounces may end with its row `rest` before the oracle's does, at the oracle's time, once its flights are
not longer than `CUT` of those that rounding keeps up; where the oracle has ended a series, further bounces until then
are fine.  A contact that changes no velocity may be there or not.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from typing import Any

import eventsim as es
from eventsim.scene.stage import stage_of
from tests.oracle.digits import ROUNDS, exact, working_with
from tests.oracle.doubt import SAFE
from tests.oracle.search import REST
from tests.oracle.story import KICK, PAIR, WALL, Kick, Part, Row, Story

CLOSE = 1e-9
"""What is right, in mean free times, mean free paths, speeds."""

REST_CLOSE = 1e-8
"""What is right for the time of coming to rest on a segment, whose places are rounded, as a part of the time until
then.
"""

CUT = 100.0
"""A series of bounces may be ended where its flights are so many times longer than those that rounding keeps up."""

NOTHING = 1e-12
"""A change of velocity below this part of the speed is none."""

RIGHT, REFUSED, WRONG, UNJUDGED = "right", "refused", "wrong", "unjudged"

STOPS = ("collapse", "digits")
"""Words for a stop with a reason."""

MOST_LOW = 25.0
"""Bounces that an engine may add to the oracle's, times 1 - e: in them flights become shorter by a factor of 1e11."""

NOTICED = 1e-5
"""Where there is no answer any more a run must stop within such a part of the time in which a disk flies its own length."""

SMALL, FAR = 1e-6, 1e3
"""The length that errors are measured in is the largest radius, where it is not below this part of the table; a free
flight is counted as at most so many of these lengths, so that an idle spell excuses nothing; by the mean, which in a
series of bounces is longer than the median, at most one."""

ENOUGH = 20
"""So many judged rows make a judged scene, whatever follows."""


@dataclass(frozen=True)
class Seen:
    """What an engine did: rows as in a log, the word it stopped with, its last state (None after a stop with a
    reason).
    """

    engine: str
    rows: Any
    epoch_length: float
    wall_names: tuple[str, ...]
    corner: tuple[float, float]
    start_time: float
    stopped: str
    reason: str | None
    time: float
    position: Any = None
    velocity: Any = None


@dataclass(frozen=True)
class Verdict:
    """word: right, refused, wrong, unjudged; why; row: the first that is wrong; judged of total rows."""

    word: str
    why: str
    row: int
    judged: int
    total: int


def observe(scene: Any, engine: str, kicks: Sequence[Kick] = ()) -> Seen:
    """Run an engine on a scene, with its kicks."""
    stage = stage_of(scene)
    if not kicks:
        run = es.simulate(scene, engine=engine, log=True)
        log, stopped, reason, time, state = run.log, run.stopped, run.reason, run.time, run.state
    else:
        log, stopped, reason, time, state = _kicked(scene, engine, kicks)
    provenance = log.provenance
    return Seen(
        engine,
        log.rows.copy(),
        provenance.epoch_length,
        tuple(provenance.wall_names),
        (float(stage.corner[0]), float(stage.corner[1])),
        scene.start_time,
        stopped,
        reason,
        time,
        state.position.copy(),
        state.velocity.copy(),
    )


def _kicked(scene: Any, engine: str, kicks: Sequence[Kick]) -> Any:
    """A simulation with kicks at times and at the instants of contacts."""
    sim = es.Simulation(scene, engine=engine)
    counts = [0] * len(scene.disks)
    timed = sorted((k for k in kicks if k.time is not None), key=lambda k: k.time or 0.0)
    hooked = [k for k in kicks if k.after is not None]
    stopped, reason = "until", None
    most = 100_000 if scene.events is None else scene.events

    def count(rows: Any) -> None:
        for row in rows:
            for i in (int(row["a"]), int(row["b"])):
                if i >= 0 and int(row["kind"]) in (0, 1):
                    counts[i] += 1

    def pass_to(time: float) -> None:
        while hooked and sim.counters.events < most:
            rows = sim.advance_to(time, events=1)
            if not len(rows):
                return
            count(rows)
            for kick in [k for k in hooked if counts[k.disk] == (k.after or 0) + 1]:
                hooked.remove(kick)
                sim.set_velocity(kick.disk, kick.velocity)
        if sim.counters.events >= most:
            return
        sim.advance_to(time, events=most - sim.counters.events)

    try:
        for kick in timed:
            assert kick.time is not None
            pass_to(kick.time)
            if sim.counters.events < most:
                sim.set_velocity(kick.disk, kick.velocity)
        pass_to(scene.until)
        if sim.counters.events >= most:
            stopped = "events"
    except es.CollapseError as error:
        stopped, reason = ("collapse" if "collapse" in str(error)[:30] else "digits"), str(error)
    return sim.log, stopped, reason, sim.time, sim.state


class _MistakeError(Exception):
    def __init__(self, why: str, row: int) -> None:
        super().__init__(why)
        self.row = row


class _NoDigitsLeftError(Exception):
    """From here on floats do not determine what a run does."""


def judge(story: Story, seen: Seen, close: float = CLOSE) -> Verdict:
    """The verdict on what an engine did; close: what is right, in mean free times and the like."""
    with working_with(ROUNDS[0]):
        return _Judge(story, seen, close).verdict()


class _Judge:
    def __init__(self, story: Story, seen: Seen, close: float) -> None:
        self.story, self.seen, self.close = story, seen, close
        n = len(story.table.radius)
        self.mine: list[list[Row]] = [[] for _ in range(n)]
        for row in story.rows:
            for part in row.parts:
                self.mine[part.disk].append(row)
        self.used: set[int] = set()
        self.place = [0] * n
        self.velocity = [(float(u), float(w)) for _, (u, w) in story.table.start]
        self.judged = 0
        self.counts = [0] * n
        self.low = [0] * n  # bounces lower than the oracle tells them one by one
        speeds = [math.hypot(*(float(c) for c in part.velocity)) for row in story.rows for part in row.parts]
        self.speed = max([math.hypot(*v) for v in self.velocity] + speeds)
        self.pull = 0.0 if story.table.gravity is None else math.hypot(*(float(g) for g in story.table.gravity))
        largest = max(float(r) for r in story.table.radius)
        self.length = largest if largest > SMALL * story.table.largest else story.table.largest
        self.free_time = self.length / self.speed if self.speed else 0.0
        last = story.rows[-1:] + [rows[-1] for rows in self.mine if rows]
        self.late = SAFE * max((row.time_error for row in last), default=0.0)
        self.unit = self.free_time
        if story.rows:
            median, mean = story.free_times
            self.free_time = max(min(median, FAR * self.unit), min(mean, self.unit)) or self.unit

    def verdict(self) -> Verdict:
        total = len(self.seen.rows)
        try:
            for number, row in enumerate(self.seen.rows):
                self._match(number, row)
            word, why = self._ending()
        except _NoDigitsLeftError:
            word, why = RIGHT, ""
        except _MistakeError as mistake:
            return Verdict(WRONG, str(mistake), mistake.row, self.judged, total)
        if word == RIGHT and not self._is_enough(total):
            return Verdict(UNJUDGED, self.story.why, -1, self.judged, total)
        return Verdict(word, why, -1, self.judged, total)

    def _is_enough(self, total: int) -> bool:
        return self.judged >= ENOUGH or 2 * self.judged >= total or self.judged == total

    # ---- rows

    def _match(self, number: int, row: Any) -> None:
        kind = ("pair", "wall", "rest", "kick")[int(row["kind"])]
        disks = [int(i) for i in (row["a"], row["b"]) if i >= 0]
        wall = "" if int(row["wall"]) < 0 else self.seen.wall_names[int(row["wall"])]
        time = self._time(row)
        expected = self._expected(kind, disks, wall, time, number)
        if expected is None:
            return
        self.used.add(id(expected))
        for name, part in zip("ab", self._parts(expected, disks), strict=False):
            self._compare(number, name, row, part, expected, time)
            self.counts[part.disk] += 1
            if expected.kind == REST:
                self.low[part.disk] = 0
            self.velocity[part.disk] = float(row[f"vx{name}"]), float(row[f"vy{name}"])
        self.judged += 1

    def _parts(self, expected: Row, disks: list[int]) -> list[Part]:
        return [next(part for part in expected.parts if part.disk == i) for i in disks]

    def _expected(self, kind: str, disks: list[int], wall: str, time: Decimal, number: int) -> Row | None:
        """The row of the story that this row of the log should be; None where it need not be judged."""
        while True:
            ahead = [self._next_group(i) for i in disks]
            for row in ahead[0]:
                is_it = (
                    row.kind == kind and {p.disk for p in row.parts} == set(disks) and (not wall or wall in row.walls)
                )
                if not is_it or not all(any(row is one for one in others) for others in ahead[1:]) or self._is_over(row, time):
                    continue
                before = not self._is_in_time(row, time) or self._leaves(row, number)
                if before and self._changes_nothing(number, disks):
                    continue  # a graze before it, or the end of a wall
                return row
            i = disks[0]
            if ahead[0] and kind == REST and (rest := self._early_rest(i, wall, number)) is not None:
                return rest
            if ahead[0] and kind == REST and self._rests_in_doubt(ahead[0][0], wall):
                raise _NoDigitsLeftError
            if ahead[0] and kind == REST and self._rests_again(ahead[0][0], wall, time, i, number):
                self.judged += 1
                return None
            if (
                ahead[0] and kind == WALL and self._is_low(ahead[0][0], wall, time, i, number)
            ) or self._changes_nothing(number, disks):
                self.judged += 1
                return None
            skippable = [row for others in ahead for row in others if row.idle or row.loose]
            if skippable:
                for row in skippable:
                    self.used.add(id(row))
                continue
            if any(not others for others in ahead) and (self._is_past(time, disks) or self._is_tail(time, i, wall)):
                return None
            raise _MistakeError(
                f"disk {disks}: {kind} {wall} at t = {float(time):.12g}, true: {self._told(ahead)}", number
            )

    def _is_in_time(self, row: Row, time: Decimal) -> bool:
        return abs(float(time - row.time)) <= self._time_slack(row, row.parts[0].disk)

    def _leaves(self, row: Row, number: int) -> bool:
        """Whether a disk only comes, in the log, to the end of its wall, and meets at once what is there."""
        i, seen = row.parts[0].disk, self.seen.rows
        following = next((k for k in range(number + 1, len(seen)) if i in (seen["a"][k], seen["b"][k])), None)
        at_once = following is not None and self._time(seen[following]) == self._time(seen[number])
        after = (float(seen["vxa"][number]), float(seen["vya"][number]))
        return at_once and row.kind == WALL and math.dist(after, _floats(row.parts[0].velocity)) > self.close * self.speed

    def _is_over(self, row: Row, time: Decimal) -> bool:
        """Whether a row that may be missing is missing: it should have come before."""
        return row.loose and float(time - row.time) > self._time_slack(row, row.parts[0].disk)

    def _is_past(self, time: Decimal, disks: list[int]) -> bool:
        """Whether a row lies behind what the story tells."""
        story = self.story
        if story.ending == "beyond":
            return time >= story.time - Decimal(max(self.late, self._slack_of_time(disks)))
        if story.ending == "events":
            return time >= story.time - Decimal(self._slack_of_time(disks))
        if story.ending == "collapse":  # an engine may need some rows to notice
            return abs(time - story.time) <= Decimal(max(1e3 * self._slack_of_time(disks), NOTICED * self.unit))
        return False

    def _slack_of_time(self, disks: list[int]) -> float:
        return self.close * self.free_time * max(1, *(self.counts[i] for i in disks), 1)

    def _is_tail(self, time: Decimal, i: int, wall: str) -> bool:
        """Whether a row is one of the last bounces on something round, too low for floats, before there is no answer
        any more.
        """
        before = [row for row in self.mine[i] if id(row) in self.used]
        if self.story.ending != "collapse" or not before or wall not in before[-1].walls:
            return False
        last = before[-1]
        return 0.0 < last.flight <= CUT * last.floor and float(time - self.story.time) <= 1e3 * self._time_slack(
            last, i
        )

    def _told(self, ahead: list[list[Row]]) -> str:
        nothing = f"nothing before {self.story.ending} at {float(self.story.time):.12g}"
        return "; ".join(_told(row) for rows in ahead for row in rows) or nothing

    def _next_group(self, i: int) -> list[Row]:
        rows = self.mine[i]
        while self.place[i] < len(rows) and id(rows[self.place[i]]) in self.used:
            self.place[i] += 1
        if self.place[i] == len(rows):
            return []
        group = rows[self.place[i]].group
        found = []
        for row in rows[self.place[i] :]:
            if row.group != group:
                break
            if id(row) not in self.used:
                found.append(row)
        return found

    def _is_low(self, rest: Row, wall: str, time: Decimal, i: int, number: int) -> bool:
        """Whether a bounce comes before the rest that ends its series, lower than the oracle tells them one by one."""
        if rest.kind != REST or wall not in rest.walls or float(time - rest.time) > self._time_slack(rest, i):
            return False
        self.low[i] += 1
        if self.low[i] * (1.0 - float(self.story.table.wall_restitution)) > MOST_LOW:
            raise _MistakeError(f"disk {i} does not come to rest at {float(rest.time):.12g} but bounces on", number)
        return True

    def _rests_again(self, rest: Row, wall: str, time: Decimal, i: int, number: int) -> bool:
        """Whether a disk that rests on one wall does so again at once after a low bounce on another one."""
        before = [row for row in self.seen.rows[:number] if i in (row["a"], row["b"])]
        at_once = bool(before) and self._time(before[-1]) == time and self.seen.rows[number]["impulse"] == 0.0
        return at_once and rest.kind == REST and wall not in rest.walls and time <= rest.time

    def _rests_in_doubt(self, bounce: Row, wall: str) -> bool:
        """Whether a disk rests in place of a low bounce on that wall that floats do not determine."""
        return bounce.kind == WALL and wall in bounce.walls and _is_cut(bounce) and self._is_in_doubt(bounce)

    def _early_rest(self, i: int, wall: str, number: int) -> Row | None:
        """The rest that ends the series that this disk is in, or begins by a bounce in doubt, if it may end here."""
        rows = self.mine[i]
        last = rows[self.place[i] - 1] if self.place[i] else None
        first = rows[self.place[i]]
        if not (last is not None and _is_cut(last)) and not (_is_cut(first) and self._is_in_doubt(first)):
            return None
        for place in range(self.place[i], len(rows)):
            row = rows[place]
            if row.kind == REST:
                if wall not in row.walls:
                    return None
                for skipped in rows[self.place[i] : place]:
                    self.used.add(id(skipped))
                return row
            if row.kind != WALL:
                return None
        return None

    def _ends_series(self, told: Row, left: list[Row]) -> bool:
        """Whether all that is left is the end of a series of bounces on something round, too low for floats."""
        i = told.parts[0].disk
        rows = self.mine[i]
        before = [row for row in rows if id(row) in self.used]
        if self.story.ending not in ("collapse", "beyond") or not before or before[-1].flight > CUT * before[-1].floor:
            return False
        return all(row.kind == WALL and row.parts[0].disk == i and row.walls & before[-1].walls for row in left)

    def _changes_nothing(self, number: int, disks: list[int]) -> bool:
        row = self.seen.rows[number]
        if int(row["kind"]) not in (0, 1):
            return False
        momenta = []
        for name, i in zip("ab", disks, strict=False):
            mass = self.story.table.mass[i]
            momenta.append(
                math.inf if mass is None else float(mass) * math.hypot(float(row[f"vx{name}"]), float(row[f"vy{name}"]))
            )
        return bool(row["impulse"] <= NOTHING * min(momenta))

    def _time(self, row: Any) -> Decimal:
        return Decimal(int(row["epoch"])) * exact(self.seen.epoch_length) + exact(float(row["remainder"]))

    def _time_slack(self, expected: Row, i: int) -> float:
        slack = max(self.close * self.free_time * max(1, self.counts[i]), SAFE * expected.time_error)
        if expected.kind == REST:
            on_side = self.story.table.size is not None and expected.walls & {"left", "right", "bottom", "top"}
            slack = max(slack, (CLOSE if on_side else REST_CLOSE) * float(expected.time))
        return slack

    def _compare(self, number: int, name: str, row: Any, part: Part, expected: Row, time: Decimal) -> None:
        i, many = part.disk, max(1, self.counts[part.disk])
        late = float(time - expected.time)
        if not abs(late) <= self._time_slack(expected, i):
            raise _MistakeError(
                f"disk {i}: {expected.kind} at t = {float(time):.15g}, true {float(expected.time):.15g}, off by {late:.3g}",
                number,
            )
        after = (float(row[f"vx{name}"]), float(row[f"vy{name}"]))
        wrong = math.hypot(*(float(exact(v) - true) for v, true in zip(after, part.velocity, strict=True)))
        slack = max(self.close * many * self.speed, SAFE * part.velocity_error)
        # a contact that is so much later finds a disk that has fallen so much longer
        slack += self.pull * (self._time_slack(expected, i) if expected.kind == REST else 2.0 * abs(late))
        if not wrong <= slack:
            raise _MistakeError(
                f"disk {i}: velocity {after} after {expected.kind}, true {_floats(part.velocity)}, off by {wrong:.3g}",
                number,
            )
        at = (float(row[f"x{name}"]), float(row[f"y{name}"]))
        away = self._distance(at, part.place, self.seen.corner)
        speed = math.hypot(*_floats(part.velocity))
        slack = max(self.close * many * self.length, SAFE * (part.place_error + expected.time_error * speed))
        slack += speed * (self._time_slack(expected, i) if expected.kind == REST else abs(late))  # it flew on until this contact
        if not away <= slack:
            raise _MistakeError(
                f"disk {i}: place {at} at {expected.kind}, true {_floats(part.place)} on the scene's axes, off by {away:.3g}",
                number,
            )

    def _distance(self, at: tuple[float, float], true: tuple[Decimal, Decimal], corner: tuple[float, float]) -> float:
        away = []
        for x, y, c, period in zip(at, true, corner, self.story.table.period, strict=True):
            d = exact(x) + exact(c) - y
            if period is not None:
                d = d % period
                d = min(abs(d), abs(d - period), abs(d + period))
            away.append(float(d))
        return math.hypot(*away)

    # ---- the end

    def _left(self) -> list[Row]:
        return [row for row in self.story.rows if id(row) not in self.used and not row.idle and not row.loose]

    def _ending(self) -> tuple[str, str]:
        story, seen = self.story, self.seen
        total = len(seen.rows)
        left = self._left()
        now = exact(seen.time) - exact(seen.start_time)
        if seen.stopped in STOPS and self._knows_no_more(left):
            return RIGHT, ""
        missed = [row for row in left if row.time < now - Decimal(self._time_slack(row, row.parts[0].disk))]
        if missed:
            raise _MistakeError(f"missed: {_told(missed[0])}; {seen.stopped} at {float(now):.12g}", total)
        if seen.stopped == "events":
            return RIGHT, ""
        if seen.stopped in STOPS:
            true = _told(left[0]) if left else story.ending
            return REFUSED, f"stopped by {seen.stopped} at {float(now):.9g}; true: {true}; {seen.reason}"
        if story.ending == "collapse" and now > story.time + Decimal(
            max(1e3 * self.close * self.free_time, NOTICED * self.unit)
        ):
            raise _MistakeError(f"went on to {float(now):.9g} behind {story.why} at {float(story.time):.12g}", total)
        if story.ending in ("until", "quiet"):
            if seen.stopped != story.ending and not (story.glides and seen.stopped in ("until", "quiet")):
                raise _MistakeError(f"stopped: {seen.stopped}, true: {story.ending}", total)
            self._compare_state(total)
        return RIGHT, ""

    def _knows_no_more(self, left: list[Row]) -> bool:
        """Whether a stop with a reason is behind the last contact that floats determine, or as right as what comes next."""
        if not left:
            return self.story.ending in ("collapse", "beyond")
        return left[0].may_refuse or self._is_in_doubt(left[0]) or self._ends_series(left[0], left)

    def _is_in_doubt(self, row: Row) -> bool:
        """Whether floats do not determine a contact: its time is known no better than since when its disks fly towards it."""
        rows = [self.mine[part.disk] for part in row.parts]
        begun = [mine[place - 1].time for mine in rows if (place := _place_of(row, mine)) > 0]
        return bool(begun) and SAFE * row.time_error >= float(row.time - max(begun))

    def _compare_state(self, total: int) -> None:
        seen = self.seen
        for part in self.story.state(exact(seen.time) - exact(seen.start_time)):
            i, many = part.disk, max(1, self.counts[part.disk])
            away = self._distance(tuple(seen.position[i]), part.place, (0.0, 0.0))
            if not away <= max(self.close * many * self.length, SAFE * part.place_error):
                raise _MistakeError(
                    f"disk {i}: place {tuple(seen.position[i])} at the end, true {_floats(part.place)}, off by {away:.3g}",
                    total,
                )
            wrong = math.hypot(
                *(float(exact(float(v)) - true) for v, true in zip(seen.velocity[i], part.velocity, strict=True))
            )
            if not wrong <= max(self.close * many * self.speed, SAFE * part.velocity_error):
                raise _MistakeError(
                    f"disk {i}: velocity {tuple(seen.velocity[i])} at the end, true {_floats(part.velocity)}, off by {wrong:.3g}",
                    total,
                )


def _is_cut(row: Row) -> bool:
    """Whether a series of bounces may be ended behind this one."""
    return 0.0 < row.flight <= CUT * row.floor


def _place_of(row: Row, rows: Sequence[Row]) -> int:
    return next(place for place, one in enumerate(rows) if one is row)


def _told(row: Row) -> str:
    disks, walls = [part.disk for part in row.parts], "/".join(sorted(row.walls))
    return f"{row.kind} {disks} {walls} at {float(row.time):.12g}"


def _floats(pair: tuple[Decimal, Decimal]) -> tuple[float, float]:
    return float(pair[0]), float(pair[1])


__all__ = ["KICK", "PAIR", "REFUSED", "RIGHT", "UNJUDGED", "WRONG", "Seen", "Verdict", "judge", "observe"]
