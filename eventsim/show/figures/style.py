"""The style that all figures share: size, colours, labels with units."""

from __future__ import annotations

from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from eventsim.record.events import Floats
from eventsim.show.palette import KINDS, LIGHT

WIDE = 34
"""Letters in a line of a small panel."""

SIZE, DPI = (7.2, 4.4), 150
"""Inches; 1080 by 660 pixels: text reads well at the width of a README."""

BLUE, ORANGE, GREEN, PINK = KINDS[0], KINDS[1], KINDS[2], KINDS[3]
RED = KINDS[5]

TIME, LENGTH, SPEED = "time unit", "length unit", "length / time"
"""Units: whatever the scene takes for them."""


def new_figure() -> Figure:
    """Return an empty figure that keeps labels from overlapping."""
    return Figure(figsize=SIZE, dpi=DPI, facecolor="white", layout="constrained")


def label(axes: Axes, x: str, y: str, title: str) -> None:
    """Put labels and a title on axes, and take away what only makes noise."""
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.set_title(title, loc="left", fontsize=11, color=LIGHT.ink, wrap=True)
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(visible=True, color="#e3e6ea", linewidth=0.7)
    axes.set_axisbelow(True)


DECADE = 10.0
"""Times that a quantity falls by from which on it is drawn on a logarithmic scale."""

FALTERING = 2.0
"""Times its least value so far that a quantity which falls may come back to."""


def falls_by_decades(y: Floats) -> bool:
    """Whether positive values (K,) in order only fall, but for some scatter, and far enough for a logarithmic scale."""
    if not len(y) or not float(y.min()) > 0.0:
        return False
    return bool(y[0] > DECADE * y[-1] and (y < FALTERING * np.minimum.accumulate(y)).all())


def scale_to(axes: Axes, y: Floats) -> None:
    """Scale the vertical axis to values in order: from 0 on, logarithmic where they fall by decades."""
    if falls_by_decades(y):
        axes.set_yscale("log")
        return
    low, high = min(float(y.min()), 0.0), max(float(y.max()), 0.0)
    room = 0.08 * (high - low or 1.0)
    axes.set_ylim(low - room if low < 0.0 else 0.0, high + room)


def say_none(axes: Axes, why: str) -> None:
    """Write into an empty panel why it is empty."""
    axes.text(0.5, 0.5, fill(why, WIDE), transform=axes.transAxes, ha="center", va="center", color=LIGHT.faint)
    axes.set(xticks=[], yticks=[])
