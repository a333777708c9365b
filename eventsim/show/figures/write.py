"""Write a figure of a log to a file."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from os import PathLike
from pathlib import Path

from matplotlib import rc_context
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from eventsim import suffixes
from eventsim.errors import EventsimError
from eventsim.record.files.atomic import atomic_write
from eventsim.replay.log import Told
from eventsim.show.figures import TITLES
from eventsim.show.figures.style import new_figure
from eventsim.show.output import suffix_of


def write_figure(log: Told, kind: str, path: str | PathLike[str]) -> None:
    """Draw a kind of figure (see `TITLES`) of a log to `path`: .png, .svg or .pdf.

    Raises EventsimError where there is no such kind, the log does not hold what the figure shows, the suffix is unknown
    or the file cannot be written.
    """
    if kind not in TITLES:
        raise EventsimError(f"there is no figure {kind!r}; there are {', '.join(TITLES)}")
    module = import_module(f"eventsim.show.figures.{kind.replace('-', '_')}")
    save_figure(lambda figure: module.draw(figure, log), Path(path))


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
