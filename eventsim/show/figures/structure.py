"""Structure: pair distribution and structure factor along a run, with what theory says at contact and for long waves."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from eventsim.errors import LogError
from eventsim.measure.measures import Measure
from eventsim.measure.studies import study
from eventsim.replay.log import AnyLog
from eventsim.show.colouring import shades_of
from eventsim.show.figures.demands import passage_with_time
from eventsim.show.figures.style import BLUE, LENGTH, ORANGE, label
from eventsim.show.output import name_of


def draw(figure: Figure, log: AnyLog) -> None:
    """Draw g(r) of each pair of species and S(k), with bars; dots are theory."""
    passage_with_time(log)
    found = study(log, "structure")
    g, s = found.tables.get("g", {}), found.tables.get("S", {})
    if not g or not s:
        raise LogError(f"structure: {found.quantities[0].doubt or 'the box is too small'}")
    left, right = figure.subplots(1, 2)
    pairs = [name.removeprefix("r") for name in g if name.startswith("r")]
    for end, shade in zip(pairs, shades_of(len(pairs)), strict=True):
        r, value, error = (np.array(g[name]) for name in (f"r{end}", f"g{end}", f"g{end}_error"))
        told = f"species {end[1:].replace('_', ' and ')}" if end else "measured"
        left.plot(r, value, color=shade, lw=1.1, label=told)
        left.fill_between(r, value - error, value + error, color=shade, alpha=0.25, linewidth=0)
        _theory(left, float(r[0]), found[f"g_contact{end}"])
    right.errorbar(s["k"], s["S"], s["S_error"], fmt="o", ms=2.5, lw=0.8, color=BLUE, label="measured")
    _theory(right, 0.0, found["S_0"])
    label(left, f"r [{LENGTH}]", "g(r)", f"{name_of(log)}: structure")
    label(right, f"k [1 / {LENGTH}]", "S(k)", f"psi_6 = {found['psi_6'].value:.3f}")
    for axes in (left, right):
        axes.set_ylim(bottom=0.0)
        axes.legend(frameon=False, fontsize=8)


def _theory(axes: Axes, place: float, entry: Measure) -> None:
    """Draw what theory says at a place, where it says anything."""
    if entry.theory is not None and math.isfinite(entry.theory):
        axes.plot([place], [entry.theory], "o", ms=5, color=ORANGE, label="theory", zorder=3)
