"""What comes first, and whether floats can tell: predictions, ties, and the decisions that end the judging.

A decision is in doubt where `SAFE` standard deviations of rounding, grown along the trajectory, exceed its margin: the time to
the next contact of one of its disks, the width of a miss, the distance from the end of a wall.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from decimal import Decimal

from tests.oracle.digits import sign
from tests.oracle.doubt import SAFE, NoDoubt
from tests.oracle.search import IMPACT, LEAVE, LOOK, REST, Call, Found, Meeting
from tests.oracle.state import State, size
from tests.oracle.story import BeyondError, CollapseError
from tests.oracle.table import Line

LOST = 1e-4
"""Errors of this part of the scene's size are no small deviations any more."""

NONE = 1e-8
"""What is left of errors that cancel, in maps that are known as well as that."""

ROUND, ENDLESS = 20, Decimal("1e-250")
"""So many contacts within such a part of the time are taken for the end of infinitely many."""


def first_of(run: State) -> Meeting | None:
    """The earliest of all that is known to be ahead."""
    first: Meeting | None = None
    for found in run.ahead.values():
        for one in found:
            if one.meeting is not None and (first is None or one.meeting.time < first.time):
                first = one.meeting
    for meeting in run.rest_due.values():
        if first is None or meeting.time <= first.time:
            first = meeting
    if first is not None and first.how == REST:
        struck = [m for m in meetings_of(run, {first.a}) if m.how == IMPACT and m.time == first.time]
        return struck[0] if struck else first  # a rest is no contact, and comes after those of its instant
    return first if first is None or not (first.at_end or first.how == LEAVE) else _leaving(run, first)


def _leaving(run: State, first: Meeting) -> Meeting:
    """A point that slides to the end of its wall leaves it there: only then it is beside what else ends there.

    Unless that makes a corner with its wall.
    """
    if run.flights[first.a].held is None or run.table.radius[first.a] > 0:
        return first
    for other in meetings_of(run, {first.a}):
        if other.b < 0 and other.how == IMPACT and may_tie(run, other, first) and run.is_in_corner(other):
            return other
    if first.how == LEAVE:
        return first
    leaves = [other for other in meetings_of(run, {first.a}) if other.how == LEAVE and may_tie(run, other, first)]
    return leaves[0] if leaves else first


def meetings_of(run: State, disks: set[int]) -> list[Meeting]:
    """What is ahead of these disks."""
    found = [
        one.meeting
        for pair, several in run.ahead.items()
        if pair[0] in disks or pair[1] in disks
        for one in several
        if one.meeting is not None and one.meeting.how != LOOK
    ]
    return found + [m for i, m in run.rest_due.items() if i in disks]


def predict(run: State, disks: Sequence[int] | range) -> None:
    """Look anew for what these disks meet."""
    fresh = set(disks)
    for key in [key for key in run.ahead if key[0] in fresh or key[1] in fresh]:
        del run.ahead[key]
    for i in fresh:
        for j in range(run.n):
            if j != i and not (j in fresh and j < i):
                look_at(run, min(i, j), max(i, j))
        for k in range(len(run.table.shapes)):
            look_at(run, i, -1 - k)
        if run.flights[i].held is not None:
            slide = run.search.slide(i, run.flights[i], run.now)
            if slide is not None:
                run.ahead[i, -1 - len(run.table.shapes)] = [slide]


def look_at(run: State, a: int, b: int) -> None:
    """Search for the meetings of a disk with another one, or with shape -1 - b; keep what floats may not tell."""
    flight = run.flights[a]
    found = (
        run.search.pair(a, b, flight, run.flights[b], run.now)
        if b >= 0
        else run.search.wall(a, -1 - b, flight, run.now)
    )
    kept = []
    for one in found:
        calls = [call for call in one.calls if is_doubtful(run, call, a, b)]
        if one.meeting is not None or calls:
            kept.append(Found(one.meeting, calls))
    if kept:
        run.ahead[a, b] = kept
    else:
        run.ahead.pop((a, b), None)


