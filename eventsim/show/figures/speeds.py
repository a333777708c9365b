"""Speeds: a histogram over disks and time, with Maxwell's curve at the run's own temperature.

Source: J. C. Maxwell, Philosophical Magazine 19, 19 (1860); in two dimensions f(v) = (m v / kT) exp(-m v^2 / 2 kT).
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from eventsim.errors import LogError
from eventsim.measure.speeds import maxwell_density, maxwell_survival
from eventsim.record.events import Floats
from eventsim.replay.log import EventLog
from eventsim.scene.pace import in_words, slowed
from eventsim.show.figures.demands import replay_with_time
from eventsim.show.figures.style import SPEED, label, name_of
from eventsim.show.frames import pace_of_log
from eventsim.show.palette import KINDS

SAMPLES, BLOCKS = 400, 20
"""Times at which speeds are read; blocks of them, whose scatter gives the error bars."""

BINS, MOST_MASSES = 36, 4
FEWEST = 20
"""Disks below which Maxwell's curve is not expected: energy that few disks share has no exponential tail."""


def draw(figure: Figure, log: EventLog) -> None:
    """Draw a histogram for each mass, error bars from blocks of time, and Maxwell's curve."""
    replay = replay_with_time(log)
    mass = log.scene.disks.mass
    moving = np.isfinite(mass) & (mass > 0.0)
    masses = np.unique(mass[moving])
    if not 1 <= len(masses) <= MOST_MASSES:
        raise LogError(f"speeds: {len(masses)} finite masses in this scene; the figure shows 1 to {MOST_MASSES}")
    times = np.linspace(*replay.span, SAMPLES)
    velocity = np.array([replay.state_at(time).velocity for time in times.tolist()])
    pace = pace_of_log(log)
    speed = slowed(np.hypot(velocity[..., 0], velocity[..., 1]), pace)
    if not speed[:, moving].any():
        raise LogError("speeds: nothing moves in this run")
    temperature = float((0.5 * mass[moving] * speed[:, moving] ** 2).mean())
    axes = figure.add_subplot()
    edges = np.linspace(0.0, float(np.quantile(speed[:, moving], 0.9995)) * 1.05, BINS + 1)
    chi2, points = 0.0, 0
    for place, value in enumerate(masses.tolist()):
        heights, errors = _histogram(speed[:, mass == value], edges)
        middle, colour = 0.5 * (edges[1:] + edges[:-1]), KINDS[place]
        name = f"m = {value:g}" if len(masses) > 1 else "measured"
        axes.stairs(heights, edges, fill=True, alpha=0.25, color=colour)
        axes.errorbar(middle, heights, errors, fmt="o", ms=3, lw=1, color=colour, label=name)
        if moving.sum() >= FEWEST:
            v = np.linspace(0.0, edges[-1], 300)
            curve = maxwell_density(v, temperature, value)
            axes.plot(v, curve, color=colour, lw=1.4, label=None if place else f"Maxwell, kT = {in_words(temperature, 2 * pace)}")
            expected = -np.diff(maxwell_survival(edges, temperature, value)) / np.diff(edges)
            good = errors > 0.0
            chi2 += float((((heights - expected)[good] / errors[good]) ** 2).sum())
            points += int(good.sum())
    verdict = (
        f"{np.sqrt(chi2 / points):.1f} standard errors from Maxwell on average"
        if points
        else "too few disks for Maxwell"
    )
    label(
        axes,
        f"speed [{SPEED}]" if not pace else f"speed [2^{pace} {SPEED}]",
        "probability density [time / length]" if not pace else f"probability density [2^{-pace} time / length]",
        f"{name_of(log)}: {verdict}",
    )
    axes.set(xlim=(0.0, edges[-1]), ylim=(0.0, None))
    axes.legend(frameon=False)


def _histogram(speed: Floats, edges: Floats) -> tuple[Floats, Floats]:
    """Return the density of speeds (T, M) in each bin, and its standard error from blocks of time."""
    blocks = [
        np.histogram(block, bins=edges)[0] / (block.size * np.diff(edges)) for block in np.array_split(speed, BLOCKS)
    ]
    return np.mean(blocks, axis=0), np.std(blocks, axis=0, ddof=1) / np.sqrt(BLOCKS)
