"""Which keys the tables of a scene file have, and of which type their values are."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from difflib import get_close_matches
from typing import Any, NamedTuple

from eventsim.letters import is_name
from eventsim.scene import manner, restitution, roughness
from eventsim.scene.domain import DOMAINS
from eventsim.scene.keys import Invalid, Optional, Required, Schema
from eventsim.scene.numbers import as_number, as_whole
from eventsim.scene.sizes import RULES, Sizes
from eventsim.scene.walls import WALLS
from eventsim.scene.walls.wall import LENGTH, NAME, OWN, POINTS, keys_of, optional_keys
from eventsim.scene.walls.wall import POINT as PLACE

MOST_FRAMES = 10**9
ARRANGEMENTS = ("random", "square", "hexagonal", "compressed")
TABLE_LISTS = ("disk", "disks_file", "gas", "wall")


def number(value: object) -> float:
    """A real number as a float."""
    try:
        return as_number(value)
    except (TypeError, OverflowError) as error:
        raise Invalid(str(error)) from None


def mass(value: object) -> float:
    """A mass; JSON has no word for inf, so it may be written as text."""
    return math.inf if value == "inf" else number(value)


def whole(least: int) -> Callable[[object], int]:
    """A whole number from `least` on."""

    def whole_number(value: object) -> int:
        found = as_whole(value)
        if found is None or found < least:
            raise Invalid(f"must be a whole number, at least {least}")
        return found

    return whole_number


def numbers(count: int, meaning: str) -> Callable[[object], tuple[float, ...]]:
    """A list of `count` numbers."""

    def list_of_numbers(value: object) -> tuple[float, ...]:
        if not isinstance(value, list | tuple) or len(value) != count:
            raise Invalid(f"must be {meaning}")
        try:
            return tuple(map(number, value))
        except Invalid:
            raise Invalid(f"must be {meaning}") from None

    return list_of_numbers


def radius_or_sizes(value: object) -> float | Sizes:
    """A radius, or the law of radii."""
    if not isinstance(value, Mapping):
        return number(value)
    rules = ", ".join(f"{{{rule} = {meaning}}}" for rule, meaning in RULES.items())
    wanted = Invalid(f"must be a number, or one of {rules}")
    found = [rule for rule in RULES if rule in value]
    if len(found) != 1 or value.keys() - {found[0], "weights"} or ("weights" in value and found != ["values"]):
        raise wanted
    given = value[found[0]], value.get("weights", ())
    if not all(isinstance(listed, list | tuple) for listed in given) or (found != ["values"] and len(given[0]) != 2):
        raise wanted
    listed, weights = (tuple(map(number, each)) for each in given)
    return Sizes(found[0], listed, weights)


def points(value: object) -> tuple[tuple[float, ...], ...]:
    """A list of points."""
    if not isinstance(value, list | tuple):
        raise Invalid("must be a list of points [x, y]")
    try:
        return tuple(map(POINT, value))
    except Invalid:
        raise Invalid("must be a list of points [x, y]") from None


def text(value: object) -> str:
    """A text."""
    if not isinstance(value, str):
        raise Invalid("must be a text in quotation marks")
    return value


def text_or_table(value: object) -> str | dict[str, str]:
    """A text; or texts by name, as logs and saved scenes have."""
    if not isinstance(value, Mapping):
        return text(value)
    return {str(key): text(entry) for key, entry in value.items()}


def one_of(*words: str) -> Callable[[object], str]:
    """One of several words."""

    def word(value: object) -> str:
        if value not in words:
            near = get_close_matches(value, words, n=1) if isinstance(value, str) else []
            hint = f' (did you mean "{near[0]}"?)' if near else ""
            raise Invalid("must be one of " + ", ".join(f'"{w}"' for w in words) + hint)
        return str(value)

    return word


def species(value: object) -> str:
    """A name of a species."""
    name = text(value)
    if not name or not is_name(name) or "-" in name:
        raise Invalid("must be one line without control characters and hyphens")
    return name


def table_of_numbers(value: object) -> dict[str, float]:
    """A table of numbers by names."""
    if not isinstance(value, Mapping):
        raise Invalid("must be a table of numbers")
    return {str(key): number(entry) for key, entry in value.items()}


def sides(value: object) -> dict[str, dict[str, float]]:
    """What sides of the domain have of their own: a table for each."""
    wanted = f"must be tables of sides with {', '.join(manner.KEYS)}, as in {{bottom = {{{manner.EXAMPLES['restitution']}}}}}"
    if not isinstance(value, Mapping) or not all(isinstance(own, Mapping) for own in value.values()):
        raise Invalid(wanted)
    return {str(name): {str(key): number(own[key]) for key in own} for name, own in value.items()}


POINT = numbers(2, "two numbers [x, y]")
KIND: dict[Any, Any] = {Required("kind"): text}
SIZED = Schema(
    {**KIND, Required("size"): numbers(2, "two numbers [width, height]"), Optional("origin"): POINT, Optional("walls"): sides}
)

SCENE = Schema(
    {
        Optional("name"): text,
        Optional("until"): number,
        Optional("events"): whole(0),
        Optional("start_time"): number,
        Optional("gravity"): POINT,
        Optional("restitution"): number,
        Optional("tangential_restitution"): number,
        Optional("contact_duration"): number,
        Optional("contact_law"): text_or_table,
        Optional("seed"): whole(0),
        Optional("equilibration"): number,
    }
)
RESTITUTION = Schema({Optional(key): number if key != restitution.PAIRS else table_of_numbers for key in restitution.KEYS})
TANGENTIAL = Schema({Optional(key): number for key in roughness.KEYS})
DOMAIN = {"box": SIZED, "periodic": SIZED, "channel": SIZED, "open": Schema(KIND)}
DISK = Schema(
    {
        Required("position"): POINT,
        Optional("velocity"): POINT,
        Required("radius"): number,
        Optional("mass"): mass,
        Optional("species"): species,
        Optional("spin"): number,
        Optional("moment"): number,
    }
)
PLAIN_KEYS = frozenset(("position", "velocity", "radius", "mass", "spin", "moment"))
GAS = Schema(
    {
        Required("count"): whole(1),
        Optional("radius"): radius_or_sizes,
        Optional("packing_fraction"): number,
        Optional("mass"): mass,
        Optional("species"): species,
        Optional("spin"): number,
        Optional("moment"): number,
        Optional("temperature"): number,
        Optional("speed"): number,
        Optional("arrangement"): one_of(*ARRANGEMENTS),
        Optional("region"): numbers(4, "four numbers [x0, y0, x1, y1]"),
        Optional("inside"): text,
        Optional("seed"): whole(0),
    }
)
DISKS_FILE = Schema(
    {Required("path"): text, Optional("frame"): whole(-MOST_FRAMES), Optional("radius"): number, Optional("mass"): mass}
)
WALL_KEYS: dict[str, Callable[[object], object]] = {PLACE: POINT, POINTS: points, LENGTH: number, NAME: text, OWN: number}
WALL = {
    kind: Schema(
        {**KIND, **{(Required, Optional)[key in optional_keys(wall)](key): WALL_KEYS[of] for key, of in keys_of(wall).items()}}
    )
    for kind, wall in WALLS.items()
}
SCALARS = tuple(str(key) for key in SCENE.schema)
SCENE_KEYS = (*SCALARS, "domain", *TABLE_LISTS)

assert DOMAIN.keys() == DOMAINS.keys()


class Read(NamedTuple):
    """What of a table could be read: the values that fit, by key, and the keys whose values do not, or are missing."""

    values: dict[str, Any]
    broken: frozenset[str] = frozenset()


NOTHING = Read({}, frozenset({"kind"}))
"""What of something that is no table, or one of no known kind, can be read."""


def is_plain_disk(table: object) -> bool:
    """Whether a [[disk]] table is what reading it would give: long lists of disks are read many times faster."""
    if type(table) is not dict or not table.keys() <= PLAIN_KEYS:
        return False
    if not all(type(table.get(key, 1.0)) is float for key in ("radius", "mass", "spin", "moment")) or "radius" not in table:
        return False
    return _is_plain_point(table.get("position")) and _is_plain_point(table.get("velocity", (0.0, 0.0)))


def _is_plain_point(value: object) -> bool:
    return isinstance(value, list | tuple) and list(map(type, value)) == [float, float]


def read_table(schema: Schema, table: object, where: str, problems: list[str]) -> Read:
    """The values of a table in the types of a schema; a problem for each that does not fit.

    `where` is the path of the table, empty for the scene itself. An unknown key is a problem, but the rest of
    the table is read all the same.
    """
    if not isinstance(table, Mapping):
        problems.append(f"{where} = {shown(table)}: must be a table")
        return NOTHING
    prefix = f"{where}." if where else ""
    known = [str(key) for key in schema.schema]
    report_unknown(table, known, prefix, problems)
    values: dict[str, Any] = {}
    broken: set[str] = set()
    for key, read in schema.schema.items():
        name = str(key)
        if name in table:
            try:
                values[name] = read(table[name])
            except Invalid as invalid:
                broken.add(name)
                problems.append(f"{prefix}{name} = {shown(table[name])}: {invalid}")
        elif isinstance(key, Required):
            broken.add(name)
            problems.append(f"{prefix}{name} is missing")
    return Read(values, frozenset(broken))


def read_kind(schemas: Mapping[str, Schema], table: object, where: str, problems: list[str]) -> Read:
    """The same for a table whose keys depend on its `kind`."""
    if not isinstance(table, Mapping):
        problems.append(f"{where} = {shown(table)}: must be a table")
        return NOTHING
    if "kind" not in table:
        problems.append(f"{where}.kind is missing: one of " + ", ".join(f'"{kind}"' for kind in schemas))
        return NOTHING
    try:
        kind = one_of(*schemas)(table["kind"])
    except Invalid as error:
        problems.append(f"{where}.kind = {shown(table['kind'])}: {error}")
        return NOTHING
    return read_table(schemas[kind], table, where, problems)


ABSENT = {
    "friction": "disks slide without friction; tangential_restitution makes them rough",
    "drag": "disks fly free: there is nothing to hold them back",
    "dt": "there is no time step: contacts are computed",
    "timestep": "there is no time step: contacts are computed",
    "time_step": "there is no time step: contacts are computed",
}
"""Keys that people look for in vain, and what there is instead."""


def report_unknown(table: Mapping[Any, object], known: list[str], prefix: str, problems: list[str]) -> None:
    """One problem for each key that is not among the known ones."""
    for key in table:
        if key not in known:
            if (absent := ABSENT.get(str(key).lower())) is not None:
                problems.append(f"{prefix}{key}: unknown key ({absent})")
                continue
            near = get_close_matches(str(key), known, n=1)
            hint = f'did you mean "{near[0]}"?' if near else "known here: " + ", ".join(known)
            problems.append(f"{prefix}{key}: unknown key ({hint})")


def shown(value: object) -> str:
    """A value as a message quotes it."""
    written = repr(value) if isinstance(value, str) else _toml(value)
    return written if len(written) <= 60 else written[:57] + "..."


def _toml(value: object) -> str:
    """A value as a scene file writes it."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key} = {_toml(entry)}" for key, entry in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(_toml, value)) + "]"
    return f'"{value}"' if isinstance(value, str) else repr(value)
