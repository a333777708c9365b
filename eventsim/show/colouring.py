"""Colouring: what the colour of a disk says, and the key that tells a reader."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import Colormap, ListedColormap, to_rgba
from numpy.typing import NDArray

from eventsim.errors import EventsimError
from eventsim.measure.ensemble import ensemble_of
from eventsim.record.events import Floats
from eventsim.scene import Scene
from eventsim.scene.disks import Disks, species_among
from eventsim.show.frames import Frame
from eventsim.show.overview import Overview
from eventsim.show.palette import AMOUNTS, AMOUNTS_FROM, AMOUNTS_TO, KINDS

MODES = ("mass", "speed", "species", "contacts", "index")

FEW = 7
"""Disks up to which each has a colour of its own; the last of KINDS, yellow, is too light for a line."""

DARK_ENOUGH = 0.92
"""Of the scale of amounts: colours up to here are dark enough for lines."""

Paint = Callable[[Frame], Floats]
"""The colours (N, 4) of all disks in a frame."""


@dataclass(frozen=True, slots=True)
class Scale:
    """The key of a colour map: what it shows, from `low` to `high`; beyond: whether there is more, in the last colour.

    apart: (label, colour) of what has no place on it.
    """

    title: str
    low: float
    high: float
    beyond: bool = False
    apart: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class Kinds:
    """The key of separate colours: (label, colour) of each."""

    labels: tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class Colouring:
    """How disks are painted, and the key to it; None where the colour only tells disks apart."""

    paint: Paint
    key: Scale | Kinds | None


def colouring_of(mode: str | None, disks: Disks, overview: Overview) -> Colouring:
    """Return the colouring of a mode; None: by species where there are a few of them, else by speed.

    Raises EventsimError for a mode that does not exist or does not fit the scene.
    """
    mode = mode_named(mode) or default_mode(disks)
    if mode == "speed":
        return _by_speed(overview)
    if mode == "contacts":
        return _by_contacts(overview)
    if mode == "mass":
        return _by_mass(disks)
    if mode == "species":
        return _by_species(disks)
    return _fixed(shades_of(len(disks)), _key_of_numbers(len(disks)))


def mode_named(mode: str | None) -> str | None:
    """Return the mode; raise EventsimError where there is none of that name."""
    if mode is not None and mode not in MODES:
        raise EventsimError(f"there is no colouring {mode!r}; there are {', '.join(MODES)}")
    return mode


def default_mode(disks: Disks) -> str:
    """Return the mode that suits: species where there are a few of them, else speed."""
    return "species" if 1 < len(species_of(disks)[1]) <= len(KINDS) else "speed"


def own_colours(disks: Disks) -> Floats:
    """Return the colours (N, 4) that tell disks apart: of their species where there are a few of them, else of their numbers."""
    if default_mode(disks) == "species":
        return _of_kinds(species_of(disks)[0])
    return shades_of(len(disks))


def shades_of(n: int) -> Floats:
    """Return a colour (n, 4) for each of n disks: unlike ones where they are few, else along a scale, dark enough for lines."""
    if n <= FEW:
        return _of_kinds(np.arange(n))
    shades: Floats = amounts()(np.linspace(0.0, DARK_ENOUGH, n))
    return shades


def _key_of_numbers(n: int) -> Scale | Kinds | None:
    if n > FEW:
        return Scale("disk", 0.0, n - 1.0)
    return Kinds(tuple((str(k) if k else "disk 0", KINDS[k]) for k in range(n))) if n > 1 else None


def amounts() -> Colormap:
    """Return the colour map of amounts, from 0 to 1."""
    return ListedColormap(colormaps[AMOUNTS](np.linspace(AMOUNTS_FROM, AMOUNTS_TO, 256)))


def species_of(disks: Disks) -> tuple[NDArray[np.int64], Floats]:
    """Return the species of each disk (N,), and radius and mass of each species (S, 2), the largest first."""
    found = species_among(disks)
    return len(found.count) - 1 - found.of, np.column_stack([found.radius, found.mass])[::-1]


def _fixed(colours: Floats, key: Scale | Kinds | None) -> Colouring:
    return Colouring(lambda frame: colours, key)


def _mapped(amount: Callable[[Frame], Floats], scale: Scale) -> Colouring:
    colours = amounts()
    return Colouring(lambda frame: colours((amount(frame) - scale.low) / (scale.high - scale.low)), scale)


def _by_speed(overview: Overview) -> Colouring:
    scale = Scale("speed", 0.0, overview.usual, beyond=overview.falls or overview.fastest > overview.usual)
    return _mapped(lambda frame: np.hypot(*frame.state.velocity.T), scale)


def _by_contacts(overview: Overview) -> Colouring:
    most = max(int(overview.contacts.max(initial=0)), 1)
    return _mapped(lambda frame: frame.contacts.astype(np.float64), Scale("contacts", 0.0, float(most)))


def _by_mass(disks: Disks) -> Colouring:
    finite = np.isfinite(disks.mass)
    masses = disks.mass[finite]
    if len(masses) == 0 or masses.min() == masses.max():
        values = np.unique(disks.mass)
        labels = tuple((f"mass {value:g}", KINDS[place]) for place, value in enumerate(values.tolist()))
        return _fixed(_of_kinds(np.searchsorted(values, disks.mass).astype(np.int64)), Kinds(labels))
    low, high = float(masses.min()), float(masses.max())
    colours = amounts()((np.where(finite, disks.mass, high) - low) / (high - low))
    colours[~finite] = to_rgba(KINDS[6])
    apart = () if finite.all() else (("mass inf", KINDS[6]),)
    return _fixed(colours, Scale("mass", low, high, apart=apart))


def _by_species(disks: Disks) -> Colouring:
    species, kinds = species_of(disks)
    if len(kinds) > len(KINDS):
        raise EventsimError(
            f"there are {len(kinds)} species (pairs of radius and mass), and colours for {len(KINDS)}: "
            "colour by mass, speed, contacts or index"
        )
    return _fixed(_of_kinds(species), Kinds(species_labels(disks)))


def species_labels(disks: Disks) -> tuple[tuple[str, str], ...]:
    """Return (label, colour) of the species, as many as there are colours: their names, or radius and mass of those without."""
    names = [str(name) for name in species_among(disks).name[::-1]]
    if all(names) and len(set(names)) == len(names):
        return tuple(zip(names, KINDS, strict=False))
    kinds = species_of(disks)[1][: len(KINDS)]
    by_mass = len(np.unique(kinds[:, 1])) > 1
    texts = [f"r {radius:.3g}, m {mass:.3g}" if by_mass else f"r {radius:.3g}" for radius, mass in kinds.tolist()]
    return tuple(zip(texts, KINDS, strict=False))


def measured_labels(scene: Scene) -> list[tuple[str, str]]:
    """Return (label, colour) of the species as `measure` counts them; those of pictures."""
    ensemble, labels = ensemble_of(scene), species_labels(scene.disks)
    places = species_of(scene.disks)[0]
    found = []
    for kind, one in enumerate(ensemble.species):
        place = int(places[np.flatnonzero(ensemble.species_of == kind)[0]])
        mixed = np.isnan(one.radius) or place >= len(labels)
        found.append((f"species {kind}", KINDS[kind % len(KINDS)]) if mixed else labels[place])
    return found


def _of_kinds(species: NDArray[np.int64]) -> Floats:
    colours: Floats = np.array([to_rgba(colour) for colour in KINDS])[species]
    return colours
