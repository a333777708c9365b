"""The figure of a comparison: what stepped engines do to one scene, against their step."""

from __future__ import annotations

from collections.abc import Callable
from os import PathLike
from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from eventsim.show.figures.style import label
from eventsim.show.palette import LIGHT
from eventsim.show.versus.colours import NAMES, look
from eventsim.show.versus.page import save_page
from eventsim.validate.compare import FITTED, Comparison, Line
from eventsim.validate.verdict import PERFECT_ENERGY, verdict

STEP = "radii that a typical disk flies in a step"
BOTTOM = 1e-17


def write_comparison(comparison: Comparison, path: str | PathLike[str]) -> None:
    """Draw a comparison to `path`: .png, .svg or .pdf.  Raises EventsimError where it cannot be written."""
    figure = Figure(figsize=(15.0, 9.2), dpi=110, facecolor="white", layout="constrained")
    first = verdict(comparison)[0]
    figure.suptitle(fill(f"{comparison.name}: {first}", 150), fontsize=11, x=0.01, ha="left", color=LIGHT.ink)
    grid = figure.subplots(2, 3)
    check = min(FITTED, len(comparison.checks) - 1)
    _panel(grid[0, 0], comparison, _found, "found of the contacts ahead", "Contacts found, from exact states")
    grid[0, 0].set_ylim(-0.03, 1.05)
    grid[0, 0].axhline(1.0, color=LIGHT.faint, lw=0.8)
    _panel(grid[0, 1], comparison, _energy, "relative change of energy", "Energy: perfect where contacts go missing", log=True)
    grid[0, 1].axhspan(BOTTOM, PERFECT_ENERGY, color="#eef3ea", zorder=0)
    grid[0, 1].annotate("looks perfect", (0.02, PERFECT_ENERGY), xycoords=("axes fraction", "data"), va="top", fontsize=9)
    _panel(
        grid[0, 2],
        comparison,
        lambda line: line.errors[check],
        "position error [diameters]",
        "Trajectories, after two contacts a disk",
        log=True,
    )
    _panel(grid[1, 0], comparison, lambda line: line.census.angle, "mean error [degrees]", "Deflection angles", log=True)
    _panel(grid[1, 1], comparison, lambda line: line.pressure, "relative to event-driven", "Bias of the pressure (virial)")
    grid[1, 1].axhline(0.0, color=LIGHT.faint, lw=0.8)
    _panel(
        grid[1, 2], comparison, lambda line: line.elapsed, "seconds per time unit", "Time; dashed: event-driven run", log=True
    )
    grid[1, 2].axhline(comparison.exact.elapsed, color="#000000", lw=1.2, ls="--")
    handles = grid[0, 0].get_legend_handles_labels()
    figure.legend(*handles, loc="outside lower center", ncols=min(len(handles[0]), 6) or 1, frameon=False, fontsize=9.5)
    save_page(figure, path)


def _found(line: Line) -> float:
    return line.census.share(line.census.found)


def _energy(line: Line) -> float:
    return float("nan") if line.energy is None else max(abs(line.energy), BOTTOM)


def _panel(
    axes: Axes, comparison: Comparison, value: Callable[[Line], float], y: str, title: str, log: bool = False
) -> None:
    """One measured number against the step, a curve for each engine."""
    for name in dict.fromkeys(line.label for line in comparison.lines):
        lines = [line for line in comparison.lines if line.label == name]
        values = np.array([value(line) for line in lines])
        if log:
            values = np.where(values > 0.0, values, np.nan)
        style = look(name)
        axes.plot(
            [line.step for line in lines], values, style.line, marker=style.marker, color=style.colour, ms=5, label=NAMES[name]
        )
    axes.set_xscale("log")
    if log:
        axes.set_yscale("log")
    label(axes, STEP, y, title)
