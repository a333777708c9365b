"""Keys of other programs and values in other forms, as people write them into scenes, and the line that would be right."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Mapping, Sequence
from difflib import get_close_matches
from typing import Any, NamedTuple

from eventsim.scene import restitution, roughness
from eventsim.scene.keyboard import plain
from eventsim.scene.walls import WALLS

EXAMPLES = {
    "name": 'name = "ramp"',
    "until": "until = 2.0",
    "events": "events = 100000",
    "start_time": "start_time = 0.0",
    "gravity": "gravity = [0.0, -9.81]",
    "restitution": "restitution = 0.9",
    "tangential_restitution": roughness.EXAMPLE,
    "contact_duration": "contact_duration = 1e-6",
    "contact_law": 'contact_law = "my_laws.py:sticky"',
    "equilibration": "equilibration = 1.0",
    **restitution.EXAMPLES,
    "kind": 'kind = "box"',
    "size": "size = [2.0, 1.0]",
    "origin": "origin = [0.0, 0.0]",
    "position": "position = [0.3, 0.8]",
    "velocity": "velocity = [1.0, 0.0]",
    "radius": "radius = 0.05",
    "mass": "mass = 2.0",
    "species": 'species = "a"',
    "spin": "spin = 1.0",
    "moment": "moment = 0.5",
    "count": "count = 20",
    "packing_fraction": "packing_fraction = 0.3",
    "temperature": "temperature = 1.0",
    "speed": "speed = 1.0",
    "arrangement": 'arrangement = "random"',
    "region": "region = [1.3, 0.3, 1.9, 0.9]",
    "inside": 'inside = "wall0"',
    "seed": "seed = 7",
    "path": 'path = "start.csv"',
    "frame": "frame = -1",
    "start": "start = [0.0, 0.5]",
    "end": "end = [1.2, 0.2]",
    "through": "through = [0.5, 0.5]",
    "center": "center = [0.0, 0.0]",
    "points": "points = [[0.0, 0.0], [1.0, 0.0], [0.5, 0.8]]",
    "semi_axes": "semi_axes = [2.0, 1.0]",
    "direction": "direction = [1.0, 0.0]",
    "shaking": "shaking = 0.3",
    "walls": "walls = {bottom = {restitution = 0.5}}",
}
"""A line for each key that a table may have."""

TEXTS = ("name", "kind", "arrangement", "path", "inside", "species", "contact_law")
FILES = {"contact_law": r".+\.py:\w+", "path": r".+\.(csv|npz)"}
"""Keys that name a file, and the form of the name."""

WHOLES = ("events", "count", "seed", "frame")
PAIRS = tuple(key for key, line in EXAMPLES.items() if re.fullmatch(r"\w+ = \[[^,]+, [^,]+\]", line))

LISTS = ("disk", "disks_file", "gas", "wall")
TABLES = {
    **dict.fromkeys(("ball", "particle", "atom", "disc", "circle", "puck", "body", "sphere", "post"), "[[disk]]"),
    **dict.fromkeys(("obstacle", "line", "segment", "border", "polygon", "arc", "barrier", "ramp"), "[[wall]]"),
    **dict.fromkeys(("box", "world", "container", "boundary", "space", "table", "periodic", "open"), "[domain]"),
    **{name: f"[[{name}]]" for name in LISTS},
}
"""What people call tables."""

ALIASES: dict[str, dict[str, str]] = {
    "": {
        "until": "time t_end tmax t_max duration end end_time stop stop_time runtime total_time",
        "events": "max_events n_events collisions",
        "start_time": "t0 t_start begin",
        "gravity": "g acceleration",
        "restitution": "e elasticity bounce bounciness cor coefficient_of_restitution",
        "name": "title",
    },
    "domain": {"kind": "type shape boundary boundaries", "size": "dimensions lengths box", "origin": "corner offset"},
    "disk": {
        "position": "pos place center centre xy location",
        "velocity": "vel v speed speed_vector",
        "radius": "r rad",
        "mass": "m weight",
        "species": "name label kind type",
    },
    "gas": {
        "count": "n number amount disks balls particles",
        "packing_fraction": "eta phi density filling fraction",
        "temperature": "t temp kt",
        "speed": "v velocity",
        "arrangement": "layout placement lattice",
        "radius": "r rad",
        "mass": "m weight",
        "region": "area box",
        "species": "name label kind type",
    },
    "wall": {
        "kind": "type shape",
        "start": "from a p1 begin",
        "end": "to b p2 stop",
        "points": "vertices corners nodes",
        "center": "centre pos position",
        "radius": "r rad",
    },
    "disks_file": {"path": "file filename name source"},
}  # fmt: skip

WORDS = {
    "kind": "box:rectangle,rect,square,walls,closed periodic:torus,pbc,wrap open:free,infinite,none,plane channel:tube,pipe",
    "arrangement": "random:uniform,rand square:grid,lattice,cubic hexagonal:hex,hexagon,triangular compressed:dense,packed",
}
"""What people call the values of a key that are words."""


def _named(words: str) -> dict[str, list[str]]:
    """Values, and what people call each of them, from one line."""
    return {right: others.split(",") for right, _, others in (group.partition(":") for group in words.split())}


OF_WALLS: dict[str, list[str]] = {kind: [] for kind in WALLS} | _named(
    "segment:line,straight,wall polygon:poly,triangle,rectangle,box circle:ring,container polyline:chain,path ellipse:oval "
    "arc:bow"
)
"""Every kind of wall that there is, and what people call some."""

POSTS = ("obstacle", "post", "pin", "peg", "pillar", "scatterer", "bumper")
"""What people call what stands still and is met from outside."""

ROUND_POST = "a round post is a [[disk]] with mass = inf"
"""How it is said here."""

LEAST_PER_CENT = 2.0
"""A restitution from here on is meant in per cent."""

NO_WALLS = {
    **dict.fromkeys(("pocket", "hole", "sink", "goal", "exit"), "disks do not vanish: there are no pockets"),
    **dict.fromkeys((*POSTS, "disk", "disc"), ROUND_POST),
}
"""Kinds of walls that there are not, and why."""

FIXED = ("fixed", "static", "immovable", "immobile", "frozen", "pinned", "anchored", "kinematic", "obstacle")
"""What people call disks that nothing deflects."""

NEEDLESS = {
    **dict.fromkeys(
        ("dt", "timestep", "time_step", "step", "fps", "steps"),
        "there is no time step: contacts are computed, not looked for",
    ),
    **dict.fromkeys(("color", "colour"), "colours are chosen by animate --color"),
}


class Remedy(NamedTuple):
    """Why a key or value will not do, and the lines that would; no lines where it is best left out.

    example: whether these are of some other scene, as nobody knows what was meant.
    other: the line that would do if the same was meant otherwise.
    """

    why: str
    write: str
    example: bool = False
    other: str = ""


def remedy(
    table: str, key: str, here: Mapping[str, Any], known: tuple[str, ...], scene_keys: tuple[str, ...]
) -> Remedy | None:
    """What to write instead of a key or its value; None where nothing is known.

    Args:
        table: the name of the table, "" for the scene itself.
        key: the key, of the file's own spelling.
        here: the keys and values of that table.
        known: the keys that such a table may have.
        scene_keys: single keys of the scene itself.
    """
    try:
        return _remedy(table, key, here, known, scene_keys)
    except (ArithmeticError, ValueError):  # numbers of thousands of digits
        return None


def _remedy(
    table: str, key: str, here: Mapping[str, Any], known: tuple[str, ...], scene_keys: tuple[str, ...]
) -> Remedy | None:
    value = here[key]
    if table == "wall" and (point := _of_arc(key, here)) is not None:
        return point
    if table == "disk" and "angle" in here and _numbers(here, ("velocity", "angle")):
        if key == "velocity":
            return _polar(here)
        if key == "angle" and "velocity" in here:
            return Remedy("the components of the velocity tell its direction: leave this line out", "")
    if key in known:
        return _of_value(table, key, value)
    word = re.sub(r"[^a-z]+$", "", key.lower().replace("-", "_"))
    if word in NEEDLESS:
        return Remedy(NEEDLESS[word], "")
    if table in ("disk", "gas") and word.removeprefix("is_") in FIXED and isinstance(value, bool):
        return Remedy("nothing deflects a disk of mass inf", "mass = inf" if value else "")
    if table == "gas" and word == "velocity" and isinstance(value, list) and len(value) == 2 and all(map(_is_number, value)):
        return Remedy("its disks have one speed, in all directions, or a temperature", f"speed = {math.hypot(*value):.6g}")
    if table == "wall" and key == "points" and here.get("kind") == "segment" and isinstance(value, list):
        if len(value) == 2:
            ends = zip(("start", "end"), value, strict=True)
            return Remedy("a segment has a start and an end", "\n".join(f"{name} = {written(place)}" for name, place in ends))
        return Remedy("a segment has a start and an end; through points goes a polyline", 'kind = "polyline"')
    if table and isinstance(value, Mapping | list) and (key in LISTS or (value and isinstance(value, list) and word in TABLES)):
        own_header = TABLES[word]
        if isinstance(value, Mapping) or all(isinstance(one, Mapping) for one in value):
            return Remedy(f"{own_header} is a table of the scene, and in no other one", own_header)
    own = next((f(here) for keys, f in COMBINED.get(table, {}).items() if key in keys and _numbers(here, keys)), None)
    if own is not None:
        return own
    if not table:
        if (word in POSTS or word.removesuffix("s") in POSTS) and _is_round(value):
            return Remedy(ROUND_POST, "[[disk]]\nmass = inf")
        header = TABLES.get(word) or TABLES.get(word.removesuffix("s"))
        if isinstance(value, Mapping | list) and header is not None:
            return Remedy(f"such a table is called {header}", header)
        if word == "domain" and isinstance(value, Mapping):
            return Remedy("names are written small", "[domain]")
    right = word if word in known else _alias(table, word)
    if right is not None:
        return _line(f"the key is {right}", table, right, value)
    if table and word in scene_keys:
        return _line(f"{word} is a key of the scene: move it above the first table", "", word, value)
    right = _alias("", word) if table else None
    if right is not None:
        return _line(f"the key is {right}, above the first table", "", right, value)
    return None


def _alias(table: str, word: str) -> str | None:
    return next((key for key, words in ALIASES.get(table, {}).items() if word in words.split()), None)


def meant(word: str) -> str:
    """The key that a word means in whatever table, the word itself where it is no other name of any."""
    if word in EXAMPLES:
        return word
    return next((right for table in ALIASES if (right := _alias(table, word)) is not None), word)


def _line(why: str, table: str, key: str, value: Any) -> Remedy:
    """A line with a key, its value mended where that is needed."""
    mended = None if _fits(key, value) else _of_value(table, key, value)
    if mended is None:
        return Remedy(why, f"{key} = {written(value)}")
    return mended._replace(why=f"{why}; {mended.why}" if mended.other else why)


def _is_round(value: Any) -> bool:
    """Whether the first of the tables in a list has a radius and no ends."""
    first = value[0] if isinstance(value, list) and value else value
    return isinstance(first, Mapping) and not {"start", "end", "points"} & first.keys() and bool({"radius", "r"} & first.keys())


def _fits(key: str, value: Any) -> bool:
    """Whether a value is of the form that a key asks for."""
    if key in PAIRS:
        return isinstance(value, list) and len(value) == 2 and all(map(_is_number, value))
    return (
        isinstance(value, str)
        if key in TEXTS
        else isinstance(value, list)
        if key in ("points", "region")
        else _is_number(value)
    )


def written(value: Any) -> str:
    """A value as TOML writes it."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(written, value)) + "]"
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key} = {written(entry)}" for key, entry in value.items()) + "}"
    return json.dumps(value, ensure_ascii=False) if isinstance(value, str) else repr(value)


