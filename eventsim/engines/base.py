"""The contract that all engines keep: what they are asked, what they return, what they hold in between."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, fields, replace
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from eventsim.errors import LogError
from eventsim.record.events import ROW, Floats, Rows, State
from eventsim.record.times import clock_times
from eventsim.replay.log import EventLog, load_log
from eventsim.scene import Scene
from eventsim.scene.stage import Stage

if TYPE_CHECKING:
    from eventsim.engines.stepped.trajectory import Trajectory
    from eventsim.measure import Measures
    from eventsim.replay.replay import Replay

Progress: TypeAlias = Callable[[float | None, int, float], None]
"""Called now and then with the fraction done (None: unknown), the events so far and the time on the scene's clock."""

OnEvent: TypeAlias = Callable[[Rows], None]
"""Called with each block of new rows (an array of ROW)."""


@dataclass(frozen=True, slots=True)
class Stop:
    """When to stop: at a time on the scene's clock, after a number of events, whichever comes first; None: not by this."""

    until: float | None = None
    events: int | None = None


@dataclass(frozen=True, slots=True)
class Snapshot:
    """All that the future of a run depends on, whichever engine holds it; see `EngineState` for the meaning of the names.

    low_vx, low_vy: empty where velocities have no low parts; low_x, low_y: where places have none.
    Calendars and cells are no part of it: they follow from the flights.
    """

    epoch: int
    window: int
    window_rows: int
    now: float
    t: tuple[float, ...]
    x: tuple[float, ...]
    y: tuple[float, ...]
    vx: tuple[float, ...]
    vy: tuple[float, ...]
    wraps_x: tuple[int, ...]
    wraps_y: tuple[int, ...]
    met: tuple[Any, ...]
    contact_time: tuple[float, ...]
    at_once: tuple[int, ...]
    low_vx: tuple[float, ...] = ()
    low_vy: tuple[float, ...] = ()
    low_x: tuple[float, ...] = ()
    low_y: tuple[float, ...] = ()


@dataclass(slots=True)
class Counters:
    """How often what happened; wraps, crossings, stale predictions and turnovers are the engine's own work, not rows.

    steps, pair_tests: the work of a stepped engine.  outer_momentum: what came from outside the disks of finite mass;
    support_force: what walls now give to the disks that rest on them, booked as if it had been so from the beginning.
    """

    events: int = 0
    pair_contacts: int = 0
    wall_contacts: int = 0
    rests: int = 0
    kicks: int = 0
    clusters: int = 0
    wraps: int = 0
    crossings: int = 0
    stale: int = 0
    turnovers: int = 0
    steps: int = 0
    pair_tests: int = 0
    deepest_overlap: float = 0.0
    outer_momentum: list[float] = field(default_factory=lambda: [0.0, 0.0])
    support_force: list[float] = field(default_factory=lambda: [0.0, 0.0])

    def copy(self) -> Counters:
        """Counters that go on on their own."""
        return replace(self, outer_momentum=list(self.outer_momentum), support_force=list(self.support_force))

    def copy_from(self, other: Counters) -> None:
        """Become equal to others."""
        for item in fields(self):
            setattr(self, item.name, getattr(other, item.name))
        self.outer_momentum = list(other.outer_momentum)
        self.support_force = list(other.support_force)


@dataclass(frozen=True, slots=True)
class Residuals:
    """How good the run is.

    energy: relative change, None where energy is not conserved.  momentum: what is not booked against walls, immovable
    disks, gravity and kicks, divided by sum m |v|.  max_overlap: the deepest overlap of a pair at contact, in reaches.
    """

    energy: float | None
    momentum: float
    max_overlap: float


class Motion(NamedTuple):
    """All disks at one time: (n,) arrays relative to the corner, and how often each wrapped around the domain."""

    x: Floats
    y: Floats
    vx: Floats
    vy: Floats
    wraps_x: NDArray[np.int64]
    wraps_y: NDArray[np.int64]


class BrokenOffError(Exception):
    """A session was interrupted while it prepared itself, and has changed nothing.

    Raised into sessions that have a property `prepares`, which says when that may be.
    """


