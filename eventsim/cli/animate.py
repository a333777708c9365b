"""`eventsim animate`: a scene or a log as a movie, a strip of moments, or a page that plays it."""

from __future__ import annotations

import re

import click

from eventsim import suffixes
from eventsim.cli.options import drawable, json_option, quiet_option, scene_options
from eventsim.cli.output import say, say_data
from eventsim.cli.source import stop_options

COLORS = ("mass", "speed", "species", "contacts", "index")


def pixels(context: click.Context, option: click.Parameter, value: str | None) -> tuple[int, int] | None:
    """Read 1280x720 as (1280, 720)."""
    if value is None:
        return None
    match = re.fullmatch(r"(\d{1,6})x(\d{1,6})", value)
    if match is None:
        raise click.BadParameter(f"{value!r} is not a size: write WIDTHxHEIGHT in pixels, as 1280x720")
    return int(match[1]), int(match[2])


@click.command()
@scene_options(required=True, metavar="SCENE|LOG")
@click.option("--out", required=True, metavar="FILE", help="FILE.mp4, .gif, .png (a strip of moments) or .html.")
@stop_options
@click.option("--fps", type=float, metavar="F", help="Frames per second; 30, of a gif 20.")
@click.option("--speed", type=float, metavar="S", help="Time of the scene that passes in a second.  [default: all in 10 seconds]")
@click.option("--duration", type=float, metavar="D", help="Seconds that it lasts.  [default: 10]")
@click.option("--from", "begin", type=float, metavar="T", help="Begin at this time on the scene's clock.")
@click.option("--to", "end", type=float, metavar="T", help="End at this time on the scene's clock.")
@click.option("--moments", type=click.IntRange(min=1), metavar="N", help="Pictures in a png; 6.")
@click.option("--size", callback=pixels, metavar="WxH", help="Pixels, as 1280x720; of a png, of each moment.")
@click.option(
    "--color",
    type=click.Choice(COLORS),
    help="What the colour of a disk says; the scene decides if not given.",
)
@click.option("--trails", is_flag=True, help="Draw where disks have been in the last second of the film.")
@click.option("--velocities", is_flag=True, help="Draw velocities as arrows.")
@click.option("--flash", is_flag=True, help="Light up disks at their contacts.")
@click.option("--dark", is_flag=True, help="Draw on a dark ground.")
@json_option
@quiet_option
def command(
    scene: str,
    settings: tuple[str, ...],
    seed: int | None,
    out: str,
    until: float | None,
    events: int | None,
    fps: float | None,
    speed: float | None,
    duration: float | None,
    begin: float | None,
    end: float | None,
    moments: int | None,
    size: tuple[int, int] | None,
    color: str | None,
    trails: bool,
    velocities: bool,
    flash: bool,
    dark: bool,
    as_json: bool,
    quiet: bool,
) -> None:
    """Draw a run: simulates SCENE, or reads LOG, and writes what happened to a file that shows it.

    Frames are exact at their times, at any rate: they come from the log, not from a clock that ticks along. Movie and
    page show the whole run in 10 seconds, whatever the scene's clock says, unless told otherwise; so does eventsim live
    show the span to the scene's until. The picture tells the rate: x 2, two time units a second. The html file is a
    player with a play button, a time line and steps from event to event; it needs no network and nothing else.

    \b
    Examples:
      eventsim animate break --out break.mp4
      eventsim animate break.csv --out slow.gif --from 0.3 --to 0.6 --trails --flash
      eventsim animate gas --out gas.html --dark
      eventsim animate funnel --out funnel.png --moments 4 --size 400x600

    \b
    Keys of --json:
      scene, out, format       as typed; the file written; its suffix without the dot
      events                   rows of the log
      bytes, elapsed_s         the size of the file; seconds of drawing and writing

    Exit codes: 0 done; 2 bad usage, scene or file, or no ffmpeg for an mp4; 130 interrupted, no file left.
    """
    target = drawable(out, "--out", suffixes.ANIMATIONS)
    assert target is not None
    if speed is not None and duration is not None:
        raise click.UsageError("--speed and --duration exclude each other: the one follows from the other")
    movies, drawn = (".mp4", ".gif"), (".mp4", ".gif", ".png")
    for option, value, allowed in (
        ("--moments", moments, (".png",)),
        ("--fps", fps, movies),
        ("--size", size, drawn),
        ("--from", begin, drawn),
        ("--to", end, drawn),
    ):
        if value is not None and target.suffix.lower() not in allowed:
            raise click.UsageError(f"{option} is for {', '.join(allowed)} files, and --out is {target}")

    from time import perf_counter

    from eventsim.cli.progress import ProgressBar
    from eventsim.cli.source import log_of
    from eventsim.cli.words import as_json_text, file_size
    from eventsim.scene.names import plural
    from eventsim.show.animate import MOMENTS, Film, animate
    from eventsim.show.picture import Look

    film = Film(fps, speed, duration, begin, end, moments or MOMENTS)
    look = Look(size, color, trails, velocities, flash, dark)
    log = log_of(scene, settings, seed, until, events, quiet)
    began = perf_counter()
    with ProgressBar(quiet=quiet) as progress:
        animate(log, target, film, look, progress)
    elapsed = perf_counter() - began
    if as_json:
        data = {"scene": scene, "out": str(target), "format": target.suffix[1:].lower(), "events": len(log)}
        say_data(as_json_text({**data, "bytes": target.stat().st_size, "elapsed_s": elapsed}))
    elif not quiet:
        if len(log) == 0:
            say("this log is empty: no event happens, the disks only fly on", err=True)
        say(f"{plural(len(log), 'event')} drawn to {target} ({file_size(target)}) in {elapsed:.2g} s")