def _numbers(here: Mapping[str, Any], keys: tuple[str, ...]) -> bool:
    """Whether all of these keys that are there are single numbers."""
    return all(_is_number(here.get(key, 0.0)) for key in keys)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _two(key: str, one: str, two: str) -> Callable[[Mapping[str, Any]], Remedy]:
    return lambda here: Remedy(
        f"both numbers stand in {key}", f"{key} = [{written(here.get(one, 0.0))}, {written(here.get(two, 0.0))}]"
    )


def _turns(*angles: float) -> tuple[list[float], str]:
    """Angles in radians, and what they are taken for."""
    degrees = any(abs(angle) > 2.0 * math.pi for angle in angles) or not any(angles)
    return [math.radians(angle) if degrees else angle for angle in angles], "degrees" if degrees else "radians"


def _around(center: Sequence[float], radius: float, turn: float) -> list[float]:
    """The point at a distance from another one, in a direction."""
    return [round(middle + radius * way, 6) + 0.0 for middle, way in zip(center, (math.cos(turn), math.sin(turn)), strict=True)]


def turned(length: float, angle: float, radians: bool) -> list[float]:
    """The components of a vector of a length and a direction."""
    return _around((0.0, 0.0), length, angle if radians else math.radians(angle))


def _polar(here: Mapping[str, Any]) -> Remedy:
    given = here.get("velocity", 1.0)
    speed, angle = float(here.get("speed", given if _is_number(given) else 1.0)), float(here.get("angle", 0.0))
    (turn,), unit = _turns(angle)
    taken = f", the angle read as {unit}" if "angle" in here else ""
    return Remedy(f"a disk has a velocity [vx, vy]{taken}", f"velocity = {written(_around((0.0, 0.0), speed, turn))}")


