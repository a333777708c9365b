"""From what was typed to a scene or a log: a file, a built-in scene, or a scene that is simulated now."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from eventsim import suffixes
from eventsim.cli.options import Verb, Whole
from eventsim.cli.output import INTERRUPTED, say
from eventsim.errors import SceneError, did_you_mean
from eventsim.reading import near_file

if TYPE_CHECKING:
    from eventsim.replay.log import AnyLog
    from eventsim.run import Run
    from eventsim.scene import Scene


def stop_options(verb: Verb) -> Verb:
    """Add --until and --events, for a scene."""
    events = click.option("--events", type=Whole(min=0), metavar="N", help="Of a scene: stop after N events.")
    until = click.option("--until", type=float, metavar="T", help="Of a scene: simulate until this time.")
    return until(events(verb))


def is_log(source: str) -> bool:
    """Whether a log file is meant, not a scene.

    Raises SceneError for a file that, by its name, is neither.
    """
    file = Path(source)
    suffix = file.suffix.lower()
    if suffix in suffixes.LOGS or source.endswith(suffixes.PART):
        return True
    if suffix not in suffixes.SCENES and file.exists():
        from eventsim.scene.gallery import names

        if source not in names():
            logs, scenes = ", ".join(suffixes.LOGS), " or ".join(suffixes.SCENES)
            raise SceneError(f"{source}: is neither a log nor a scene file: these end in {logs}, or in {scenes}")
    return False


def log_of(
    source: str,
    settings: Sequence[str],
    seed: int | None,
    until: float | None,
    events: int | None,
    quiet: bool,
) -> AnyLog:
    """Return the log that is meant: one in a file, which stays there if it is long, or that of a scene simulated now.

    Raises click.UsageError where options of a scene are given with a log, or nothing says when a scene stops.
    """
    if is_log(source):
        demand_no_scene_options(source, settings, seed, until, events)
        from eventsim.replay.filed import open_filed

        return open_filed(source)

    return run_of(chosen_scene(source, settings, seed), source, until, events, quiet, log=True).log


def demand_no_scene_options(
    source: str, settings: Sequence[str], seed: int | None, until: float | None, events: int | None
) -> None:
    """Raise click.UsageError where options of a scene are given with a log."""
    if settings or seed is not None or until is not None or events is not None:
        raise click.UsageError(f"{source} is a log: --set, --seed, --until and --events are for scenes")


def run_of(scene: Scene, asked: str, until: float | None, events: int | None, quiet: bool, **wanted: Any) -> Run:
    """Simulate a scene for what is wanted of it; ends the command where the run is interrupted."""
    from eventsim.cli.progress import ProgressBar
    from eventsim.cli.signals import interruptible
    from eventsim.simulation import simulate

    demand_stop(scene, asked, until, events)
    with ProgressBar(quiet=quiet) as progress, interruptible() as interrupt:
        run = simulate(scene, until, events, progress=progress, interrupt=interrupt, **wanted)
    if run.stopped == "interrupted":
        say("interrupted", err=True)
        click.get_current_context().exit(INTERRUPTED)
    if run.reason is not None and not quiet:
        say(f"stopped early: {run.reason}", err=True)
    return run


def demand_stop(scene: Scene, asked: str, until: float | None, events: int | None) -> None:
    """Raise click.UsageError where neither the command line nor the scene says when to stop."""
    if until is events is None and scene.until is scene.events is None:
        raise click.UsageError(
            f"nothing says when to stop {asked}: give --until T or --events N, or a key until or events in the scene"
        )


def chosen_scene(scene: str, settings: Sequence[str], seed: int | None) -> Scene:
    """Return the scene meant by the argument SCENE and the options --set and --seed; tell of a seed that changes nothing.

    Raises:
        SceneError: if there is no such scene, a setting does not fit, or the scene breaks a rule.
    """
    made = seeded_scene(scene, settings, seed)
    if seed is not None and not draws_at_random(scene, settings):
        say(f"note: --seed {seed} changes nothing: {scene} draws no random numbers", err=True)
    return made


def draws_at_random(scene: str, settings: Sequence[str]) -> bool:
    """Whether a scene has random numbers, so that a seed changes it."""
    from eventsim.scene import files
    from eventsim.scene.gallery import describe

    if Path(scene).suffix.lower() in suffixes.SCENES:
        return files.draws_at_random(scene, settings)
    return "seed" in describe(scene).parameters


def seeded_scene(scene: str, settings: Sequence[str], seed: int | None) -> Scene:
    """Return the same scene without a word; raises SceneError alike."""
    from eventsim.scene.files import load_scene
    from eventsim.scene.gallery import names

    if Path(scene).suffix.lower() in suffixes.SCENES:
        return load_scene(scene, overrides=settings, seed=seed)
    if scene in names():
        return built_in_scene(scene, settings, seed)
    if Path(scene).exists():
        raise SceneError(f"{scene}: a scene file ends in {' or '.join(suffixes.SCENES)}")
    if files := [scene + suffix for suffix in suffixes.SCENES if Path(scene + suffix).exists()]:
        raise SceneError(f"{scene!r} is no built-in scene, but {files[0]} is here: write the name of the file with its end")
    if Path(scene).suffix and (near := near_file(Path(scene), suffixes.SCENES)):
        raise SceneError(f"{scene}: no such file{near}")
    raise SceneError(
        f"{scene!r} is neither a scene file ({', '.join(suffixes.SCENES)}) nor a built-in scene"
        f"{did_you_mean(scene, names()) or near_file(Path(scene), suffixes.SCENES)}; eventsim gallery lists the built-in ones"
    )


def built_in_scene(name: str, settings: Sequence[str], seed: int | None) -> Scene:
    """Return a built-in scene: settings that name one of its parameters first, then keys of the scene."""
    from eventsim.scene.files import apply_overrides, begun_by, scene_from_dict, scene_to_dict
    from eventsim.scene.gallery import describe, gallery
    from eventsim.scene.schema import SCENE_KEYS

    allowed = describe(name).parameters
    parameters = {}
    overrides = []
    for setting in settings:
        key, equals, text = setting.partition("=")
        if equals and key.strip() in allowed:
            parameters[key.strip()] = apply_overrides({}, [f"value={text}"])["value"]
        else:
            overrides.append(setting)
    if seed is not None and "seed" in allowed:
        parameters["seed"] = seed
    scene = gallery(name, **parameters)
    if not overrides:
        return scene
    for setting in overrides:
        key = setting.partition("=")[0].strip()
        if re.split(r"[.\[]", key)[0] not in SCENE_KEYS:
            near = did_you_mean(key.lower(), allowed) or did_you_mean(key.lower(), SCENE_KEYS)
            own = f"its own are {', '.join(allowed)}" if allowed else "it has none of its own"
            raise SceneError(f"{name}: {key}: unknown key{near}; {own}; those of every scene are {', '.join(SCENE_KEYS)}")
    data = scene_to_dict(scene)
    try:
        return scene_from_dict(apply_overrides(data, overrides), source=name)
    except SceneError as error:
        raise begun_by(error, data, overrides) from None
