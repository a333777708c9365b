"""Near ties: contacts that share a disk and come so close to each other that the last bits of the start decide their order.

Contacts of exactly one time are resolved jointly; of two that come one after the other, the first may turn the disk away from
the second.  So where only rounding parts them, all that follows hangs on it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import takewhile

from eventsim.engines.base import Stop
from eventsim.engines.reference.calendar import CONTACT, Event
from eventsim.engines.reference.loop import ReferenceSession
from eventsim.formulas.clock import clock_time
from eventsim.formulas.doubt import contact_doubt
from eventsim.scene import Scene
from eventsim.scene.stage import Stage, stage_of

MOST_DISKS = 1000
"""In larger scenes nobody looks: the run would take longer than the rest of a check, and what is placed by chance has no ties."""

ROWS, ROWS_PER_DISK, STEPS_PER_ROW = 50, 2, 50
"""How far the run goes: until rounding, which every contact amplifies, has made the last bits of the start unimportant."""


@dataclass(frozen=True, slots=True)
class NearTie:
    """Two contacts (a, b) that share a disk, b the name of a wall where it is one; time of the first on the scene's clock,
    and how much later the second one comes."""

    first: tuple[int, int | str]
    second: tuple[int, int | str]
    time: float
    apart: float


def near_ties(scene: Scene) -> tuple[NearTie, ...] | None:
    """The near ties in a short run of the reference engine; None in a scene of more than MOST_DISKS disks."""
    stage = stage_of(scene)
    if stage.n > MOST_DISKS:
        return None
    rows = ROWS + ROWS_PER_DISK * stage.n
    session = WatchfulSession(stage)
    session.advance(Stop(scene.until, rows), STEPS_PER_ROW * rows)
    return tuple(session.near_ties)


class WatchfulSession(ReferenceSession):
    """The reference engine, which before it resolves an instant looks at what comes next."""

    def __init__(self, stage: Stage, keep_rows: bool = False) -> None:
        super().__init__(stage, keep_rows)
        self.near_ties: list[NearTie] = []

    def near_ties_until(self, time: float) -> int:
        """How many near ties there were up to a time of the scene's clock."""
        return sum(tie.time <= time for tie in self.near_ties)

    def _resolve_instant(self) -> str | None:
        first = self.calendar.first()
        assert first is not None
        latest = first.time + self._slack(first)
        near = [
            event
            for event in takewhile(lambda event: event.time <= latest, self.calendar)
            if event.rank == CONTACT and not self.is_stale(event)
        ]
        now = [event for event in near if event.time == first.time]
        for event in near[len(now) :]:
            sharing = next((one for one in now if _disks(one) & _disks(event)), None)
            if sharing is not None and not (self._is_border(sharing) and self._is_border(event)):
                self._note(sharing, event)
        return super()._resolve_instant()

    def _slack(self, event: Event) -> float:
        """What two contact times like this one may be off by, together."""
        state, radius, t = self.state, self.stage.radius, event.time
        disks = sorted(_disks(event))
        places = [state.place(i, t) for i in disks]
        speeds = [state.speed(i, t) for i in disks]
        size = sum(abs(x) + abs(y) + float(radius[i]) for i, (x, y) in zip(disks, places, strict=True))
        (u, w), (u2, w2) = speeds[0], speeds[1] if len(speeds) > 1 else (0.0, 0.0)
        speed = math.hypot(u - u2, w - w2)
        return float(2.0 * contact_doubt(size if speed > 0.0 else 0.0, speed or 1.0, 0.0, t))

    def _is_border(self, event: Event) -> bool:
        """Whether a contact is one with an end of the domain: two of these, at right angles, may come in any order."""
        return event.b < 0 and self.stage.boundary(-1 - event.b) is not None

    def _note(self, one: Event, other: Event) -> None:
        time = clock_time(self.state.epoch, one.time, self.stage.epoch_length, self.stage.start_time)
        found = NearTie(self._contact(one), self._contact(other), time, other.time - one.time)
        if found not in self.near_ties:
            self.near_ties.append(found)

    def _contact(self, event: Event) -> tuple[int, int | str]:
        return event.a, event.b if event.b >= 0 else self.stage.wall_names[self.stage.surfaces[-1 - event.b].wall]


def _disks(event: Event) -> set[int]:
    return {event.a} if event.b < 0 else {event.a, event.b}
