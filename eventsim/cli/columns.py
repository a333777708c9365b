"""Series and profiles as columns: a table of text, a CSV file."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from eventsim.measure.found import Columns, Found
from eventsim.record.files.atomic import atomic_write

if TYPE_CHECKING:
    from eventsim.measure import Measures


def series_columns(measures: Measures) -> Columns:
    """The series as columns."""
    return measures.series.to_dict()


MOST_LAGS = 8
"""Lags of D that are told."""


def diffusion_columns(measures: Measures) -> Columns:
    """D against the lag as columns: the longest lags, each twice as long as the one before."""
    found = measures.correlations
    place = [k for k, error in enumerate(found.diffusion_error.tolist()) if error > 0.0]
    longest = found.lag[place[-1]] if place else math.nan
    chosen = [k for k in place if (longest / found.lag[k]) in {2.0**power for power in range(MOST_LAGS)}]
    return {
        "lag": found.lag[chosen].tolist(),
        "D": found.diffusion[chosen].tolist(),
        "error": found.diffusion_error[chosen].tolist(),
    }


def profile_columns(measures: Measures) -> Columns:
    """The profile as columns: the middle of each slice, and what was measured there of each species."""
    profile = measures.profile
    if profile is None:
        return {}
    columns: Columns = {profile.axis: (0.5 * (profile.edges[1:] + profile.edges[:-1])).tolist()}
    for one in profile.species:
        end = f"_{one.species}" if len(profile.species) > 1 else ""
        columns |= {f"density{end}": one.density.tolist(), f"density_error{end}": one.density_error.tolist()}
        if one.theory is not None:
            columns[f"theory{end}"] = one.theory.tolist()
        for axis, name in enumerate("xy"):
            columns[f"v{name}{end}"] = one.velocity[:, axis].tolist()
            columns[f"v{name}_error{end}"] = one.velocity_error[:, axis].tolist()
        columns |= {f"temperature{end}": one.temperature.tolist(), f"temperature_error{end}": one.temperature_error.tolist()}
    return columns


def study_columns(found: Iterable[Found]) -> Columns:
    """All tables of studies side by side; NaN below the end of a short one, the table's name before a column's that is taken."""
    columns: Columns = {}
    for name, table in ((name, table) for one in found for name, table in one.tables.items()):
        columns |= {key if key not in columns else f"{name}_{key}": column for key, column in table.items()}
    longest = max(map(len, columns.values()), default=0)
    return {key: column + [math.nan] * (longest - len(column)) for key, column in columns.items()}


def table_of(columns: Columns) -> str:
    """Columns as aligned lines; a dash where there is no number, and no column that is all dashes."""
    known = {name: column for name, column in columns.items() if not all(math.isnan(number) for number in column)}
    cells = [[name, *(EM_DASH if math.isnan(number) else f"{number:.4g}" for number in column)] for name, column in known.items()]
    widths = [max(map(len, column)) for column in cells]
    lines = zip(*cells, strict=True)
    return "\n".join("  " + "  ".join(f"{cell:>{width}}" for cell, width in zip(line, widths, strict=True)) for line in lines)


EM_DASH = "\N{EM DASH}"


def write_columns(columns: Columns, path: Path) -> None:
    """Write columns to a CSV file; what has no number is empty."""
    with atomic_write(path) as part, part.open("w", encoding="utf-8", newline="") as file:
        file.write(",".join(columns) + "\n")
        for line in zip(*columns.values(), strict=True):
            file.write(",".join("" if math.isnan(number) else repr(number) for number in line) + "\n")
