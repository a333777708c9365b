"""Rows of a log to look at: one event, some of them, a data frame."""

from __future__ import annotations

import operator
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, Never, cast, overload

import numpy as np

from eventsim.errors import EventsimError, LogError
from eventsim.meant import NamesMeant
from eventsim.notebook import few, html_table
from eventsim.record.digest import digest_of
from eventsim.record.events import FIELDS, LABELS, Column, Kind, Rows, SpinColumns, columns_of, has_spins, unchangeable
from eventsim.record.places import on_scene_axes
from eventsim.record.provenance import Provenance
from eventsim.scene.corner import corner_of
from eventsim.scene.walls import parts_of

if TYPE_CHECKING:
    import pandas as pd

PLACES = {"xa": 0, "ya": 1, "xb": 0, "yb": 1}
"""Columns of places, with their axes."""


class Event(NamedTuple):
    """One row of a log, on the scene's axes; `b` is -1 and `wall` empty where there is none, and numbers NaN.

    The columns of the log, but for its exact clock.
    """

    event: int
    time: float
    kind: str
    a: int
    b: int
    wall: str
    xa: float
    ya: float
    vxa: float
    vya: float
    xb: float
    yb: float
    vxb: float
    vyb: float
    impulse: float
    joint: int

    def __repr__(self) -> str:
        met = f" and {self.b}" if self.b >= 0 else f" at {self.wall}" if self.wall else ""
        return f"Event({self.event}: {self.kind} of disk {self.a}{met} at t = {self.time!r})"


SHOWN = ("event", "time", "kind", "a", "b", "wall", "xa", "ya", "impulse")
"""Columns of the table in a notebook."""


def _no_row(place: object) -> str:
    """What to write where rows of a log are asked for by something else than a number."""
    if isinstance(place, str):
        named = f": it is a column, log.{place}" if place in FIELDS else ""
        return f"log[{place!r}] is no row{named}"
    return (
        f"log[{type(place).__name__}]: rows go by one number, a slice, or an array of numbers or of True and False, one a row; "
        "choose among them in log.rows or log.to_pandas()"
    )


def _places(place: object) -> Column | None:
    """Several rows as an array of their numbers, or of whether each is meant; None for what is neither."""
    if not isinstance(place, np.ndarray | list):
        return None
    several = np.asarray(place)
    return several if several.ndim == 1 and several.dtype.kind in "biu" else None


class Excerpt(NamesMeant, SpinColumns):
    """Some rows of a log.

    Every column is an attribute holding a read-only array (`rows.time`, `rows.vxa`, ...), `spin_a` and `spin_b` only where disks
    have spin: `kind` holds codes
    (`kinds` the text), `wall` indices into `provenance.wall_names` (`wall_name` the text).  Places are relative to
    `corner`; `rows[i]` and `to_pandas()` give those on the scene's axes.
    """

    def __init__(self, provenance: Provenance, rows: Rows) -> None:
        view = unchangeable(rows)
        self.provenance = provenance
        self.rows = view
        for name in columns_of(has_spins(rows)):
            setattr(self, name, view[name])

    def __len__(self) -> int:
        return len(self.rows)

    def __eq__(self, other: object) -> bool:
        """Whether other rows tell the same events: their digests are equal.  Compact logs are made full for it."""
        if not isinstance(other, Excerpt):
            return NotImplemented
        return self is other or (len(self) == len(other) and self.digest() == other.digest())

    def __hash__(self) -> int:
        return hash(len(self))

    def __array__(self, *_: object, **__: object) -> Never:
        """Refuse: rows have columns of several types."""
        raise LogError("a log is no array of one type: log.rows is a structured one, log.time, log.xa, ... are its columns")

    def digest(self) -> str:
        """Return the SHA-256 of these rows (see `eventsim.record.digest`)."""
        return digest_of(self.rows)

    @overload
    def __getitem__(self, place: int) -> Event: ...
    @overload
    def __getitem__(self, place: slice | list[int] | list[bool] | Column) -> Excerpt: ...

    def __getitem__(self, place: int | slice | list[int] | list[bool] | Column) -> Event | Excerpt:
        """One event, its places on the scene's axes, or some rows, whose columns count places from `corner` as those here do."""
        if isinstance(place, slice):
            return Excerpt(self.provenance, self.rows[place])
        if (several := _places(place)) is not None:
            try:
                return Excerpt(self.provenance, self.rows[several])
            except IndexError as error:
                raise IndexError(f"there are no such rows: {error}") from None
        try:
            number = operator.index(cast("int", place))
        except TypeError:
            raise LogError(_no_row(place)) from None
        if not -len(self) <= number < len(self):
            raise IndexError(f"there is no row {number}: the log has {len(self)}")
        row = self.rows[number : number + 1 or None]
        values: dict[str, Any] = {name: row[name][0].item() for name in Event._fields}
        values |= {name: float(self._place(row[name], name)[0]) for name in PLACES}
        values["kind"] = LABELS[values["kind"]]
        values["wall"] = self.provenance.wall_names[values["wall"]] if values["wall"] >= 0 else ""
        return Event(**values)

    def __repr__(self) -> str:
        return f"Excerpt({len(self)} rows)"

    def _repr_html_(self) -> str:
        rows = [["..."] * len(SHOWN) if i < 0 else [getattr(self[i], name) for name in SHOWN] for i in few(len(self))]
        return html_table(repr(self), SHOWN, rows)

    @cached_property
    def kinds(self) -> Column:
        """The kinds as text, an array of str (rows,)."""
        texts: Column = np.array(LABELS)[self.kind]
        return texts

    @cached_property
    def wall_name(self) -> Column:
        """The names of the walls as text, an array of str (rows,), empty where there is none."""
        texts: Column = np.array([*self.provenance.wall_names, ""])[self.wall]
        return texts

    def to_pandas(self) -> pd.DataFrame:
        """A pandas DataFrame with the columns of the log: kinds and walls as names, places on the scene's axes.

        Raises EventsimError without pandas.
        """
        try:
            import pandas as pd
        except ImportError:
            raise EventsimError("a data frame is made by pandas: pip install pandas") from None
        columns: dict[str, Any] = {name: self.rows[name].copy() for name in columns_of(has_spins(self.rows))}
        columns |= {name: self._place(columns[name], name) for name in PLACES}
        columns["kind"] = pd.Categorical.from_codes(columns["kind"], [kind.label for kind in Kind])
        columns["wall"] = pd.Categorical.from_codes(columns["wall"], list(self.provenance.wall_names))
        return pd.DataFrame(columns)

    def _place(self, values: Column, name: str) -> Column:
        """A column of places on the scene's axes."""
        axis, period = PLACES[name], self.provenance.scene.domain.period
        told = np.isfinite(values)
        placed = values.copy()
        placed[told] = on_scene_axes(values[told], self.corner[axis], period[axis])
        return placed

    @property
    def corner(self) -> tuple[float, float]:
        """The point of the scene from which places in rows count."""
        scene = self.provenance.scene
        return self.provenance.corner or corner_of(scene.disks, scene.domain, parts_of(scene.walls))
