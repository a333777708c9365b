"""`eventsim run`: simulate a scene, print what happened, keep what was asked for."""

from __future__ import annotations

import math

import click

from eventsim.cli.engine_options import DT_HELP, KNOWN, OPTION_HELP, engine_options
from eventsim.cli.exits import INTERRUPTED, STOPPED_EARLY
from eventsim.cli.options import Whole, json_option, quiet_option, scene_options
from eventsim.cli.target import LOG_SUFFIXES, STATE_SUFFIXES, writable

FIRST_SCENE = "break"
ENGINE_HELP = f"Which engine simulates: auto, reference, fast, certified; with time steps: {', '.join(KNOWN)}."
EARLY = ("collapse", "digits", "undecided tie")
EXITS = {**dict.fromkeys(EARLY, STOPPED_EARLY), "interrupted": INTERRUPTED}


@click.command()
@scene_options(required=False)
@click.option("--until", type=float, metavar="T", help="Stop at this time on the scene's clock.")
@click.option(
    "--events",
    type=Whole(min=0),
    metavar="N",
    help="Stop after this many events; contacts at one instant are not cut apart.",
)
@click.option("--log", metavar="FILE", help=f"Keep every event in FILE, one of {', '.join(LOG_SUFFIXES)}.")
@click.option("--compact", is_flag=True, help="Log only what replay cannot compute.")
@click.option("--state", metavar="FILE", help="Write the final state to FILE (.csv or .npz).")
@click.option("--engine", default="auto", show_default=True, metavar="NAME", help=ENGINE_HELP)
@click.option("--dt", type=float, metavar="DT", help=DT_HELP)
@click.option("--option", "engine_settings", multiple=True, metavar="KEY=VALUE", help=OPTION_HELP)
@click.option("--digest", is_flag=True, help="Compute the log's digest also where no log is kept.")
@click.option("--horizon", is_flag=True, help="Estimate until when the float64 trajectory is the true one.")
@json_option
@quiet_option
def command(
    scene: str | None,
    settings: tuple[str, ...],
    seed: int | None,
    until: float | None,
    events: int | None,
    log: str | None,
    compact: bool,
    state: str | None,
    engine: str,
    dt: float | None,
    engine_settings: tuple[str, ...],
    digest: bool,
    horizon: bool,
    as_json: bool,
    quiet: bool,
) -> None:
    """Simulate SCENE (a file or a built-in scene; without one: break) until its stop, and print a summary.

    It stops at the time or the number of events that the scene or the command line gives, whichever comes
    first; what the command line gives replaces what the scene says.

    \b
    Examples:
      eventsim run                                          the built-in break
      eventsim run my.toml --until 10 --log my.csv          a scene of your own, every event kept
      eventsim run galperin --set mass_ratio=10000 --json   pi from a hundred to one
      eventsim run gas --events 5000 --state end.csv        where all disks are in the end
      eventsim run gas --events 5000 --horizon              how long to believe every single contact
      eventsim run gas --engine frames --dt 0.01            what an engine with time steps makes of it

    \b
    Keys of --json:
      scene, name              as typed; the name inside the scene (null without)
      version, engine          of eventsim; the engine that simulated
      disks                    their number
      start_time, time         the scene's clock at the beginning and at the end
      events                   rows of the log: pair_contacts + wall_contacts + rests
      pair_contacts, wall_contacts, counters
      elapsed_s, events_per_s  simulating only; compile_s and write_s apart
      digest                   SHA-256 of the log; null without --log or --digest
      residuals                energy (relative change; null where it is not conserved),
                               momentum (share of sum m |v| not booked at walls),
                               max_overlap (deepest overlap at a contact, in reaches)
      horizon                  null without --horizon; {event, time: of the first contact that runs from
                               starts a last bit apart disagree on, null where none (exact ties part
                               them at once); events, until: how far they were compared}
      stopped, reason          until | events | quiet (no event ahead) | collapse | digits |
                               undecided tie | interrupted; and why, in words
      log, state               the files written (null without)

    Exit codes: 0 done; 2 bad usage, scene or file; 3 collapse or digits; 130 interrupted.
    """
    log_path = writable(log, "--log", LOG_SUFFIXES, source=scene)
    state_path = writable(state, "--state", STATE_SUFFIXES, source=scene)
    if compact and log_path is None:
        raise click.UsageError("--compact says how the log is written: give --log FILE too")
    if log_path is not None and state_path is not None and log_path.resolve() == state_path.resolve():
        raise click.UsageError(f"--log and --state name the same file, {log_path}")
    if until is not None and math.isnan(until):
        raise click.UsageError("--until nan: must be a time")

    options = engine_options(engine, dt, engine_settings)

    from eventsim.cli.choose import chosen_scene
    from eventsim.cli.progress import ProgressBar
    from eventsim.cli.summary import summary_data, summary_text
    from eventsim.cli.words import as_json_text
    from eventsim.simulation import simulate

    asked = scene or FIRST_SCENE
    chosen = chosen_scene(asked, settings, seed)
    if until is None and events is None and chosen.until is None and chosen.events is None:
        raise click.UsageError(
            f"nothing says when to stop {asked}: give --until T or --events N, or a key until or events in the scene"
        )
    with ProgressBar(quiet=quiet) as progress:
        run = simulate(
            chosen,
            until=until,
            events=events,
            engine=engine,
            log=False if log_path is None else log_path,
            compact=compact,
            digest=digest,
            progress=progress,
            command=click.get_current_context().obj,
            **options,
        )
    estimate = None
    if horizon:
        from eventsim.engines.horizon import horizon as horizon_of
        from eventsim.simulation import stop_of

        estimate = horizon_of(run.scene, stop_of(chosen, until, events))
    if state_path is not None:
        from eventsim.record.states import write_states

        write_states(state_path, run.scene, [run.state])
    if as_json:
        click.echo(as_json_text(summary_data(asked, run, log_path, state_path, estimate)))
    elif not quiet:
        click.echo(summary_text(asked, run, log_path, state_path, estimate))
    if run.stopped in EXITS:
        if as_json or quiet:
            click.echo(f"stopped early: {run.reason or run.stopped}", err=True)
        click.get_current_context().exit(EXITS[run.stopped])
