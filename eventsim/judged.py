"""validate(): engines against the event-driven run, from Python: those that there are, or one of your own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias, overload

import numpy as np

from eventsim.errors import EventsimError
from eventsim.meant import NamesMeant
from eventsim.readers import read_samples, samples_in
from eventsim.readers.contacts import ToldContacts, read_contacts, told_from
from eventsim.readers.samples import Samples, checked
from eventsim.scene import Scene
from eventsim.validation.compare import Comparison, compare
from eventsim.validation.competitors import chosen_competitors
from eventsim.validation.judge.faults import Fault
from eventsim.validation.judge.judgement import Judgement, judge
from eventsim.validation.judge.stepping import Step, stepped
from eventsim.validation.judge.table import judgement_data
from eventsim.validation.judge.words import contacts_in_short, judged_in_words
from eventsim.validation.verdict import verdict

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

Source: TypeAlias = "str | PathLike[str] | Sequence[Any]"
"""A file; or arrays: (times, positions) or (times, positions, velocities), or a DataFrame with the columns of such a file; of
contacts rows (time, a, b[, wall])."""


@dataclass(frozen=True, slots=True)
class Judged(NamesMeant):
    """What an engine's motion is worth: print it, or ask for the numbers.

    Attributes:
        judgement: all numbers.
    """

    judgement: Judgement

    @property
    def verdict(self) -> list[str]:
        """The verdict in sentences, the first wrong event first."""
        return judged_in_words(self.judgement)

    @property
    def first_fault(self) -> Fault | None:
        """The first wrong event, with its kind, time and disks; None where there is none."""
        return self.judgement.first_fault

    @property
    def compared(self) -> int:
        """The contacts that were compared: without any, that no wrong event was seen says nothing."""
        return self.judgement.compared

    def to_dict(self) -> dict[str, Any]:
        """All numbers as plain values: the keys of `eventsim validate --json`."""
        return judgement_data(self.judgement)

    def save_figure(self, path: str | PathLike[str]) -> None:
        """Draw it to the file `path`: .png, .svg or .pdf."""
        from eventsim.show.versus.judgement import write_judgement

        write_judgement(self.judgement, path)

    def __str__(self) -> str:
        return "\n".join([*self.verdict, contacts_in_short(self.judgement)])

    def __repr__(self) -> str:
        return f"Judged({self.judgement.source} on {self.judgement.name}: {self.verdict[0]})"


@overload
def validate(
    scene: Scene,
    *,
    trajectory: Source,
    contacts: Source | None = ...,
    dt: float | None = ...,
    until: float | None = ...,
    tolerance: float | None = ...,
) -> Judged: ...


@overload
def validate(scene: Scene, *, step: Step, dt: float, until: float | None = ..., tolerance: float | None = ...) -> Judged: ...


@overload
def validate(
    scene: Scene, *, against: Sequence[str] = ..., dt: float | Sequence[float] | None = ..., until: float | None = ...
) -> Comparison: ...


def validate(
    scene: Scene,
    *,
    trajectory: Source | None = None,
    contacts: Source | None = None,
    step: Step | None = None,
    dt: float | Sequence[float] | None = None,
    until: float | None = None,
    tolerance: float | None = None,
    against: Sequence[str] = (),
) -> Judged | Comparison:
    """Compare engines with the event-driven run of a scene.

    With `trajectory` or `step`: judge one engine by its motion. Without: compare the time-stepped engines that there are.

    Args:
        scene: what is simulated.
        trajectory: a file of positions at times (.csv, .npz, .parquet, .xyz, .gsd), or arrays: times (T,), positions (T, n, 2)
            and, if you like, velocities (T, n, 2); or a DataFrame with the columns time, disk, x, y.
        contacts: those that the engine tells: a file with the columns time, a, b (-1: a wall), or rows (time, a, b[, wall]).
            None: they are read from the paths.
        step: a function step(position, velocity, dt) that returns both after dt, or changes them in place and returns None.
        dt: the step; of a trajectory the time between frames that tell none; without both, one or several steps to compare.
        until: when to stop; None: when the scene, or the trajectory, does.
        tolerance: how far apart the times of one contact may be; None: two steps and what a disk needs for a tenth of a diameter.
        against: the engines to compare with, or one; none: all.

    Raises:
        EventsimError: for what is no motion of this scene, or arguments that do not go together.
    """
    if trajectory is not None and step is not None:
        raise EventsimError("trajectory and step: give one of them")
    if trajectory is None and step is None:
        if contacts is not None or tolerance is not None:
            raise EventsimError("contacts and tolerance belong to a trajectory")
        steps = None if dt is None else np.atleast_1d(np.asarray(dt, dtype=np.float64)).tolist()
        compared = compare(scene, chosen_competitors(against), steps, until)
        return replace(compared, verdict=tuple(verdict(compared)))
    if dt is not None and not isinstance(dt, float | int):
        raise EventsimError(f"dt = {dt!r}: must be a number: one engine has one step")
    if step is not None:
        if contacts is not None:
            raise EventsimError("contacts belong to a trajectory: those of a step are read from its paths")
        if dt is None:
            raise EventsimError("step: give its dt, too")
        done = stepped(scene, step, dt, until)
        found = judge(scene, done.samples, tolerance=tolerance)
        found.elapsed = done.elapsed
        return Judged(found)
    assert trajectory is not None
    samples = _samples(trajectory, dt)
    told = None if contacts is None else _contacts(contacts, len(scene.disks), samples.counted)
    return Judged(judge(scene, samples, told, tolerance, until))


def _samples(trajectory: Source, dt: float | None) -> Samples:
    """A motion from a file or from arrays."""
    if isinstance(trajectory, str | PathLike):
        return read_samples(Path(trajectory), dt)
    table: Any = trajectory
    if hasattr(table, "items"):  # a DataFrame, or a dict of columns
        return samples_in([(str(name), np.asarray(column)) for name, column in table.items()], "the table", dt)
    try:
        times, *arrays = (np.asarray(values, dtype=np.float64) for values in trajectory)
    except (TypeError, ValueError):
        times, arrays = np.empty(0), []
    if len(arrays) not in (1, 2) or any(array.ndim != 3 for array in arrays):
        raise EventsimError(
            "trajectory: must be a file, (times, positions) or (times, positions, velocities), or a DataFrame of time, disk, x, y"
        )
    velocity = arrays[1][..., :2] if len(arrays) == 2 else None
    return checked(Samples("the arrays", times, arrays[0][..., :2], velocity))


def _contacts(contacts: Source | ArrayLike, n: int, counted: int) -> ToldContacts:
    """Contacts from a file or from rows, of disks that are counted as those of the motion."""
    if isinstance(contacts, str | PathLike):
        return read_contacts(Path(contacts), n, counted)
    try:
        given: Any = contacts
        rows = [(float(time), float(a), float(b), str(*wall)) for time, a, b, *wall in given]
    except (TypeError, ValueError):
        raise EventsimError('contacts: must be rows (time, a, b) or (time, a, b, "wall"), b = -1 at a wall') from None
    numbers = np.array([row[:3] for row in rows]).reshape(-1, 3)
    return told_from(numbers[:, 0], numbers[:, 1], numbers[:, 2], [row[3] for row in rows], n, "the contacts", counted)
