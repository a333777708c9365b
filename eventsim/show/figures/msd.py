"""Mean squared displacement against the lag, as `measure` has it, and D from its slope: in two dimensions D grows with the lag.

Source for Enskog's D = kT / (m rate), rate = contacts of a disk per time: S. Chapman, T. G. Cowling, The Mathematical Theory of
Non-uniform Gases (1970), chapter 16; good at low density.
"""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from eventsim.errors import LogError
from eventsim.measure import Measures, measure
from eventsim.measure.theory import enskog_diffusion
from eventsim.replay.log import AnyLog
from eventsim.scene.names import plural
from eventsim.show.figures.demands import passage_with_time
from eventsim.show.figures.style import BLUE, GREEN, LENGTH, ORANGE, TIME, label
from eventsim.show.output import name_of

SURE = 2.0
"""Standard errors above zero from which on a point says something on a logarithmic scale."""


def draw(figure: Figure, log: AnyLog) -> None:
    """Draw the displacement about the common motion above, D from its slope between half the lag and the lag below."""
    passage_with_time(log)
    if not np.isfinite(log.scene.disks.mass).any():
        raise LogError("msd: 0 finite masses in this scene; the figure is of disks that contacts deflect")
    measures = measure(log)
    found = measures.correlations
    if not found.msd.any():
        raise LogError("msd: nothing moves in this run")
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    _draw_displacement(above, measures)
    _draw_diffusion(below, measures, log)
    who = plural(measures.disks, "disk") if measures.disks else plural(measures.tracers, "tracer")
    told = measures.by_name.get("diffusion")
    verdict = "" if told is None or math.isnan(told.error) else f", D = {told.value:.3g} \N{PLUS-MINUS SIGN} {told.error:.1g}"
    verdict += "" if measures.steady else ", an average over a run without a steady state"
    label(above, "", f"$\\langle r^2\\rangle$ [{LENGTH}$^2$]", f"{name_of(log)}: {who}{verdict}")
    label(below, f"lag [{TIME}]", "D [area / time]", "")
    above.legend(frameon=False)


def _draw_displacement(axes: Axes, measures: Measures) -> None:
    found = measures.correlations
    seen = np.isfinite(found.msd) & (found.msd > 0.0)
    lag, msd = found.lag[seen], found.msd[seen]
    axes.errorbar(lag, msd, found.msd_error[seen], fmt="o", ms=3.5, lw=1, color=BLUE, label="measured")
    low, high = 0.5 * float(msd.min()), 4.0 * float(msd.max())
    ballistic = msd[0] * (lag / lag[0]) ** 2
    shown = ballistic < high
    axes.plot(lag[shown], ballistic[shown], color=ORANGE, lw=1.3, label=r"ballistic, $\propto \mathrm{lag}^2$")
    axes.set(xscale="log", yscale="log", ylim=(low, high))


def _draw_diffusion(axes: Axes, measures: Measures, log: AnyLog) -> None:
    found = measures.correlations
    slope, error = found.diffusion, found.diffusion_error
    told = measures.by_name.get("diffusion")
    with np.errstate(invalid="ignore"):
        sure = np.isfinite(slope) & (slope > SURE * error)
    if told is None or math.isnan(told.value):  # where `measure` has no D there is none at any lag
        sure[:] = False
    axes.errorbar(found.lag[sure], slope[sure], error[sure], fmt="o", ms=3.5, lw=1, color=BLUE)
    rate = measures.by_name.get("collision_rate")
    if rate is not None and rate.theory is not None:  # a fluid of equal disks
        enskog = enskog_diffusion(measures["temperature"].value, float(log.scene.disks.mass[0]), rate.value)
        axes.axhline(enskog, color=GREEN, lw=1.3, label="Enskog, kT / (m rate)")
        axes.legend(frameon=False)
    if not sure.any():
        why = "it has no meaning here" if told is None else told.doubt if math.isnan(told.value) else "it is not known"
        axes.text(0.5, 0.5, f"no D: {why}", transform=axes.transAxes, ha="center", va="center", color="#5b6570")
    axes.set_ylim(0.0, None)
