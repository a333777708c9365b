"""Series: energy, temperature, pressure and collision rate along a run, against time and against the contacts of a disk.

Source of the curve of a cooling gas: P. K. Haff, J. Fluid Mech. 134, 401 (1983), doi:10.1017/S0022112083003419.
"""

from __future__ import annotations

from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from eventsim.errors import LogError
from eventsim.measure import measure
from eventsim.measure.theory import cooling_exponent
from eventsim.record.events import Floats
from eventsim.replay.log import AnyLog
from eventsim.scene.names import plural
from eventsim.show.figures.demands import passage_with_time
from eventsim.show.figures.style import BLUE, ORANGE, TIME, label
from eventsim.show.output import name_of

WIDE = 34
"""Letters in a line of a panel."""

DECADE = 10.0
"""Times that a series falls by from which on it is drawn on a logarithmic scale."""


def draw(figure: Figure, log: AnyLog) -> None:
    """Draw four panels: energy against time and temperature against contacts above, rate and pressure against time below."""
    passage_with_time(log)
    measures = measure(log, discard=0.0)
    series = measures.series
    if not len(series.time):
        raise LogError("series: there is nothing to draw: no time passes")
    panels = figure.subplots(2, 2)
    time = f"time [{TIME}]" if log.scene.start_time == 0.0 else f"time since the start [{TIME}]"
    _line(panels[0, 0], series.time, series.energy, time, "kinetic energy")
    _line(panels[1, 0], series.time, series.collision_rate, time, f"contacts of a disk / {TIME}")
    reasons = {name: measures[name].doubt for name in ("Z", "temperature") if name in measures}
    _line(panels[1, 1], series.time, series.pressure, time, "pressure", reasons.get("Z"))
    warm = panels[0, 1]
    _line(warm, series.contacts, series.temperature, "contacts of a disk", "temperature kT", reasons.get("temperature"))
    fall = measures.by_name.get("cooling_exponent")
    restitution = log.scene.restitution
    if fall is not None and fall.theory is not None and restitution is not None:
        start = float(series.temperature[0]) * np.exp(fall.theory * series.contacts[0])
        warm.plot(
            series.contacts,
            start * np.exp(-cooling_exponent(restitution.pair) * series.contacts),
            color=ORANGE, lw=1.3, label="Haff",
        )  # fmt: skip
        warm.legend(frameon=False)
    who = plural(measures.disks, "disk") if measures.disks else plural(measures.tracers, "tracer")
    figure.suptitle(f"{name_of(log)}: {who} along the run", fontsize=11, x=0.02, ha="left")


def _line(axes: Axes, x: Floats, y: Floats, along: str, what: str, why: str | None = None) -> None:
    known = np.isfinite(y)
    label(axes, f"{along}", what, "")
    if not known.any():
        text = fill(f"none: {why or 'it has no meaning here'}", WIDE)
        axes.text(0.5, 0.5, text, transform=axes.transAxes, ha="center", va="center", color="#5b6570")
        axes.set(xticks=[], yticks=[])
        return
    axes.plot(x[known], y[known], ".-", ms=3.5, lw=1.0, color=BLUE)
    if y[known].min() > 0.0 and y[known].max() > DECADE * y[known].min():
        axes.set_yscale("log")
    else:
        axes.set_ylim(min(0.0, 1.1 * float(y[known].min())), 1.15 * float(y[known].max()) or 1.0)
