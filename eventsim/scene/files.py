"""Scene files: TOML or JSON in, a scene out, and back."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from os import PathLike
from pathlib import Path
from typing import Any

from eventsim.errors import SceneError
from eventsim.scene.numbers import optional_whole
from eventsim.scene.origins import Origins, origins_of
from eventsim.scene.overrides import apply_overrides, begun_by, is_shallow, settings_of
from eventsim.scene.scene import Scene
from eventsim.scene.texts import tables_of_file, tables_of_toml, with_lines
from eventsim.scene.writing import (
    DISKS_BESIDE,
    scene_beside,
    scene_beside_disks,
    scene_texts,
    scene_to_dict,
    scene_to_json,
    scene_to_toml,
)

__all__ = [
    "apply_overrides",
    "begun_by",
    "draws_at_random",
    "listed_scene",
    "load_scene",
    "origins",
    "scene_beside",
    "scene_beside_disks",
    "scene_from_dict",
    "scene_texts",
    "scene_to_dict",
    "scene_to_json",
    "scene_to_toml",
    "tables_of_toml",
    "with_lines",
]

GALLERY = Path(__file__).with_name("gallery")
"""Where the built-in scenes are, which are made of what is here."""


def load_scene(
    path: str | PathLike[str] | Mapping[str, Any], overrides: Iterable[str] | None = None, seed: int | None = None
) -> Scene:
    """The scene of a .toml or .json file; where it has no name, it is called after the file.

    Args:
        path: the file; a disks_file in it is looked for beside it.  Or a dict with the tables of a file, as
            {"until": 1.0, "domain": {...}, "gas": [{...}]}.
        overrides: settings like "gas.0.count=500", or one, that change keys before the scene is made.
        seed: seeds the i-th gas from (seed, i) instead of its own seed.

    Raises:
        SceneError: with all problems of the file.
    """
    if isinstance(path, Mapping):
        return scene_from_dict(apply_overrides(path, overrides), seed=optional_whole(seed, "seed"))
    if not isinstance(path, str | PathLike):
        raise SceneError(f"a scene is loaded from the path of a file, or a dict, not from the type {type(path).__name__}")
    if not Path(path).exists() and _is_built_in(str(path)):
        raise SceneError(f"{path}: no such file; the built-in scene is gallery({str(path)!r})")
    path, settings, seed = Path(path), settings_of(overrides), optional_whole(seed, "seed")
    data, text = tables_of_file(path)
    changed = apply_overrides(data, settings)
    if path.stem.isprintable():
        changed = {"name": path.stem, **changed}
    try:
        return scene_from_dict(changed, path.parent, None, seed)
    except SceneError as error:
        told = with_lines(begun_by(error, data, settings), text, data, settings, path.suffix.lower() == ".json")
        raise SceneError(f"{path}: {problem}" for problem in told.problems) from None


def _is_built_in(name: str) -> bool:
    """Whether a scene of the gallery has this name: it has a file there."""
    stem = name.replace("-", "_")
    return stem.isidentifier() and any((GALLERY / f"{stem}{end}.py").exists() for end in ("", "_"))


def draws_at_random(path: str | Path, overrides: Iterable[str] | None = None) -> bool:
    """Whether the scene of a file has a gas that cannot be made without random numbers; its mistakes are not looked at.

    Raises:
        SceneError: where the file cannot be read or the overrides lead nowhere.
    """
    from eventsim.scene.tables import uses_chance

    return uses_chance(apply_overrides(tables_of_file(Path(path))[0], overrides))


def origins(path: str | Path, overrides: Iterable[str] | None, seed: int | None, disks: int) -> Origins:
    """Which tables the disks of a scene file, so many, come from; its mistakes are not looked at.

    Raises:
        SceneError: where the file cannot be read or the overrides lead nowhere.
    """
    return origins_of(apply_overrides(tables_of_file(Path(path))[0], overrides), disks, seed)


def scene_from_dict(
    data: Mapping[str, Any],
    base_dir: str | Path | None = None,
    source: str | None = None,
    seed: int | None = None,
    *,
    runs: bool = True,
) -> Scene:
    """The scene that the tables of a scene file describe.

    The order of the disks is: all [[disk]] tables, all [[disks_file]] tables, all [[gas]] tables.

    Args:
        data: the tables, with the keys of a scene file.
        base_dir: where a disks_file is looked for; the current directory if None.
        source: what messages call the file.
        seed: seeds the i-th gas from (seed, i) instead of its own seed.
        runs: whether the file of a law of contacts is run.

    Raises:
        SceneError: with all problems.
    """
    # The schema library is needed only here.
    from eventsim.scene.tables import read_scene

    try:
        if not is_shallow(data):
            raise SceneError("is nested too deeply for a scene")
        return read_scene(data, Path(base_dir or "."), seed, runs)
    except SceneError as error:
        if source is None:
            raise
        raise SceneError(f"{source}: {problem}" for problem in error.problems) from None


def listed_scene(data: Mapping[str, Any], folder: Path | None = None) -> Scene:
    """The scene of a log or checkpoint, which lists its disks: no other file is opened for it, and no gas is made.

    Args:
        data: the tables of `scene_to_dict`, or of `scene_beside`.
        folder: where its disks are, if they are beside it; under their own name and no other.

    Raises:
        SceneError: with all problems, or the table that no such scene has.
    """
    if not isinstance(data, Mapping):
        raise SceneError("it is no table with the keys of a scene")
    beside = folder is not None and data.get("disks_file") == [{"path": DISKS_BESIDE}]
    for table in ("gas", *(() if beside else ("disks_file",))):
        if table in data:
            raise SceneError(f"{table}: a log lists its disks; it makes none and reads no other file")
    law = data.get("contact_law")
    if law is not None and not isinstance(law, Mapping):
        raise SceneError("contact_law: a log holds the text of a law; it runs no other file")
    return scene_from_dict(data, folder, runs=False)
