"""The figure of a comparison: what stepped engines do to one scene, against their step."""

from __future__ import annotations

from collections.abc import Callable
from os import PathLike
from textwrap import fill

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from eventsim.show.figures.style import label
from eventsim.show.output import as_written
from eventsim.show.palette import LIGHT
from eventsim.show.versus.colours import NAMES, look
from eventsim.show.versus.losses import STEP, draw_energy, draw_missed, scale_steps
from eventsim.show.versus.notes import ACROSS, note
from eventsim.show.versus.page import save_page
from eventsim.validation.compare import FITTED, Comparison, Line
from eventsim.validation.verdict import verdict

SIZE, TITLE_LETTERS = (16.0, 9.0), 150
"""Inches; letters in a line of the title."""

AROUND = 3.0
"""As a factor: how much of the axis of times is free on both sides of the event-driven run, for its name."""

FAR = 10.0
"""Per cent: where a pressure is off by more, a scale that is logarithmic beyond 1 per cent shows the others as well."""

AGAINST = "against event-driven [%]"

EXACT_ANGLE = 1e-3
"""Degrees: angles that are wrong by less are drawn here."""


def write_comparison(comparison: Comparison, path: str | PathLike[str]) -> None:
    """Draw a comparison to `path`: .png, .svg or .pdf.  Raises EventsimError where it cannot be written."""
    figure = Figure(figsize=SIZE, dpi=100, facecolor="white", layout=ConstrainedLayoutEngine(h_pad=0.08))
    title = fill(f"{comparison.name}. {verdict(comparison)[0]}", TITLE_LETTERS)
    figure.suptitle(as_written(title), fontsize=13, x=0.01, ha="left", color=LIGHT.ink)
    grid = figure.subplots(2, 3)
    draw_missed(grid[0, 0], comparison)
    if any(line.energy is not None for line in comparison.lines):
        draw_energy(grid[0, 1], comparison)
    else:
        bias = "Bias of the rate of contacts"
        _panel(grid[0, 1], comparison, lambda line: 100.0 * line.rate, AGAINST, bias)
        grid[0, 1].axhline(0.0, color=LIGHT.ink, lw=0.9)
    check = min(FITTED, len(comparison.checks) - 1)
    title = "Positions after two contacts a disk"
    _panel(grid[0, 2], comparison, lambda line: line.errors[check], "position error [diameters]", title, log=True)
    angles, pressure, times = grid[1]
    _panel(angles, comparison, _angle, "mean error [degrees]", "Deflection angles of found contacts", log=True)
    if any(_angle(line) == EXACT_ANGLE for line in comparison.lines):
        note(angles, f"{EXACT_ANGLE:g} or less", (0.0, EXACT_ANGLE), ACROSS, (4, 6))
    _panel(pressure, comparison, lambda line: 100.0 * line.pressure, AGAINST, "Bias of the pressure (virial)")
    pressure.axhline(0.0, color=LIGHT.ink, lw=0.9)
    if any(100.0 * abs(line.pressure) > FAR for line in comparison.lines):
        pressure.set_yscale("symlog", linthresh=1.0)
        pressure.yaxis.set_major_formatter("{x:g}")
        pressure.margins(y=0.1)
    _panel(times, comparison, lambda line: line.elapsed, "CPU seconds per time unit of the scene", "Computing time", log=True)
    for line in comparison.lines:
        spread = [[line.timing.median - line.timing.least], [line.timing.most - line.timing.median]]
        times.errorbar([line.step], [line.elapsed], yerr=spread, fmt="none", ecolor=look(line.label).colour, elinewidth=0.9)
    exact = comparison.exact.elapsed
    times.axhline(exact, color=LIGHT.ink, lw=1.2, ls="--")
    low, high = times.get_ylim()
    times.set_ylim(min(low, exact / AROUND), max(high, exact * AROUND))
    note(times, f"event-driven ({comparison.engine})", (0.0, exact), ACROSS, (4, 4))
    handles = grid[0, 0].get_legend_handles_labels()
    figure.legend(*handles, loc="outside lower center", ncols=3, frameon=False, fontsize=10.5)
    save_page(figure, path)


def _angle(line: Line) -> float:
    return max(line.census.angle, EXACT_ANGLE)


def _panel(
    axes: Axes, comparison: Comparison, value: Callable[[Line], float], y: str, title: str, log: bool = False
) -> None:
    """One measured number against the step, a curve for each engine; a panel without a number above 0 is not logarithmic."""
    for name in dict.fromkeys(line.label for line in comparison.lines):
        lines = [line for line in comparison.lines if line.label == name]
        steps, values = [line.step for line in lines], [value(line) for line in lines]
        axes.plot(steps, values, label=NAMES.get(name, name), **look(name).drawn(5.5))
    scale_steps(axes, comparison)
    if log and any(value(line) > 0.0 for line in comparison.lines):
        axes.set_yscale("log", nonpositive="mask")
    label(axes, STEP, y, title)
