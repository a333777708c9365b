"""`eventsim gallery`: the built-in scenes, listed, shown, or copied to start one of your own."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from eventsim import suffixes
from eventsim.cli.options import SEED_HELP, SET_HELP, complete_scene, json_option, quiet_option, writable
from eventsim.cli.output import say, say_data

if TYPE_CHECKING:
    from eventsim.scene import Scene


@click.command()
@click.argument("name", required=False, shell_complete=complete_scene)
@click.option("--copy", metavar="FILE", help="Write the scene as a file of your own, .toml or .json.")
@click.option("--set", "settings", multiple=True, metavar="KEY=VALUE", help=f"With --copy. {SET_HELP}")
@click.option("--seed", type=click.IntRange(min=0), metavar="S", help=f"With --copy. {SEED_HELP}")
@json_option
@quiet_option
def command(
    name: str | None,
    copy: str | None,
    settings: tuple[str, ...],
    seed: int | None,
    as_json: bool,
    quiet: bool,
) -> None:
    """List the built-in scenes; with NAME tell what happens in one, why, and its parameters.

    Every verb takes these names instead of a file; --set PARAMETER=VALUE sets a parameter.

    \b
    Examples:
      eventsim gallery                            all names, a line each
      eventsim gallery galperin                   the story of one
      eventsim gallery break --copy my.toml       a file to change as you like

    \b
    Keys of --json:
      scenes                             without NAME: a list of {name, title}
      name, title, text                  with NAME: the story of the scene
      parameters, about                  name -> default; what they mean
      copied                             the file written (null without --copy)

    Exit codes: 0 done; 2 bad usage or an unknown name.
    """
    if copy is None and (settings or seed is not None):
        raise click.UsageError("--set and --seed change what --copy FILE writes: give --copy FILE too")
    if name is None:
        if copy is not None:
            raise click.UsageError("--copy: name the scene to copy, as in eventsim gallery NAME --copy FILE")
        _list(as_json, quiet)
    else:
        _tell(name, copy, settings, seed, as_json, quiet)


def _list(as_json: bool, quiet: bool) -> None:
    """Print the names of all built-in scenes and a line about each."""
    from eventsim.cli.words import aligned, as_json_text
    from eventsim.scene.gallery import describe, names

    titles = [(each, describe(each).title) for each in names()]
    if as_json:
        say_data(as_json_text({"scenes": [{"name": each, "title": title} for each, title in titles]}))
    elif not quiet:
        say(aligned(titles))
        say("\neventsim gallery NAME tells the story of one, eventsim run NAME runs it")


def _tell(name: str, copy: str | None, settings: tuple[str, ...], seed: int | None, as_json: bool, quiet: bool) -> None:
    """Print the story of one scene, or copy it into a file."""
    from eventsim.cli.folding import reflowed
    from eventsim.cli.source import chosen_scene
    from eventsim.cli.words import aligned, as_json_text
    from eventsim.scene.gallery import describe

    entry = describe(name)
    target = writable(copy, "--copy", suffixes.SCENES)
    if target is not None:
        if target.exists():
            raise click.UsageError(f"--copy {target}: there is such a file already; it is left as it is")
        _write_scene(target, chosen_scene(name, settings, seed))
    if as_json:
        data = {
            "name": name,
            "title": entry.title,
            "text": entry.text,
            "about": entry.about,
            "parameters": entry.parameters,
        }
        say_data(as_json_text({**data, "copied": None if target is None else str(target)}))
    elif not quiet and target is not None:
        say(f"{name} copied to {target}; eventsim run {target} runs it")
    elif not quiet:
        say(f"{name}: {entry.title}\n\n{reflowed(entry.text)}")
        if entry.parameters:
            rows = [(key, repr(value)) for key, value in entry.parameters.items()]
            say(f"\nParameters and their defaults (--set NAME=VALUE):\n{aligned(rows)}")
            say(f"  {entry.about}")


def _write_scene(target: Path, scene: Scene) -> None:
    """Write a scene in the format of the file's suffix, every disk listed."""
    from eventsim.cli.words import as_json_text
    from eventsim.scene.files import scene_to_dict, scene_to_toml

    is_toml = target.suffix.lower() == ".toml"
    text = scene_to_toml(scene) if is_toml else as_json_text(scene_to_dict(scene)) + "\n"
    target.write_text(text, encoding="utf-8")
