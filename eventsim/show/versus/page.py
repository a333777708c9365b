"""A page: saving a figure to a file that depends on its numbers alone."""

from __future__ import annotations

from os import PathLike
from pathlib import Path

from matplotlib import rc_context
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from eventsim import suffixes
from eventsim.record.files.atomic import atomic_write
from eventsim.show.output import suffix_of


def save_page(figure: Figure, path: str | PathLike[str]) -> None:
    """Save a figure as .png, .svg or .pdf, without dates; EventsimError where it cannot be written."""
    file = Path(path)
    suffix = suffix_of(file, suffixes.FIGURES, "a figure")
    with rc_context({"svg.hashsalt": "eventsim", "svg.fonttype": "path"}):
        FigureCanvasAgg(figure)
        dates = {".png": {}, ".svg": {"Date": None}, ".pdf": {"CreationDate": None}}
        with atomic_write(file) as part:
            figure.savefig(part, format=suffix[1:], metadata=dates[suffix])
