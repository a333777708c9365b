"""Series and profiles as columns: a table of text, a CSV file."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

from eventsim.record.files.atomic import atomic_write

if TYPE_CHECKING:
    from eventsim.measure import Measures

Columns = dict[str, list[float]]
"""Name -> numbers; NaN where there is none."""


def series_columns(measures: Measures) -> Columns:
    """The series as columns."""
    return measures.series.to_dict()


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
