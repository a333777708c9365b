"""Velocity autocorrelation: exponential at first, then the tail 1 / t of two dimensions.

Source of the tail: B. J. Alder, T. E. Wainwright, Phys. Rev. A 1, 18 (1970), doi:10.1103/PhysRevA.1.18.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from eventsim.errors import LogError
from eventsim.measure import measure
from eventsim.replay.log import AnyLog
from eventsim.show.figures.demands import passage_with_time
from eventsim.show.figures.style import BLUE, GREEN, ORANGE, TIME, label
from eventsim.show.output import name_of

TAIL_FROM = 10.0
"""Mean free times after which sound and shear, not single contacts, carry what is left."""

SURE = 2.0
"""Standard errors above zero from which on a point says something on a logarithmic scale."""


def draw(figure: Figure, log: AnyLog) -> None:
    """Draw <v(0) v(t)> / <v^2> against the lag, Enskog's exponential, and a line 1 / t through the first points of the tail."""
    passage_with_time(log)
    measures = measure(log)
    lag, vacf, error = measures.correlations.lag, measures.correlations.vacf, measures.correlations.vacf_error
    if not len(lag) or not vacf[0] > 0.0:
        raise LogError("vacf: there is nothing to draw: no velocity is kept from one sample to the next")
    start = float(vacf[0])
    axes = figure.add_subplot()
    sure = vacf > SURE * error
    axes.errorbar(
        lag[sure], vacf[sure] / start, error[sure] / start, fmt="o", ms=3.5, lw=1, color=BLUE, label="measured"
    )
    free_time = measures.by_name.get("mean_free_time")
    if free_time is not None and free_time.theory is not None:  # a fluid of equal disks that keeps its momentum
        early = lag[lag < 5.0 * free_time.value]
        # Enskog: D = kT / (m rate) is <v^2> / 2 times the decay time of one free time
        axes.plot(early, np.exp(-(early - lag[0]) / free_time.value), color=GREEN, lw=1.3, label="Enskog")
        tail = sure & (lag > TAIL_FROM * free_time.value)
        if tail.sum() >= 2:
            first = np.flatnonzero(tail)[:3]
            level = float((vacf[first] * lag[first]).mean()) / start
            axes.plot(lag[tail], level / lag[tail], color=ORANGE, lw=1.3, label="1 / t")
    axes.set(xscale="log", yscale="log")
    verdict = "" if measures.steady else ", an average over a run without a steady state"
    kept = r"$\langle v(0)\, v(t)\rangle / \langle v^2\rangle$"
    label(axes, f"lag [{TIME}]", kept, f"{name_of(log)}: velocity autocorrelation{verdict}")
    axes.legend(frameon=False)