def _of_arc(key: str, here: Mapping[str, Any]) -> Remedy | None:
    """What to write for a key of an arc that is told by its circle and two angles; None where it is not."""
    told = {"radius", "start", "end"} <= here.keys() and _numbers(here, ("radius", "start", "end"))
    if here.get("kind") != "arc" or not told or not _fits("center", here.get("center")):
        return None
    (first, last), unit = _turns(here["start"], here["end"])
    turns = {"start": first, "center": 0.5 * (first + last), "end": last}
    why = f"an arc has three points on it, the angles read as {unit}"
    if key not in turns:
        return Remedy("three points tell the circle", "") if key == "radius" else None
    name = "through" if key == "center" else key
    place = _around(here["center"], here["radius"], turns[key])
    return Remedy(why, f"{name} = {written(place)}")


def _half(here: Mapping[str, Any]) -> Remedy:
    return Remedy("the size of a disk is its radius, half the diameter", f"radius = {written(here['diameter'] / 2)}")


COMBINED: dict[str, dict[tuple[str, ...], Callable[[Mapping[str, Any]], Remedy]]] = {
    "disk": {
        ("x", "y"): _two("position", "x", "y"),
        ("vx", "vy"): _two("velocity", "vx", "vy"),
        ("speed", "angle"): _polar,
        ("diameter",): _half,
    },
    "gas": {("diameter",): _half},
    "wall": {("x1", "y1"): _two("start", "x1", "y1"), ("x2", "y2"): _two("end", "x2", "y2"), ("diameter",): _half},
    "domain": {("width", "height"): _two("size", "width", "height"), ("w", "h"): _two("size", "w", "h")},
}
"""Keys that together say what one key says here."""