class Session(Protocol):
    """An engine in the middle of a run."""

    stage: Stage

    @property
    def counters(self) -> Counters:
        """How often what happened."""

    @property
    def reason(self) -> str | None:
        """A sentence on why it stopped, where there is more to say."""

    @property
    def clock(self) -> tuple[int, float]:
        """Where the clock stands: (epoch, remainder)."""

    def advance(self, stop: Stop, budget: int) -> str | None:
        """Simulate until the stop or for about `budget` steps; the reason to stop, None where the budget ended first."""

    def take_rows(self) -> Rows:
        """The rows since the last call, an array of ROW; empty where no rows are kept."""

    def motion(self) -> Motion:
        """Where all disks are now; nothing is changed by it."""

    def kick(self, i: int, vx: float, vy: float) -> None:
        """Set the velocity of a disk from outside, now; a row of the log."""

    def snapshot(self) -> Snapshot:
        """All that the future depends on."""

    def restore(self, saved: Snapshot) -> None:
        """Go on from a snapshot, this engine's or another's."""


@dataclass(slots=True)
class Run:
    """What a simulation gives: the state it ended in, the log if one was kept, how good it is and why it stopped.

    begun_by: the engine that handed over to `engine`, where `auto` began with another one.
    log_path: where the log was streamed to.  measures: where they were asked for.  stopped: `until`, `events`, `quiet` (no
    event ahead), `collapse`, `digits`, `interrupted`.  reason: a sentence about that where there is more to say.  elapsed_s:
    simulating only; compile_s and write_s (waiting for rows to be written and measured) apart, seconds.  trajectory: samples,
    of a stepped engine, whose motion does not follow from its log.
    """

    scene: Scene
    engine: str
    state: State
    counters: Counters
    residuals: Residuals
    stopped: str
    reason: str | None
    digest: str | None
    elapsed_s: float
    write_s: float
    compile_s: float = 0.0
    begun_by: str | None = None
    log_path: Path | None = None
    trajectory: Trajectory | None = None
    measures: Measures | None = None
    _log: EventLog | None = None
    _replay: Replay | None = None

    def __repr__(self) -> str:
        name = self.scene.name or "a scene without a name"
        return f"Run({name}: {self.counters.events:,} events to t = {self.time!r}, stopped: {self.stopped})"

    @property
    def time(self) -> float:
        """Where the scene's clock stands."""
        return self.state.time

    @property
    def start_time(self) -> float:
        """Where the scene's clock began."""
        return self.scene.start_time

    @property
    def log(self) -> EventLog | None:
        """The log, if one was kept; one that was streamed to a file is read when first asked for."""
        if self._log is None and self.log_path is not None:
            self._log = load_log(self.log_path)
        return self._log

    def state_at(self, time: float) -> State:
        """The state at any time of the run, by replay of its log; at the time of an event, the state after it.

        Of a stepped engine: free flight from the last sample of its trajectory before.
        Raises LogError where no log was kept or the time is outside the run.
        """
        if self.trajectory is not None:
            if not self.start_time <= time <= self.time:
                raise LogError(
                    f"there is no state at time {time!r}: the run is from {self.start_time!r} to {self.time!r}"
                )
            return self.trajectory.state_at(time, self.start_time)
        from eventsim.replay.replay import Replay  # only who looks back pays for it

        log = self.log
        if log is None:
            raise LogError("state_at needs the log of the run: simulate(..., log=True)")
        if self._replay is None:
            self._replay = Replay(log)
        return self._replay.state_at(time)

    def animate(self, path: str | PathLike[str], **options: Any) -> None:
        """Write an animation to `path`: .mp4, .gif, .png (a strip of moments) or .html (a page that plays the run).

        options: those of `eventsim animate` (fps, speed or duration, begin, end, moments, size, color, trails,
        velocities, flash, dark).  Raises LogError where no log was kept, EventsimError for what does not fit.
        """
        from eventsim.show.animate import animate_with  # pictures stand above engines: loaded by who wants one

        if self.log is None:
            raise LogError("animate needs the log of the run: simulate(..., log=True)")
        animate_with(self.log, path, **options)

    def _repr_html_(self) -> str | None:
        """Return the player for a notebook; None, and so the plain text, without a log or with too large a one."""
        from eventsim.show.player.page import notebook_frame

        return None if self.log is None else notebook_frame(self.log)


def rows_from(tuples: list[tuple[Any, ...]], epoch_length: float, start_time: float) -> Rows:
    """An array of ROW from the tuples that an engine appended, the column `time` filled in."""
    rows = np.array(tuples, dtype=ROW)
    if len(rows):
        rows["time"] = clock_times(rows["epoch"], rows["remainder"], epoch_length, start_time)
    return rows
