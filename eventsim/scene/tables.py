"""From the tables of a scene file to a scene, collecting every problem on the way."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from eventsim.errors import SceneError
from eventsim.scene import schema
from eventsim.scene.compressed import place_compressed
from eventsim.scene.disks import USUAL, Disks, join
from eventsim.scene.disks_file import read_disks_file
from eventsim.scene.domain import DOMAINS, Domain, Open
from eventsim.scene.fill import place_gas
from eventsim.scene.gas import MOST_DISKS, Gas, gas_problems, inside_of, region_of
from eventsim.scene.names import BlockNames
from eventsim.scene.own_law import own_law_from, own_law_in
from eventsim.scene.scene import Scene
from eventsim.scene.validate import NO_DISKS, NO_SPECIES, domain_problems, number_problems
from eventsim.scene.walls import WALLS, Wall, wall_names

DISK_STAND_IN = {"position": (0.0, 0.0), "radius": 0.0}
DOMAIN_STAND_IN = {"size": (1.0, 1.0)}
GAS_STAND_IN = {"count": 1, "radius": 1.0, "packing_fraction": 0.1}
"""What is put in the place of a value that cannot be read, so that the rules can be applied to the others of its table."""


def read_scene(data: Mapping[str, Any], base_dir: Path, seed: int | None, runs: bool = True) -> Scene:
    """The scene of these tables; see files.scene_from_dict.

    runs: whether the file of a law of contacts is run.

    Raises:
        SceneError: with all problems. Gases are placed only when nothing else is wrong.
    """
    problems: list[str] = []
    if seed is not None and seed < 0:
        problems.append(f"seed = {seed}: must be at least 0")
    found = _read_parts(data, base_dir, problems, runs, seed)
    gases = _read_gases(data, found.domain, found.walls, seed, problems)
    disks = join(found.disks)
    try:
        scene = found.scene(disks)
    except SceneError as error:
        # Disks may be missing because their gas has not been placed, or because their tables have problems.
        waiting = bool(gases or [problem for problem in problems if not problem.startswith("domain is missing")])
        problems += [p for p in error.problems if not (waiting and (p == NO_DISKS or NO_SPECIES in p))]
    if problems:
        raise SceneError(problems)
    if not gases:
        return scene
    domain = found.domain or Open()
    rngs = {i: np.random.default_rng(gas.seed if seed is None else (seed, i)) for i, gas in gases}
    grown: dict[int, Disks] = {}
    for i, gas in gases:
        if gas.arrangement == "compressed" and i not in grown:
            # all that are to fill this region densely grow together
            group = [(k, other) for k, other in gases if _grows_with(gas, other, domain)]
            parts = place_compressed(
                [other for _, other in group], domain, found.walls, disks, [rngs[k] for k, _ in group], f"gas[{i}]"
            )
            grown |= {k: part for (k, _), part in zip(group, parts, strict=True)}
        placed = grown[i] if i in grown else place_gas(gas, domain, found.walls, disks, rngs[i], f"gas[{i}]")
        found.names.add(len(disks), f"disk {{}} (of gas[{i}])", range(len(disks), len(disks) + len(placed)))
        disks = join([disks, placed])
    return found.scene(disks)


def uses_chance(data: Mapping[str, Any]) -> bool:
    """Whether a [[gas]] table among these, as far as they can be read, cannot be placed without random numbers."""
    return any(gas.uses_chance for _, gas in gases_of(data))


def gases_of(data: Mapping[str, Any]) -> list[tuple[int, Gas]]:
    """The [[gas]] tables among these, as far as they can be read, each with its index."""
    return _read_gases(data, None, None, None, [])


def _grows_with(gas: Gas, other: Gas, domain: Domain) -> bool:
    return other.arrangement == "compressed" and region_of(gas, domain) == region_of(other, domain)


@dataclass(slots=True)
class _Parts:
    """What of a scene could be read."""

    values: dict[str, Any] = field(default_factory=dict)
    domain: Domain | None = None
    walls: list[Wall] = field(default_factory=list)
    disks: list[Disks] = field(default_factory=list)
    names: BlockNames = field(default_factory=BlockNames)

    def scene(self, disks: Disks) -> Scene:
        """The scene of the parts and these disks; in the open while the domain is not known."""
        domain = Open() if self.domain is None else self.domain
        return Scene(disks, domain, self.walls, **self.values, names=self.names)


def _read_parts(data: Mapping[str, Any], base_dir: Path, problems: list[str], runs: bool, seed: int | None) -> _Parts:
    """Everything but the gases."""
    schema.report_unknown(data, list(schema.SCENE_KEYS), "", problems)
    parts = _Parts()
    scalars = {key: value for key, value in data.items() if key in schema.SCALARS}
    for key, keys in (("restitution", schema.RESTITUTION), ("tangential_restitution", schema.TANGENTIAL)):
        if isinstance(scalars.get(key), Mapping):
            parts.values[key] = schema.read_table(keys, scalars.pop(key), key, problems).values
    # One by one: a bad one does not keep the rules from being applied to the others.
    for key, value in scalars.items():
        parts.values |= schema.read_table(schema.SCENE, {key: value}, "", problems).values
    if seed is not None and "seed" in parts.values:
        parts.values["seed"] = seed
    if (named := parts.values.pop("contact_law", None)) is not None:
        try:
            parts.values["law"] = own_law_in(named, base_dir) if isinstance(named, str) else own_law_from(named, runs)
        except SceneError as error:
            problems += error.problems
    if "domain" not in data:
        problems.append('domain is missing; write: a line [domain], and below it kind = "box" and size = [2.0, 1.0]')
    else:
        values, broken = schema.read_kind(schema.DOMAIN, data["domain"], "domain", problems)
        if not broken:
            try:
                parts.domain = DOMAINS[values.pop("kind")](**values)
            except SceneError as error:
                problems += error.problems
        elif "kind" not in broken:
            problems += domain_problems(DOMAINS[values.pop("kind")](**DOMAIN_STAND_IN | values))
    _read_walls(data, parts, problems)
    _read_disks(data, parts, problems)
    _read_disks_files(data, base_dir, parts, problems)
    return parts


def _tables(data: Mapping[str, Any], key: str, problems: list[str]) -> list[Any]:
    """The tables of a [[key]] list."""
    tables = data.get(key, [])
    if isinstance(tables, list | tuple):
        return list(tables)
    problems.append(
        f"{key} = {schema.shown(tables)}: must be a list of tables; write [[{key}]], in double brackets"
    )
    return []


def _read_walls(data: Mapping[str, Any], parts: _Parts, problems: list[str]) -> None:
    """The walls, if all can be read; if not, at least the shapes of those that can."""
    read: dict[int, Wall] = {}
    tables = _tables(data, "wall", problems)
    for i, wall in enumerate(tables):
        values, broken = schema.read_kind(schema.WALL, wall, f"wall[{i}]", problems)
        if broken:
            kind = values.get("kind")
            found = WALLS[kind].number_problems(values) if kind else ()
            problems += [f"wall[{i}]{problem}" for problem in found]
        else:
            read[i] = WALLS[values.pop("kind")](**values)
    if len(read) == len(tables):
        parts.walls = list(read.values())
    else:
        problems += [f"wall[{i}]{problem}" for i, wall in read.items() for problem in wall.problems()]


def _read_disks(data: Mapping[str, Any], parts: _Parts, problems: list[str]) -> None:
    """The [[disk]] tables that can be read."""
    read: dict[int, dict[str, Any]] = {}
    partly: dict[int, dict[str, Any]] = {}
    for i, disk in enumerate(_tables(data, "disk", problems)):
        if schema.is_plain_disk(disk):
            read[i] = disk
            continue
        values, broken = schema.read_table(schema.DISK, disk, f"disk[{i}]", problems)
        if broken:
            partly[i] = DISK_STAND_IN | values
        else:
            read[i] = values
    if partly:
        names, disks = BlockNames(), _disks_of(partly.values())
        names.add(0, "disk[{}]", list(partly))
        problems += number_problems(disks, names, np.ones(len(disks), dtype=np.bool_))
    if read:
        parts.names.add(0, "disk[{}]", list(read))
        parts.disks.append(_disks_of(read.values()))


def _disks_of(tables: Collection[dict[str, Any]]) -> Disks:
    return Disks(
        [table["position"] for table in tables],
        [table.get("velocity", (0.0, 0.0)) for table in tables],
        [table["radius"] for table in tables],
        [table.get("mass", 1.0) for table in tables],
        [table.get("species", "") for table in tables],
        [table.get("spin", USUAL["spin"]) for table in tables],
        [table.get("moment", USUAL["moment"]) for table in tables],
    )


def _read_disks_files(data: Mapping[str, Any], base_dir: Path, parts: _Parts, problems: list[str]) -> None:
    """The disks of the [[disks_file]] tables that can be read."""
    for i, entry in enumerate(_tables(data, "disks_file", problems)):
        values, broken = schema.read_table(schema.DISKS_FILE, entry, f"disks_file[{i}]", problems)
        if broken:
            continue
        try:
            file = read_disks_file(base_dir / values.pop("path"), parts.domain, **values)
        except SceneError as error:
            problems += [f"disks_file[{i}].path: {problem}" for problem in error.problems]
            continue
        parts.names.add(sum(map(len, parts.disks)), f"{entry['path']} {file.row} {{}}", file.number)
        parts.disks.append(file.disks)


def _read_gases(
    data: Mapping[str, Any], domain: Domain | None, walls: Sequence[Wall] | None, seed: int | None, problems: list[str]
) -> list[tuple[int, Gas]]:
    """The [[gas]] tables that keep the rules, each with its index; walls: None where they are not known."""
    gases: list[tuple[int, Gas]] = []
    for i, entry in enumerate(_tables(data, "gas", problems)):
        values, broken = schema.read_table(schema.GAS, entry, f"gas[{i}]", problems)
        if broken and not values:
            continue
        stand_ins = {key: value for key, value in GAS_STAND_IN.items() if key in broken}
        gas = Gas(**stand_ins | values)
        found = gas_problems(gas, domain, f"gas[{i}]", seeded=seed is not None)
        problems += [problem for problem in found if not problem.startswith(tuple(f"gas[{i}].{key}" for key in broken))]
        if not broken:
            gases.append((i, gas))
    for place, (i, gas) in enumerate(gases):
        if gas.inside is not None and walls is not None:
            named = dict(zip(wall_names(walls), walls, strict=True))
            wall = named.get(gas.inside)
            if wall is None:
                listed = ", ".join(named) or "none here"
                problems.append(f'gas[{i}].inside = "{gas.inside}": must be the name of a wall ({listed})')
            elif wall.contains(np.empty((0, 2))) is None:
                problems.append(f'gas[{i}].inside = "{gas.inside}": must be a closed wall, and it is a {wall.kind}')
            else:
                gases[place] = i, inside_of(gas, wall, domain or Open())
    total = sum(gas.count for _, gas in gases)
    if len(gases) > 1 and total > MOST_DISKS:
        problems.append(f"gas: {total} disks in all: must be at most {MOST_DISKS}")
    return gases
