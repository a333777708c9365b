"""Words within a panel: in one style, and without a say in the layout of the page."""

from __future__ import annotations

from typing import Any

from matplotlib.axes import Axes

from eventsim.show.palette import LIGHT

BACK = {"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.6}


def note(
    axes: Axes, text: str, at: tuple[float, float], coords: Any = "data", offset: tuple[float, float] = (0, 0), **style: Any
) -> None:
    """Write `text` at a place, moved by `offset` points."""
    style = {"fontsize": 9, "zorder": 6, "color": LIGHT.ink, "bbox": BACK, **style}
    axes.annotate(text, at, xycoords=coords, xytext=offset, textcoords="offset points", **style).set_in_layout(False)


ACROSS = ("axes fraction", "data")
"""Coordinates of a note that belongs to a height: x as a share of the panel, y in data."""
