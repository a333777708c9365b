"""Contact by contact: which of the contacts that lie ahead of an exact state an engine finds, and which others it reports.

Two runs of a chaotic scene part within a few contacts of each disk, and then nothing can be matched.  So an engine is set on
the exact state again and again, and followed for a fraction of a mean free time each time.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from eventsim.engines import Engine
from eventsim.engines.stepped import IN_A_ROW, StepOptions
from eventsim.record.contacts import Key, contacts_of, keys_of
from eventsim.record.events import Kind, Rows
from eventsim.validation.follow import follow
from eventsim.validation.truth import Truth, restarted

RESTARTS = 12
"""How often an engine is set on the exact state."""

STRETCH = 0.5
"""Mean free times that it is followed for."""

FEW_STEPS = 3
"""Steps that a stretch has at least."""


@dataclass(slots=True)
class Census:
    """How many contacts are ahead of exact states, and what an engine made of them.

    exact: contacts ahead.  found: of them, reported once.  missed: not reported.  doubled: reported again though the pair (or
    disk and wall) meets once.  spurious: reported of a pair that does not meet.  angles: between the velocities after a found
    contact and the exact ones, radians, one per disk.
    """

    exact: int = 0
    found: int = 0
    missed: int = 0
    doubled: int = 0
    spurious: int = 0
    angles: list[float] = field(default_factory=list)

    def share(self, count: int) -> float:
        """A count as a fraction of the contacts ahead; nan where there are none."""
        return count / self.exact if self.exact else float("nan")

    @property
    def angle(self) -> float:
        """The mean deflection-angle error, degrees; nan where nothing was found."""
        return float(np.degrees(np.mean(self.angles))) if self.angles else float("nan")


def census(truth: Truth, engine: Engine, options: StepOptions, dt: float) -> Census:
    """Set an engine on exact states of the run and compare what it finds ahead; rows of the truth are the exact contacts.

    A contact that is reported late counts although it falls just behind the end of a stretch.
    """
    total = Census()
    stretch = max(STRETCH * truth.mean_free_time, FEW_STEPS * dt)
    late = options.late * dt
    exact = contacts_of(truth.run.rows)
    last = float(truth.times[-1])
    for place in _spread(len(truth.times), RESTARTS):
        time = float(truth.times[place])
        end = time + stretch
        if end + late > last:
            break
        state = truth.run.position[place], truth.run.velocity[place]
        session = engine.open(restarted(truth.stage, *state, time), options=options)
        rows = contacts_of(follow(session, [end, end + late]).rows)
        rows = first_of_each(rows, IN_A_ROW * dt) if options.spread else rows
        ahead = exact[(exact["time"] > time) & (exact["time"] <= end)]
        behind = exact[(exact["time"] > end) & (exact["time"] <= end + late)]
        _count(total, ahead, rows[rows["time"] <= end], behind, rows[rows["time"] > end])
    return total


def first_of_each(rows: Rows, within: float) -> Rows:
    """Rows without those that follow one of the same two within a time: an impulse over several steps is one contact."""
    last: dict[Key, float] = {}
    kept = np.zeros(len(rows), dtype=bool)
    for place, (key, time) in enumerate(zip(keys_of(rows), rows["time"].tolist(), strict=True)):
        kept[place] = time > last.get(key, -np.inf) + within
        last[key] = time
    return rows[kept]


def _spread(count: int, most: int) -> Sequence[int]:
    """Up to `most` of `count` places, evenly spread."""
    places: Sequence[int] = np.unique(np.linspace(0, count - 1, min(most + 1, count)).astype(int)).tolist()
    return places


def _count(total: Census, ahead: Rows, rows: Rows, behind: Rows, late: Rows) -> None:
    """Add one stretch: exact contacts ahead and rows of the engine, and both just behind the end of the stretch."""
    wanted, reported = Counter(keys_of(ahead)), Counter(keys_of(rows))
    excused, afterwards = Counter(keys_of(behind)), Counter(keys_of(late))
    for key, count in wanted.items():
        got = reported[key] + min(afterwards[key], max(count - reported[key], 0))
        total.exact += count
        total.found += min(count, got)
        total.missed += max(count - got, 0)
        total.doubled += max(reported[key] - count - excused[key], 0)
    for key, got in reported.items():
        if key not in wanted:
            total.spurious += max(got - excused[key], 0)
    total.angles += _angles(ahead, np.concatenate([rows, late]))


def _angles(ahead: Rows, rows: Rows) -> list[float]:
    """Angles between velocities after the contacts that are the first of both disks in both logs."""
    exact, engine = _firsts(ahead), _firsts(rows)
    angles = []
    for key, row in exact.items():
        other = engine.get(key)
        if other is None or key[0] != Kind.PAIR:
            continue
        for x, y in (("vxa", "vya"), ("vxb", "vyb")):
            cross = row[x] * other[y] - row[y] * other[x]
            dot = row[x] * other[x] + row[y] * other[y]
            angles.append(float(abs(np.arctan2(cross, dot))))
    return angles


def _firsts(rows: Rows) -> dict[Key, np.void]:
    """The rows that are the first of all their disks."""
    seen: dict[int, int] = defaultdict(int)
    found = {}
    for key, row in zip(keys_of(rows), rows, strict=True):
        disks = (key[1], key[2]) if key[0] == Kind.PAIR else (key[1],)
        if not any(seen[i] for i in disks):
            found[key] = row
        for i in disks:
            seen[i] += 1
    return found


def longest_stuck(rows: Rows, dt: float) -> float:
    """The longest time for which a disk meets the same wall step after step; 0 where none does.

    Two rows of a disk and a wall belong together if no more than one step and a half lies between them.
    """
    walls = rows[rows["kind"] == Kind.WALL]
    walls = walls[np.lexsort((walls["time"], walls["wall"], walls["a"]))]
    longest = 0.0
    begun = 0
    for k in range(1, len(walls) + 1):
        if (
            k == len(walls)
            or walls["a"][k] != walls["a"][begun]
            or walls["wall"][k] != walls["wall"][begun]
            or walls["time"][k] - walls["time"][k - 1] > 1.5 * dt
        ):
            longest = max(longest, float(walls["time"][k - 1] - walls["time"][begun]))
            begun = k
    return longest
