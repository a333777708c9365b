"""`eventsim validate`: the event-driven run of a scene against time-stepped engines."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from itertools import groupby
from typing import TYPE_CHECKING

import click

from eventsim.cli.options import drawable, json_option, quiet_option, scene_options, writable
from eventsim.cli.output import FAILED, INTERRUPTED, say, say_data

if TYPE_CHECKING:
    from eventsim.validation.compare import Comparison, Line

PATIENCE_HELP = "CPU seconds for one run at most; ten times that for the event-driven one, whose end all others then share."

@click.command()
@scene_options(required=True)
@click.option("--dt", "steps", type=float, multiple=True, metavar="DT", help="A step size; may be given several times.")
@click.option(
    "--against",
    multiple=True,
    metavar="ENGINE",
    help="Only this engine; may be given several times. Default: all of them.",
)
@click.option("--trajectory", metavar="FILE", help="Judge your own engine by its motion (.csv, .npz, ...).")
@click.option("--contacts", metavar="FILE", help="The contacts that it tells: .csv, .npz, .parquet.")
@click.option("--tolerance", type=float, metavar="T", help="How far apart the times of one contact may be.")
@click.option("--until", type=float, metavar="T", help="Simulate, or judge, until this time.")
@click.option("--patience", type=float, default=1.0, show_default=True, metavar="S", help=PATIENCE_HELP)
@click.option("--csv", metavar="FILE.csv", help="Write all numbers, with where they come from.")
@click.option("--figure", metavar="FILE", help="Draw them: .png, .svg or .pdf.")
@json_option
@quiet_option
def command(
    scene: str,
    settings: tuple[str, ...],
    seed: int | None,
    steps: tuple[float, ...],
    against: tuple[str, ...],
    trajectory: str | None,
    contacts: str | None,
    tolerance: float | None,
    until: float | None,
    patience: float,
    csv: str | None,
    figure: str | None,
    as_json: bool,
    quiet: bool,
) -> None:
    """Compare the event-driven run of SCENE with engines that advance in steps, over a list of steps.

    Contacts are compared one by one: each engine is set on states of the event-driven run, again and again, and followed
    for half a mean free time. Trajectories are compared after 1, 2, 4 and 8 contacts a disk; rate, pressure, energy and
    disks stuck at walls over the whole run. Without --dt, typical disks fly 2 radii to 0.01 radii in a step; what an
    engine calls sub-steps are smaller steps here.

    \b
    Engines: frames, frames-forget (a students' project, two readings of its memory), stepped,
    stepped-located (impact located within the step), penalty (springs), pymunk, pymunk-1, pymunk-30
    (Chipmunk, an extra, with 10, 1, 30 iterations of its solver in a step).

    \b
    Your own engine: --trajectory FILE has where it moved the disks of SCENE, at any times. Its contacts are read from
    the paths, or told by --contacts. Matched pair by pair with those of the event-driven run, in order, with the least
    total difference of times; its first wrong event is named, with disks and time. Overlaps deeper than two steps of it explain
    are wrong at any time. --dt: time between frames (XYZ, column frame).

    
    Columns of --trajectory (CSV, NPZ, Parquet), disks in the order of the scene, counted from 0, or from 1:
      time, disk, x, y [, vx, vy]        a row for each disk and time
      time, x0, y0, x1, y1, ...          a row for each time
      time, position [, velocity]        arrays (T,), (T, n, 2) of an .npz file
    Columns of --contacts: time, a, b (-1: a wall) [, wall], disks counted as in --trajectory

    
    Examples:
      eventsim validate gas --figure gas.png --csv gas.csv
      eventsim run gas --until 0 --state start.csv       the start, for an engine of yours
      eventsim validate gas --trajectory mine.csv --figure mine.png
      eventsim validate corner --against stepped --against penalty
      eventsim validate my.toml --dt 0.01 --dt 0.001 --json

    Columns: found, missed, doubled, spurious in per cent of the contacts ahead; angle: mean error of
    deflection, degrees; overlap: the deepest, in reaches; stuck: longest time at a wall; position: error
    after two contacts a disk, diameters; energy: relative change; rate, pressure: relative to event-driven;
    s/time: CPU seconds per time unit, the median of warm runs that only step; +-: half their spread.

    \b
    Keys of --json:
      scene, engine            as typed; the event-driven engine
      checks, horizon          times of comparison; until when float64 can be believed
      agrees                   whether the event-driven engines wrote the same log
      rows                     one object a line, keys as in the CSV file
      orders                   engine -> measured order of convergence (null: not measurable)
      settings, versions       what each engine was told; of what is compared
      left_out, verdict        sentences

    With --trajectory: source, told (the file; what it holds), first_fault {kind, time, disks, sentence}, compared (how
    many contacts), faults, parting (of the contacts: time, sentence), elapsed_per_time (of a step function), contacts {found,
    missed, doubled, false, elsewhere, unseen (in the samples), untold (found, and nobody knows their impulse)},
    late, positions, lost, believed, energy, momentum, deepest_overlap, tolerance, remarks, verdict, versions.

    Exit codes: 0 done, whatever stepped engines did; 1 event-driven engines do not agree; 2 bad usage or scene; 130
    interrupted: what was reached is told.
    With --trajectory: 0 also where a wrong event is named: in a test ask whether first_fault of --json is null
    and compared is above 0: of nothing nothing is wrong.
    """
    csv_path, figure_path = writable(csv, "--csv", (".csv",)), drawable(figure, "--figure")
    judging = trajectory is not None
    if not judging and (contacts is not None or tolerance is not None):
        raise click.UsageError("--contacts and --tolerance belong to --trajectory")
    if judging and (against or len(steps) > 1):
        raise click.UsageError("--trajectory judges one motion as it is: --against and several --dt do not go with it")
    for step in steps:
        if not 0.0 < step < math.inf:
            raise click.UsageError(f"--dt {step!r}: a step must be a finite time above 0")

    from eventsim.cli.progress import status_line
    from eventsim.cli.source import chosen_scene
    from eventsim.cli.words import as_json_text
    from eventsim.validation.compare import compare
    from eventsim.validation.competitors import chosen_competitors
    from eventsim.validation.table import comparison_rows, provenance_lines, write_csv
    from eventsim.validation.verdict import verdict
    from eventsim.validation.versions import versions

    chosen = chosen_scene(scene, settings, seed)
    if trajectory is not None:
        from eventsim.cli.judge import say_judged

        say_judged(chosen, trajectory, contacts, steps, tolerance, until, csv_path, figure_path, as_json, quiet)
        return
    competitors = chosen_competitors(against)
    with status_line(quiet or as_json) as tell:
        comparison = compare(chosen, competitors, steps or None, until, patience, tell, keeps=True)
    if csv_path is not None:
        facts = {
            "scene": scene,
            "checks": comparison.checks,
            "engine": comparison.engine,
            "settings": comparison.settings,
            "left_out": comparison.left_out,
        }
        lines = provenance_lines(click.get_current_context().obj, facts)
        write_csv(csv_path, comparison_rows(comparison), lines)
    if figure_path is not None:
        from eventsim.show.versus.comparison import write_comparison

        write_comparison(comparison, figure_path)
    if as_json:
        data = {
            "scene": scene,
            "engine": comparison.engine,
            "checks": list(comparison.checks),
            "horizon": comparison.truth.horizon,
            "agrees": comparison.agrees,
            "rows": comparison_rows(comparison),
            "orders": comparison.orders,
            "settings": comparison.settings,
            "versions": versions(),
            "left_out": comparison.left_out,
            "verdict": verdict(comparison),
        }
        say_data(as_json_text(data))
    elif not quiet:
        say(_text(scene, comparison, verdict(comparison)))
    if comparison.interrupted:
        click.get_current_context().exit(INTERRUPTED)
    if not comparison.agrees:
        say("the event-driven engines do not write the same log", err=True)
        click.get_current_context().exit(FAILED)


def _text(scene: str, comparison: Comparison, sentences: list[str]) -> str:
    """The table, what was left out, the verdict, settings and versions."""
    from eventsim.validation.versions import versions

    run = comparison.truth.run
    lines = [
        f"{scene}: event-driven ({comparison.engine}) to t = {comparison.truth.times[-1]:g}: "
        f"{run.counters.pair_contacts:,} pair and {run.counters.wall_contacts:,} wall contacts, "
        f"{comparison.exact.elapsed:.2g} s per time unit; believed until t = {comparison.truth.horizon:.4g}",
    ]
    lines += ["", CONTACTS_HEAD, *_by_engine(comparison.lines, _contacts_row)]
    lines += ["", MOTION_HEAD, *_by_engine(comparison.lines, _motion_row), "", *LEGEND]
    lines += ["", *comparison.left_out, *([""] if comparison.left_out else []), *sentences, ""]
    lines.append("; ".join(f"{label}: {told}" for label, told in comparison.settings.items()))
    lines.append(", ".join(f"{name} {number}" for name, number in versions().items()))
    return "\n".join(lines)


def _by_engine(lines: Sequence[Line], row: Callable[[Line], str]) -> Iterator[str]:
    """The rows of a table, those of each engine apart."""
    for number, (_, group) in enumerate(groupby(lines, lambda line: line.label)):
        if number:
            yield ""
        yield from map(row, group)


LEGEND = (
    "radii/dt: what a typical disk flies in a step. found to spurious: % of the contacts ahead of exact states, on which the"
    " engine is set; angle: of its deflections, degrees off; overlap: in reaches; stuck: time at a wall.",
    "position: error after two contacts a disk, diameters; energy: relative change; rate, pressure: over the whole run,"
    " beside event-driven (without contacts at its very end); s/time: CPU seconds per time unit.",
)
"""What the columns hold."""

CONTACTS_HEAD = "engine           radii/dt  found missed doubled spurious  angle  overlap   stuck"


def _contacts_row(line: Line) -> str:
    census = line.census
    shares = (census.share(count) for count in (census.found, census.missed, census.doubled, census.spurious))
    found, missed, doubled, spurious = (f"{100.0 * share:.1f}" if not math.isnan(share) else "-" for share in shares)
    angle = "-" if math.isnan(census.angle) else f"{census.angle:.2f}"
    return (
        f"{line.label:<16} {line.step:>8.3g} {found:>6} {missed:>6} {doubled:>7} {spurious:>8} "
        f"{angle:>6} {line.overlap:>8.1e} {line.stuck:>7.3g}"
    )


MOTION_HEAD = "engine           radii/dt   position    energy     rate  pressure    s/time   +-"


def _motion_row(line: Line) -> str:
    energy = "-" if line.energy is None else f"{line.energy:.0e}"
    error = line.errors[min(1, len(line.errors) - 1)]
    spread = 0.5 * (line.timing.most - line.timing.least) / line.timing.median if line.timing.median else 0.0
    return (
        f"{line.label:<16} {line.step:>8.3g} {error:>10.1e} {energy:>9} {line.rate:>+8.1%} {line.pressure:>+9.1%} "
        f"{line.elapsed:>9.1e} {spread:>4.0%}"
    )
