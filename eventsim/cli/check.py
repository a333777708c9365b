"""`eventsim check`: is a scene valid, and what will simulate it, and why."""

from __future__ import annotations

from pathlib import Path

import click

from eventsim import suffixes
from eventsim.cli.options import json_option, quiet_option, scene_options
from eventsim.cli.output import say, say_data
from eventsim.cli.source import chosen_scene, is_log


@click.command()
@scene_options(required=True)
@click.option("--horizon", is_flag=True, help="Simulate a little, to estimate until when float64 is right.")
@click.option("--all", "every", is_flag=True, help="Write out every problem: all pairs that overlap, not the first three.")
@json_option
@quiet_option
def command(
    scene: str, settings: tuple[str, ...], seed: int | None, horizon: bool, every: bool, as_json: bool, quiet: bool
) -> None:
    """Validate SCENE, and explain what it has and which machinery it gets for that; or check all of a log file.

    A scene with problems is answered with all of them at once, each naming the key or the disks, the value
    and the rule.  A warning tells where its outcome hangs on the last bits of its numbers; of a file it tells which
    disks have which numbers, and gases of one seed, which begin alike.

    \b
    Examples:
      eventsim check my.toml
      eventsim check gas --set n=50
      eventsim check gas --horizon         until which contact its trajectory can be believed
      eventsim check my.toml --quiet       says nothing; the exit code tells
      eventsim check my.toml --all         each pair of disks that overlap
      eventsim check break.csv             a log: its scene, every row, every digest; a compact one is run again

    \b
    Keys of --json:
      scene, name                 as typed; the name inside the scene (null without)
      disks, moving, immovable, obstacles, tracers
                                  numbers of disks: all, with a speed, of mass inf, both, of mass 0
      species, species_count      the commonest {count, radius, mass}; how many there are
      radii, masses               [least, largest]
      fastest, temperature        largest speed; mean m v^2/2 (null without a finite positive mass)
      packing_fraction            of the area that disks can cover; null where nothing bounds it
      table                       [area, perimeter, pi A / P] of the region that the centre of a lone disk or of tracers
                                  sees; null where disks meet each other
      domain, size, origin        kind; [width, height]; lower-left corner
      walls, shapes               name -> kind; primitive shape -> number
      gravity, restitution, contact_duration
                                  null without; restitution [pair, wall]
      law                         the numbers of the law of contacts
      low_parts                   whether velocities carry what their rounding leaves (very uneven masses)
      points                      whether disks are so small that they remember on which side of a wall they are
      gap_bits                    bits that coordinates leave of the 53 of a gap between disks; null of points
      start_time, epoch_length    of the clock
      search                      {kind, side, columns, rows, giants}: "all pairs" or "cells"
      images                      periodic images in which a disk can be met: 1, 3 or 9
      touching_pairs              pairs at contact at the start
      touching_notes              starting overlaps so small that they count as touching
      near_ties                   a list {first, second, time, apart}: contacts [a, b or wall] in a short run
                                  that share a disk and that only rounding parts; null in scenes of more
                                  than 1,000 disks
      until, events, engine       the stop of the scene; what auto chooses
      horizon                     null without --horizon; {event, time} of the first contact that runs with
                                  other last bits disagree on (null: none; exact ties part them at
                                  once), {events, until} compared, near_ties until then, apart: largest
                                  difference in time of contacts before it
      explanation                 topic -> words, as the text prints them

    
    Keys of --json of a log:
      log, rows, compact          the file; the number of its rows; whether they had to be made full
      engine, version, bits       what wrote it, by which version of the rules
      begin, end, stopped         times on the scene's clock; why the run ended (null: it goes on, or was killed)
      digest                      of the full rows
      notes                       what it does not vouch for

    Exit codes: 0 valid; 2 bad usage, scene or file, or a log that is not what its run wrote.
    """
    if settings == () and seed is None and not horizon and is_log(scene):
        check_log(scene, as_json, quiet)
        return
    from contextlib import nullcontext
    from dataclasses import asdict

    from eventsim.cli.explain import explanation, page
    from eventsim.cli.needs import needs_of
    from eventsim.cli.words import as_json_text
    from eventsim.scene import files
    from eventsim.scene.validate import all_written_out

    with all_written_out() if every else nullcontext():
        chosen = chosen_scene(scene, settings, seed)
    needs = needs_of(chosen)
    is_file = Path(scene).suffix.lower() in suffixes.SCENES
    origins = files.origins(scene, settings, seed, needs.disks) if is_file else None
    estimate = None
    if horizon:
        from eventsim.engines.base import Stop
        from eventsim.validation.shadows import horizon as horizon_of

        estimate = horizon_of(chosen, Stop(chosen.until, chosen.events))
    if as_json:
        told = None if estimate is None else asdict(estimate)
        words = dict(explanation(needs, origins))
        data = {"scene": scene, "name": chosen.name, **asdict(needs), "horizon": told, "explanation": words}
        say_data(as_json_text(data))
    elif not quiet:
        say(page(scene, chosen.name, needs, origins))
        if estimate is not None:
            from eventsim.cli.summary import horizon_words

            say(f"  horizon: {horizon_words(estimate)}")


def check_log(path: str, as_json: bool, quiet: bool) -> None:
    """Check all of a log file, and say what it is."""
    from dataclasses import asdict

    from eventsim.cli.words import as_json_text
    from eventsim.replay.audit import audit
    from eventsim.scene.names import plural

    found = audit(path)
    if as_json:
        say_data(as_json_text({"log": path, **asdict(found)}))
    elif not quiet:
        form = "compact, run again and the same" if found.compact else "as its run stored them"
        ended = "not closed" if found.stopped is None else f"stopped: {found.stopped}"
        say(f"{path}: {plural(found.rows, 'row')}, {form}, from t = {found.begin!r} to {found.end!r} ({ended})")
        say(f"  written by {found.engine}, eventsim {found.version}, bits {found.bits}")
        say(f"  digest {found.digest}")
        for note in found.notes:
            say(f"  note: {note}")
