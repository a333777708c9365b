"""Any measure of a sweep against any of its numbers: the replicas of each value averaged, with error bars, theory beside."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from eventsim.errors import EventsimError, did_you_mean
from eventsim.record.events import Floats
from eventsim.show.figures.equation_of_state import column, keys_of, number_in, series_of, styles, weighted
from eventsim.show.figures.style import ORANGE, label
from eventsim.show.figures.write import save_figure
from eventsim.show.output import as_written
from eventsim.sweep.task import Row


def write_swept(rows: Sequence[Row], path: Path, x: str | None, y: str | None, name: str | None = None) -> None:
    """Draw two columns of the table of a sweep to .png, .svg or .pdf.

    Args:
        rows: of the table.
        path: of the picture.
        x: the column to the right; None: the first key that takes several values.
        y: the column upwards; None: Z.
        name: of what was swept.

    Raises:
        EventsimError: where a column is not there, or no run has numbers in both.
    """
    save_figure(lambda figure: draw(figure, rows, x, y, name), path)


def draw(figure: Figure, rows: Sequence[Row], x: str | None, y: str | None, name: str | None = None) -> None:
    """Draw the mean of the replicas at each value of x, a series for each setting of the other keys."""
    along = x or next((key for key in keys_of(rows) if len({row.get(key) for row in rows}) > 1), "packing_fraction")
    upwards = y or "Z"
    columns = numbers_of(rows)
    for option, asked in (("--x", along), ("--y", upwards)):
        if asked not in columns:
            raise EventsimError(
                f"{option} {asked}: no run of the table has such a number{did_you_mean(asked, columns)}; "
                f"there are {', '.join(columns)}"
            )
    drawn = partial(_has_both, x=along, y=upwards)
    if not any(map(drawn, rows)):
        raise EventsimError(f"there is nothing to draw: no run of the table has both {along} and {upwards}")
    axes = figure.subplots()
    shown = False
    for (words, members), style in zip(series_of(rows, along, drawn), styles(), strict=False):
        places, means, errors, theory = averages(list(filter(drawn, members)), along, upwards)
        known = np.isfinite(theory)
        axes.plot(places[known], theory[known], color=ORANGE, lw=1.5, label=None if shown or not known.any() else "theory")
        shown |= bool(known.any())
        axes.errorbar(places, means, np.nan_to_num(errors), fmt="none", color=style["color"])
        axes.plot(places, means, label=as_written(words) or "measured", **style)
    right, up = (as_written(column.replace("_", " ")) for column in (along, upwards))
    label(axes, right, up, f"{as_written(name or 'these runs')}: {up} against {right}, means of replicas")
    axes.legend(frameon=False)


def averages(rows: Sequence[Row], x: str, y: str) -> tuple[Floats, Floats, Floats, Floats]:
    """(x, mean of y, its standard error, theory), one entry for each x.

    Replicas are weighted by their error bars; where one has none, the error is that of their scatter, NaN for a single one.
    """
    groups: dict[float, list[Row]] = {}
    for row in rows:
        groups.setdefault(round(number_in(row, x), 12), []).append(row)
    means = np.array([_mean(groups[place], y) for place in sorted(groups)])
    return np.array(sorted(groups)), means[:, 0], means[:, 1], means[:, 2]


def _mean(rows: Sequence[Row], y: str) -> tuple[float, float, float]:
    """(Mean, its standard error, theory) of replicas."""
    values, errors, theory = (column(rows, key) for key in (y, f"{y}_error", f"{y}_theory"))
    if (errors > 0.0).all():
        return *weighted(values, errors), float(theory.mean())
    scatter = float(values.std(ddof=1)) / math.sqrt(len(values)) if len(values) > 1 else math.nan
    return float(values.mean()), scatter, float(theory.mean())


def numbers_of(rows: Sequence[Row]) -> list[str]:
    """The columns that tell a number in some run: settings first, then what was measured, without errors and theory."""
    beside = ("_error", "_theory", "_accuracy")
    found = dict.fromkeys(key for row in rows for key in row if math.isfinite(number_in(row, key)))
    return [key for key in found if key not in ("replica", "seed") and not key.endswith(beside)]


def _has_both(row: Row, x: str, y: str) -> bool:
    return math.isfinite(number_in(row, x)) and math.isfinite(number_in(row, y))
