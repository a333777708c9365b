"""`eventsim figure`: what a log says, as a figure."""

from __future__ import annotations

import click

from eventsim.cli.options import drawable, json_option, quiet_option, scene_options
from eventsim.cli.output import say, say_data
from eventsim.cli.source import stop_options
from eventsim.kinds import TITLES

HELP = """Draw a figure of the run that LOG tells, or of SCENE, simulated now.

\b
Kinds:
{kinds}

\b
Examples:
  eventsim figure break.csv --kind trajectories --out break.png
  eventsim figure gas --kind free-paths --out paths.pdf
  eventsim figure corridor --kind space-time --out corridor.svg

\b
Keys of --json:
  scene, kind, out      as typed; the file written
  events                rows of the log
  bytes, elapsed_s      the size of the file; seconds of drawing and writing

Exit codes: 0 done; 2 bad usage, scene or file, or a log without what the figure shows; 130 interrupted.
""".format(kinds="\n".join(f"  {kind:<14} {title}" for kind, title in TITLES.items()))


@click.command(help=HELP)
@scene_options(required=True, metavar="LOG|SCENE")
@click.option("--kind", type=click.Choice(tuple(TITLES)), required=True, metavar="KIND", help="Which figure, one of these.")
@click.option("--out", required=True, metavar="FILE", help="FILE.png, .svg or .pdf.")
@stop_options
@json_option
@quiet_option
def command(
    scene: str,
    settings: tuple[str, ...],
    seed: int | None,
    kind: str,
    out: str,
    until: float | None,
    events: int | None,
    as_json: bool,
    quiet: bool,
) -> None:
    """Draw one kind of figure, see HELP."""
    target = drawable(out, "--out")
    assert target is not None

    from time import perf_counter

    from eventsim.cli.source import log_of
    from eventsim.cli.words import as_json_text, file_size
    from eventsim.show.figures.write import write_figure

    log = log_of(scene, settings, seed, until, events, quiet)
    began = perf_counter()
    write_figure(log, kind, target)
    elapsed = perf_counter() - began
    if as_json:
        data = {"scene": scene, "kind": kind, "out": str(target), "events": len(log)}
        say_data(as_json_text({**data, "bytes": target.stat().st_size, "elapsed_s": elapsed}))
    elif not quiet:
        say(f"{kind} drawn to {target} ({file_size(target)}) in {elapsed:.2g} s")
