"""`eventsim measure`: numbers from a log or a run, with error bars, and theory beside them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import click

from eventsim.cli.columns import (
    diffusion_columns,
    profile_columns,
    series_columns,
    study_columns,
    table_of,
    write_columns,
)
from eventsim.cli.options import Verb, json_option, quiet_option, scene_options, writable
from eventsim.cli.output import say, say_data
from eventsim.cli.source import chosen_scene, demand_no_scene_options, is_log, log_of, run_of, stop_options
from eventsim.cli.words import as_json_text, short
from eventsim.measure.quantities import FAMILIES
from eventsim.measure.studies import STUDIES, Study
from eventsim.measure.words import table_text
from eventsim.scene.names import plural

if TYPE_CHECKING:
    from eventsim.measure import Measures
    from eventsim.measure.found import Columns, Found
    from eventsim.record.events import Rows


HELP = """Measure the run that LOG tells, or of SCENE, simulated now without keeping a log.

Every number has a standard error from block averages; the block length is found, not guessed. Averages weigh time to
the very end of the run. Theory stands beside a number only where it holds, with the difference in standard errors. A
quantity without meaning in this run is a dash with the reason; what a number does not say stands behind it. The
beginning is left out as far as --discard, the scene's key equilibration, or else the pressure itself tells. Where a
steady state is in doubt, the reasons are printed.

\b
Examples:
  eventsim measure gas.csv
  eventsim measure periodic-fluid --set packing_fraction=0.3 --events 1000000
  eventsim measure cooling --series --out cooling.csv
  eventsim measure jar --until 500 --profile y
  eventsim measure sinai --until 2000 --lyapunov 1
  eventsim measure periodic-fluid --set n=1000 --events 1e6 --transport --structure

\b
Quantities:
{quantities}

\b
Keys of --json:
  scene                     as typed
  disks, tracers            those that carry energy; those of mass 0
  packing_fraction          of the area that disks can cover; null where nothing bounds it
  table                     {{area, perimeter}} that the centre of a lone disk or of tracers sees, else null
  duration, discarded       of the run; at its beginning; discard_given: whether it was asked for
  steady, equilibrated      can there be a steady state; was it reached, as far as one can tell
  driven                    walls keep up the steady state, which need be no equilibrium
  doubts                    reasons against it, sentences
  quantities                name -> {{value, error, unit, doubt, theory, accuracy, deviation, source, fixed, blocks,
                            block_length}}; value null: no meaning, for the reason in doubt; error null: none can be
                            given; fixed: conservation laws fix the value; deviation in standard errors
  speeds                    histograms: species, edges, density, error, theory, misfit
  correlations              lag, msd, msd_error, vacf, vacf_error; diffusion (slope of msd / 4 between half the lag
                            and the lag), diffusion_error
  series                    columns time, contacts (of a disk), energy, temperature, pressure, collision_rate
  profile                   null without --profile; axis, edges, species: density, velocity, temperature, each with
                            its error, and theory of the density (hydrostatics under gravity)
{studies}
                            null without their options, else {{quantities, tables: name -> columns, notes}}

