"""Z against the packing fraction: the runs of a sweep beside the equation of state of the fluid."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from eventsim.errors import EventsimError
from eventsim.measure.theory import KOLAFA_ROTTNER_UP_TO, compressibility_factor
from eventsim.record.events import Floats
from eventsim.show.figures.style import BLUE, ORANGE, RED, label, name_of
from eventsim.show.figures.write import save_figure
from eventsim.sweep.task import Row


def write_equation_of_state(rows: Sequence[Row], path: Path, name: str | None = None) -> None:
    """Draw the table of a sweep to .png, .svg or .pdf; EventsimError where it holds no Z."""
    save_figure(lambda figure: draw(figure, rows, name), path)


def draw(figure: Figure, rows: Sequence[Row], name: str | None = None) -> None:
    """Draw the mean Z of the replicas at each packing fraction, and its distance from theory in standard errors of both."""
    eta, z, error, theory, accuracy, settled = averages(rows)
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(3, 1))
    x = np.linspace(0.0, min(KOLAFA_ROTTNER_UP_TO, max(1.1 * float(eta.max()), 0.05)), 200)
    curve = [compressibility_factor(value) for value in x.tolist()]
    above.plot(x, curve, color=ORANGE, lw=1.5, label="Kolafa & Rottner 2006, fluid, N \N{RIGHTWARDS ARROW} \N{INFINITY}")
    for chosen, colour, text in ((settled, BLUE, "measured"), (~settled, RED, "not known to be equilibrated")):
        if chosen.any():
            above.errorbar(eta[chosen], z[chosen], error[chosen], fmt="o", ms=4, color=colour, label=text)
    compared = np.isfinite(theory) & np.isfinite(accuracy)
    off = (z - theory)[compared] / np.hypot(error, accuracy)[compared]
    below.axhspan(-1.0, 1.0, color="#e3e6ea")
    below.axhline(0.0, color=ORANGE, lw=1.5)
    below.plot(eta[compared], off, "o", ms=4, color=BLUE)
    verdict = "no theory for these states"
    if compared.any():
        verdict = f"{np.sqrt((off**2).mean()):.1f} standard errors from theory, root mean square"
    label(above, "", "Z = P V / N kT", f"{name_of(name)}: {verdict}")
    label(below, "packing fraction", "difference\n[std. errors]", "")
    above.legend(frameon=False)


def averages(rows: Sequence[Row]) -> tuple[Floats, Floats, Floats, Floats, Floats, NDArray[np.bool_]]:
    """(packing fraction, Z, its error, theory, its accuracy, whether all are equilibrated), one entry for each setting and N.

    Theory is NaN where there is none, its accuracy where it is a guide and no prediction.
    Replicas are weighted by their error bars.  Raises EventsimError where no row holds a packing fraction and a Z.
    """
    groups: dict[tuple[float, object], list[Row]] = {}
    for row in rows:
        eta, spread = row.get("packing_fraction"), row.get("Z_error")
        if isinstance(eta, float) and isinstance(row.get("Z"), float) and isinstance(spread, float) and spread > 0.0:
            # the same setting may differ in the last digit of what the disks cover
            groups.setdefault((round(eta, 12), row.get("disks")), []).append(row)
    if not groups:
        raise EventsimError("there is nothing to draw: no run of the table has a packing fraction and a Z with an error bar")
    means = [_mean(group) for _, group in sorted(groups.items(), key=lambda item: item[0][0])]
    z, error, theory, accuracy, settled = (np.array([mean[k] for mean in means]) for k in range(5))
    return np.array(sorted(eta for eta, _ in groups)), z, error, theory, accuracy, settled.astype(np.bool_)


def _mean(group: Sequence[Row]) -> tuple[float, float, float, float, bool]:
    """(Z, its error, theory, its accuracy, whether all are equilibrated) of replicas."""
    z, error, theory, accuracy = (_column(group, key) for key in ("Z", "Z_error", "Z_theory", "Z_accuracy"))
    weight = 1.0 / error**2
    settled = all(row.get("equilibrated") is True for row in group)
    mean, spread = float(np.average(z, weights=weight)), float(weight.sum() ** -0.5)
    return mean, spread, float(theory.mean()), float(accuracy.mean()), settled


def _column(rows: Sequence[Row], key: str) -> Floats:
    values = [row.get(key) for row in rows]
    return np.array([float(value) if isinstance(value, int | float) else math.nan for value in values])
