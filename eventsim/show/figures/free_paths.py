"""Free paths: how far a disk flies between contacts with other disks, against kinetic theory.

A disk of speed v meets others at a rate nu(v) proportional to the mean of |v - v'| over Maxwell's v'; its free paths are
exponential with the mean v / nu(v), so the paths of all are a mixture of exponentials. Its mean is 1 / (2 sqrt 2 rho d g), with
g = (Z - 1) / (2 eta) and Henderson's Z = (1 + eta^2 / 8) / (1 - eta)^2.
Source: S. Chapman, T. G. Cowling, The Mathematical Theory of Non-uniform Gases (1970), 5.2; D. Henderson, Molecular Physics
30, 971 (1975), doi:10.1080/00268977500102511.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from eventsim.errors import LogError
from eventsim.record.events import Floats, Kind
from eventsim.record.log import EventLog
from eventsim.show.figures.demands import replay_with_time, with_events
from eventsim.show.figures.style import BLUE, LENGTH, ORANGE, label, name_of
from eventsim.show.flights import FlightTable, flight_table

BINS, LONGEST = 40, 6.0
"""Bins, up to this many mean free paths."""

FEWEST = 20
"""Free paths below which there is nothing to say about how they are distributed."""


def draw(figure: Figure, log: EventLog) -> None:
    """Draw the distribution of free paths between pair contacts, reflections at walls passed over."""
    with_events(log, Kind.PAIR)
    paths = free_paths(flight_table(replay_with_time(log)))
    if len(paths) < FEWEST:
        raise LogError(f"free-paths: only {len(paths)} whole free paths in this log; at least {FEWEST} are needed")
    mean, error = float(paths.mean()), float(paths.std(ddof=1) / np.sqrt(len(paths)))
    edges = np.linspace(0.0, LONGEST * mean, BINS + 1)
    counts = np.histogram(paths, bins=edges)[0]
    width = edges[1] - edges[0]
    axes = figure.add_subplot()
    seen = counts > 0
    middle = 0.5 * (edges[1:] + edges[:-1])
    axes.errorbar(
        middle[seen], counts[seen] / (len(paths) * width), np.sqrt(counts[seen]) / (len(paths) * width),
        fmt="o", ms=3.5, lw=1, color=BLUE, label=f"{len(paths):,} free paths, counting errors",
    )  # fmt: skip
    theory = mean_free_path(log)
    shown = mean if theory is None else theory
    x = np.linspace(0.0, edges[-1], 200)
    axes.plot(x, path_density(x / shown) / shown, color=ORANGE, lw=1.5, label=f"kinetic theory, mean {shown:.4g}")
    if theory is None:
        verdict = f"mean free path {mean:.4g} \N{PLUS-MINUS SIGN} {error:.1g}, taken over by the curve"
    else:
        verdict = (
            f"mean free path {mean:.4g} \N{PLUS-MINUS SIGN} {error:.1g}, Enskog {theory:.4g} ({mean / theory - 1:+.1%})"
        )
    label(
        axes,
        f"free path [{LENGTH}]",
        f"probability density [per {LENGTH}]",
        f"{name_of(log.scene.name)}: {verdict}",
    )
    axes.set(yscale="log", xlim=(0.0, edges[-1]))
    axes.legend(frameon=False)


def free_paths(table: FlightTable) -> Floats:
    """Return the length of every way from one pair contact of a disk to its next."""
    gone = np.cumsum(table.lengths()) - table.lengths()  # length flown before each flight, all disks in a row
    at = np.flatnonzero(table.pair)
    same = table.disk[at[1:]] == table.disk[at[:-1]]
    paths = np.diff(gone[at])[same]
    result: Floats = paths[paths > 0.0]  # contacts of one instant have no path between them
    return result


def mean_free_path(log: EventLog) -> float | None:
    """Return Enskog's mean free path; None where the scene is no gas of equal disks in a rectangle."""
    scene, disks = log.scene, log.scene.disks
    equal = len(np.unique(disks.radius)) == 1 == len(np.unique(disks.mass)) and disks.radius[0] > 0.0
    if scene.domain.size is None or not equal or scene.gravity is not None or scene.walls or len(disks) < FEWEST:
        return None
    area, diameter = scene.domain.size[0] * scene.domain.size[1], 2.0 * float(disks.radius[0])
    density = len(disks) / area
    eta = density * np.pi * diameter**2 / 4.0
    contact_value = ((1.0 + eta**2 / 8.0) / (1.0 - eta) ** 2 - 1.0) / (2.0 * eta)
    return float(1.0 / (2.0 * np.sqrt(2.0) * density * diameter * contact_value))


def path_density(x: Floats) -> Floats:
    """Return the density of free paths x (K,), measured in mean free paths."""
    v, dv = np.linspace(1e-3, 7.0, 350, retstep=True)
    angle = np.linspace(0.0, np.pi, 181)
    other = v[:, None] * np.exp(-(v[:, None] ** 2) / 2.0)  # Maxwell's density of the other speed
    relative = np.array(
        [np.sqrt(v[:, None] ** 2 + w * w - 2.0 * v[:, None] * w * np.cos(angle)).mean(axis=1) for w in v]
    )
    rate = (relative * other * dv).sum(axis=0)  # proportional to nu(v)
    share = rate * v * np.exp(-(v**2) / 2.0)
    share /= share.sum()
    free = v / rate
    free /= (share * free).sum()
    density: Floats = (share / free * np.exp(-x[:, None] / free)).sum(axis=1)
    return density
