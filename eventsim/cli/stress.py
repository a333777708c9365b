"""`eventsim stress`: every engine on the scenes where methods fail; the atlas of what they make of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from eventsim.cli.options import Whole, drawable, json_option, quiet_option, writable
from eventsim.cli.output import FAILED, INTERRUPTED, say, say_data
from eventsim.validation.stress.catalogue import CASES
from eventsim.validation.stress.verdict import Word

if TYPE_CHECKING:
    from eventsim.validation.stress.case import Case
    from eventsim.validation.stress.soak import Finding
    from eventsim.validation.stress.verdict import Verdict


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
    help="Seconds of computing for one engine on one scene; a proof has ten times as many.",
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
    from eventsim.engines import ONE_LOG, engine_named

    if soak is not None:
        if names or out or table:
            raise click.UsageError("--soak draws its own scenes: no NAME, --out or --csv with it")
        against = tuple(engine_named(name).name for name in dict.fromkeys(engines)) or ONE_LOG
        _soak(range(seed, seed + soak), against, workers, as_json, quiet)
        return
    figure_path = drawable(out, "--out")
    table_path = writable(table, "--csv", (".csv",))

    from eventsim.cli.progress import ProgressBar
    from eventsim.cli.words import as_json_text
    from eventsim.engines import ENGINES
    from eventsim.validation.stress.atlas import atlas_of, write_csv
    from eventsim.validation.stress.catalogue import chosen

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
        say_data(as_json_text(as_data(verdicts, figure_path, table_path)))
    elif not quiet:
        say(as_text(verdicts))
    if any(verdict.fault for verdict in verdicts):
        click.get_current_context().exit(FAILED)


def _soak(seeds: range, engines: tuple[str, ...], workers: int, as_json: bool, quiet: bool) -> None:
    """Run the soak; print what was found, also up to an interrupt."""
    from eventsim.cli.progress import ProgressBar
    from eventsim.cli.words import as_json_text
    from eventsim.validation.stress.soak import soak

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
        say_data(as_json_text(soak_data(seeds, engines, findings)))
    elif not quiet:
        say(soak_text(seeds, engines, findings))
    if interrupted:
        click.get_current_context().exit(INTERRUPTED)
    if findings:
        click.get_current_context().exit(FAILED)


def as_listing(cases: Sequence[Case]) -> str:
    """Each case: its name, what happens, why methods fail, what is true."""
    parts = []
    for case in cases:
        lines = [f"{case.name}: {case.title}", f"fails: {case.why}", f"true: {case.oracle}"]
        lines.append(f"allowed: {case.tolerance:.2g}. {case.because}")
        parts.append("\n    ".join(lines))
    return "\n\n".join(parts)


def as_text(verdicts: Sequence[Verdict]) -> str:
    """A table, scenes down and engines across; then a line for each fault."""
    engines = list(dict.fromkeys(v.engine for v in verdicts))
    cells = {(v.case, v.engine): _cell(v) for v in verdicts}
    cases = list(dict.fromkeys(v.case for v in verdicts))
    first = max(len(name) for name in ("scene", *cases)) + 2
    widths = [max(len(engine), *(len(cells[case, engine]) for case in cases)) + 2 for engine in engines]
    lines = ["scene".ljust(first) + "".join(e.ljust(w) for e, w in zip(engines, widths, strict=True))]
    for case in cases:
        lines.append(case.ljust(first) + "".join(cells[case, e].ljust(w) for e, w in zip(engines, widths, strict=True)))
    faults = [v for v in verdicts if v.fault]
    lines += ["", *(f"fault: {v.engine} on {v.case}: {v.sentence}" for v in faults)]
    if not faults:
        lines.append("no fault: the event-driven engines are right everywhere, or refuse with a documented reason")
    return "\n".join(line.rstrip() for line in lines)


def _cell(verdict: Verdict) -> str:
    sized = verdict.word is Word.INACCURATE or (verdict.word is Word.WRONG and math.isfinite(verdict.error))
    return f"{verdict.word} {verdict.error:.1g}" if sized else str(verdict.word)


def as_data(verdicts: Sequence[Verdict], figure: Path | None, table: Path | None) -> dict[str, Any]:
    """The keys of --json."""
    return {
        "scenes": list(dict.fromkeys(v.case for v in verdicts)),
        "engines": list(dict.fromkeys(v.engine for v in verdicts)),
        "verdicts": [
            {
                "scene": v.case,
                "engine": v.engine,
                "verdict": str(v.word),
                "fault": v.fault,
                "error": v.error if math.isfinite(v.error) else None,
                "tolerance": CASES[v.case].tolerance,
                "seconds": v.seconds,
                "sentence": v.sentence,
            }
            for v in verdicts
        ],
        "faults": sum(v.fault for v in verdicts),
        "out": None if figure is None else str(figure),
        "csv": None if table is None else str(table),
    }


def soak_text(seeds: range, engines: Sequence[str], findings: Sequence[Finding]) -> str:
    """What a soak found."""
    lines = [f"seed {found.seed}, {found.engine}: {found.sentence}" for found in findings]
    outcome = (
        "no hang, no NaN, no clock that steps back, no two logs that differ"
        if not findings
        else f"{len(findings)} faults"
    )
    return "\n".join([*lines, f"{len(seeds):,} random scenes, {' against '.join(engines)}: {outcome}"])


def soak_data(seeds: range, engines: Sequence[str], findings: Sequence[Finding]) -> dict[str, Any]:
    """The keys of --soak --json."""
    told = [{"seed": f.seed, "engine": f.engine, "sentence": f.sentence} for f in findings]
    return {
        "soak": len(seeds),
        "seed": seeds.start,
        "engines": list(engines),
        "findings": told,
        "faults": len(findings),
    }
