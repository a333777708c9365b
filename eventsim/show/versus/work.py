"""One scene of a chart: error against computing time, a curve for each engine, and what lies between them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, NullFormatter

from eventsim.show.figures.style import label
from eventsim.show.output import as_written
from eventsim.show.palette import LIGHT
from eventsim.show.versus.colours import look
from eventsim.show.versus.notes import ACROSS, note, panel_title
from eventsim.validation.advantages import (
    OWN,
    WANTED,
    Advantage,
    advantages_on,
    amount,
    own_points,
    time_at,
)
from eventsim.validation.conclusions import Win, winning
from eventsim.validation.precision import Curves, Point

ERRORS = {
    "trajectory": "position error [diameters]",
    "pressure": "relative error of the pressure (virial)",
    "unrest": r"unrest: overlap [d] or speed [$\sqrt{gd}$]",
}
BESIDE = 9
"""Points from an arrow to its words: half a star, and some more."""

ARROW = "#333333"
SHADE, WON = "#e3e6ea", "#fbe9d7"
"""Backgrounds: what is chance, and where a stepped engine is ahead."""


def draw_work(axes: Axes, curves: Curves) -> None:
    """Error against seconds per time unit of the scene; arrows: the other's error in equal time, its time at equal error."""
    for name in curves.labels:
        points, alone = curves.of(name), len(curves.of(name)) == 1
        style = look(name).drawn(13 if alone else 5)
        above = 3 if not alone else 5 + (name == OWN[0])  # on small scenes engines share a place
        axes.plot([p.elapsed for p in points], [p.error for p in points], lw=1.3, zorder=above, **style)
        bars = [p for p in points if math.isfinite(p.least)]
        across, up = (
            [[middle - low for low, middle, _ in spread], [high - middle for _, middle, high in spread]]
            for spread in ([(p.least, p.elapsed, p.most) for p in bars], [_seeds(p) for p in bars])
        )
        where = [p.elapsed for p in bars], [p.error for p in bars]
        axes.errorbar(*where, xerr=across, yerr=up, fmt="none", ecolor=look(name).colour, elinewidth=0.9, zorder=2)
    axes.set_xscale("log")
    axes.set_yscale("log")
    low, high = axes.get_ylim()
    axes.set_ylim(min(low, WANTED[curves.task.measure]) / 3.0, high * 2.0)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(LogLocator(numticks=8))
        axis.set_minor_formatter(NullFormatter())
    if curves.floor > 0.0:
        axes.axhspan(axes.get_ylim()[0], curves.floor, color=SHADE, zorder=0)
        note(axes, "below: chance", (0.98, 0.015), "axes fraction", ha="right", color=LIGHT.faint, back=SHADE)
    win = winning(curves)
    if win is not None:
        _draw_win(axes, win)
    else:
        _draw_advantages(axes, curves)
    title = f"{curves.task.name}: {curves.task.words}" if curves.task.words else curves.task.name
    label(axes, "CPU seconds per time unit of the scene", ERRORS[curves.task.measure], as_written(panel_title(title)))
    axes.title.set_fontsize(10.5)


def _seeds(point: Point) -> tuple[float, float, float]:
    """(least, median, most) of the errors over the seeds."""
    if not math.isfinite(point.error_least):
        return point.error, point.error, point.error
    return point.error_least, point.error, point.error_most


def _draw_win(axes: Axes, win: Win) -> None:
    """Shade the errors at which a stepped engine is the faster one."""
    axes.axhspan(axes.get_ylim()[0], win.begins, color=WON, zorder=0)
    text = f"shaded: {win.label} is ahead,\n{amount(win.ratio)} x sooner at {win.error:.1g}"
    note(axes, text, (0.02, 0.03), "axes fraction", back=WON)


def _draw_advantages(axes: Axes, curves: Curves) -> None:
    """Two arrows from the event-driven engine: up to the best error in its time, right to the least time for its error."""
    own, found = own_points(curves), advantages_on(curves)
    if not own or not found:
        return
    best = min(own, key=lambda point: point.error)
    wanted = WANTED[curves.task.measure]
    in_time = [a for a in found if not math.isnan(a.error_ratio)]
    if in_time:
        nearest = min(in_time, key=lambda a: a.error_ratio)
        _arrow(axes, (best.elapsed, best.error), (best.elapsed, best.error * nearest.error_ratio))
        middle = math.sqrt(best.error * best.error * nearest.error_ratio)
        text = f"equal time: the next\nerrs {amount(nearest.error_ratio)} x as much"
        note(axes, text, (best.elapsed, middle), va="center", **_beside(axes, best.elapsed, 0))
    axes.axhline(wanted, color=ARROW, lw=0.8, ls=(0, (4, 3)), zorder=1)
    note(axes, f"{wanted:g}", (0.0, wanted), ACROSS, (3, 3))
    _draw_time(axes, found, time_at(own, wanted), wanted)


def _draw_time(axes: Axes, found: list[Advantage], mine: float, wanted: float) -> None:
    """The arrow at equal error, to the first stepped engine that comes to it; a sentence where none does."""
    reached = [a for a in found if a.bound == "" and not math.isnan(a.time_ratio)]
    text = f"no stepped engine\ncomes to {wanted:g}"
    if reached:
        nearest = min(reached, key=lambda a: a.time_ratio)
        _arrow(axes, (mine, wanted), (mine * nearest.time_ratio, wanted))
        text = f"equal error:\n{amount(nearest.time_ratio)} x the time"
    note(axes, text, (mine, wanted), va="top", **_beside(axes, mine, -4))


def _beside(axes: Axes, elapsed: float, up: float) -> dict[str, Any]:
    """Where words stand beside an arrow: to its right, or to its left where they would leave the panel; so many points up."""
    low, high = (math.log(value) for value in axes.get_xlim())
    right = math.log(elapsed) > low + 0.65 * (high - low)
    return {"offset": (-BESIDE if right else BESIDE, up), "ha": "right" if right else "left"}


def _arrow(axes: Axes, start: tuple[float, float], end: tuple[float, float]) -> None:
    if np.all(np.isfinite([*start, *end])):
        axes.annotate("", end, xytext=start, arrowprops={"arrowstyle": "<->", "color": ARROW, "lw": 1.3}, zorder=4)
