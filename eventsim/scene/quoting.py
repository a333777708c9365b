"""Where in the text of a scene file a key stands, and how a message quotes it: line, caret, and the line that would be right."""

from __future__ import annotations

import json
import re
import tomllib
from bisect import bisect_right
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from eventsim.errors import SceneError
from eventsim.scene import schema
from eventsim.scene.remedies import Remedy, example_of, read_both, remedy, two_ways, with_points
from eventsim.scene.validate import NO_DISKS

LONGEST = 1 << 23
"""Letters of a file whose lines are looked for."""

WIDEST = 100
"""Letters of a line that are shown."""

HEADER = re.compile(r"\s*(\[\[?)\s*([\w.\"'-]+)\s*\]")
KEY = re.compile(r"\s*([\w-]+)\s*=\s*")
INNER = re.compile(r"[{,]\s*([\w-]+)\s*=\s*")
PATH = re.compile(r"(?P<table>[\w-]+(?:\[\d+\])?)(?:\.(?P<key>[\w-]+))?(?:\[\d+\])*(?P<rest>: | = | is missing)")
GUESS = re.compile(r"unknown key \((?:did you mean \"(\w+)\"\?|known here: [^)]*)\)")
CHOICE = re.compile(r"(?P<table>\w+\[\d+\]): (?:needs|has both) (?P<key>\w+)")
TAKEN = re.compile(r"wall\[\d+\]: the name ")
SUBJECT = re.compile(r"\b(?:disk|gas|wall)\[\d+\](?!\.)")
MET = re.compile(r"(?:across|out of) \w+ (?P<name>.+?): ")
ANCHORS = {"disk": "position", "wall": "name"}
"""Tables that a sentence is about, and the key at which it points to one."""