def look_again(run: State, meeting: Meeting) -> None:
    """Repeat a search for images, which sees only so far."""
    look_at(run, meeting.a, meeting.b if meeting.b >= 0 else -1 - meeting.shape)


def is_doubtful(run: State, call: Call, a: int, b: int) -> bool:
    """Whether floats may take a close decision the other way."""
    delay = float(call.time - run.flights[a].time)
    bound = run.doubt.error(a, delay)
    terms = [(a, delay, *call.pull)]
    if b >= 0:
        delay_b = float(call.time - run.flights[b].time)
        bound += run.doubt.error(b, delay_b)
        terms.append((b, delay_b, -call.pull[0], -call.pull[1]))
    size = max(1.0, math.hypot(*call.pull))
    if SAFE * bound * size <= call.margin:
        return False
    spread = run.doubt.spread(terms)
    return SAFE * spread > call.margin and spread > NONE * bound * size


def demand_calls(run: State, time: Decimal) -> None:
    """Stop the judging where a close decision before `time` could have been another one."""
    for found in run.ahead.values():
        for one in found:
            for call in one.calls:
                if call.time <= time and (one.meeting is None or call.time <= one.meeting.time):
                    raise BeyondError("a graze, or the end of a wall")


def demand_before(run: State, first: Meeting, stop: Decimal) -> None:
    """Stop the judging where a meeting may be before or after a stop."""
    terms, apart = time_terms(run, first), abs(float(stop - first.time))
    bound = sum((abs(hx) + abs(hy)) * run.doubt.error(i, t) for i, t, hx, hy in terms)
    if SAFE * bound > apart and SAFE * run.doubt.spread(terms) > apart:
        raise BeyondError("a contact at the very time of a stop")


def demand_clear(run: State, stop: Decimal, first: Meeting | None) -> None:
    """Stop the judging where a stop may come after what is ahead, or what is ahead is not known until then."""
    demand_calls(run, stop)
    for i, flight in enumerate(run.flights):
        if not SAFE * run.doubt.error(i, float(stop - flight.time)) <= LOST * run.large:
            raise BeyondError("growth")
    if first is not None and first.how != LOOK:
        demand_before(run, first, stop)


def demand_ends(run: State) -> None:
    """Where doubt is put aside: rounds of contacts that no number of digits can tell apart do not end."""
    if not isinstance(run.doubt, NoDoubt) or len(run.rows) <= ROUND:
        return
    if 0 < run.now - run.rows[-ROUND].time < ENDLESS * run.now:
        raise CollapseError("rounds of contacts that do not end")


def demand_small(run: State, disks: Sequence[int]) -> None:
    """Stop the judging where errors are no small deviations any more."""
    for i in disks:
        speed = max(size((run.flights[i].u, run.flights[i].w)), 1e-300)
        late = run.doubt.speed_error(i) / speed
        if not (SAFE * run.doubt.error(i, 0.0) <= LOST * run.large and SAFE * late < 1e100):
            raise BeyondError("growth")


def time_terms(run: State, m: Meeting) -> list[tuple[int, float, float, float]]:
    """The meeting's time as a linear function of the deviations: minus the gap's over its rate."""
    if m.how in (LOOK, REST):
        return []
    if m.how == LEAVE:
        one = run.table.shapes[m.shape]
        assert isinstance(one, Line)
        f = run.flights[m.a]
        _, _, u, w = f.at(m.time)
        ex, ey = float(one.along[0] / one.norm), float(one.along[1] / one.norm)
        rate = ex * float(u) + ey * float(w)
        return [(m.a, float(m.time - f.time), -ex / rate, -ey / rate)] if rate != 0.0 else []
    nx, ny, rate = run.closing(m)
    if rate == 0.0:
        return []
    f = run.flights[m.a]
    terms = [(m.a, float(m.time - f.time), -nx / rate, -ny / rate)]
    if m.b >= 0:
        terms.append((m.b, float(m.time - run.flights[m.b].time), nx / rate, ny / rate))
    return terms


def lateness(run: State, m: Meeting) -> float:
    """The standard deviation of the time of a meeting."""
    return run.doubt.spread(merged(time_terms(run, m)))


