"""Until when a run can be believed: how far rounding has moved its disks, estimated along its rows.

Every contact moves places and velocities by last bits, and the dynamics amplify what is there.  Both are linear while errors are
small.  So one deviation is carried through the tangent map (`formulas.tangent`), and each contact adds last bits by chance.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from eventsim.measure.tangent import Deviation, Passed, Tangent
from eventsim.record.events import Rows
from eventsim.scene.contact_law import law_of_scene
from eventsim.scene.domain import Open, Periodic
from eventsim.scene.scene import Scene
from eventsim.scene.walls import parts_of

HELD = 1e-3
"""Share of the smallest reach up to which a place is said to hold."""

LAST_BIT = 2.0**-53
"""Rounding, as a share of what is rounded."""

DRAWS, SEED = 4096, 1
"""Draws of chance, used again and again, and their seed."""

UNASKED = 20_000
"""Rows that are looked at where nobody asked: a fifth of a second."""

FEWEST = 16
"""Events from which on a growth can be told."""

GENTLE = 8.0
"""Errors that grow by less than this from half of the events to all of them grow as a power of time, not by chaos."""


@dataclass(frozen=True, slots=True)
class Trust:
    """Until when positions hold.

    Attributes:
        event: the first one at which a place is off by more than `HELD` of `length`, or whose order is not sure; None: none was.
        time: of that event on the scene's clock.
        error: the largest error of a place, in shares of `length`, up to that event or the end.
        length: the smallest reach at which anything is met.
        events: rows that were looked at.
        gentle: whether errors grow as a power of time.
        reason: why there is no estimate; None where there is one.
    """

    event: int | None
    time: float | None
    error: float
    length: float
    events: int
    gentle: bool
    reason: str | None


class TrustLine:
    """Estimates until when positions hold, from the rows of a run as they come.

    >>> line = TrustLine(scene); line.write(rows); line.write(more_rows); line.found()
    """

    def __init__(self, scene: Scene, most: int | None = None) -> None:
        """Begin with a scene; most: rows after which nothing is looked at any more."""
        n = len(scene.disks)
        self._most = math.inf if most is None else most
        self._tangent = Tangent(scene, [(0.0, 0.0, 0.0, 0.0)] * n, self._round)
        self._length = smallest_reach(scene)
        self._shift = [0.0] * n
        self._met: list[int | None] = [None] * n
        draws = np.random.default_rng(SEED).uniform(-LAST_BIT, LAST_BIT, DRAWS).tolist()
        self._draws = [*draws, *draws[:3]]  # four are taken from any place on
        self._drawn = 0
        self._events, self._error = 0, 0.0
        self._halves = 0.0, 0.0
        self._event: int | None = None
        self._time: float | None = None
        self._reason = None if self._length < math.inf else "there is nothing to be met"
        self._reason = law_of_scene(scene).no_tangent or self._reason

    def write(self, rows: Rows) -> None:
        """Follow a block of rows, as far as it is needed."""
        if self._is_told():
            return
        for passed in self._tangent.follow(rows):
            if self._events >= self._most:
                self._reason = f"only the first {self._events:,} events were looked at"
                return
            self._events += 1
            self._judge(passed)
            if self._is_told():
                return

    def found(self) -> Trust:
        """Return what has been found so far."""
        before, now = self._halves
        return Trust(
            event=self._event,
            time=self._time,
            error=self._error / self._length,
            length=self._length,
            events=self._events,
            gentle=self._event is None and self._events >= FEWEST and now <= GENTLE * before,
            reason=self._reason,
        )

    def _is_told(self) -> bool:
        return self._event is not None or self._reason is not None

    def _round(self, off: Deviation, x: float, y: float, vx: float, vy: float, span: float) -> Deviation:
        """Add what rounding may do to a flight over a span of the clock."""
        dx, dy, du, dw = off
        draws, k = self._draws, self._drawn
        self._drawn = (k + 4) % DRAWS
        return (
            dx + draws[k] * (abs(x) + abs(vx) * span),
            dy + draws[k + 1] * (abs(y) + abs(vy) * span),
            du + draws[k + 2] * vx,
            dw + draws[k + 3] * vy,
        )

    def _judge(self, passed: Passed) -> None:
        """Look at the errors of the disks of a row, and at the margins to their rows before."""
        event, disks, lags = passed.event, passed.disks, passed.lags
        if passed.joint:
            self._reason = f"event {event:,} is one of several contacts at one instant"
            return
        if 0.0 in lags:
            self._reason = f"event {event:,} comes at exactly the time of another one of its disk"
            return
        off, spun = self._tangent.off, self._tangent.spun
        if spun is not None:
            for i in disks:
                self._drawn = (self._drawn + 1) % DRAWS
                spun[i] += self._draws[self._drawn - 1] * self._tangent.spin[i]
        error = max(math.hypot(off[i][0], off[i][1]) for i in disks)
        self._error = max(self._error, error)
        if event & (event + 1) == 0:
            self._halves = self._halves[1], self._error
        late = abs(passed.shift)
        unsure = False
        for i, lag, met in zip(disks, lags, passed.met, strict=True):
            # two contacts with the same thing, and nothing between them, have but one order
            unsure = unsure or (met != self._met[i] and abs(lag) < late + self._shift[i])
            self._shift[i], self._met[i] = late, met
        if unsure or error > HELD * self._length:
            self._event, self._time = event, passed.time


def smallest_reach(scene: Scene) -> float:
    """Return the smallest positive distance at which a disk meets a disk or a wall; of points, the size of what they meet."""
    radii = sorted(scene.disks.radius.tolist())
    found = [one + other for one, other in pairwise(radii)]
    if scene.walls or not isinstance(scene.domain, Open | Periodic):
        found += radii
    if not any(length > 0.0 for length in found):
        found += [part.curvature_radius() or part.length() for part in parts_of(scene.walls)]
        found += list(scene.domain.size or ())
    return min((length for length in found if length > 0.0), default=math.inf)
