"""Z against the packing fraction: the runs of a sweep beside the equation of state of the fluid."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from itertools import cycle, takewhile
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from eventsim.errors import EventsimError
from eventsim.measure.theory import KOLAFA_ROTTNER_UP_TO, compressibility_factor
from eventsim.record.events import Floats
from eventsim.show.figures.style import BLUE, GREEN, ORANGE, PINK, RED, label
from eventsim.show.figures.write import save_figure
from eventsim.show.output import as_written
from eventsim.show.palette import LIGHT
from eventsim.sweep.task import Row

COLOURS = (BLUE, GREEN, PINK, RED)
"""Of the series, in turn; theory is orange."""

MARKS = ("o", "s", "^", "D", "v")
"""Their marks: more than colours, by one, so that all pairs of both come up."""


def write_equation_of_state(rows: Sequence[Row], path: Path, name: str | None = None) -> None:
    """Draw the table of a sweep to .png, .svg or .pdf; EventsimError where it holds no Z."""
    save_figure(lambda figure: draw(figure, rows, name), path)


def draw(figure: Figure, rows: Sequence[Row], name: str | None = None) -> None:
    """Draw the mean Z of the replicas at each packing fraction, and its distance from theory in standard errors of both."""
    offs = [off for _, members in series_of(rows) for off in _off(members)]
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(3, 1)) if offs else (figure.subplots(), None)
    _draw_z(above, rows)
    verdict = "no prediction for these states; the curve is that of the fluid without walls"
    if offs:
        verdict = f"{np.sqrt(np.mean(np.square(offs))):.1f} standard errors from theory, root mean square"
    label(above, "" if below else "packing fraction", "Z = P V / N kT", f"{name or 'these runs'}: {verdict}")
    if below is not None:
        below.axhspan(-1.0, 1.0, color="#e3e6ea")
        below.axhline(0.0, color=ORANGE, lw=1.5)
        for (_, members), style in zip(series_of(rows), styles(), strict=False):
            eta, _, _, theory, accuracy, _ = averages(members)
            below.plot(eta[np.isfinite(theory) & np.isfinite(accuracy)], _off(members), **style)
        label(below, "packing fraction", "difference\n[std. errors]", "")


def _draw_z(axes: Axes, rows: Sequence[Row]) -> None:
    eta, *_ = averages(rows)
    x = np.linspace(0.0, min(KOLAFA_ROTTNER_UP_TO, max(1.1 * float(eta.max()), 0.05)), 200)
    curve = [compressibility_factor(value) for value in x.tolist()]
    axes.plot(x, curve, color=ORANGE, lw=1.5, label="Kolafa & Rottner 2006, fluid, N \N{RIGHTWARDS ARROW} \N{INFINITY}")
    doubtful = False
    for (words, members), style in zip(series_of(rows), styles(), strict=False):
        eta, z, error, _, _, settled = averages(members)
        axes.errorbar(eta, z, error, fmt="none", color=style["color"])
        axes.plot(eta[settled], z[settled], label=as_written(words) or "measured", **style)
        axes.plot(eta[~settled], z[~settled], mfc="white", **style)
        doubtful |= bool((~settled).any())
    if doubtful:
        axes.plot([], [], "o", ms=4, color=LIGHT.faint, mfc="white", label="not known to be equilibrated")
    axes.legend(frameon=False)


def styles() -> Iterator[dict[str, Any]]:
    """How the series are drawn, one after the other."""
    for mark, colour in zip(cycle(MARKS), cycle(COLOURS), strict=False):
        yield {"marker": mark, "ls": "none", "ms": 4, "color": colour}


def _off(rows: Sequence[Row]) -> list[float]:
    """How far Z is from theory, in standard errors of both, where there is a prediction."""
    _, z, error, theory, accuracy, _ = averages(rows)
    compared = np.isfinite(theory) & np.isfinite(accuracy)
    off: list[float] = ((z - theory)[compared] / np.hypot(error, accuracy)[compared]).tolist()
    return off


def series_of(
    rows: Sequence[Row], x: str = "packing_fraction", drawn: Callable[[Row], bool] | None = None
) -> list[tuple[str, list[Row]]]:
    """(words, rows) for each setting of the keys that are swept besides what changes x, in the order of the table.

    drawn: whether a row has what is drawn; None: a packing fraction and a Z.
    """
    keys = [key for key in keys_of(rows) if len({row.get(key) for row in rows}) > 1]
    along = next((key for key in keys if _moves_along(rows, key, keys, x)), None)
    others = [key for key in keys if key != along]
    found: dict[str, list[Row]] = {}
    for row in rows:
        found.setdefault(", ".join(f"{key} = {row.get(key)}" for key in others), []).append(row)
    return [(words, members) for words, members in found.items() if any(map(drawn or _can_be_drawn, members))]


def keys_of(rows: Sequence[Row]) -> list[str]:
    """The keys that were set."""
    return list(takewhile(lambda key: key != "replica", rows[0] if rows else ()))


def _moves_along(rows: Sequence[Row], key: str, keys: Sequence[str], x: str) -> bool:
    """Whether a key changes x where the others stay as they are."""
    places: dict[tuple[object, ...], set[float]] = {}
    for row in rows:
        place = row.get(x)
        if isinstance(place, int | float):
            places.setdefault(tuple(row.get(other) for other in keys if other != key), set()).add(round(place, 12))
    return any(len(values) > 1 for values in places.values())


def averages(rows: Sequence[Row]) -> tuple[Floats, Floats, Floats, Floats, Floats, NDArray[np.bool_]]:
    """(packing fraction, Z, its error, theory, its accuracy, whether all are equilibrated), one entry for each setting and N.

    Theory is NaN where there is none, its accuracy where it is a guide and no prediction.
    Replicas are weighted by their error bars.  Raises EventsimError where no row holds a packing fraction and a Z.
    """
    groups: dict[tuple[float, object], list[Row]] = {}
    for row in rows:
        if _can_be_drawn(row):
            # the same setting may differ in the last digit of what the disks cover
            groups.setdefault((round(float(row["packing_fraction"] or 0.0), 12), row.get("disks")), []).append(row)
    if not groups:
        raise EventsimError(
            "there is nothing to draw: no run of the table has a packing fraction and a Z with an error bar; "
            "--x and --y take any columns of numbers"
        )
    means = [_mean(group) for _, group in sorted(groups.items(), key=lambda item: item[0][0])]
    z, error, theory, accuracy, settled = (np.array([mean[k] for mean in means]) for k in range(5))
    return np.array(sorted(eta for eta, _ in groups)), z, error, theory, accuracy, settled.astype(np.bool_)


def _can_be_drawn(row: Row) -> bool:
    """Whether a row has a packing fraction and a Z with an error bar."""
    eta, z, spread = row.get("packing_fraction"), row.get("Z"), row.get("Z_error")
    return isinstance(eta, float) and isinstance(z, float) and isinstance(spread, float) and spread > 0.0


def _mean(group: Sequence[Row]) -> tuple[float, float, float, float, bool]:
    """(Z, its error, theory, its accuracy, whether all are equilibrated) of replicas."""
    z, error, theory, accuracy = (column(group, key) for key in ("Z", "Z_error", "Z_theory", "Z_accuracy"))
    settled = all(row.get("equilibrated") is True for row in group)
    return *weighted(z, error), float(theory.mean()), float(accuracy.mean()), settled


def weighted(values: Floats, errors: Floats) -> tuple[float, float]:
    """(Mean, its standard error) of numbers that are weighted by their error bars."""
    weight = 1.0 / errors**2
    return float(np.average(values, weights=weight)), float(weight.sum() ** -0.5)


def column(rows: Sequence[Row], key: str) -> Floats:
    """The cells of a column as numbers; NaN where one is none."""
    return np.array([number_in(row, key) for row in rows])


def number_in(row: Row, key: str) -> float:
    """A cell as a number; NaN where it is none."""
    value = row.get(key)
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool) else math.nan
