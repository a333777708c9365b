"""`eventsim validate --trajectory`: an engine judged by the motion that it gave."""

from __future__ import annotations

from pathlib import Path

import click

from eventsim.cli.output import say, say_data
from eventsim.cli.words import as_json_text
from eventsim.judged import validate
from eventsim.scene import Scene
from eventsim.validation.judge.table import judgement_data, judgement_rows
from eventsim.validation.table import provenance_lines, write_csv


def say_judged(
    scene: Scene,
    trajectory: str,
    contacts: str | None,
    steps: tuple[float, ...],
    tolerance: float | None,
    until: float | None,
    csv: Path | None,
    figure: Path | None,
    as_json: bool,
    quiet: bool,
) -> None:
    """Judge a motion, write what was asked for, and print the verdict."""
    dt = steps[0] if steps else None
    judged = validate(scene, trajectory=trajectory, contacts=contacts, dt=dt, until=until, tolerance=tolerance)
    data = judgement_data(judged.judgement)
    if csv is not None:
        facts = {"scene": data["scene"], "trajectory": trajectory, "tolerance": data["tolerance"], "verdict": data["verdict"]}
        write_csv(csv, judgement_rows(judged.judgement), provenance_lines(click.get_current_context().obj, facts))
    if figure is not None:
        judged.save_figure(figure)
    if as_json:
        say_data(as_json_text(data))
    elif not quiet:
        say(f"{trajectory} on {data['scene']}: {data['told']}\n\n{judged}")
