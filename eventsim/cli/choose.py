"""From what was typed to a scene: a file or the name of a built-in scene, with its settings."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from eventsim import suffixes
from eventsim.cli.output import say
from eventsim.errors import SceneError, did_you_mean

if TYPE_CHECKING:
    from eventsim.scene import Scene



def chosen_scene(scene: str, settings: Sequence[str], seed: int | None) -> Scene:
    """Return the scene meant by the argument SCENE and the options --set and --seed; tell of a seed that changes nothing.

    Raises:
        SceneError: if there is no such scene, a setting does not fit, or the scene breaks a rule.
    """
    made = seeded_scene(scene, settings, seed)
    if seed is not None and not _draws_at_random(scene, settings):
        say(f"note: --seed {seed} changes nothing: {scene} draws no random numbers", err=True)
    return made


def _draws_at_random(scene: str, settings: Sequence[str]) -> bool:
    from eventsim.scene.files import draws_at_random
    from eventsim.scene.gallery import describe

    if Path(scene).suffix.lower() in suffixes.SCENES:
        return draws_at_random(scene, settings)
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
    raise SceneError(
        f"{scene!r} is neither a scene file ({', '.join(suffixes.SCENES)}) nor a built-in scene"
        f"{did_you_mean(scene, names())}; eventsim gallery lists the built-in ones"
    )


def built_in_scene(name: str, settings: Sequence[str], seed: int | None) -> Scene:
    """Return a built-in scene: settings that name one of its parameters first, then keys of the scene."""
    from eventsim.scene.files import apply_overrides, scene_from_dict, scene_to_dict
    from eventsim.scene.gallery import describe, gallery

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
    return scene_from_dict(apply_overrides(scene_to_dict(scene), overrides), source=name)
