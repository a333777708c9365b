"""The layout of what happened: kinds of events, rows of a log, and the state of all disks at one time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import IntEnum
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple, TypeAlias, get_type_hints

import numpy as np
from numpy.typing import NDArray

from eventsim.errors import EventsimError
from eventsim.meant import NamesMeant
from eventsim.notebook import few, html_table

if TYPE_CHECKING:
    from eventsim.scene import Scene

Rows: TypeAlias = NDArray[np.void]
Floats: TypeAlias = NDArray[np.float64]
Column: TypeAlias = NDArray[Any]


class Kind(IntEnum):
    """What a row of the log records; the number is the code in arrays and in the digest."""

    PAIR = 0
    WALL = 1
    REST = 2
    KICK = 3

    @property
    def label(self) -> str:
        """The text that files show for this kind."""
        return self.name.lower()


LABELS = tuple(kind.label for kind in Kind)


class Field(NamedTuple):
    """A column of the log.

    Attributes:
        type: of its numbers, little-endian.
        missing: what stands where there is none; None: there always is one.
        kept: A compact log has it too; replay computes the others.
        steady: It hardly changes from row to row.
        labelled: Its numbers are codes, for which files show texts.
    """

    type: str
    missing: float | None = None
    kept: bool = False
    steady: bool = False
    labelled: bool = False


FLOAT = Field("<f8", missing=np.nan)
DISK = Field("<i4", kept=True)


class Columns:
    """The columns of a log as attributes, in the order of its rows.

    This is the one place that lists them.  Rows, files and compact logs follow; what goes into the digest is `record.digest`'s.
    """

    event: Annotated[Column, Field("<i8", kept=True)]
    time: Annotated[Column, Field("<f8")]
    kind: Annotated[Column, Field("<i4", kept=True, steady=True, labelled=True)]
    a: Annotated[Column, DISK]
    b: Annotated[Column, DISK._replace(missing=-1)]
    wall: Annotated[Column, Field("<i4", missing=-1, kept=True, steady=True, labelled=True)]
    xa: Annotated[Column, FLOAT]
    ya: Annotated[Column, FLOAT]
    vxa: Annotated[Column, FLOAT]
    vya: Annotated[Column, FLOAT]
    xb: Annotated[Column, FLOAT]
    yb: Annotated[Column, FLOAT]
    vxb: Annotated[Column, FLOAT]
    vyb: Annotated[Column, FLOAT]
    impulse: Annotated[Column, FLOAT]
    joint: Annotated[Column, Field("<i8", missing=-1, kept=True, steady=True)]
    epoch: Annotated[Column, Field("<i8", kept=True, steady=True)]
    remainder: Annotated[Column, Field("<f8", kept=True)]


class SpinColumns(Columns):
    """The same of scenes whose disks have spin: angular velocities after the contact."""

    spin_a: Annotated[Column, FLOAT]
    spin_b: Annotated[Column, FLOAT]


def _columns(kind: type[Columns]) -> tuple[str, ...]:
    return tuple(get_type_hints(kind))


FIELDS: dict[str, Field] = {
    name: hint.__metadata__[0] for name, hint in get_type_hints(SpinColumns, include_extras=True).items()
}
COLUMNS: tuple[str, ...] = _columns(Columns)
SPINS: tuple[str, ...] = tuple(name for name in FIELDS if name not in COLUMNS)
"""The columns that only scenes with spin have."""

SPIN_ROW = np.dtype([(name, FIELDS[name].type) for name in (*COLUMNS, *SPINS)])
"""A row of a scene whose disks have spin."""

ROW = np.dtype([(name, FIELDS[name].type) for name in COLUMNS])
"""One row per impulse; b, wall and joint are -1 and floats NaN where there is none.  128 bytes without gaps: two cache lines."""

OFFSETS = {name: int(field[1]) for name, field in (ROW.fields or {}).items()}
"""Where each column lies in a row, bytes."""

COMPACT_COLUMNS: tuple[str, ...] = tuple(name for name, field in FIELDS.items() if field.kept)
"""What a compact log keeps; replay computes the others."""


def columns_of(spin: bool) -> tuple[str, ...]:
    """Return the names of the columns of full rows, of a scene with or without spin."""
    return (*COLUMNS, *SPINS) if spin else COLUMNS


def row_of(spin: bool) -> np.dtype[Any]:
    """Return the type of such rows."""
    return SPIN_ROW if spin else ROW


def has_spins(rows: Rows) -> bool:
    """Whether rows are those of a scene with spin."""
    return rows.dtype == SPIN_ROW


def blank_rows(count: int, spin: bool = False) -> Rows:
    """Return `count` rows in which everything is missing: zeros for event, epoch and kind, else -1 or NaN."""
    rows = np.zeros(count, dtype=row_of(spin))
    for name in columns_of(spin):
        missing = FIELDS[name].missing
        if rows.dtype[name].kind == "f":
            rows[name] = np.nan
        elif missing is not None:
            rows[name] = missing
    return rows


def joined(blocks: Sequence[Rows], spin: bool | None = None) -> Rows:
    """Return blocks of rows as one; empty ones may be of either type.  spin: which there would be, if nobody tells."""
    told = [rows for rows in blocks if len(rows)]
    if told:
        row = told[0].dtype  # numpy compares the names of columns block by block, and copies row by row: not so what has none
        return np.concatenate([rows.view(f"V{row.itemsize}") for rows in told]).view(row)
    return blocks[0] if blocks and spin is None else blank_rows(0, bool(spin))


def unchangeable(rows: NDArray[Any]) -> NDArray[Any]:
    """Return the same rows, or numbers, as an array that cannot be written to, for whoever only looks."""
    view = rows.view()
    view.flags.writeable = False
    return view


def _are_equal(mine: Floats | None, its: Floats | None) -> bool:
    return mine is its if mine is None or its is None else np.array_equal(mine, its)


@dataclass(frozen=True, slots=True, repr=False)
class State(NamesMeant):
    """Where all disks are at one time.

    time: on the scene's clock. position, velocity: float64 arrays (N, 2) on the scene's axes, as in a scene file;
    along a period the position lies inside the domain.  Arrays cannot be written to: a simulation takes velocities by
    `set_velocity`, and a copy is anybody's own.  scene: what the disks are; None where that is not known.
    spin: angular velocities (N,); None where disks have none.
    """

    time: float
    position: Floats
    velocity: Floats
    scene: Scene | None = field(default=None, compare=False)
    spin: Floats | None = None

    def __post_init__(self) -> None:
        for name in ("position", "velocity", "spin"):
            if (values := getattr(self, name)) is not None:
                object.__setattr__(self, name, unchangeable(values))

    def __eq__(self, other: object) -> bool:
        """Whether another state has the same time, places, velocities and spins: equal numbers, not nearly equal ones."""
        if not isinstance(other, State):
            return NotImplemented
        pairs = ((getattr(self, name), getattr(other, name)) for name in ("position", "velocity", "spin"))
        return self.time == other.time and all(_are_equal(mine, its) for mine, its in pairs)

    def __hash__(self) -> int:
        return hash((self.time, len(self.position)))

    def __repr__(self) -> str:
        return f"State(time = {self.time!r}, {len(self.position)} disks)"

    def _repr_html_(self) -> str:
        columns = (*self.position.T.tolist(), *self.velocity.T.tolist())
        rows = [["..."] * 5 if i < 0 else [i, *(column[i] for column in columns)] for i in few(len(self.position))]
        return html_table(repr(self), ("disk", "x", "y", "vx", "vy"), rows)

    @property
    def energy(self) -> float:
        """Kinetic (of rotation too) and, under gravity, potential energy (0 at the point (0, 0)) of the disks of finite mass.

        Raises EventsimError where a state was made without its scene.
        """
        mass = self._masses()
        energy = 0.5 * float(mass @ (self.velocity**2).sum(axis=1))
        if self.spin is not None and self.scene is not None:
            disks = self.scene.disks
            energy += 0.5 * float((mass * disks.moments()) @ (disks.radius * self.spin) ** 2)
        if self.scene is not None and self.scene.gravity is not None:
            energy -= float(mass @ (self.position @ np.array(self.scene.gravity)))
        return energy

    @property
    def momentum(self) -> tuple[float, float]:
        """The momentum (x, y) of the disks of finite mass.  Raises EventsimError where a state was made without its scene."""
        x, y = (self._masses() @ self.velocity).tolist()
        return x, y

    def _masses(self) -> Floats:
        """Masses (N,), 0 of what cannot be deflected."""
        if self.scene is None:
            raise EventsimError("the masses of this state are not known: it was made without its scene")
        mass = self.scene.disks.mass
        return np.where(np.isfinite(mass), mass, 0.0)
