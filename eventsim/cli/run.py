"""`eventsim run`: simulate a scene, print what happened, keep what was asked for."""

from __future__ import annotations

import math
from typing import Any

import click

from eventsim import suffixes
from eventsim.cli.options import (
    DT_HELP,
    ENGINE_HELP,
    OPTION_HELP,
    Files,
    Whole,
    engine_options,
    json_option,
    quiet_option,
    scene_options,
    writable,
)
from eventsim.cli.output import INTERRUPTED, STOPPED_EARLY, say, say_data
from eventsim.engines import STEPPED

FIRST_SCENE = "break"
EARLY = ("collapse", "digits", "law", "undecided tie")
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
@click.option("--log", metavar="FILE", help=f"Keep every event in FILE, one of {', '.join(suffixes.LOGS)}.")
@click.option("--compact", is_flag=True, help="Log only what tells the events: to read it the run is done again.")
@click.option("--state", metavar="FILE", help="Write the final state to FILE (.csv or .npz).")
@click.option("--engine", metavar="NAME", help=f"{ENGINE_HELP}  [default: auto]")
@click.option("--dt", type=float, metavar="DT", help=DT_HELP)
@click.option("--option", "engine_settings", multiple=True, metavar="KEY=VALUE", help=OPTION_HELP)
@click.option("--digest", is_flag=True, help="Compute the log's digest also where no log is kept.")
@click.option("--horizon", is_flag=True, help="Estimate until when the float64 trajectory is the true one.")
@click.option("--checkpoint", metavar="FILE", help="Keep FILE, from which a run that was stopped or killed can go on.")
@click.option("--every", metavar="EVENTS|TIME", help="How often: so many events, or 90s, 5min, 2h.  [default: 60s]")
@click.option("--resume", metavar="FILE", help="Go on from a checkpoint; its scene, stop and log are in it.")
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
    engine: str | None,
    dt: float | None,
    engine_settings: tuple[str, ...],
    digest: bool,
    horizon: bool,
    checkpoint: str | None,
    every: str | None,
    resume: str | None,
    as_json: bool,
    quiet: bool,
) -> None:
    """Simulate SCENE (a file or a built-in scene; without one: break) until its stop, and print a summary.

    It stops at the time or the number of events that the scene or the command line gives, whichever comes
    first; what the command line gives replaces what the scene says.

    A run that was interrupted, killed, or has reached its stop goes on from its checkpoint: the joined log is that of
    an uninterrupted run, bit for bit. With --resume, --until and --events replace the stop, --engine the engine, --log
    says where the log was moved to; a SCENE is compared with that of the checkpoint. FILE.part of a log is what
    a killed run has written; every verb reads it. A whole log that is there is replaced; a file that is no log is not.

    \b
    Examples:
      eventsim run                                          the built-in break
      eventsim run my.toml --until 10 --log my.csv          a scene of your own, every event kept
      eventsim run galperin --set mass_ratio=10000 --json   pi from a hundred to one
      eventsim run gas --events 5000 --state end.csv        where all disks are in the end
      eventsim run gas --events 5000 --horizon              how long to believe every single contact
      eventsim run gas --engine frames --dt 0.01            what an engine with time steps makes of it
      eventsim run gas --until 1e6 --log gas.npz --checkpoint gas.checkpoint --every 10min
      eventsim run --resume gas.checkpoint                  what was killed goes on

    \b
    Keys of --json:
      scene, name              as typed; the name inside the scene (null without)
      version, engine          of eventsim; the engine that simulated (auto: the one that came last)
      begun_by                 the engine that handed over to it (null: none)
      disks                    their number
      start_time, time         the scene's clock at the beginning and at the end
      events                   rows of the log: pair_contacts + wall_contacts + rests
      pair_contacts, wall_contacts, counters
      elapsed_s, events_per_s  simulating only; compile_s and write_s apart
      digest                   SHA-256 of the log; null without --log or --digest
      residuals                energy (relative change; null where it is not conserved),
                               momentum (share of sum m |v| not booked at walls),
                               max_overlap (deepest overlap at a contact, in reaches)
      horizon                  null without --horizon; {event, time: of the first contact that runs with
                               other last bits disagree on, null where none (exact ties part
                               them at once); events, until: how far they were compared; near_ties:
                               contacts until then that only last bits part; apart: largest difference
                               in time of contacts before it, from those of such a run}
      trust                    null where nobody asked and it would cost; {event, time: from which on places
                               are off by more than 1e-3 of length (null: never); error: in shares of
                               length, the smallest reach; events looked at; gentle: errors grow as a power
                               of time; reason: why there is no estimate}
      stopped, reason          until | events | quiet (no event ahead) | collapse | digits |
                               law | undecided tie | interrupted; and why, in words
      log, state, checkpoint   the files written (null without)

    Exit codes: 0 done; 2 bad usage, scene or file; 3 collapse, digits, or what no law tells; 130 interrupted.
    1 is kept for comparisons that fail, in stress and validate.
    """
    files = Files(
        writable(log, "--log", suffixes.LOGS, source=scene),
        writable(state, "--state", suffixes.STATES, source=scene),
        writable(checkpoint or resume, "--checkpoint", None, source=scene),
    )
    named = [path.resolve() for path in files if path is not None]
    if len(set(named)) < len(named):
        raise click.UsageError("two of --log, --state and --checkpoint name the same file")
    if compact and log is None:
        raise click.UsageError("--compact says how the log is written: give --log FILE too")
    if until is not None and math.isnan(until):
        raise click.UsageError("--until nan: must be a time")
    if every is not None and files.checkpoint is None:
        raise click.UsageError("--every says how often a checkpoint is written: give --checkpoint FILE too")
    if resume is not None and compact:
        raise click.UsageError("--compact: a log that goes on stays as it was begun")
    if resume is not None and scene is None and (settings or seed is not None):
        raise click.UsageError("--set and --seed shape a scene, and that of a checkpoint is what it is")

    if horizon and engine in STEPPED:
        raise click.UsageError(
            f"--horizon is about the last bits of an event-driven trajectory; that of {engine} is off by its time steps: "
            "eventsim validate tells how far"
        )
    if horizon and engine == "certified":
        raise click.UsageError("--horizon: what the certified engine has simulated is proven; eventsim certify compares float64")
    replaces = files.log is not None and resume is None and files.log.exists() and files.log.stat().st_size > 0
    options = engine_options(engine or "auto", dt, engine_settings)
    if resume is not None and options:
        raise click.UsageError("--dt and --option: what an engine was told is not in a checkpoint")

    from eventsim import simulation
    from eventsim.cli.progress import ProgressBar
    from eventsim.cli.signals import interruptible
    from eventsim.cli.source import chosen_scene, demand_stop
    from eventsim.cli.summary import summary_data, summary_text
    from eventsim.cli.words import as_json_text

    asked = scene or resume or FIRST_SCENE
    chosen = None if resume and scene is None else chosen_scene(asked, settings, seed)
    if not resume and chosen is not None:
        demand_stop(chosen, asked, until, events)
    wanted: dict[str, Any] = {"until": until, "events": events, "log": files.log, "digest": digest}
    wanted |= {"engine": engine, "checkpoint": files.checkpoint, "every": every}
    wanted = {name: value for name, value in wanted.items() if value is not None}
    if horizon and not resume:
        wanted["trust"] = True
    with ProgressBar(quiet=quiet) as progress, interruptible() as interrupt:
        wanted |= {"progress": progress, "interrupt": interrupt}
        if not quiet:
            kept = ", and the log is kept" if files.log is not None or resume else ""
            wanted["notice"] = lambda told: say(f"note: {told}. Ctrl-C ends the run{kept}", err=True)
        if chosen is None or resume:
            run = simulation.resume(str(resume), scene=chosen, **wanted)
        else:
            command_line = click.get_current_context().obj
            run = simulation.simulate(chosen, compact=compact, command=command_line, **wanted, **options)
    files = files._replace(log=run.log_path)
    estimate = None
    if horizon:
        from eventsim.engines.base import Stop
        from eventsim.validation.shadows import horizon as horizon_of

        estimate = horizon_of(
            run.scene, Stop(events=run.counters.events) if run.stopped == "events" else Stop(run.time)
        )
    if files.state is not None:
        from eventsim.replay.states import write_states

        write_states(files.state, run.scene, [run.state])
    if as_json:
        say_data(as_json_text(summary_data(asked, run, files, estimate)))
    elif not quiet:
        say(summary_text(asked, run, files, estimate, replaces))
    if run.stopped in EXITS:
        if as_json or quiet:
            say(f"stopped early: {run.reason or run.stopped}", err=True)
        click.get_current_context().exit(EXITS[run.stopped])
