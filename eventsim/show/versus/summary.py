"""The chart on one page, 16 to 9, to be read in a minute: five questions with an answer each, and the panels that show them."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from os import PathLike
from textwrap import wrap
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from eventsim.show.output import as_written
from eventsim.show.palette import LIGHT
from eventsim.show.versus.chaos import draw_chaos
from eventsim.show.versus.colours import NAMES, look
from eventsim.show.versus.losses import draw_energy, draw_missed
from eventsim.show.versus.page import save_page
from eventsim.show.versus.work import draw_work
from eventsim.validation.advantages import table
from eventsim.validation.chart import Chart
from eventsim.validation.conclusions import conclusions
from eventsim.validation.versions import versions

SIZE = (16.0, 9.0)
"""Inches."""

SHOWN = ("gas", "break", "pile")
"""The scenes that are shown where many were measured; the others are on the page of details."""

GRID = {1: (1, 1), 2: (1, 2), 3: (1, 3), 4: (2, 2)}
"""Panels -> rows and columns; more fill rows of three."""

TEXT_SHARE, LETTERS, QUESTION_LETTERS, LINE = 0.25, 42, 34, 0.0235
"""The column of answers: its share of the width, letters in a line of an answer and of a question, the height of a line as a
share of the page."""

UNKNOWN = ">: not reached in so much; -: no run so short\n<: the event-driven engine did not come to this error"
"""What the signs in the table mean."""

TABLE_AT = (0.05, 0.47, 0.73)
"""Where the columns of the table begin, as shares of the column of answers."""

Draw = Callable[[Axes], None]


def write_summary(chart: Chart, path: str | PathLike[str]) -> None:
    """Draw the page to `path`: .png, .svg or .pdf.  Raises EventsimError where it cannot be written."""
    figure = Figure(figsize=SIZE, dpi=100, facecolor="white", layout=ConstrainedLayoutEngine(h_pad=0.08))
    draw_summary(figure, chart)
    save_page(figure, path)


def draw_summary(figure: Figure, chart: Chart) -> None:
    """Draw the page onto a figure."""
    panels = panels_of(chart)
    text, right = figure.subfigures(1, 2, width_ratios=[TEXT_SHARE, 1.0 - TEXT_SHARE], squeeze=False)[0]
    rows, columns = GRID.get(len(panels), (-(-len(panels) // 3), 3))
    if panels:
        grid = right.subplots(rows, columns, squeeze=False)
        for place, axes in enumerate(grid.ravel()):
            if place < len(panels):
                panels[place](axes)
            else:
                axes.set_axis_off()
    _draw_answers(text.add_axes((0.0, 0.0, 1.0, 1.0)), chart)


def panels_of(chart: Chart) -> list[Draw]:
    """What draws each panel."""
    many = len(chart.tasks) > len(SHOWN)
    panels: list[Draw] = [
        partial(draw_work, curves=curves) for curves in chart.tasks if not many or curves.task.name in SHOWN
    ]
    losses, chaos = chart.losses, chart.chaos
    if losses is not None:
        panels += [lambda axes: draw_missed(axes, losses), lambda axes: draw_energy(axes, losses)]
    if chaos is not None:
        panels.append(lambda axes: draw_chaos(axes, chaos))
    return panels


def _draw_table(axes: Axes, height: float, rows: list[list[str]]) -> None:
    """How far each engine is behind on the only scene, from a height on, as a share of the page."""
    if not rows:
        return
    style: dict[str, Any] = {"transform": axes.transAxes, "va": "top", "color": LIGHT.ink}
    axes.text(0.05, height, "How far behind is each engine?", fontsize=12, weight="bold", **style)
    for x, text in zip(TABLE_AT, ("", "its time at\nequal error", "its error in\nequal time"), strict=True):
        axes.text(x, height - 1.2 * LINE, text, fontsize=9, linespacing=1.1, **{**style, "color": LIGHT.faint})
    for place, (name, told) in enumerate(rows):
        cells = [name, *(f"{number} x" if number != "-" else "-" for number in told.split(" | "))]
        for x, text in zip(TABLE_AT, cells, strict=True):
            colour = look(name).colour if text == name else LIGHT.ink
            axes.text(x, height - (2.9 + 0.9 * place) * LINE, text, fontsize=10.5, **{**style, "color": colour})
    below = height - (3.1 + 0.9 * len(rows)) * LINE
    axes.text(0.05, below, UNKNOWN, fontsize=8, **{**style, "color": LIGHT.faint})


def _draw_answers(axes: Axes, chart: Chart) -> None:
    """The questions with their answers, the legend, and what was compared."""
    axes.set_axis_off()
    style: dict[str, Any] = {"transform": axes.transAxes, "va": "top", "color": LIGHT.ink}
    axes.text(0.05, 0.97, "Speed against\naccuracy", fontsize=20, weight="bold", linespacing=1.1, **style)
    height = 0.87
    for answer in conclusions(chart):
        for text, letters, weight in ((answer.question, QUESTION_LETTERS, "bold"), (answer.answer, LETTERS, "normal")):
            lines = wrap(text, letters)
            axes.text(0.05, height, as_written("\n".join(lines)), fontsize=12, weight=weight, linespacing=1.2, **style)
            height -= LINE * len(lines)
        height -= LINE
    if len(chart.tasks) == 1:
        _draw_table(axes, height, table(chart)[1])
    names = [name for name in NAMES if any(name in curves.labels for curves in chart.tasks)]
    for name in names:
        axes.plot([], [], label=NAMES[name], **look(name).drawn(7))
    if names:
        axes.legend(loc="lower left", bbox_to_anchor=(0.02, 0.055), frameon=False, fontsize=9.5, labelspacing=0.35)
    told = ", ".join(f"{name} {number}" for name, number in versions().items())
    bars = "bars: least and most of warm runs" + (", and of seeds" if any(c.task.others for c in chart.tasks) else "")
    part = ["interrupted: a part of what was asked for"] if chart.interrupted else []
    axes.text(0.05, 0.05, "\n".join([*wrap(told, 62), *wrap(bars, 62), *part]), fontsize=8, **{**style, "color": LIGHT.faint})
