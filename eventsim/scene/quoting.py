"""Where in the text of a scene file a key stands, and how a message quotes it: line, caret, and the line that would be right."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from typing import Any, NamedTuple

from eventsim.errors import SceneError
from eventsim.scene import schema
from eventsim.scene.remedies import Remedy, example_of, remedy

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


class Place(NamedTuple):
    """A line, counted from 1, the column of a key in it, from 0, and that of its value."""

    line: int
    key: int
    value: int


def quoted(line: str, column: int, why: str, write: str, label: str = "", example: bool = False) -> str:
    """The lines that follow the sentence of a problem.

    Args:
        line: what was written.
        column: where the caret points to, from 0.
        why: what is wrong there; may be empty.
        write: what would be right, one or more lines; empty: nothing.
        label: what the line is called, as in "line 3".
        example: whether `write` only shows the form.
    """
    if len(line) > WIDEST:
        first = min(max(column - WIDEST // 2, 0), len(line) - WIDEST)
        line, column = line[first : first + WIDEST], column - first
    inset = len(line) - len(line.lstrip())
    width = max(len(label), len("write")) + 2
    shown = [f"{label}:".ljust(width) + line.strip(), (" " * (width + column - inset) + f"^ {why}").rstrip()]
    for number, right in enumerate(write.splitlines() if len(write) <= WIDEST else ()):
        shown.append(("" if number else "as in:" if example else "write:").ljust(width) + right.strip())
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


def with_lines(error: SceneError, text: str, data: Mapping[str, Any], settings: Collection[str] = ()) -> SceneError:
    """The same problems, those with keys of a TOML text followed by their line, a caret and a line that would be right.

    Args:
        error: its problems begin with the path of a key, as in "disk[2].radius".
        text: of the file.
        data: its tables.
        settings: "key=value" as typed after --set; what they changed stands in no line.
    """
    if len(text) > LONGEST:
        return error
    places, lines = places_in(text), text.split("\n")
    typed = {re.sub(r"\.(\d+)", r"[\1]", setting.partition("=")[0].strip()): setting for setting in settings}
    return SceneError(_with_quotes(problem, list(_quotes(problem, places, lines, data, typed))) for problem in error.problems)


def _with_quotes(problem: str, quotes: list[str]) -> str:
    """A problem with its quoted lines; what these propose is not guessed as well."""
    told = "".join(quotes)
    if "\n    write:" in told or "\n    as in:" in told:
        problem = GUESS.sub(lambda guess: guess[0] if guess[1] and guess[1] in told else "unknown key", problem)
    return problem + told


def _quotes(
    problem: str, places: Mapping[str, Place], lines: list[str], data: Mapping[str, Any], typed: Mapping[str, str]
) -> Iterator[str]:
    """What follows the sentence of one problem: nothing, or its quoted lines."""
    match = PATH.match(problem) or CHOICE.match(problem)
    if match is None:
        return
    table, key = match["table"], match["key"]
    path = f"{table}.{key}" if key else table
    if path in typed:
        setting = typed[path]
        name, _, value = setting.partition("=")
        told = _remedy(table, key, {**_table(data, table), (key or table): _read(value)})
        write = told.write.replace(f"{key or table} = ", f"{name}=")
        yield quoted(setting, len(name) + 1, told.why, write, "typed", told.example)
        return
    missing = problem[match.start() :].partition(" is missing")[1] and path not in places
    here = _table(data, table) if missing else {}
    for other in here:  # it may be there under another name
        told = _remedy(table, other, here)
        if key and told.write.startswith(f"{key} = ") and f"{table}.{other}" in places:
            named = places[f"{table}.{other}"]
            yield quoted(lines[named.line - 1], named.key, told.why, told.write, f"line {named.line}", told.example)
            return
    place = places.get(path) or places.get(table) or places.get(f"{table}[0]") or places.get(table.partition("[")[0])
    if place is None:
        return
    if missing or "needs" in problem.split(":")[1][:8]:
        lacks = f"this table lacks {key}" if key else ""
        example = example_of(table.partition("[")[0], key or "")
        yield quoted(lines[place.line - 1], place.key, lacks, example, f"line {place.line}", True)
        return
    told = _remedy(table, key, _table(data, table) if key else data)
    unknown = "unknown key" in problem
    header = places.get(table) if key else None
    write = told.write
    if unknown and "above the first table" in told.why and header is not None:
        first = min(place.line for place in places.values() if HEADER.match(lines[place.line - 1]))
        write = f"{write}\n{lines[first - 1].strip()}"
    column = place.key if unknown else place.value
    if _bare(write) == _bare(lines[place.line - 1]):  # what was written is of the right form
        write = ""
    yield quoted(lines[place.line - 1], column, told.why, write, f"line {place.line}", told.example)


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
