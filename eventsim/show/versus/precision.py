"""The figure of a chart: five answers, then error against time scene by scene, losses, chaos, rates, and all advantages."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from os import PathLike
from textwrap import fill, wrap
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from eventsim.show.figures.style import label
from eventsim.show.palette import LIGHT
from eventsim.show.versus.chaos import draw_chaos
from eventsim.show.versus.colours import NAMES, look
from eventsim.show.versus.losses import draw_energy, draw_missed
from eventsim.show.versus.page import save_page
from eventsim.show.versus.work import draw_work
from eventsim.validation.advantages import table
from eventsim.validation.chart import RATE_STEP, Chart
from eventsim.validation.conclusions import conclusions

COLUMNS, PANEL = 3, (4.4, 3.9)
"""Panels in a row; inches of one."""

LETTERS, LINE = 92, 0.215
"""Letters in a line of the answers; inches of its height."""

TITLE, LEGEND_LINE = 0.42, 0.24
"""Inches of the title and of a line of the legend."""

HEAD_WIDTH = COLUMNS * PANEL[0]
"""Inches that the answers need."""

ANSWERS_AT = 0.37
"""Where the answers begin, as a share of the width; the questions stand before them."""

TABLE_TITLE = (
    "How far event-driven is ahead of each engine: its time at equal error (head) | its error in equal time, "
    "as multiples (>: never came to that error; <: event-driven did not; -: even its coarsest run takes longer)"
)

TABLE_LETTERS = {1: 76, 2: 112}
"""In a line of its title, by the panels in whose place it stands."""

Draw = Callable[[Axes], None]


def write_chart(chart: Chart, path: str | PathLike[str]) -> None:
    """Draw a chart to `path`: .png, .svg or .pdf.  Raises EventsimError where it cannot be written."""
    panels = panels_of(chart)
    head, rows = table(chart)
    lines = answer_lines(chart)
    across = min(COLUMNS, max(len(panels), 2))
    # The table takes what is left of the last row of panels where it has room there; else a row of its own.
    free = -len(panels) % across
    beside = free >= 2 or (free == 1 and len(chart.tasks) == 1)
    last = -(-len(panels) // across)
    head_height = TITLE + LINE * (len(lines) + 1) + LEGEND_LINE * -(-len(present(chart)) // COLUMNS)
    table_height = [] if beside or not rows else [0.34 * (len(rows) + 3)]
    heights = [head_height, *[PANEL[1]] * last, *table_height]
    figure = Figure(figsize=(max(across * PANEL[0], HEAD_WIDTH), sum(heights)), dpi=120, facecolor="white", layout="constrained")
    grid = figure.add_gridspec(len(heights), across, height_ratios=heights)
    draw_head(figure.add_subplot(grid[0, :]), chart, lines, head_height)
    for place, draw in enumerate(panels):
        draw(figure.add_subplot(grid[1 + place // across, place % across]))
    if rows:
        where = grid[last, across - free :] if beside else grid[last + 1, :]
        draw_table(figure.add_subplot(where), head, rows, TABLE_LETTERS[min(free, 2) if beside else 2])
    save_page(figure, path)


def panels_of(chart: Chart) -> list[Draw]:
    """What draws each panel, in the order of the questions."""
    panels: list[Draw] = [partial(draw_work, curves=curves) for curves in chart.tasks]
    losses, chaos = chart.losses, chart.chaos
    if losses is not None:
        panels += [lambda axes: draw_missed(axes, losses), lambda axes: draw_energy(axes, losses)]
    if chaos is not None:
        panels.append(lambda axes: draw_chaos(axes, chaos))
    if chart.rates:
        panels.append(lambda axes: draw_rates(axes, chart))
    return panels


def answer_lines(chart: Chart) -> list[tuple[str, str]]:
    """(question, answer) line by line; the question stands beside the first line of its answer."""
    lines = []
    for answer in conclusions(chart):
        lines += [("" if place else answer.question, text) for place, text in enumerate(wrap(answer.answer, LETTERS))]
    return lines


def present(chart: Chart) -> list[str]:
    """The engines that took part, in the order of the legend."""
    return [name for name in NAMES if any(name in curves.labels for curves in chart.tasks)]


def draw_head(axes: Axes, chart: Chart, lines: list[tuple[str, str]], height: float) -> None:
    """The title, the answers, and the legend of all panels; height: of the axes, inches."""
    axes.set_axis_off()
    above: dict[str, Any] = {"transform": axes.transAxes, "va": "top", "color": LIGHT.ink}
    axes.text(0.0, 1.0, "Speed against accuracy, and where each engine is the right one", fontsize=16, weight="bold", **above)
    for place, (question, text) in enumerate(lines):
        y = 1.0 - (TITLE + LINE * place) / height
        axes.text(0.0, y, question, fontsize=11, weight="bold", **above)
        axes.text(ANSWERS_AT, y, text, fontsize=11, **above)
    for name in present(chart):
        axes.plot([], [], label=NAMES.get(name, name), **look(name).drawn(8))
    axes.legend(loc="lower left", ncols=COLUMNS, frameon=False, fontsize=10.5, borderaxespad=0.0, columnspacing=2.0)


def draw_rates(axes: Axes, chart: Chart) -> None:
    """Contacts per second against the number of disks."""
    for name, points in chart.rates.items():
        n, rate = zip(*points, strict=True)
        axes.loglog(n, rate, lw=1.3, **look(name).drawn(6))
    axes.set_xticks([30, 100, 300, 1000, 3000], ["30", "100", "300", "1000", "3000"])
    axes.set_xticks([], minor=True)
    label(axes, "disks", "contacts simulated per second", f"Rates in the gas (stepped: {RATE_STEP:g} radii a step)")


def draw_table(axes: Axes, head: list[str], rows: list[list[str]], letters: int) -> None:
    """By what the event-driven engine is ahead of every other one on every scene; letters: in a line of the title."""
    axes.set_axis_off()
    axes.set_title(fill(TABLE_TITLE, letters), loc="left", fontsize=10.5, color=LIGHT.ink)
    widths = [0.19, *[0.81 / (len(head) - 1)] * (len(head) - 1)]
    names = [text.replace(": ", "\n") for text in head]
    drawn = axes.table(rows, colLabels=names, colWidths=widths, cellLoc="center", loc="upper left", edges="horizontal")
    drawn.auto_set_font_size(False)
    drawn.set_fontsize(9.5)
    drawn.scale(1.0, 1.45)
    for (row, column), cell in drawn.get_celld().items():
        cell.set_edgecolor("#c8cdd3")
        if row == 0:
            cell.set_height(1.6 * cell.get_height())
            cell.get_text().set_fontweight("bold")
        elif column == 0:
            cell.get_text().set_color(look(rows[row - 1][0]).colour)
            cell.get_text().set_fontweight("bold")
