"""Why contacts pile up at an instant: the diagnosis of an inelastic collapse from the last rows of a run.

A collapse is a geometric series: each round of contacts takes r < 1 times as long as the one before, and all of them are over
after a finite time.  Where the rounds have become too short for the clock, that time is known, and it is now.  Where the
gaps sank below the digits of the positions before, the last rounds are noise, and nothing can be told.

Source: S. McNamara, W. R. Young, Phys. Fluids A 4, 496 (1992), doi:10.1063/1.858323.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from eventsim.engines.endless import is_endless
from eventsim.formulas.doubt import AT_ONCE, kept_up_instant
from eventsim.record.events import Floats, Kind, Rows
from eventsim.scene.settling import remedy_of
from eventsim.scene.stage import Stage

TAIL = 1024
"""Rows that are looked at: several times what a sequence at one instant may have."""

SETTLED = 2.0**-20
"""A last round shorter than this part of the first one was not cut off by the digits of the positions."""

CLEAN = 2.0**10
"""Rounds so many times as long as the last ones are known well enough to tell their ratio, which the last digits blur."""

CLEAN_OF_SUNK = 2.0
"""The same of a series that was stopped when its gaps had a few last bits left."""

MANY_DISKS = 8
"""More disks are counted, not named."""

LAST_ROUNDS = 4
"""The ratio is that of so many rounds, the last ones that are known well, where it has settled."""


KEPT = 2.0**-10
"""Where the last rounds change velocities no less, but for this part, gaps close because nothing stops what closes them."""

STEADY = 1.005
"""Ratios of rounds that differ by no more than this factor are one; near the critical restitution they drift by more."""

SEEN = 1e-9
"""A series of which less than this part of the time is left is over at that time, which is written with nine digits."""

RECENT = 6
"""The disks of a series are those that are connected through so many rows at its end."""

SQUEEZED = "speeds do not fall: one is squeezed between others, or walls, that it cannot deflect"
"""What there is to say where no contact duration helps: the room goes, and not the motion."""

LIES_STILL = (
    "what lies still on another disk, on several walls or on a round one is not modelled; begin with gaps, and with a "
    "contact_duration, which keeps bounces up"
)
"""What is left to do about a pile without any motion, which no contact duration can keep up."""


class Rounds(NamedTuple):
    """How the contacts of some disks came closer to each other.

    disks: those that meet at the last instant.  number: how many rounds followed each other ever faster.  ratio: how long the
    last ones took, each in terms of the one before; nan where there were none.  first, last: the longest and the shortest.
    ends_now: whether a series with this ratio is over within what the clock can tell.  steady: whether the ratio has settled.
    kept_up: whether the last ones change velocities no less.
    """

    disks: list[int]
    number: int
    ratio: float
    first: float
    last: float
    ends_now: bool
    steady: bool
    kept_up: bool


def diagnosis(rows: Rows, stage: Stage, clock: tuple[int, float], time: float) -> tuple[str, str] | None:
    """(stopped, sentence) from the last rows of a run that does not end at an instant; None where they say nothing.

    clock, time: that instant, (epoch, remainder) and on the scene's clock.
    """
    instant = kept_up_instant(stage.law.loss()) if stage.settles else AT_ONCE
    rounds = rounds_before_the_end(rows, stage.epoch_length, clock, instant)
    if rounds is None or (rounds.number < 2 and stage.gravity is not None):  # what rests there has no rounds to show
        return None
    if rounds.number < 2:
        _, remedy = _called(rounds.disks, stage, _are_kept_up(rows, rounds.disks))
        return _of_an_instant(rows, rounds.disks, stage, time) or (
            "digits",
            f"the contacts of {named(rounds.disks)} at time {time:.9g} follow one another faster than the digits of float64 can "
            f"tell, without a steady ratio before: they may or may not end; {remedy}",
        )
    return _of_rounds(rounds, stage, time, rounds.ends_now or rounds.last < SETTLED * rounds.first)


def _of_an_instant(rows: Rows, disks: list[int], stage: Stage, time: float) -> tuple[str, str] | None:
    """The same of contacts that all come at one instant, as of disks that stick; None where they are not known to have no end.

    No gap tells anything there, and none has to: the map of a round is of velocities alone.  Where it has no end, impulses fall
    from round to round by its eigenvalue, in no time, and no flight comes after them.
    """
    mine = _of_these(rows[(rows["kind"] == Kind.PAIR) | (rows["kind"] == Kind.WALL)][-TAIL:], disks)
    if not is_endless(mine, stage):
        return None
    last, before = mine[-1], mine[:-1]
    same = (before["a"] == last["a"]) & (before["b"] == last["b"]) & (before["wall"] == last["wall"])
    ratio = float(last["impulse"] / before["impulse"][same][-1])
    what, remedy = _called(disks, stage, abs(ratio - 1.0) < KEPT)
    return "collapse", (
        f"{what} of {named(disks)} at time {time:.9g}: contacts at that instant, in rounds of which each has "
        f"{ratio:.3g} of the impulses of the one before, and there is no end of them; {remedy}"
    )


def _called(disks: list[int], stage: Stage, kept_up: bool) -> tuple[str, str]:
    """What a series is called, and what is left to do; kept_up: whether speeds do not fall from round to round.

    So they do between disks that are not deflected: there the contacts take no motion, it is the room that goes.
    """
    if kept_up and stage.mass is not None and np.any(np.isinf(stage.mass[disks]) | (stage.mass[disks] == 0.0)):
        return "contacts without end", SQUEEZED
    return "inelastic collapse", remedy_of(stage)


def diagnosis_of_sunk(rows: Rows, stage: Stage, time: float) -> tuple[str, str] | None:
    """The same of a run that stops because a gap has sunk below the digits; None where no rounds came before.

    A series is a collapse if the map of a round says that it has no end; without such a map, if its ratio has become steady.
    """
    rows = rows[(rows["kind"] == Kind.PAIR) | (rows["kind"] == Kind.WALL)][-TAIL:]
    if len(rows) == 0:
        return None
    disks = _connected(rows[-RECENT:])
    mine = _of_these(rows, disks)
    times = (mine["epoch"] - mine["epoch"][-1]) * stage.epoch_length + mine["remainder"]
    rounds = _series(disks, mine, times, 0.0, CLEAN_OF_SUNK)
    if rounds.number < 2:
        return None
    told = is_endless(mine, stage)
    return _of_rounds(rounds, stage, time, rounds.steady if told is None else told)


def _of_rounds(rounds: Rounds, stage: Stage, time: float, collapses: bool) -> tuple[str, str]:
    names = named(rounds.disks)
    series = (
        f"{rounds.number} rounds of contacts, the last ones each {rounds.ratio:.3g} times as long as the one before"
    )
    what, remedy = _called(rounds.disks, stage, rounds.kept_up)
    if collapses:
        if rounds.last * rounds.ratio <= (1.0 - rounds.ratio) * SEEN * abs(time):
            return "collapse", f"{what} of {names} at time {time:.9g}: {series}; {remedy}"
        return "collapse", (
            f"{what} of {names} soon after time {time:.9g}: {series}, and there is no end of them; the gaps sank "
            f"below the digits of float64 when a round still took {rounds.last:.2g}; {remedy}"
        )
    return "digits", (
        f"{names}: {series}, then the gaps sank below the digits of float64 at time {time:.9g}, when a round still took "
        f"{rounds.last:.2g}; whether the contacts ever end cannot be told with these digits; {remedy}"
    )


def rounds_before_the_end(
    rows: Rows, epoch_length: float, clock: tuple[int, float], instant: float = AT_ONCE
) -> Rounds | None:
    """The rounds of the disks that met at the last instant; None where nothing came before it, or no row is of it.

    instant: the share of the clock within which contacts are at one instant.
    """
    rows = rows[(rows["kind"] == Kind.PAIR) | (rows["kind"] == Kind.WALL)][-TAIL:]
    if len(rows) == 0:
        return None
    # Times before the end: epochs are whole numbers, so nothing is lost by a late clock.
    before = (clock[0] - rows["epoch"]) * epoch_length + (clock[1] - rows["remainder"])
    end = len(rows) * instant * clock[1]
    at_once = before <= end
    if not at_once[-1]:
        return None
    disks = _connected(rows[at_once])
    inside = np.isin(rows["a"], disks) & ((rows["b"] < 0) | np.isin(rows["b"], disks))
    if not (inside & ~at_once).any():
        return None
    mine = rows[inside]
    times = -np.concatenate([before[inside & ~at_once], before[inside & at_once][:1]])
    return _series(disks, mine, times, end, CLEAN)


def _series(disks: list[int], rows: Rows, times: Floats, end: float, clean: float) -> Rounds:
    """The rounds of rows at these times: as many rows as there are different contacts make one."""
    period = _period(rows)
    return _rounds(disks, rows, times[period:] - times[:-period] if len(times) > period else times[:0], period, end, clean)


def _period(rows: Rows) -> int:
    """How many different contacts there are."""
    return len(set(zip(rows["a"].tolist(), rows["b"].tolist(), rows["wall"].tolist(), strict=True)))


def _rounds(disks: list[int], rows: Rows, lengths: Floats, period: int, end: float, clean: float) -> Rounds:
    """The longest series of rounds that became shorter and shorter; none of those after it, which are noise, was as long.

    end: a time that is as good as none.  clean: see CLEAN.
    """
    best, last, count, longest = 0, 0, 0, 0.0
    counts = []
    for k, length in enumerate(lengths.tolist()):
        count = count + 1 if k and 0.0 < length < lengths[k - 1] else 1
        counts.append(count)
    for k in reversed(range(len(counts))):
        if lengths[k] > longest:
            longest = float(lengths[k])
            if counts[k] > best:
                best, last = counts[k], k
    if best < 2 * period:
        return Rounds(disks, best // period, math.nan, math.nan, math.nan, False, False, False)
    series = lengths[last + 1 - best : last + 1]
    ratio = _ratio(series, period, clean * float(lengths[last:].min()))
    ends_now = float(series[-1]) * ratio <= (1.0 - ratio) * 2.0 * end
    kept_up = _is_kept_up(rows[: last + period + 1], period, min(best // period, LAST_ROUNDS))
    first, final = float(series[0]), float(series[-1])
    return Rounds(disks, best // period, ratio, first, final, ends_now, _is_steady(series, period), kept_up)


def _is_kept_up(rows: Rows, period: int, rounds: int) -> bool:
    """Whether the last round changes velocities as much as one some rounds before, or more."""
    before: dict[int, tuple[float, float]] = {}
    changes = np.zeros(len(rows))
    for k, row in enumerate(rows):
        for i, u, w in ((row["a"], row["vxa"], row["vya"]), (row["b"], row["vxb"], row["vyb"])):
            if i >= 0:
                after = float(u), float(w)
                changes[k] = max(changes[k], math.dist(after, before.get(int(i), after)))
                before[int(i)] = after
    now, then = (float(changes[end - period : end].sum()) for end in (len(rows), len(rows) - rounds * period))
    return now > (1.0 - KEPT) * then


def _are_kept_up(rows: Rows, disks: list[int]) -> bool:
    """The same of the last contacts of disks with each other and with walls, which may all be at one instant."""
    mine = _of_these(rows[(rows["kind"] == Kind.PAIR) | (rows["kind"] == Kind.WALL)][-TAIL:], disks)
    period = _period(mine)
    return len(mine) > LAST_ROUNDS * period and _is_kept_up(mine, period, LAST_ROUNDS)


def _is_steady(series: Floats, period: int) -> bool:
    """Whether the last rounds all took the same share of the one before."""
    ratios = series[period:] / series[:-period]
    last = ratios[-4 * period : -period]  # the very last gaps have lost most of their digits
    return len(last) >= 2 * period and float(last.max()) <= STEADY * float(last.min())


def _ratio(series: Floats, period: int, clean: float) -> float:
    """How long rounds took in terms of the one before: the last ones of a series of which none, if possible, is below `clean`."""
    whole = (len(series) - 1) // period
    while True:
        known = (int((series >= clean).sum()) - 1) // period
        if known >= min(whole, LAST_ROUNDS):
            break
        clean *= 0.5
    rounds = min(known, LAST_ROUNDS)
    end = 1 + int(np.flatnonzero(series >= clean)[-1])
    return math.pow(series[end - 1] / series[end - 1 - rounds * period], 1.0 / rounds)


def _of_these(rows: Rows, disks: list[int]) -> Rows:
    """The rows of contacts of these disks with each other and with walls."""
    return rows[np.isin(rows["a"], disks) & ((rows["b"] < 0) | np.isin(rows["b"], disks))]


def _connected(rows: Rows) -> list[int]:
    """The disks that are connected with the last row's through rows, in order."""
    disks = {int(i) for i in (rows["a"][-1], rows["b"][-1]) if i >= 0}
    for a, b in zip(rows["a"][::-1].tolist(), rows["b"][::-1].tolist(), strict=True):
        if a in disks or b in disks:
            disks |= {i for i in (a, b) if i >= 0}
    return sorted(disks)


def named(disks: list[int]) -> str:
    """The disks in words."""
    if len(disks) > MANY_DISKS:
        return f"{len(disks)} disks, {', '.join(map(str, disks[:3]))}, ..."
    return f"disk {disks[0]}" if len(disks) == 1 else f"disks {', '.join(map(str, disks))}"
