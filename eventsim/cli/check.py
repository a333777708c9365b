"""`eventsim check`: is a scene valid, and what will simulate it, and why."""

from __future__ import annotations

import click

from eventsim.cli.options import json_option, quiet_option, scene_options


@click.command()
@scene_options(required=True)
@json_option
@quiet_option
def command(scene: str, settings: tuple[str, ...], seed: int | None, as_json: bool, quiet: bool) -> None:
    """Validate SCENE, and explain what it has and which machinery it gets for that.

    A scene with problems is answered with all of them at once, each naming the key or the disks, the value
    and the rule.

    \b
    Examples:
      eventsim check my.toml
      eventsim check gas --set n=50
      eventsim check my.toml --quiet       says nothing; the exit code tells

    \b
    Keys of --json:
      scene, name                 as typed; the name inside the scene (null without)
      disks, moving, immovable, obstacles, tracers
                                  numbers of disks: all, with a speed, of mass inf, both, of mass 0
      species, species_count      the commonest {count, radius, mass}; how many there are
      radii, masses               [least, largest]
      fastest, temperature        largest speed; mean m v^2/2 (null without a finite positive mass)
      packing_fraction            null on the open plane
      domain, size, origin        kind; [width, height]; lower-left corner
      walls, shapes               name -> kind; primitive shape -> number
      gravity, restitution, contact_duration
                                  null without; restitution [pair, wall]
      start_time, epoch_length    of the clock
      search                      {kind, side, columns, rows, giants}: "all pairs" or "cells"
      images                      periodic images in which a disk can be met: 1, 3 or 9
      touching_pairs              pairs at contact at the start
      touching_notes              starting overlaps so small that they count as touching
      until, events, engine       the stop of the scene; what auto chooses
      explanation                 topic -> words, as the text prints them

    Exit codes: 0 valid; 2 bad usage, scene or file.
    """
    from dataclasses import asdict

    from eventsim.cli.choose import chosen_scene
    from eventsim.cli.explain import explanation, page
    from eventsim.cli.needs import needs_of
    from eventsim.cli.words import as_json_text

    chosen = chosen_scene(scene, settings, seed)
    needs = needs_of(chosen)
    if as_json:
        words = dict(explanation(needs))
        click.echo(as_json_text({"scene": scene, "name": chosen.name, **asdict(needs), "explanation": words}))
    elif not quiet:
        click.echo(page(scene, chosen.name, needs))