def combined(here: Mapping[str, Any]) -> str | None:
    """The line that says what such keys together mean, in whatever table; None where they mean nothing together."""
    rules = (rule for table in COMBINED.values() for rule in table.items())
    return next((told(here).write for keys, told in rules if set(keys) == here.keys() and _numbers(here, keys)), None)


def example_of(table: str, key: str) -> str:
    """A line that shows the form of a key of a table; empty for a key that nobody knows."""
    return 'kind = "segment"' if (table, key) == ("wall", "kind") else EXAMPLES.get(key, "")


def _of_value(table: str, key: str, value: Any) -> Remedy | None:
    """What to write instead of the value of a known key."""
    of_wall = table == "wall" and key == "kind"
    line = example_of(table, key)
    example = Remedy("", line, example=True) if line else None
    mended: Any = None
    if key in FILES and isinstance(value, str) and re.fullmatch(FILES[key], value):
        return None  # what is wrong is in that file
    if key == "inside" and isinstance(value, str):
        return None  # the sentence lists the names that there are
    if key in WORDS and isinstance(value, str):
        word = value.lower()
        if of_wall and word.removesuffix("s") in NO_WALLS:
            return Remedy(NO_WALLS[word.removesuffix("s")], "")
        mine = OF_WALLS if of_wall else _named(WORDS[key])
        fits = [right for right, words in mine.items() if word == right or word in words] or get_close_matches(word, mine, n=1)
        mended = fits[0] if fits else None
    elif key == "velocity" and isinstance(value, Mapping) and "speed" in value and value.keys() <= {"speed", "angle"}:
        return _polar(value) if _numbers(value, ("speed", "angle")) else example
    elif key in TEXTS and _is_number(value):
        mended = str(value)
    elif key in PAIRS:
        mended = _pair(key, value)
        if mended == value:
            return None  # of the right form, whatever is wrong with its numbers
    elif key == "restitution" and _is_number(value) and 1.0 < value < LEAST_PER_CENT:
        return Remedy("more than 1 would make energy", f"{key} = 1.0")
    elif key == "restitution" and _is_number(value) and LEAST_PER_CENT <= value <= 100.0:
        return Remedy("it is a part of 1, not per cent", f"{key} = {written(value / 100)}")
    elif key == "radius" and table == "gas" and isinstance(value, list) and len(value) > 1 and all(map(_is_number, value)):
        law = "uniform" if len(value) == 2 else "values"
        return Remedy("radii are drawn by a law", f"radius = {{{law} = {written(value)}}}")
    elif key == "mass" and isinstance(value, str) and re.fullmatch(r"(?i)\W*(?:infinit[ey]|inf|\u221e|oo)\W*", value):
        mended = math.inf
    elif isinstance(value, str) and OPEN_COMMA.fullmatch(value.strip()) and key not in WHOLES:
        point, none = read_both(value.strip())
        return Remedy(two_ways(value), f"{key} = {point}", other=f"{key} = {none}")
    elif isinstance(value, str):
        mended = number_in(re.sub(r"(?<=\d),(?=\d{3})", "", value) if key in WHOLES else value)
    elif isinstance(value, list) and len(value) == 1 and _is_number(value[0]):
        mended = value[0]
    if key in WHOLES and isinstance(mended, float):
        mended = round(mended)
    return example if mended is None else Remedy("", f"{key} = {written(mended)}")


