"""The figure of a chart: error against time, scene by scene; chaos; rate against size; and what it all comes to."""

from __future__ import annotations

import math
from os import PathLike
from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from eventsim.show.figures.style import label
from eventsim.show.palette import LIGHT
from eventsim.show.versus.colours import NAMES, look
from eventsim.show.versus.page import save_page
from eventsim.validate.chart import Chaos, Chart
from eventsim.validate.conclusions import conclusions
from eventsim.validate.precision import Curves

COLUMNS, PANEL = 3, (5.0, 4.0)
"""Panels in a row; inches of one."""

ERRORS = {
    "trajectory": "position error [diameters]",
    "pressure": "relative error of the virial",
    "unrest": "speed or overlap that is left [diameters]",
}


def write_chart(chart: Chart, path: str | PathLike[str]) -> None:
    """Draw a chart to `path`: .png, .svg or .pdf.  Raises EventsimError where it cannot be written."""
    panels = len(chart.tasks) + (chart.chaos is not None) + bool(chart.rates) + 1
    rows = math.ceil(panels / COLUMNS)
    figure = Figure(figsize=(COLUMNS * PANEL[0], rows * PANEL[1]), dpi=110, facecolor="white", layout="constrained")
    grid = figure.subplots(rows, COLUMNS, squeeze=False)
    free = iter(grid.ravel().tolist())
    for curves in chart.tasks:
        draw_curves(next(free), curves)
    if chart.chaos is not None:
        draw_chaos(next(free), chart.chaos)
    if chart.rates:
        draw_rates(next(free), chart)
    draw_words(next(free), chart)
    for axes in free:
        axes.set_axis_off()
    save_page(figure, path)


def draw_curves(axes: Axes, curves: Curves) -> None:
    """One scene: error against seconds per time unit of the scene, a curve for each engine."""
    for name in curves.labels:
        points, style = curves.of(name), look(name)
        alone = len(points) == 1
        axes.plot(
            [point.elapsed for point in points],
            [point.error for point in points],
            style.line,
            marker=style.marker,
            ms=13 if alone else 4.5,
            lw=1.3,
            color=style.colour,
            mec="white" if alone else style.colour,
            zorder=5 if alone else 2,
        )
    axes.set_xscale("log")
    axes.set_yscale("log")
    if curves.floor > 0.0:
        axes.axhspan(axes.get_ylim()[0], curves.floor, color="#e3e6ea", zorder=0)
        if curves.floor > 1e-6:
            place = (0.2, 0.02)
            axes.annotate("below: chance", place, xycoords="axes fraction", fontsize=8.5)
    title = f"{curves.task.name}: {curves.task.words}" if curves.task.words else curves.task.name
    label(axes, "seconds of computing per time unit", ERRORS[curves.task.measure], title)
    axes.title.set_fontsize(9.5)


def draw_chaos(axes: Axes, chaos: Chaos) -> None:
    """Errors against contacts per disk: straight in a logarithmic plot until nothing is left of them."""
    for name, errors in chaos.errors.items():
        style = look(name)
        axes.semilogy(chaos.contacts[: len(errors)], np.maximum(errors, 1e-17), style.line, color=style.colour, lw=1.4)
        place = len(errors) // 3 if name == "event-driven" else 2
        text = "event-driven, float64" if name == "event-driven" else name.split(", ")[1]
        spot = (chaos.contacts[place], max(errors[place], 1e-17))
        axes.annotate(text, spot, xytext=(6, -9), textcoords="offset points", fontsize=8)
    if not math.isnan(chaos.slope):
        steep = 1e-16 * 2.0 ** (chaos.slope * chaos.contacts)
        shown = steep < 10.0
        axes.semilogy(chaos.contacts[shown], steep[shown], ":", color=LIGHT.faint, lw=1.2)
        axes.axvline(chaos.horizon, color=LIGHT.faint, lw=0.9, ls="--")
        axes.annotate("float64 ends", (chaos.horizon, 1e-14), xytext=(4, 0), textcoords="offset points", fontsize=8.5)
    title = f"Chaos in the gas: {chaos.slope:.2g} bits lost a contact" if not math.isnan(chaos.slope) else "Chaos in the gas"
    label(axes, "contacts of each disk", ERRORS["trajectory"], title)
    axes.title.set_fontsize(9.5)


def draw_rates(axes: Axes, chart: Chart) -> None:
    """Contacts per second against the number of disks."""
    for name, points in chart.rates.items():
        style = look(name)
        n, rate = zip(*points, strict=True)
        axes.loglog(n, rate, style.line, marker=style.marker, ms=5, lw=1.3, color=style.colour)
    label(axes, "disks", "contacts simulated per second", "Rate in the gas; stepped engines with 0.05 radii a step")
    axes.title.set_fontsize(9.5)


def draw_words(axes: Axes, chart: Chart) -> None:
    """The legend, and the conclusions below it."""
    axes.set_axis_off()
    present = [name for name in NAMES if any(name in curves.labels for curves in chart.tasks)]
    for name in present:
        style = look(name)
        axes.plot([], [], style.line, marker=style.marker, color=style.colour, label=NAMES[name], ms=7)
    axes.legend(loc="upper left", frameon=False, fontsize=8.5, borderaxespad=0.0, labelspacing=0.25)
    text = "\n".join(fill(sentence, 72) for sentence in conclusions(chart))
    axes.text(0.0, 0.5, text, transform=axes.transAxes, va="top", fontsize=8.6, linespacing=1.15, color=LIGHT.ink)