def cluster_of(run: State, first: Meeting) -> list[Meeting]:
    """The meetings at exactly that time that are connected with the first one through disks; stops where floats
    cannot tell which.
    """
    cluster, disks = [first], set(first.disks)
    if first.how in (LEAVE, REST):
        demand_order(run, first, disks, cluster)
        return cluster
    grown = True
    while grown:
        grown = False
        for other in meetings_of(run, disks):
            if other in cluster or other.how in (LEAVE, REST) or is_same(run, other, cluster):
                continue
            if (
                sign(other.time - first.time, abs(first.time) + abs(run.flights[other.a].time)) == 0
                if may_tie(run, other, first)
                else False
            ):
                cluster.append(other)
                disks |= set(other.disks)
                grown = True
    demand_order(run, first, disks, cluster)
    return cluster


def may_tie(run: State, other: Meeting, first: Meeting) -> bool:
    """Whether two times agree in the digits of any round."""
    gap = other.time - first.time
    return gap <= abs(first.time) * Decimal("1e-30") + Decimal("1e-300")


def is_same(run: State, other: Meeting, cluster: list[Meeting]) -> bool:
    """Whether a contact is with what continues a wall of the cluster, in the same direction: one contact with two
    names.
    """
    if other.b >= 0 or other.how in (LEAVE, REST):
        return False
    for one in cluster:
        if one.b < 0 and one.a == other.a and one.image == other.image and other.shape in run.kin(one.shape):
            (nx, ny), (mx, my) = run.normal(one), run.normal(other)
            if nx * mx + ny * my > 0 and abs(nx * my - ny * mx) < Decimal("1e-5"):
                return True
    return False


def demand_order(run: State, first: Meeting, disks: set[int], cluster: list[Meeting]) -> None:
    """Stop the judging where another contact of these disks may come first, or a tie may be none."""
    mine = time_terms(run, first)
    for other in meetings_of(run, disks):
        if other is first or is_same(run, other, [first]) or is_shut_in(run, other, first):
            continue
        later = float(other.time - first.time)
        theirs = time_terms(run, other)
        both = mine + [(i, t, -hx, -hy) for i, t, hx, hy in theirs]
        bound = sum((abs(hx) + abs(hy)) * run.doubt.error(i, t) for i, t, hx, hy in both)
        if SAFE * bound <= later or bound == 0.0:
            continue
        spread = run.doubt.spread(merged(both))
        if other in cluster:
            if spread > NONE * bound and not at_right_angles(run, first, other):
                raise BeyondError("a tie of what has been rounded")
        elif SAFE * spread > later and spread > 0.0:
            raise BeyondError("order")


def is_shut_in(run: State, other: Meeting, first: Meeting) -> bool:
    """Whether a point slides to an end of its wall that is exactly on what it meets there: it does not leave it.

    Nor does it meet what only begins there, where it leaves.
    """
    if (other.how == LEAVE) == (first.how == LEAVE) or run.flights[other.a].held is None or run.table.radius[other.a] > 0:
        return False
    if first.how == LEAVE and not other.at_end:
        return False
    return may_tie(run, other, first) and sign(other.time - first.time, abs(first.time)) == 0


def at_right_angles(run: State, one: Meeting, other: Meeting) -> bool:
    """Whether two walls are along the axes, and at right angles: their contacts do not feel each other."""
    if one.b >= 0 or other.b >= 0:
        return False
    (nx, ny), (mx, my) = run.normal(one), run.normal(other)
    return nx * mx + ny * my == 0


def merged(terms: list[tuple[int, float, float, float]]) -> list[tuple[int, float, float, float]]:
    """Terms of one disk added up, so that what cancels cancels."""
    total: dict[tuple[int, float], list[float]] = {}
    for i, t, hx, hy in terms:
        one = total.setdefault((i, t), [0.0, 0.0])
        one[0] += hx
        one[1] += hy
    rows: list[tuple[int, float, float, float]] = [(i, t, h[0], h[1]) for (i, t), h in total.items()]
    return rows
