"""The disks of a scene at its start: where they are, how they move, how large and heavy they are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from eventsim.errors import SceneError
from eventsim.letters import is_name
from eventsim.notebook import few, html_table

Floats: TypeAlias = NDArray[np.float64]
Names: TypeAlias = NDArray[np.str_]

USUAL = {"spin": 0.0, "moment": 0.5}
"""What disks have of these where nobody says."""


@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class Disks:
    """N disks as read-only float64 arrays.

    Attributes:
        position: centres, shape (N, 2), length.
        velocity: shape (N, 2), length / time.
        radius: shape (N,), length; 0 is a point.
        mass: shape (N,); inf cannot be deflected (a post or a moving obstacle), 0 deflects nobody (a tracer).
        species: shape (N,), names, "" where a disk has none of its own; None where no disk has one.
        spin: shape (N,), angular velocities, 1 / time; None where all are 0.
        moment: shape (N,), moments of inertia I / m r^2; None where all are 1/2.
    """

    position: Floats
    velocity: Floats
    radius: Floats
    mass: Floats
    species: Names | None
    spin: Floats | None
    moment: Floats | None

    def __init__(
        self,
        position: ArrayLike,
        velocity: ArrayLike | None = None,
        radius: ArrayLike | None = None,
        mass: ArrayLike = 1.0,
        species: str | Sequence[str] | Names | None = None,
        spin: ArrayLike | None = None,
        moment: ArrayLike | None = None,
    ) -> None:
        """Disks at `position` (N, 2); velocity (N, 2) or None for rest; of all others (N,), or one for all.

        A radius must be given: points are asked for by radius=0.

        Raises:
            SceneError: if the shapes do not fit together or an entry is not a number.
        """
        if radius is None:
            raise SceneError("disks.radius is missing: give one for all disks or one for each (0 is a point)")
        problems: list[str] = []
        centres = _floats(position, "position", problems)
        if centres.size == 0:
            centres = centres.reshape(0, 2)
        if centres.ndim != 2 or centres.shape[1] != 2:
            problems.append(f"disks.position has the shape {centres.shape}: must be (N, 2)")
        if problems:
            raise SceneError(problems)
        count = len(centres)
        at_rest = np.zeros((count, 2))
        given: dict[str, ArrayLike] = {"velocity": at_rest if velocity is None else velocity, "radius": radius, "mass": mass}
        given |= {key: value for key, value in (("spin", spin), ("moment", moment)) if value is not None}
        wanted = {**dict.fromkeys(given, (count,)), "velocity": (count, 2)}
        arrays = {"position": centres}
        for key, value in given.items():
            known = len(problems)
            array = _floats(value, key, problems)
            if array.size == 0 and count == 0:
                array = array.reshape(wanted[key])
            if array.ndim == 0 and key != "velocity":
                array = np.full(count, array)
            if array.shape != wanted[key] and len(problems) == known:
                shape = f"{wanted[key]}" if key == "velocity" else f"{wanted[key]} or a single number"
                problems.append(f"disks.{key} has the shape {array.shape}: must be {shape}")
            arrays[key] = array
        names = _names(species, count, problems)
        if problems:
            raise SceneError(problems)
        object.__setattr__(self, "species", names)
        for key, array in arrays.items():
            array.setflags(write=False)
            object.__setattr__(self, key, array)
        for key, usual in USUAL.items():
            if key not in arrays or np.all(arrays[key] == usual):
                object.__setattr__(self, key, None)

    def __len__(self) -> int:
        return len(self.position)

    def __repr__(self) -> str:
        kinds = len(species_among(self).count) if len(self) else 0
        return f"Disks({len(self)} of {kinds} kind{'' if kinds == 1 else 's'} of radius and mass)"

    def _repr_html_(self) -> str:
        columns = (*self.position.T.tolist(), *self.velocity.T.tolist(), self.radius.tolist(), self.mass.tolist())
        rows = [["..."] * 7 if i < 0 else [i, *(column[i] for column in columns)] for i in few(len(self))]
        return html_table(repr(self), ("disk", "x", "y", "vx", "vy", "radius", "mass"), rows)

    def select(self, index: NDArray[np.int64]) -> Disks:
        """The disks with these numbers, in this order; index: (M,) whole numbers."""
        return Disks(**{key: array[index] for key, array in self._arrays().items()})

    def begun_at(self, position: ArrayLike, velocity: ArrayLike, spin: ArrayLike | None = None) -> Disks:
        """The same disks elsewhere, position and velocity (N, 2), spin (N,); None: their own."""
        turning = {} if spin is None else {"spin": spin}
        return Disks(**{**self._arrays(), "position": position, "velocity": velocity, **turning})

    def spins(self) -> Floats:
        """The angular velocities (N,)."""
        return np.zeros(len(self)) if self.spin is None else self.spin

    def moments(self) -> Floats:
        """The moments I / m r^2 (N,)."""
        return np.full(len(self), USUAL["moment"]) if self.moment is None else self.moment

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Disks):
            return NotImplemented
        mine, theirs = self._arrays(), other._arrays()
        return mine.keys() == theirs.keys() and all(np.array_equal(array, theirs[key]) for key, array in mine.items())

    def __hash__(self) -> int:
        # Adding 0.0 turns -0.0 into 0.0: equal disks have equal hashes.
        arrays = self._arrays().values()
        return hash(tuple((array + 0.0 if array.dtype == np.float64 else array).tobytes() for array in arrays))

    def _arrays(self) -> dict[str, Any]:
        """What the disks have, by the name of the argument."""
        found = {key: getattr(self, key) for key in KEYS}
        return {key: array for key, array in found.items() if array is not None}


KEYS = tuple(item.name for item in fields(Disks))
"""What disks may have: the arguments of Disks, in their order."""


@dataclass(frozen=True, slots=True)
class Species:
    """The kinds of disks: S triples of a radius, a mass and a name, in the order of these.

    radius, mass, name, count: (S,) of each kind, name "" of one without; and how many disks it has.  first: (S,) the first of
    them.  of: (N,) the kind of each disk.
    """

    radius: Floats
    mass: Floats
    name: Names
    count: NDArray[np.int64]
    first: NDArray[np.int64]
    of: NDArray[np.int64]


def species_among(disks: Disks) -> Species:
    """The kinds that there are among disks; O(N log N)."""
    radii, radius_code = np.unique(disks.radius, return_inverse=True)
    masses, mass_code = np.unique(disks.mass, return_inverse=True)
    names, name_code = np.unique(_named(disks), return_inverse=True)
    codes, first, of, count = np.unique(
        (radius_code * len(masses) + mass_code) * len(names) + name_code,
        return_index=True, return_inverse=True, return_counts=True,
    )  # fmt: skip
    codes, name_of = np.divmod(codes, max(len(names), 1))
    radius_of, mass_of = np.divmod(codes, max(len(masses), 1))
    return Species(radii[radius_of], masses[mass_of], names[name_of], count, first, of)


def named_species(disks: Disks) -> tuple[tuple[str, ...], NDArray[np.int64]]:
    """The names of the species, in the order of the scene, and which of them each disk is, (N,).

    Disks without a name of their own are one species where radius and mass are equal: 0, 1, ... in the order of the scene.
    """
    found = species_among(disks)
    order = np.argsort(found.first, kind="stable")
    unnamed = iter(range(len(order)))
    names: list[str] = []
    number = np.empty(len(order), np.int64)
    for kind in order.tolist():
        name = str(found.name[kind]) or str(next(unnamed))
        if name not in names:
            names.append(name)
        number[kind] = names.index(name)
    return tuple(names), number[found.of]


def _named(disks: Disks) -> Names:
    return np.full(len(disks), "", np.str_) if disks.species is None else disks.species


def join(parts: list[Disks]) -> Disks:
    """All the disks of `parts`, in order, as one."""
    if not parts:
        return Disks(np.empty((0, 2)), radius=0.0)
    named = any(part.species is not None for part in parts)
    return Disks(
        np.concatenate([part.position for part in parts]),
        np.concatenate([part.velocity for part in parts]),
        np.concatenate([part.radius for part in parts]),
        np.concatenate([part.mass for part in parts]),
        np.concatenate([_named(part) for part in parts]) if named else None,
        np.concatenate([part.spins() for part in parts]) if any(part.spin is not None for part in parts) else None,
        np.concatenate([part.moments() for part in parts]) if any(part.moment is not None for part in parts) else None,
    )


def _names(value: str | Sequence[str] | Names | None, count: int, problems: list[str]) -> Names | None:
    """A fresh copy (count,) of names of species; None where there are none."""
    if value is None:
        return None
    if isinstance(value, str):
        value = [value] * count
    names = np.array(value)
    if names.size and (names.dtype.kind != "U" or not all(isinstance(name, str) for name in value)):
        problems.append("disks.species: every entry must be a text")
        return None
    names = names.astype(np.str_)
    if names.shape != (count,):
        problems.append(f"disks.species has the shape {names.shape}: must be ({count},) or a single text")
        return None
    wrong = [name for name in np.unique(names).tolist() if name and not (is_name(name) and "-" not in name)]
    problems += [f"disks.species = {name!r}: must be one line without control characters and hyphens" for name in wrong]
    names.setflags(write=False)
    return names if (names != "").any() else None


def _floats(value: ArrayLike, key: str, problems: list[str]) -> Floats:
    """A fresh float64 copy of the value: whoever gave it may go on changing theirs."""
    try:
        found = np.asarray(value)
        if found.dtype.kind in "USc":  # NumPy would read texts, and drop what is imaginary
            raise TypeError
        return np.array(found, dtype=np.float64)
    except (TypeError, ValueError):
        problems.append(f"disks.{key}: every entry must be a number, and the rows must have equal lengths")
    except OverflowError:
        problems.append(f"disks.{key}: an entry is too large for a number")
    return np.empty(0)


def typical_speed(vx: Floats, vy: Floats) -> float:
    """The root mean square of speeds, vx and vy of one shape."""
    return float(np.sqrt(np.mean(vx**2 + vy**2)))
