"""Speeds: the share of time at each speed, with Maxwell's curve at the run's own energy where it holds.

Source: J. C. Maxwell, Philosophical Magazine 19, 19 (1860); at fixed energy see `measure.theory.survival`.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from eventsim.errors import LogError
from eventsim.measure import measure
from eventsim.replay.log import AnyLog
from eventsim.show.colouring import measured_labels
from eventsim.show.figures.demands import passage_with_time
from eventsim.show.figures.style import SPEED, label
from eventsim.show.output import name_of
from eventsim.show.palette import KINDS

SEEN = 1e-3
"""Of the largest density: bins below it at the end of the histogram are not shown."""


def draw(figure: Figure, log: AnyLog) -> None:
    """Draw a histogram for each species, as `measure` has it, error bars from blocks of time, and Maxwell's curve."""
    passage_with_time(log)
    measures = measure(log)
    histograms = measures.speeds
    if not any(len(one.density) and one.density[1:].any() for one in histograms):
        raise LogError("speeds: nothing moves in this run, or slower than its histogram shows")
    axes = figure.add_subplot()
    end, misfits = 0.0, []
    looks = measured_labels(log.scene)
    for place, one in enumerate(histograms[: len(KINDS)]):
        middle, (name, colour) = 0.5 * (one.edges[1:] + one.edges[:-1]), looks[one.species]
        name = name if len(histograms) > 1 else "measured"
        name = "tracers" if measures.tracers and one is histograms[-1] else name
        axes.stairs(one.density, one.edges, fill=True, alpha=0.25, color=colour)
        axes.errorbar(middle, one.density, one.error, fmt="o", ms=3, lw=1, color=colour, label=name)
        if one.theory is not None:
            axes.plot(middle, one.theory, color=colour, lw=1.4, label=None if place else "Maxwell at fixed energy")
        if one.misfit is not None:
            misfits.append(one.misfit)
        seen = np.flatnonzero(one.density > SEEN * one.density.max())
        end = max(end, float(one.edges[seen[-1] + 1]))
    verdict = "speeds, with no theory beside"
    if misfits:
        verdict = f"{np.sqrt(np.mean(np.square(misfits))):.1f} standard errors from Maxwell on average"
    elif measures.doubts:
        verdict = measures.doubts[0]
    label(axes, f"speed [{SPEED}]", "share of time / speed [time / length]", f"{name_of(log)}: {verdict}")
    axes.set(xlim=(0.0, end), ylim=(0.0, None))
    axes.legend(frameon=False)
