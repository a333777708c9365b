"""From a scene to the tables and the text of a scene file, every bit of it."""

from __future__ import annotations

import json
import math
import os
import re
import secrets
from collections.abc import Iterable, Iterator
from dataclasses import asdict
from itertools import islice, repeat
from pathlib import Path
from typing import TYPE_CHECKING, Any

from eventsim import suffixes
from eventsim.errors import SceneError
from eventsim.scene.disks import USUAL, Disks
from eventsim.scene.domain import Domain, Open
from eventsim.scene.walls.wall import Wall, keys_of

if TYPE_CHECKING:
    from eventsim.scene.scene import Scene

LIST_BELOW = re.compile(r"\[\n((?: +[-+.\w]+,\n)+) *\]")
"""A list of numbers, each in a line of its own."""

DISKS_IN_PIECE = 256
DISKS_BESIDE = "disks.npz"


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


def _tables(scene: Scene) -> dict[str, Any]:
    """The tables of a scene in their order, that of the disks still empty."""
    data: dict[str, Any] = {}
    for key in ("name", "until", "events", "contact_duration", "equilibration", "seed"):
        value = getattr(scene, key)
        if value is not None:
            data[key] = value
    if not _is_default(scene.start_time, 0.0):
        data["start_time"] = scene.start_time
    if scene.gravity is not None:
        data["gravity"] = list(scene.gravity)
    if scene.restitution is not None:
        data["restitution"] = scene.restitution.table()
    if scene.tangential_restitution is not None:
        data["tangential_restitution"] = asdict(scene.tangential_restitution)
    if scene.law is not None:
        data["contact_law"] = scene.law.table()
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
    return LIST_BELOW.sub(lambda rows: f"[{', '.join(rows[1].replace(',', '').split())}]", tomli_w.dumps(data))


def _domain_table(domain: Domain) -> dict[str, Any]:
    if isinstance(domain, Open):
        return {"kind": domain.kind}
    table: dict[str, Any] = {"kind": domain.kind, "size": list(domain.size)}
    if not all(_is_default(value, 0.0) for value in domain.origin):
        table["origin"] = list(domain.origin)
    if domain.walls:
        table["walls"] = {name: side.manner for name, side in domain.walls}
    return table


def _disk_tables(disks: Disks) -> list[dict[str, Any]]:
    tables: list[dict[str, Any]] = []
    columns = (disks.position, disks.velocity, disks.radius, disks.mass, disks.spins(), disks.moments())
    lists = (column.tolist() for column in columns)
    for position, velocity, radius, mass, spin, moment, name in zip(*lists, _names(disks), strict=True):
        table = {"position": position, "velocity": velocity, "radius": radius}
        if _is_default(velocity[0], 0.0) and _is_default(velocity[1], 0.0):
            del table["velocity"]
        if mass != 1.0:
            table["mass"] = "inf" if math.isinf(mass) else mass
        if name:
            table["species"] = name
        if not _is_default(spin, 0.0):
            table["spin"] = spin
        if moment != USUAL["moment"]:
            table["moment"] = moment
        tables.append(table)
    return tables


def _disk_texts(disks: Disks) -> Iterator[str]:
    """The tables of disks as JSON."""
    columns = (*disks.position.T, *disks.velocity.T, disks.radius, disks.mass)
    turns = iter(_turning_texts(disks))
    for x, y, vx, vy, radius, mass, name in zip(*(column.tolist() for column in columns), _names(disks), strict=True):
        moves = not (_is_default(vx, 0.0) and _is_default(vy, 0.0))
        velocity = f', "velocity": [{vx!r}, {vy!r}]' if moves else ""
        weight = "" if mass == 1.0 else f', "mass": {repr(mass) if mass < math.inf else json.dumps("inf")}'
        species = f', "species": {json.dumps(name)}' if name else ""
        yield f'{{"position": [{x!r}, {y!r}]{velocity}, "radius": {radius!r}{weight}{species}{next(turns)}}}'


def _names(disks: Disks) -> Iterable[str]:
    """The names of the species of disks, "" where they have none of their own."""
    return repeat("", len(disks)) if disks.species is None else disks.species.tolist()


def _turning_texts(disks: Disks) -> Iterable[str]:
    """What those texts say of spin and moment, which is nothing of usual disks."""
    if disks.spin is None and disks.moment is None:
        return repeat("")
    return (
        ("" if _is_default(spin, 0.0) else f', "spin": {spin!r}') + ("" if moment == 0.5 else f', "moment": {moment!r}')
        for spin, moment in zip(disks.spins().tolist(), disks.moments().tolist(), strict=True)
    )


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


def save_scene(scene: Scene, path: Path) -> None:
    """Write a scene file, .toml or .json; it appears under its name only when whole.

    Raises:
        SceneError: for another suffix, or where it cannot be written.
    """
    if path.suffix.lower() not in suffixes.SCENES:
        raise SceneError(f"{path}: a scene file ends in {' or '.join(suffixes.SCENES)}")
    text = scene_to_toml(scene) if path.suffix.lower() == ".toml" else scene_to_json(scene) + "\n"
    part = path.with_name(f"{path.name}.{secrets.token_hex(4)}{suffixes.PART}")
    try:
        part.write_text(text, encoding="utf-8", newline="\n")
        os.replace(part, path)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise SceneError(f"{path}: cannot be written ({error.strerror or error})") from None
