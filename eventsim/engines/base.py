"""The contract that all engines keep: what they are asked, what they return, what they hold in between."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field, fields, replace
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from eventsim.engines.trajectory import Trajectory
from eventsim.errors import EventsimError
from eventsim.record.events import Floats, Rows, row_of
from eventsim.record.times import clock_times
from eventsim.scene.stage import Stage


@dataclass(frozen=True, slots=True)
class Stop:
    """When to stop: at a time on the scene's clock, after a number of events, whichever comes first; None: not by this.

    until: a Fraction is a time between two floats.
    """

    until: float | Fraction | None = None
    events: int | None = None


@dataclass(frozen=True, slots=True)
class Snapshot:
    """All that the future of a run depends on, whichever engine holds it; see `EngineState` for the meaning of the names.

    low_vx, low_vy: empty where velocities have no low parts; sides: where no disk is a point to a wall; spin: where disks have
    none; contacts: where chance does not hang on their number.
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
    sides: tuple[Any, ...] = ()
    spin: tuple[float, ...] = ()
    contacts: tuple[int, ...] = ()


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


class Motion(NamedTuple):
    """All disks at one time: (n,) arrays relative to the corner, how often each wrapped around the domain, spins if they have."""

    x: Floats
    y: Floats
    vx: Floats
    vy: Floats
    wraps_x: NDArray[np.int64]
    wraps_y: NDArray[np.int64]
    spin: Floats | None = None


class BrokenOffError(BaseException):
    """A session was interrupted while it only prepared itself (see `Session.prepares`), and has changed nothing.

    As KeyboardInterrupt it is no Exception: compilers catch these.
    """


class Session(ABC):
    """An engine in the middle of a run: what every engine is asked, with the answers of one that has nothing to add.

    Attributes:
        name: of the engine.
        stage: what is simulated.
        counters: how often what happened.
        reason: a sentence on why it stopped, where there is more to say.
        refused: whether it stopped at what it knows that it cannot resolve.
        sunk: whether it stopped at a gap that has sunk below the digits.
        compile_s: seconds spent on loading a compiler and on compiling.
        at_work, begun_by: the engine that simulates; the one that handed over to it, if one did.
        trajectory: samples of a motion that does not follow from the log; None where it does.
    """

    name: str
    reason: str | None = None
    refused = False
    sunk = False
    compile_s = 0.0
    begun_by: str | None = None
    trajectory: Trajectory | None = None

    def __init__(self, stage: Stage) -> None:
        """Begin a run; raises EventsimError where nobody can run under the law of the stage."""
        if stage.law.refusal is not None:
            raise EventsimError(stage.law.refusal)
        self.stage = stage
        self.counters = Counters()
        self.at_work = self.name

    @property
    @abstractmethod
    def clock(self) -> tuple[int, float]:
        """Where the clock stands: (epoch, remainder)."""

    @property
    def prepares(self) -> bool:
        """Whether it only prepares itself (loads a compiler, compiles), so that BrokenOffError may be raised into it."""
        return False

    @abstractmethod
    def advance(self, stop: Stop, budget: int) -> str | None:
        """Simulate until the stop or for about `budget` steps; the reason to stop, None where the budget ended first."""

    @abstractmethod
    def take_rows(self) -> Rows:
        """The rows since the last call, an array of ROW; empty where no rows are kept."""

    @abstractmethod
    def motion(self) -> Motion:
        """Where all disks are now; nothing is changed by it."""

    @abstractmethod
    def kick(self, i: int, vx: float, vy: float) -> None:
        """Set the velocity of disk i from outside, now; a row of the log."""

    @abstractmethod
    def snapshot(self) -> Snapshot:
        """All that the future depends on."""

    @abstractmethod
    def restore(self, saved: Snapshot) -> None:
        """Go on from a snapshot, this engine's or another's."""

    def break_off(self) -> None:  # noqa: B027 - most hold no rows back
        """End here: rows that were held back, because it might have begun again, can be taken."""


def rows_from(tuples: list[tuple[Any, ...]], stage: Stage) -> Rows:
    """An array of rows from the tuples that an engine appended, the column `time` filled in."""
    rows = np.array(tuples, dtype=row_of(stage.spin is not None))
    if len(rows):
        rows["time"] = clock_times(rows["epoch"], rows["remainder"], stage.epoch_length, stage.start_time)
    return rows
