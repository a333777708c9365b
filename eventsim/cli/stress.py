"""`eventsim stress`: every engine on the scenes where methods fail; the atlas of what they make of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from eventsim import suffixes
from eventsim.cli.exits import FAILED, INTERRUPTED
from eventsim.cli.options import Whole, json_option, quiet_option
from eventsim.cli.output import say
from eventsim.cli.target import writable

if TYPE_CHECKING:
    from eventsim.validate.stress.soak import Finding



@click.command()
@click.argument("names", nargs=-1, metavar="[NAME ...]")
@click.option(
    "--engine", "engines", multiple=True, metavar="ENGINE", help="Only this engine; may be given several times."
)
@click.option("--list", "listing", is_flag=True, help="List the scenes and why methods fail on them; simulate nothing.")
@click.option("--out", metavar="FILE", help="Draw the atlas as a matrix to FILE.png, .svg or .pdf.")
@click.option("--csv", "table", metavar="FILE", help="Write every verdict to FILE.csv.")
@click.option(
    "--limit",
    type=click.FloatRange(min=0.1),
    default=10.0,
    show_default=True,
    metavar="S",
    help="Seconds of computing for one engine on one scene.",
)
@click.option(
    "--workers",
    type=click.IntRange(min=1),
    default=2,
    show_default=True,
    metavar="W",
    help="Processes at the same time.",
)
@click.option("--soak", type=Whole(min=1), metavar="N", help="Instead: N random scenes, engine against engine.")
@click.option(
    "--seed", type=click.IntRange(min=0), default=0, show_default=True, metavar="S", help="First seed of --soak."
)
@json_option
@quiet_option
def command(
    names: tuple[str, ...],
    engines: tuple[str, ...],
    listing: bool,
    out: str | None,
    table: str | None,
    limit: float,
    workers: int,
    soak: int | None,
    seed: int,
    as_json: bool,
    quiet: bool,
) -> None:
    """Run every engine on the scenes where methods fail, and say what each made of them.

    NAME is a scene of the catalogue (f6-break) or a family (f22); without one: all.

    \b
    Verdicts:
      right        within the tolerance that the catalogue derives
      inaccurate   by how much, in reaches, typical speeds or counts
      energy       wrong, and energy was gained or lost
      wrong        another outcome
      refused      the engine stops, or declines, with a reason
      hung         not done within the limit

    \b
    Examples:
      eventsim stress --list                             what is in the catalogue, and why
      eventsim stress --out atlas.png --csv atlas.csv    the whole atlas: some minutes
      eventsim stress f22 t1 --engine fast --engine stepped
      eventsim stress --soak 10000                       random scenes near every degenerate surface:
                                                         touching, grazing, ties, tiny boxes, extreme ratios

    \b
    Keys of --json:
      scenes, engines      what was looked at
      verdicts             a list: scene, engine, verdict, fault, error (null where there is none), tolerance,
                           seconds, sentence
      faults               how many verdicts on event-driven engines are neither right nor a documented refusal
      out, csv             the files written (null without)
      of --soak: soak, seed, engines, findings (a list: seed, engine, sentence), faults

    Exit codes: 0 done; 1 an event-driven engine is at fault; 2 bad usage; 130 interrupted (a soak tells what
    it found so far).
    """
    from eventsim.engines import engine_named

    if soak is not None:
        if names or out or table:
            raise click.UsageError("--soak draws its own scenes: no NAME, --out or --csv with it")
        against = tuple(engine_named(name).name for name in dict.fromkeys(engines)) or ("reference", "fast")
        _soak(range(seed, seed + soak), against, workers, as_json, quiet)
        return
    figure_path = writable(out, "--out", suffixes.FIGURES)
    table_path = writable(table, "--csv", (".csv",))

    from eventsim.cli.progress import ProgressBar
    from eventsim.cli.verdicts import as_data, as_listing, as_text
    from eventsim.cli.words import as_json_text
    from eventsim.engines import ENGINES
    from eventsim.validate.stress.atlas import atlas_of, write_csv
    from eventsim.validate.stress.catalogue import chosen
    from eventsim.validate.stress.verdict import Verdict

    cases = chosen(names)
    if listing:
        say(as_listing(cases))
        return
    wanted = [engine_named(name).name for name in dict.fromkeys(engines)] or list(ENGINES)
    total, done = len(cases) * len(wanted), 0
    with ProgressBar(quiet=quiet) as progress:

        def told(_verdict: Verdict) -> None:
            nonlocal done
            done += 1
            progress.show(done / total, f"{done:,} of {total:,} verdicts")

        verdicts = atlas_of(cases, wanted, limit, workers, told)
    if table_path is not None:
        write_csv(verdicts, table_path)
    if figure_path is not None:
        from eventsim.show.atlas import write_atlas

        write_atlas(verdicts, figure_path)
    if as_json:
        say(as_json_text(as_data(verdicts, figure_path, table_path)))
    elif not quiet:
        say(as_text(verdicts))
    if any(verdict.fault for verdict in verdicts):
        click.get_current_context().exit(FAILED)


def _soak(seeds: range, engines: tuple[str, ...], workers: int, as_json: bool, quiet: bool) -> None:
    """Run the soak; print what was found, also up to an interrupt."""
    from eventsim.cli.progress import ProgressBar
    from eventsim.cli.verdicts import soak_data, soak_text
    from eventsim.cli.words import as_json_text
    from eventsim.validate.stress.soak import soak

    findings: list[Finding] = []
    done, interrupted = 0, False
    try:
        with ProgressBar(quiet=quiet) as progress:
            for done, finding in enumerate(soak(seeds, engines, workers), 1):
                progress.show(done / len(seeds), f"{done:,} of {len(seeds):,} scenes, {len(findings)} findings")
                if finding is not None:
                    findings.append(finding)
    except KeyboardInterrupt:
        interrupted = True
    seeds = seeds[:done]
    if as_json:
        say(as_json_text(soak_data(seeds, engines, findings)))
    elif not quiet:
        say(soak_text(seeds, engines, findings))
    if interrupted:
        click.get_current_context().exit(INTERRUPTED)
    if findings:
        click.get_current_context().exit(FAILED)