OPEN_COMMA = re.compile(r"(?<![\w.,])([1-9]\d{0,2}),(\d{3})(?![\d.]|,\d)")
"""A comma that may be meant as the point of a number, or as a mark between thousands."""

MANY_COMMAS = re.compile(r"(?<![\w.,])[1-9]\d{0,2}(?:,\d{3}){2,}(?![\d,])")
"""Commas that can only be marks between thousands."""


def pointed(text: str) -> str:
    """A text whose numbers have a decimal point where they had a comma, and no marks between thousands."""
    text = MANY_COMMAS.sub(lambda number: number[0].replace(",", ""), text)
    return re.sub(r"(?<![\d.])(?<!\d,)(\d+),(\d+)(?![\d.]|,\d)", r"\1.\2", text)


def read_both(text: str) -> tuple[str, str]:
    """A text with a point in the place of each comma that may part thousands, and with nothing there."""
    return OPEN_COMMA.sub(r"\1.\2", text), OPEN_COMMA.sub(r"\1\2", text)


def two_ways(text: str) -> str:
    """Which two numbers such a comma may mean; empty where there is none."""
    found = OPEN_COMMA.search(text)
    return "" if found is None else f"{found[1]}.{found[2]}, or {found[1]}{found[2]} if the comma separates thousands"


COUNTS = {**dict.fromkeys(PAIRS, 2), "region": 4}
"""How many numbers stand in the list of a key."""


def with_points(key: str, value: str) -> str | None:
    """The text of a list, written with decimal commas, with points; None where that is no list of the right length."""

    def row(match: re.Match[str]) -> str:
        parts = re.split(r",\s+|\s*;\s*|\s+", match[1].strip())
        return f"[{', '.join(map(pointed, parts))}]"

    if key not in (*COUNTS, "points") or (key == "points") != value.startswith("[["):
        return None
    right = re.sub(r"\[([^\[\]]*)\]", row, value)
    rows = re.findall(r"\[([^\[\]]*)\]", right)
    lists = [[number_in(part) for part in each.split(", ")] for each in rows]
    whole = all(len(each) == COUNTS.get(key, 2) and None not in each for each in lists)
    return right if lists and whole and right != value else None


def _pair(key: str, value: Any) -> list[Any] | None:
    """Two numbers that somebody means by a value; None where that is open."""
    if isinstance(value, str):
        found = [
            number_in(part)
            for part in re.split(r"[;\s]+|,\s+|,(?=.*\.)|(?<=\d)x(?=\d)", value.strip(" ()[]{}"))
            if part
        ]
        return found if len(found) == 2 and None not in found else None
    if isinstance(value, Mapping) and value.keys() == {"x", "y"}:
        return [value["x"], value["y"]]
    if isinstance(value, list) and len(value) == 4 and all(isinstance(x, int) for x in value):
        return [float(f"{value[0]}.{value[1]}"), float(f"{value[2]}.{value[3]}")]  # decimal commas
    if isinstance(value, list) and len(value) == 2:
        found = [x if _is_number(x) else number_in(str(x)) for x in value]
        return None if None in found else found
    if _is_number(value):
        return {"gravity": [0.0, -abs(float(value))], "size": [value, value], "semi_axes": [value, value]}.get(
            key, [value, 0.0] if key == "velocity" else None
        )
    return None


NUMBER = re.compile(r"([-+]?)(\d*)(?:[.,](\d*))?([eE][-+]?\d+)?\s*([*/]\s*\d+\.?\d*|%|[A-Za-z°µ²^/]\S*)?")


def number_in(text: str) -> float | int | None:
    """The number that somebody means by a text: with a decimal comma, no digit before the point, a unit, a fraction."""
    found = NUMBER.fullmatch(plain(text).strip())
    if found is None or not (found[2] or found[3]):
        return None
    sign, whole, part, power, rest = (group or "" for group in found.groups())
    if not part and not power and not rest and "." not in text and "," not in text:
        return int(sign + whole)
    number = float(f"{sign}{whole or 0}.{part or 0}{power}")
    if rest.startswith(("*", "/")) and re.fullmatch(r"\d+\.?\d*", rest[1:].strip()):
        other = float(rest[1:])
        return number * other if rest[0] == "*" else number / other if other else None
    return number / 100.0 if rest == "%" else number
