"""Words on a panel: in one style, crossed by no line, and without a say in the layout of the page."""

from __future__ import annotations

from textwrap import fill
from typing import Any

from matplotlib.axes import Axes

from eventsim.show.palette import LIGHT

ABOVE = 7
"""Where notes lie: above all curves, which end at their backs."""

TITLE_LETTERS = 38
"""In a line of a panel's title: more would come near to that of the next panel."""


def note(
    axes: Axes,
    text: str,
    at: tuple[float, float],
    coords: Any = "data",
    offset: tuple[float, float] = (0, 0),
    back: str = "white",
    **style: Any,
) -> None:
    """Write `text` at a place, moved by `offset` points, on a back of the colour of what is there."""
    box = {"facecolor": back, "edgecolor": "none", "pad": 0.6}
    style = {"fontsize": 9, "zorder": ABOVE, "color": LIGHT.ink, "bbox": box, **style}
    axes.annotate(text, at, xycoords=coords, xytext=offset, textcoords="offset points", **style).set_in_layout(False)


ACROSS = ("axes fraction", "data")
"""Coordinates of a note that belongs to a height: x as a share of the panel, y in data."""


def panel_title(text: str) -> str:
    """A title in lines that fit above its panel."""
    return fill(text, TITLE_LETTERS)