Exit codes: 0 done; 2 bad usage, scene or file, or nothing to measure; 130 interrupted.
""".format(
    quantities="\n".join(f"  {family.words}" for family in FAMILIES),
    studies="\n".join(f"  {one.name:<25} {one.words}" for one in STUDIES),
)


def study_options(verb: Verb) -> Verb:
    """Add the options of all studies."""
    for one in reversed(STUDIES):
        kinds = tuple(kind for _, kind in one.values)
        how: dict[str, Any] = {"type": kinds[0] if len(kinds) == 1 else kinds} if kinds else {"is_flag": True, "default": None}
        words = f"Also {one.words}."
        verb = click.option(f"--{one.name}", metavar=" ".join(name for name, _ in one.values) or None, help=words, **how)(verb)
    return verb


@click.command(help=HELP)
@scene_options(required=True, metavar="LOG|SCENE")
@stop_options
@click.option("--discard", type=click.FloatRange(min=0), metavar="T", help="Leave out this much time at the beginning.")
@click.option("--series", is_flag=True, help="Also energy, temperature, pressure and collision rate along the run.")
@click.option("--profile", type=click.Choice(["x", "y"]), help="Also density, velocity and temperature along an axis.")
@study_options
@click.option("--out", metavar="FILE.csv", help="Write the series, else the profile, else the tables of studies, to a file.")
@json_option
@quiet_option
def command(
    scene: str,
    settings: tuple[str, ...],
    seed: int | None,
    until: float | None,
    events: int | None,
    discard: float | None,
    series: bool,
    profile: str | None,
    out: str | None,
    as_json: bool,
    quiet: bool,
    **studies: Any,
) -> None:
    """Measure a run, see HELP."""
    target = writable(out, "--out", (".csv",))
    asked = {one: _given(studies[one.name]) for one in STUDIES if studies[one.name] is not None}
    if target is not None and not series and profile is None and not asked:
        raise click.UsageError("--out is the file of the series, the profile or the tables of studies: ask for one of them")
    measures, found = measured(scene, settings, seed, until, events, discard, profile, asked, quiet)
    columns = series_columns(measures) if series else profile_columns(measures) or study_columns(found.values())
    if target is not None:
        write_columns(columns, target)
    if as_json:
        made = {one.name: found[one.name].to_dict() if one.name in found else None for one in STUDIES}
        say_data(as_json_text({"scene": scene, **measures.to_dict(), **made}))
    elif not quiet:
        say(measures_text(scene, measures))
        for one in found.values():
            say("\n" + found_text(one))
        if series:
            say("\n" + table_of(series_columns(measures)))
        if profile is not None:
            say("\n" + table_of(profile_columns(measures)))


def measured(
    source: str,
    settings: Sequence[str],
    seed: int | None,
    until: float | None,
    events: int | None,
    discard: float | None,
    profile: str | None,
    asked: Mapping[Study, tuple[float, ...]],
    quiet: bool,
) -> tuple[Measures, dict[str, Found]]:
    """The measures of a log file, or of a scene that is simulated now; and what the studies that are asked for find."""
    if is_log(source):
        from eventsim.measure import measure, measure_file

        if not asked:
            demand_no_scene_options(source, settings, seed, until, events)
            return measure_file(source, discard, profile)[0], {}
        log = log_of(source, settings, seed, until, events, quiet)
        return measure(log, discard, profile), {one.name: one.of(log, discard, *given) for one, given in asked.items()}

    scene = chosen_scene(source, settings, seed)
    sinks = {one.name: one.sink(scene, discard, *given) for one, given in asked.items() if one.sink is not None}

    def write(rows: Rows) -> None:
        for sink in sinks.values():
            sink.write(rows)

    run = run_of(
        scene,
        source,
        until,
        events,
        quiet,
        measure=True if discard is None else discard,
        profile=profile,
        log=len(sinks) < len(asked),
        on_event=write if sinks else None,
    )
    if not run.has_measures:
        raise click.UsageError(f"there is nothing to measure: no time passes in this run of {source}")
    found = {name: sink.found(run.state.time - scene.start_time) for name, sink in sinks.items()}
    if run.has_log:
        found |= {one.name: one.of(run.log, discard, *given) for one, given in asked.items() if one.sink is None}
    return run.measures, found


def _given(option: Any) -> tuple[float, ...]:
    """What stood behind the option of a study."""
    return () if option is True else option if isinstance(option, tuple) else (option,)


MOST_LINES = 40
"""Of a table of a study that are shown."""


def _beginning_of(columns: Columns) -> str:
    """A table, or as much of it as can be read."""
    lines = max(map(len, columns.values()), default=0)
    more = f"\n  ... {lines:,} lines; --out FILE.csv has all" if lines > MOST_LINES else ""
    return table_of({name: column[:MOST_LINES] for name, column in columns.items()}) + more


def found_text(found: Found) -> str:
    """What a study found, as aligned lines."""
    tables = [_beginning_of(columns) for columns in found.tables.values()]
    words = [f"  {note}" for note in found.notes]
    return "\n".join([table_text(found.quantities), *words, *tables])


def measures_text(asked: str, measures: Measures) -> str:
    """The measures as aligned lines: measured, theory, difference, where the theory comes from."""
    eta = "" if measures.packing_fraction is None else f", packing fraction {short(measures.packing_fraction)}"
    who = [plural(measures.disks, "disk")] if measures.disks or not measures.tracers else []
    who += [plural(measures.tracers, "tracer")] if measures.tracers else []
    units = "unit" if measures.duration == 1.0 else "units"
    lines = [f"{asked}: {' and '.join(who)}{eta}, over {short(measures.duration)} {units} of time"]
    if measures.table_seen is not None:
        area, perimeter = (short(number) for number in measures.table_seen)
        lines.append(f"  table of the centre: area {area}, perimeter {perimeter}")
    if measures.discarded > 0.0:
        how = "as asked" if measures.discard_given else "found from the pressure"
        lines.append(f"  left out at the beginning: {short(measures.discarded)} ({how})")
    lines.append(measures.table())
    if "diffusion" in measures and math.isfinite(measures["diffusion"].value):
        lines.append("  D against lag, from the slope between half the lag and the lag:")
        lines.append(table_of(diffusion_columns(measures)))
    for histogram in measures.speeds:
        if histogram.misfit is not None:
            kind = f" of species {histogram.species}" if len(measures.speeds) > 1 else ""
            lines.append(f"  speeds{kind}: {histogram.misfit:.1f} standard errors from Maxwell, root mean square")
    lines.append(_verdict(measures))
    return "\n".join(line.rstrip() for line in lines)


def _verdict(measures: Measures) -> str:
    if not measures.steady:
        return f"  no steady state: {measures.doubts[0]}; --series tells it along the run"
    if measures.driven:
        if not measures.doubts:
            return "  settled, as far as this run can tell: walls drive the gas, which need be in no equilibrium"
        return "  NOT known to have settled, in the steady state of a driven gas: " + ";\n    ".join(measures.doubts)
    if measures.disks < 2:
        return f"  no equilibrium to come to: {measures.doubts[0]}"
    if not measures.doubts:
        return "  equilibrated, as far as this run can tell"
    return "  NOT known to be equilibrated: " + ";\n    ".join(measures.doubts)
