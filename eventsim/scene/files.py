"""Scene files: TOML or JSON in, a scene out, and back."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator, Mapping
from itertools import islice
from pathlib import Path
from typing import Any

from eventsim.errors import SceneError
from eventsim.scene.disks import Disks
from eventsim.scene.domain import Domain, Open
from eventsim.scene.overrides import apply_overrides, is_shallow
from eventsim.scene.scene import Scene
from eventsim.scene.texts import tables_of_file, tables_of_toml, with_lines
from eventsim.scene.walls.wall import Wall, keys_of

__all__ = [
    "apply_overrides",
    "draws_at_random",
    "listed_scene",
    "load_scene",
    "scene_beside",
    "scene_from_dict",
    "scene_texts",
    "scene_to_dict",
    "scene_to_json",
    "scene_to_toml",
    "tables_of_toml",
    "with_lines",
]

DISKS_IN_PIECE = 256
DISKS_BESIDE = "disks.npz"


def load_scene(path: str | Path, overrides: Iterable[str] | None = None, seed: int | None = None) -> Scene:
    """The scene of a .toml or .json file.

    Args:
        path: the file; a disks_file in it is looked for beside it.
        overrides: settings like "gas.0.count=500" that change keys before the scene is made.
        seed: seeds the i-th gas from (seed, i) instead of its own seed.

    Raises:
        SceneError: with all problems of the file.
    """
    path, settings = Path(path), list(overrides or ())
    data, text = tables_of_file(path)
    changed = apply_overrides(data, settings)
    try:
        return scene_from_dict(changed, path.parent, None, seed)
    except SceneError as error:
        told = error if path.suffix.lower() == ".json" else with_lines(error, text, data, settings)
        raise SceneError(f"{path}: {problem}" for problem in told.problems) from None


def draws_at_random(path: str | Path, overrides: Iterable[str] | None = None) -> bool:
    """Whether the scene of a file has a gas that cannot be made without random numbers; its mistakes are not looked at.

    Raises:
        SceneError: where the file cannot be read or the overrides lead nowhere.
    """
    from eventsim.scene.tables import uses_chance

    return uses_chance(apply_overrides(tables_of_file(Path(path))[0], overrides))


def scene_from_dict(
    data: Mapping[str, Any],
    base_dir: str | Path | None = None,
    source: str | None = None,
    seed: int | None = None,
) -> Scene:
    """The scene that the tables of a scene file describe.

    The order of the disks is: all [[disk]] tables, all [[disks_file]] tables, all [[gas]] tables.

    Args:
        data: the tables, with the keys of a scene file.
        base_dir: where a disks_file is looked for; the current directory if None.
        source: what messages call the file.
        seed: seeds the i-th gas from (seed, i) instead of its own seed.

    Raises:
        SceneError: with all problems.
    """
    # The schema library is needed only here.
    from eventsim.scene.tables import read_scene

    try:
        if not is_shallow(data):
            raise SceneError("is nested too deeply for a scene")
        return read_scene(data, Path(base_dir or "."), seed)
    except SceneError as error:
        if source is None:
            raise
        raise SceneError(f"{source}: {problem}" for problem in error.problems) from None


def scene_to_dict(scene: Scene) -> dict[str, Any]:
    """The scene as tables for a scene file, every disk listed; scene_from_dict gives back every bit.

    What has its default is left out. A mass of inf is written as "inf", so that the tables fit into JSON.
    """
    data = _tables(scene)
    data["disk"] = _disk_tables(scene.disks)
    return data


def scene_to_json(scene: Scene) -> str:
    """The same as one line of JSON, several times as fast as by way of tables."""
    return "".join(scene_texts(scene))


def scene_texts(scene: Scene) -> Iterator[str]:
    """That line piece by piece, each a millisecond's work: of many disks it takes a while."""
    before, after = json.dumps(_tables(scene)).split('"disk": []')
    yield f'{before}"disk": ['
    texts, separator = _disk_texts(scene.disks), ""
    while piece := ", ".join(islice(texts, DISKS_IN_PIECE)):
        yield separator + piece
        separator = ", "
    yield f"]{after}"


