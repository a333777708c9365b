"""The panel on chaos: errors that grow from contact to contact until no digit is left."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes

from eventsim.show.figures.style import label
from eventsim.show.palette import LIGHT
from eventsim.show.versus.colours import look
from eventsim.show.versus.notes import note
from eventsim.validation.chart import Chaos
from eventsim.validation.truth import BELIEVED

FIRST = 1e-16
STYLES = ("-", ":")
BELIEVED_NOT = "#eceff2"
"""Background where no digit is left."""


def draw_chaos(axes: Axes, chaos: Chaos) -> None:
    """Errors against contacts of each disk: straight in a logarithmic plot; where float64 ends, shaded from there on."""
    styles = iter(STYLES)
    for name, errors in chaos.errors.items():
        own = name == "event-driven"
        text = "event-driven, float64" if own else name
        line = "-" if own else next(styles, "-.")
        style = {"color": look(name).colour, "lw": 2.0 if own else 1.5, "label": text}
        axes.semilogy(chaos.contacts[: len(errors)], np.maximum(errors, FIRST), line, **style)
    if not math.isnan(chaos.slope):
        steep = FIRST * 2.0 ** (chaos.slope * chaos.contacts)
        shown = steep < 1.0
        text = f"{chaos.slope:.2g} bits lost in each contact"
        axes.semilogy(chaos.contacts[shown], steep[shown], "--", color=LIGHT.faint, lw=1.2, label=text)
        axes.axvline(chaos.horizon, color=LIGHT.ink, lw=1.1)
        axes.axvspan(chaos.horizon, float(chaos.contacts[-1]), color=BELIEVED_NOT, zorder=0)
        text = f"float64 ends:\n{chaos.horizon:.0f} contacts,\nerror {BELIEVED:g}\n\nonly statistics\nare true here"
        note(axes, text, (chaos.horizon, 1e-6), offset=(5, 0), va="center", back=BELIEVED_NOT)
    axes.set_xlim(0.0, float(chaos.contacts[-1]))
    axes.set_ylim(FIRST / 3.0, 30.0)
    axes.legend(loc="lower right", fontsize=8.5, framealpha=0.95, borderpad=0.3)
    label(axes, "contacts of each disk", "position error [diameters]", "Where does float64 end? The gas")