LIST = re.compile(r"\[(?:[^\[\]]|\[[^\[\]]*\])*\]")
JSON_TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|[{}\[\],:]|[^\s{}\[\],:"]+')


NO_DISK = "\n    as in:  [[disk]]\n            position = [0.3, 0.8]\n            radius = 0.05"
NO_DISK_IN_JSON = '\n    as in:  "disk": [{"position": [0.3, 0.8], "radius": 0.05}]'
"""What is shown to who has written no disk."""


class Place(NamedTuple):
    """A line, counted from 1, the column of a key in it, from 0, and that of its value."""

    line: int
    key: int
    value: int


def quoted(line: str, column: int, why: str, write: str, label: str = "", example: bool = False, other: str = "") -> str:
    """The lines that follow the sentence of a problem.

    Args:
        line: what was written.
        column: where the caret points to, from 0.
        why: what is wrong there; may be empty.
        write: what would be right, one or more lines; empty: nothing.
        label: what the line is called, as in "line 3".
        example: whether `write` only shows the form.
        other: what would be right if the line was meant otherwise; empty: nothing.
    """
    if len(line) > WIDEST:
        first = min(max(column - WIDEST // 2, 0), len(line) - WIDEST)
        line, column = line[first : first + WIDEST], column - first
    inset = len(line) - len(line.lstrip())
    width = max(len(label), len("write")) + 2
    shown = [f"{label}:".ljust(width) + line.strip(), (" " * (width + column - inset) + f"^ {why}").rstrip()]
    for number, right in enumerate(write.splitlines() if len(write) <= WIDEST else ()):
        shown.append(("" if number else "as in:" if example else "write:").ljust(width) + right.strip())
    if other and len(other) <= WIDEST:
        shown.append("or:".ljust(width) + other.strip())
    return "".join(f"\n    {row}" for row in shown)


def places_in(text: str) -> dict[str, Place]:
    """Where each key and table header of a TOML text stands, by path, as in "disk[2].radius".  O(length)."""
    found: dict[str, Place] = {}
    counts: dict[str, int] = {}
    prefix, depth = "", 0
    for number, line in enumerate(text.split("\n"), 1):
        bare = re.sub(r'"[^"]*"|\'[^\']*\'', lambda match: "_" * len(match[0]), line).partition("#")[0]
        header = HEADER.match(line) if depth == 0 else None
        if header is not None:
            name = header[2].strip("\"'")
            if header[1] == "[[":
                counts[name] = counts.get(name, -1) + 1
                name = f"{name}[{counts[name]}]"
            found.setdefault(name, Place(number, header.start(1), header.start(1)))
            prefix = f"{name}."
            continue
        key = KEY.match(line) if depth == 0 else None
        if key is not None:
            path = prefix + key[1]
            found.setdefault(path, Place(number, key.start(1), key.end()))
            for inner in INNER.finditer(bare):
                found.setdefault(f"{path}.{inner[1]}", Place(number, inner.start(1), inner.end()))
        depth = max(depth + bare.count("[") + bare.count("{") - bare.count("]") - bare.count("}"), 0)
    return found


def places_in_json(text: str) -> dict[str, Place]:
    """Where each key and table of a JSON text, which can be read, stands, by the same paths.  O(length)."""
    starts = [0, *(match.end() for match in re.finditer("\n", text))]
    found: dict[str, Place] = {}
    outer: list[tuple[str, int | None]] = []  # what is open: its path, and in a list the number of the next value
    key: re.Match[str] | None = None
    for token in JSON_TOKEN.finditer(text):
        mark = token[0]
        parent, count = outer[-1] if outer else ("", None)
        if mark in "]}":
            outer.pop()
        elif mark == ",":
            key = None
            outer[-1] = parent, None if count is None else count + 1
        elif mark == ":":
            pass
        elif outer and count is None and key is None:
            key = token
        else:
            name = None if key is None else json.loads(key[0])
            path = f"{parent}[{count}]" if name is None else f"{parent}.{name}" if parent else name
            first = token if key is None else key
            line = bisect_right(starts, first.start())
            at, value = first.start() - starts[line - 1], token.start() - starts[line - 1]
            found.setdefault(path, Place(line, at, at if "\n" in text[first.start() : token.start()] else value))
            if mark in "[{":
                outer.append((path if outer else "", 0 if mark == "[" else None))
                key = None
    return found


def with_lines(
    error: SceneError, text: str, data: Mapping[str, Any], settings: Collection[str] = (), is_json: bool = False
) -> SceneError:
    """The same problems, those with keys or tables of a text followed by their lines, a caret and a line that would be right.

    Args:
        error: its problems begin with the path of a key, as in "disk[2].radius", or speak of tables, as in "disk[2]".
        text: of the file.
        data: its tables.
        settings: "key=value" as typed after --set; what they changed stands in no line.
        is_json: whether the text is JSON; else it is TOML.
    """
    if len(text) > LONGEST:
        return error
    places, lines = (places_in_json if is_json else places_in)(text), text.split("\n")
    form = _in_json if is_json else str
    typed = {re.sub(r"\.(\d+)", r"[\1]", setting.partition("=")[0].strip()): setting for setting in settings}
    told = [_with_quotes(problem, list(_quotes(problem, places, lines, data, typed, form))) for problem in error.problems]
    return SceneError(_joined(told))


ONE_KEY = re.compile(r"(?P<table>[\w.]+(?:\[\d+\])?)\.(?P<key>\w+)(?P<what>: unknown key| is missing)(?P<shown>\n.*)?", re.DOTALL)


def _joined(problems: Iterable[str]) -> list[str]:
    """The problems, those of keys of one table that the same lines mend as one."""
    found: dict[object, list[str]] = {}
    for place, problem in enumerate(problems):
        match = ONE_KEY.fullmatch(problem)
        shown, _, write = (match["shown"] or "").partition("\n    write:") if match else ("", "", "")
        same = found.setdefault((match["table"], write.strip()) if match and write else place, [])
        if match is None or not same:
            same.append(problem)
        elif not match["what"].startswith(" is") and (first := ONE_KEY.fullmatch(same[0])) is not None:
            line, more = shown.split("\n")[1], f"{first['key']}, {match['key']}"
            above, _, below = (first["shown"] or "").partition("\n    write:")
            same[0] = f"{first['table']}.{more}: unknown key{above}\n{line}\n    write:{below}"
    return [problem for same in found.values() for problem in same]


def _in_json(write: str) -> str:
    """What a line of TOML says, in JSON; empty where it is no whole line."""
    try:
        told = tomllib.loads(write)
    except tomllib.TOMLDecodeError:
        return ""
    return ", ".join(f"{json.dumps(key)}: {json.dumps(value)}" for key, value in told.items())


def _with_quotes(problem: str, quotes: list[str]) -> str:
    """A problem with its quoted lines; what these propose is not guessed as well."""
    told = "".join(quotes)
    if "\n    write:" in told or "\n    as in:" in told:
        problem = GUESS.sub(lambda guess: guess[0] if guess[1] and guess[1] in told else "unknown key", problem)
    return problem + told


def _quotes(
    problem: str,
    places: Mapping[str, Place],
    lines: list[str],
    data: Mapping[str, Any],
    typed: Mapping[str, str],
    form: Callable[[str], str],
) -> Iterator[str]:
    """What follows the sentence of one problem: nothing, or its quoted lines; form: that in which TOML is written there."""
    match = PATH.match(problem) or CHOICE.match(problem)
    if problem == NO_DISKS:
        yield NO_DISK_IN_JSON if form is _in_json else NO_DISK
    if match is None or TAKEN.match(problem):
        yield from _quotes_of_tables(problem, places, lines, data, typed)
        return
    table, key = match["table"], match["key"]
    path = f"{table}.{key}" if key else table
    if path in typed:
        setting = typed[path]
        name, _, value = setting.partition("=")
        told = _remedy(table, key, {**_table(data, table), (key or table): _read(value)})
        told = _by_text(told, key or table, value.strip())
        write, other = (line.replace(f"{key or table} = ", f"{name}=") for line in (told.write, told.other))
        column = 0 if "unknown key" in problem else len(name) + 1
        yield quoted(setting, column, told.why, write, "typed", told.example, other)
        return
    missing = problem[match.start() :].partition(" is missing")[1] and path not in places
    here = _table(data, table) if missing else {}
    for other in (name for name in here if name != "kind"):  # it may be there under another name
        told = _remedy(table, other, here)
        lines_of = told.write.splitlines()
        mends = any(line.startswith((f"{key} = ", "kind = ")) for line in lines_of) and not told.example
        if key and mends and f"{table}.{other}" in places:
            named = places[f"{table}.{other}"]
            yield quoted(lines[named.line - 1], named.key, told.why, form(told.write), f"line {named.line}", told.example)
            return
    place = places.get(path) or places.get(f"{path}[0]") or places.get(table) or places.get(f"{table}[0]")
    place = place or places.get(table.partition("[")[0])
    if place is None:
        return
    if missing or "needs" in problem.split(":")[1][:8]:
        lacks = f"this table lacks {key}" if key else ""
        example = example_of(table.partition("[")[0], key or "")
        yield quoted(lines[place.line - 1], place.key, lacks, form(example), f"line {place.line}", True)
        return
    told = _remedy(table, key, _table(data, table) if key else data)
    listed = LIST.match(lines[place.line - 1], place.value)
    told = _by_text(told, key or table, "" if listed is None else listed[0])
    unknown = "unknown key" in problem
    header = places.get(table) if key else None
    write = told.write
    if unknown and "above the first table" in told.why and header is not None:
        headers = [place.line for place in places.values() if HEADER.match(lines[place.line - 1])]
        write = f"{write}\n{lines[min(headers) - 1].strip()}" if headers else write
    above = min((one.line for one in places.values() if HEADER.match(lines[one.line - 1])), default=place.line)
    if key is None and told.write.startswith(f"{table} = ") and HEADER.match(lines[place.line - 1]) and form is str:
        told = told._replace(why=f"{table} is a key of the scene: write it above the first table")
        write = f"{write}\n{lines[above - 1].strip()}" if above < place.line else write
    column, write = place.key if unknown else place.value, form(write)
    bare, written = _bare(write), _bare(lines[place.line - 1])
    if bare == written or (bare.startswith('"') and bare in written):  # what was written is of the right form
        write = ""
    yield quoted(lines[place.line - 1], column, told.why, write, f"line {place.line}", told.example, form(told.other))


def _quotes_of_tables(
    problem: str, places: Mapping[str, Place], lines: list[str], data: Mapping[str, Any], typed: Mapping[str, str]
) -> Iterator[str]:
    """Of each table that a sentence speaks of the line that it points to: of a disk its place, or what the sentence names."""
    named = re.search(r"\bhas (\w+)", problem)
    for table in _subjects(problem, data):
        paths = [f"{table}.{key}" for key in (named[1] if named else "", ANCHORS.get(table.partition("[")[0], ""))]
        setting = next((typed[path] for path in paths if path in typed), None)
        place = next((places[path] for path in (*paths, table) if path in places), None)
        if setting is not None:
            yield quoted(setting, 0, table, "", "typed")
        elif place is not None:
            yield quoted(lines[place.line - 1], place.key, table, "", f"line {place.line}")


def _subjects(problem: str, data: Mapping[str, Any]) -> list[str]:
    """The tables that a sentence speaks of: disks, gases and walls by their numbers, walls by their names as well."""
    found = SUBJECT.findall(problem)
    met = MET.search(problem)
    for i, wall in enumerate(data.get("wall", ()) if met else ()):
        name = wall.get("name", f"wall{i}")
        if met and (met["name"] == name or met["name"].startswith(f"{name}.")):
            found.append(f"wall[{i}]")
    return list(dict.fromkeys(found))


def _bare(line: str) -> str:
    """A line without spaces and comment."""
    return re.sub(r"\s", "", line.partition("#")[0])


def _read(written: str) -> Any:
    """A setting's value: the text, unless it is a number."""
    from eventsim.scene.overrides import value_of

    return value_of(written.strip())


def _table(data: Mapping[str, Any], table: str) -> Mapping[str, Any]:
    """The table of a path such as "disk[2]", "domain" or "" for the scene; empty where there is none."""
    name, _, index = table.rstrip("]").partition("[")
    here = data.get(name)
    if index and isinstance(here, list):
        here = here[int(index)] if int(index) < len(here) else None
    return here if isinstance(here, Mapping) else {}


def _remedy(table: str, key: str | None, here: Mapping[str, Any]) -> Remedy:
    """What is known about a key of a table; nothing, where nothing is."""
    name = table.partition("[")[0] if key else ""
    key = key or table.partition("[")[0]
    if key not in here:
        return Remedy("", "")
    if not name and key in (*schema.TABLE_LISTS, "domain"):
        double = key in schema.TABLE_LISTS
        return Remedy("", f"[[{key}]]" if double else f"[{key}]")
    return remedy(name, key, here, _known(name, here), schema.SCALARS) or Remedy("", "")


def _by_text(told: Remedy, key: str, value: str) -> Remedy:
    """What is known about a list, or what its text tells: which of its commas are those of numbers."""
    right = with_points(key, value)
    if right is None:
        return told
    point, none = read_both(value)
    why, line = "a number has a decimal point, not a comma", f"{key} = {right}"
    if point == none:
        return Remedy(why, line)
    return Remedy(f"{why}: {two_ways(value)}", line, other=f"{key} = {with_points(key, none) or none}")


def _known(name: str, here: Mapping[str, Any]) -> tuple[str, ...]:
    """The keys that a table of this name may have."""
    kinds = {"domain": schema.DOMAIN, "wall": schema.WALL}.get(name)
    if kinds is not None:
        kind = here.get("kind")
        listed = (
            kinds[kind].schema
            if isinstance(kind, str) and kind in kinds
            else {k for s in kinds.values() for k in s.schema}
        )
        return tuple(map(str, listed))
    tables = {"": schema.SCENE, "disk": schema.DISK, "gas": schema.GAS, "disks_file": schema.DISKS_FILE}
    return tuple(map(str, tables[name].schema)) if name in tables else ("pair", "wall")
