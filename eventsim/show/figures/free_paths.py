"""Free paths: how far a disk flies between contacts with other disks, against kinetic theory."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from matplotlib.figure import Figure

from eventsim.errors import LogError
from eventsim.measure import measure
from eventsim.measure.ensemble import ensemble_of
from eventsim.measure.free_paths import free_paths, path_density
from eventsim.record.events import Floats, Kind
from eventsim.replay.flight_table import flights
from eventsim.replay.log import AnyLog
from eventsim.replay.passage import Passage
from eventsim.show.figures.demands import passage_with_time, with_events
from eventsim.show.figures.style import BLUE, LENGTH, ORANGE, label
from eventsim.show.output import name_of

BINS, LONGEST = 40, 6.0
"""Bins, up to this many mean free paths."""

FEWEST = 20
"""Free paths below which there is nothing to say about how they are distributed."""


def draw(figure: Figure, log: AnyLog) -> None:
    """Draw the distribution of free paths between pair contacts, reflections at walls passed over."""
    with_events(log, Kind.PAIR)
    passage = passage_with_time(log)
    number, total = 0, 0.0
    for paths in _paths(passage):
        number, total = number + len(paths), total + float(paths.sum())
    if number < FEWEST:
        raise LogError(f"free-paths: only {number} whole free paths in this log; at least {FEWEST} are needed")
    mean, squares = total / number, 0.0
    edges = np.linspace(0.0, LONGEST * mean, BINS + 1)
    counts = np.zeros(BINS, np.int64)
    for paths in _paths(passage):
        squares += float(((paths - mean) ** 2).sum())
        counts += np.histogram(paths, bins=edges)[0]
    error = math.sqrt(squares / (number - 1) / number)
    width = edges[1] - edges[0]
    axes = figure.add_subplot()
    seen = counts > 0
    middle = 0.5 * (edges[1:] + edges[:-1])
    axes.errorbar(
        middle[seen], counts[seen] / (number * width), np.sqrt(counts[seen]) / (number * width),
        fmt="o", ms=3.5, lw=1, color=BLUE, label=f"{number:,} free paths, counting errors",
    )  # fmt: skip
    told = measure(log).by_name.get("mean_free_path")
    theory = None if told is None or math.isnan(told.value) else told.theory
    if theory is not None:
        x = np.linspace(0.0, edges[-1], 200)
        axes.plot(x, path_density(x / theory) / theory, color=ORANGE, lw=1.5, label=f"kinetic theory, mean {theory:.4g}")
    if told is not None and told.value > 0.0 and not math.isnan(told.error):
        mean, error = told.value, told.error  # flights that the run cuts off included
    verdict = f"mean free path {mean:.4g} \N{PLUS-MINUS SIGN} {error:.1g}"
    if theory is not None:
        verdict += f", kinetic theory {theory:.4g} ({mean / theory - 1:+.1%})"
    label(
        axes,
        f"way between contacts with other disks, walls passed over [{LENGTH}]",
        f"probability density [per {LENGTH}]",
        f"{name_of(log)}: {verdict}",
    )
    axes.set(yscale="log", xlim=(0.0, edges[-1]))
    axes.legend(frameon=False)


def _paths(passage: Passage) -> Iterator[Floats]:
    """Of those that carry energy; of tracers where nothing does."""
    movers = np.flatnonzero(ensemble_of(passage.log.scene).movers)
    return free_paths((table.of(movers) for table in flights(passage)), passage.stage.n)
