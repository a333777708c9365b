"""Comparisons and charts as CSV files: lines that begin with `# ` say where the numbers come from, then a header and rows."""

from __future__ import annotations

import csv
import json
import platform
import sys
from collections.abc import Mapping, Sequence
from io import StringIO
from pathlib import Path
from typing import Any

from eventsim.record.files.atomic import atomic_write
from eventsim.validation.advantages import advantages
from eventsim.validation.chart import Chart
from eventsim.validation.compare import Comparison, Line
from eventsim.validation.versions import versions


def line_data(line: Line) -> dict[str, Any]:
    """One line of a comparison as plain values."""
    census = line.census
    return {
        "engine": line.label,
        "dt": line.dt,
        "radii_per_step": line.step,
        "pair_contacts": line.pair_contacts,
        "wall_contacts": line.wall_contacts,
        "contact_ratio": line.ratio,
        "ahead": census.exact,
        "found": census.found,
        "missed": census.missed,
        "doubled": census.doubled,
        "spurious": census.spurious,
        "angle_error_deg": census.angle,
        "deepest_overlap": line.overlap,
        "longest_stuck": line.stuck,
        **{f"position_error_{k}": error for k, error in enumerate(line.errors)},
        "energy_drift": line.energy,
        "momentum_drift": line.momentum,
        "rate_bias": line.rate,
        "pressure_bias": line.pressure,
        "elapsed_per_time": line.timing.median,
        "elapsed_least": line.timing.least,
        "elapsed_most": line.timing.most,
        "timed_runs": line.timing.runs,
        "steps": line.steps,
        "pair_tests": line.pair_tests,
    }


def comparison_rows(comparison: Comparison) -> list[dict[str, Any]]:
    """The event-driven line and those of the stepped engines."""
    return [line_data(line) for line in (comparison.exact, *comparison.lines)]


def chart_rows(chart: Chart) -> list[dict[str, Any]]:
    """Every point of a chart as a row; columns that a panel does not have are empty."""
    rows: list[dict[str, Any]] = []
    for curves in chart.tasks:
        for point in curves.points:
            rows.append(
                {
                    "panel": "precision",
                    "scene": point.scene,
                    "measure": point.measure,
                    "engine": point.label,
                    "parameter": point.parameter,
                    "value": point.value,
                    "error": point.error,
                    "error_least": point.error_least,
                    "error_most": point.error_most,
                    "elapsed_per_time": point.elapsed,
                    "elapsed_least": point.least,
                    "elapsed_most": point.most,
                    "events": point.events,
                    "steps": point.steps,
                    "pair_tests": point.pair_tests,
                    "calendar_events": point.calendar,
                }
            )
    if chart.losses is not None:
        rows += [{"panel": "losses", "scene": "gas", **line_data(line)} for line in chart.losses.lines]
    if chart.chaos is not None:
        for label, errors in chart.chaos.errors.items():
            for contacts, error in zip(chart.chaos.contacts, errors, strict=False):
                rows.append(
                    {"panel": "chaos", "engine": label, "parameter": "contacts", "value": contacts, "error": error}
                )
    for label, points in chart.rates.items():
        rows += [
            {"panel": "rate", "engine": label, "parameter": "disks", "value": n, "contacts_per_s": rate}
            for n, rate in points
        ]
    for each in advantages(chart):
        rows.append(
            {
                "panel": "advantage",
                "scene": each.scene,
                "engine": each.label,
                "parameter": "wanted error",
                "value": each.wanted,
                "time_ratio": each.time_ratio,
                "bound": each.bound,
                "error_ratio": each.error_ratio,
            }
        )
    return rows


def provenance_lines(command: str | None, facts: Mapping[str, Any]) -> list[str]:
    """Where numbers come from: version, command, machine, and facts of the caller."""
    machine = f"{platform.machine()} {sys.platform}"
    data = {**versions(), "command": command, "machine": machine, **facts}
    return [f"# {key}: {json.dumps(value)}" for key, value in data.items()]


def write_csv(path: Path, rows: Sequence[Mapping[str, Any]], comments: Sequence[str]) -> None:
    """Write rows under the union of their keys; the file appears when it is whole. EventsimError where it cannot be written."""
    text = StringIO()
    text.writelines(f"{line}\n" for line in comments)
    keys = list(dict.fromkeys(key for row in rows for key in row))
    writer = csv.DictWriter(text, keys, lineterminator="\n", restval="")
    writer.writeheader()
    writer.writerows({key: "" if value is None else _plain(value) for key, value in row.items()} for row in rows)
    with atomic_write(path) as part:
        part.write_text(text.getvalue(), encoding="utf-8")


def _plain(value: Any) -> Any:
    return value.item() if hasattr(value, "item") else value