def scene_beside(scene: Scene, folder: Path) -> str:
    """The scene as JSON for a file in a folder, its disks in a disks_file beside: quickly written, every bit of many disks."""
    # Nobody else needs what reads archives and tables.
    from eventsim.scene.disks_file import write_disks_file

    write_disks_file(folder / DISKS_BESIDE, scene.disks)
    tables = _tables(scene)
    del tables["disk"]
    return json.dumps({**tables, "disks_file": [{"path": DISKS_BESIDE}]})


def scene_beside_disks(scene: Scene) -> str:
    """All of a scene but its disks, as JSON."""
    return json.dumps(_tables(scene))


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
    return scene_from_dict(data, folder)


def _tables(scene: Scene) -> dict[str, Any]:
    """The tables of a scene in their order, that of the disks still empty."""
    data: dict[str, Any] = {}
    for key in ("name", "until", "events", "contact_duration", "equilibration"):
        value = getattr(scene, key)
        if value is not None:
            data[key] = value
    if not _is_default(scene.start_time, 0.0):
        data["start_time"] = scene.start_time
    if scene.gravity is not None:
        data["gravity"] = list(scene.gravity)
    if scene.restitution is not None:
        data["restitution"] = {"pair": scene.restitution.pair, "wall": scene.restitution.wall}
    data["domain"] = _domain_table(scene.domain)
    data["disk"] = []
    if scene.walls:
        data["wall"] = [_wall_table(wall) for wall in scene.walls]
    return data


def scene_to_toml(scene: Scene) -> str:
    """The text of a scene file for the scene, every disk listed."""
    import tomli_w

    data = scene_to_dict(scene)
    for disk in data["disk"]:
        if disk.get("mass") == "inf":
            disk["mass"] = math.inf
    return tomli_w.dumps(data)


def _domain_table(domain: Domain) -> dict[str, Any]:
    if isinstance(domain, Open):
        return {"kind": domain.kind}
    table: dict[str, Any] = {"kind": domain.kind, "size": list(domain.size)}
    if not all(_is_default(value, 0.0) for value in domain.origin):
        table["origin"] = list(domain.origin)
    return table


def _disk_tables(disks: Disks) -> list[dict[str, Any]]:
    tables: list[dict[str, Any]] = []
    columns = (disks.position.tolist(), disks.velocity.tolist(), disks.radius.tolist(), disks.mass.tolist())
    for position, velocity, radius, mass in zip(*columns, strict=True):
        table = {"position": position, "velocity": velocity, "radius": radius}
        if _is_default(velocity[0], 0.0) and _is_default(velocity[1], 0.0):
            del table["velocity"]
        if mass != 1.0:
            table["mass"] = "inf" if math.isinf(mass) else mass
        tables.append(table)
    return tables


def _disk_texts(disks: Disks) -> Iterator[str]:
    """The tables of disks as JSON."""
    columns = (*disks.position.T, *disks.velocity.T, disks.radius, disks.mass)
    for x, y, vx, vy, radius, mass in zip(*(column.tolist() for column in columns), strict=True):
        moves = not (_is_default(vx, 0.0) and _is_default(vy, 0.0))
        velocity = f', "velocity": [{vx!r}, {vy!r}]' if moves else ""
        weight = "" if mass == 1.0 else f', "mass": {repr(mass) if mass < math.inf else json.dumps("inf")}'
        yield f'{{"position": [{x!r}, {y!r}]{velocity}, "radius": {radius!r}{weight}}}'


def _wall_table(wall: Wall) -> dict[str, Any]:
    table: dict[str, Any] = {"kind": wall.kind}
    for key in keys_of(type(wall)):
        value = getattr(wall, key)
        if value is not None:
            table[key] = _lists(value)
    return table


def _lists(value: Any) -> Any:
    """Tuples as lists, as TOML and JSON have them."""
    return [_lists(item) for item in value] if isinstance(value, tuple) else value


def _is_default(value: float, default: float) -> bool:
    """Whether a value may be left out: equal in every bit (-0.0 is not 0.0)."""
    return value == default and math.copysign(1.0, value) == math.copysign(1.0, default)
