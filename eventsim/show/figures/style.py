"""The style that all figures share: size, colours, labels with units."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

from eventsim.record.events import Floats
from eventsim.show.colouring import amounts
from eventsim.show.palette import KINDS, LIGHT

SIZE, DPI = (7.2, 4.4), 150
"""Inches; 1080 by 660 pixels: text reads well at the width of a README."""

BLUE, ORANGE, GREEN, PINK = KINDS[0], KINDS[1], KINDS[2], KINDS[3]
RED = KINDS[5]
MOST_KINDS = 7
"""Disks up to which each has a colour of its own; the last of KINDS, yellow, is too light for a line."""

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


def shades_of(n: int) -> Floats:
    """Return a colour (n, 4) for each disk: unlike ones where they are few, else along a scale, dark enough for lines."""
    if n <= MOST_KINDS:
        return np.array([to_rgba(colour) for colour in KINDS[:n]])
    shades: Floats = amounts()(np.linspace(0.0, 0.92, n))
    return shades


