"""Write a figure of a log to a file."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from os import PathLike
from pathlib import Path
from typing import Any, cast

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from eventsim import suffixes
from eventsim.errors import EventsimError
from eventsim.kinds import TITLES
from eventsim.record.files.atomic import atomic_write
from eventsim.replay.log import AnyLog
from eventsim.show.figures.style import SIZE, new_figure
from eventsim.show.output import suffix_of


class OnAxes:
    """Stands in for an empty figure where a drawing of one panel goes onto axes that somebody has."""

    def __init__(self, axes: Axes, kind: str) -> None:
        self._axes, self._kind = axes, kind

    def add_subplot(self, **how: Any) -> Axes:
        """Give the axes."""
        self._axes.set(**how)
        return self._axes

    def subplots(self, *panels: int, **how: Any) -> Axes:
        """Give the axes where one panel is wanted; EventsimError for more."""
        if panels:
            raise EventsimError(f"the figure {self._kind} has several panels: leave ax out, and it makes a figure of its own")
        return self.add_subplot(**how)

    def set_size_inches(self, *size: float) -> None:
        """Leave the size to whoever made the axes."""


def plot(log: AnyLog, kind: str, ax: Axes | None = None) -> Axes:
    """Draw a kind of figure of a log; the axes, of several panels the first.

    ax: where to; None: in a new figure of pyplot.  Raises EventsimError as `write_figure`, and for axes where panels are needed.
    """
    draw = drawing_of(kind)
    if ax is not None:
        _demand_axes(ax)
        draw(cast(Figure, OnAxes(ax, kind)), log)
        return ax
    from matplotlib import pyplot  # it chooses a window system, which files need not

    figure = pyplot.figure(figsize=SIZE, layout="constrained")
    try:
        draw(figure, log)
    except BaseException:
        pyplot.close(figure)
        raise
    return figure.axes[0]


def _demand_axes(ax: object) -> None:
    """Raise EventsimError for what is none of matplotlib's axes, as are several in an array."""
    if not isinstance(ax, Axes):
        several = " (of several, one: ax=axes.flat[0])" if isinstance(ax, np.ndarray) else ""
        raise EventsimError(f"ax is of the type {type(ax).__name__}: must be axes of matplotlib{several}")


def drawing_of(kind: str) -> Callable[[Figure, AnyLog], None]:
    """Return the function that draws a kind of figure; EventsimError where there is none."""
    if kind not in tuple(TITLES):  # whatever is asked for
        raise EventsimError(f"there is no figure {kind!r}; there are {', '.join(TITLES)}")
    draw: Callable[[Figure, AnyLog], None] = import_module(f"eventsim.show.figures.{kind.replace('-', '_')}").draw
    return draw


def write_figure(log: AnyLog, kind: str, path: str | PathLike[str]) -> None:
    """Draw a kind of figure (see `TITLES`) of a log to `path`: .png, .svg or .pdf.

    Raises EventsimError where there is no such kind, the log does not hold what the figure shows, the suffix is unknown
    or the file cannot be written.
    """
    draw = drawing_of(kind)
    save_figure(lambda figure: draw(figure, log), Path(path))


def save_figure(draw: Callable[[Figure], None], file: Path) -> None:
    """Write the figure that `draw` fills, to a file that depends on nothing else: no date, no random names inside an svg."""
    suffix = suffix_of(file, suffixes.FIGURES, "a figure")
    with rc_context({"svg.hashsalt": "eventsim", "svg.fonttype": "path"}):
        figure = new_figure()
        FigureCanvasAgg(figure)
        draw(figure)
        dates = {".png": {}, ".svg": {"Date": None}, ".pdf": {"CreationDate": None}}
        with atomic_write(file) as part:
            figure.savefig(part, format=suffix[1:], metadata=dates[suffix])
