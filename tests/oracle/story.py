"""What the oracle tells of a scene: rows as a log has them, each with how far floats may be from it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from decimal import Decimal

from tests.oracle.table import Table, Vector

PAIR, WALL, KICK = "pair", "wall", "kick"
"""Kinds of rows, beside `rest`."""


@dataclass(frozen=True, slots=True)
class Kick:
    """A velocity set from outside: at a time, or at the instant of a disk's contact number `after` (0: its first
    one).
    """

    disk: int
    velocity: tuple[float, float]
    time: float | None = None
    after: int | None = None


@dataclass(slots=True)
class Part:
    """A disk in a row: where it is, its velocity afterwards, and how far floats may be from both."""

    disk: int
    place: Vector
    velocity: Vector
    place_error: float
    velocity_error: float


@dataclass(slots=True)
class Row:
    """One impulse, as a log would have it.

    group: rows of one number are of one instant's cluster and come in any order.  walls: the names that a log may give.
    loose: of the rows of this group some may be missing (their impulses are not unique).  may_refuse: stopping here
    is as right. idle: it changes no velocity by more than rounding.  flight: what follows of a series of bounces: the
    time of the next one, and below which length rounding keeps flights up; 0 where it is no series.
    """

    group: int
    time: Decimal
    kind: str
    parts: tuple[Part, ...]
    walls: frozenset[str]
    time_error: float
    loose: bool = False
    may_refuse: bool = False
    idle: bool = False
    flight: float = 0.0
    floor: float = 0.0


@dataclass(slots=True)
class Story:
    """All rows that floats determine, and how it goes on.

    ending: `until`, `events`, `quiet` (nothing ahead), `collapse` (no answer from `time` on: the run must stop with a
    reason there), or `beyond` (floats do not determine what comes next).  why: a word on that.  free_times: between
    two contacts of a disk, median and mean. state(time): places and velocities at a time after the last row.
    glides: a disk moves along a wall, but for the last bits of its velocity, which may take it there some day.
    """

    table: Table
    rows: list[Row]
    ending: str
    why: str
    time: Decimal
    free_times: tuple[float, float]
    state: Callable[[Decimal], list[Part]]
    glides: bool = False


class BeyondError(Exception):
    """Floats do not determine what comes next."""


class CollapseError(Exception):
    """There is no answer from here on."""
