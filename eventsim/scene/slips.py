"""Slips of the pen in scene files that are no TOML: which line, what is wrong there, and what would be right.

A line is mended by one rule after the other; what is proposed has been read: the text is TOML then, at least as far as that line.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Iterator
from itertools import islice
from typing import NamedTuple

from eventsim.scene.keyboard import with_plain_signs, without_foreign_blanks
from eventsim.scene.quoting import HEADER, quoted
from eventsim.scene.remedies import (
    COUNTS,
    EXAMPLES,
    LISTS,
    MANY_COMMAS,
    OPEN_COMMA,
    PAIRS,
    TEXTS,
    WHOLES,
    combined,
    meant,
    pointed,
    turned,
    two_ways,
    with_points,
    written,
)

LONGEST = 1 << 20
"""Letters of a file that is read again with a line mended."""

LINES_BEFORE = 3
"""Where an error is noticed, the slip may be so many lines before: a bracket that is not closed."""

WIDEST = 400
"""Letters of a line that is mended."""

PLACE = re.compile(r"(.*) \(at (?:line (\d+), column (\d+)|end of document)\)", re.DOTALL)
VALUE = r"(?<![\w.])"
POWER = r"(?:(\d+(?:\.\d+)?)\s*\*\s*)?10(?:\^|\*\*)([-+]?\d+)"
UNIT = r"(=\s*[-+]?[\d.]+(?:[eE][-+]?\d+)?|\])\s*[A-Za-zµ°][\w/²^*-]*\s*(?=#|$)"
COMPUTED = re.compile(r"=.*(?:\b(?:cos|sin|tan|sqrt|exp|log|math\.\w+|np\.\w+)\b|\d\s*[-+*/^]\s*[(\d]|\d\s*[*/^]|\)\s*[-+*/^])")
"""A value that is to be worked out."""

UNIT_IN_LIST = r"(?<=\d)\s*(?![eE][-+]?\d)[A-Za-zµ°][\w/²^*-]*(?=\s*[,\]])"


POLAR = r"\[\s*([-+]?[\d.]+)\s*[,;]\s*([-+]?[\d.]+)\s*(°|deg(?:rees)?|rad(?:ians)?)\s*\]"
"""A speed and an angle with its unit, in a list."""


class Slip(NamedTuple):
    """What is wrong, and a function of a line and its key that gives it without."""

    why: str
    mend: Callable[[str, str], str]


def _sub(pattern: str, by: str | Callable[[re.Match[str]], str]) -> Callable[[str, str], str]:
    return lambda line, key: re.sub(pattern, by, line)


def _fraction(match: re.Match[str]) -> str:
    one, other = float(match[1]), float(match[3])
    return written(one * other) if match[2] == "*" else written(one / other) if other else match[0]


def _comma(line: str, key: str) -> str:
    head, equals, value = line.partition("=")
    if key in WHOLES:
        return line
    if key in PAIRS and "[" not in value and "(" not in value:
        return line
    listed = re.search(r"\[.*\]", value) if key in COUNTS or key == "points" else None
    if listed is not None:
        right = with_points(key, listed[0])
        return line if right is None else head + equals + value.replace(listed[0], right)
    return head + equals + pointed(value)


def _thousands(line: str, key: str) -> str:
    head, equals, value = line.partition("=")
    marks = r"(?<=\d)[,'](?=\d{3}(?!\d))" if key in WHOLES else r"(?<=\d)'(?=\d{3}(?!\d))"
    return head + equals + MANY_COMMAS.sub(lambda number: number[0].replace(",", ""), re.sub(marks, "", value))


def _semicolon(line: str, key: str) -> str:
    between = r"(?<=[\d\]])\s*;\s*(?=[-+.\d\[])"
    return re.sub(between, ", ", pointed(line)) if re.search(between, line) else line


def _pair(line: str, key: str) -> str:
    number = r"[-+]?[\d.][\d.eE+-]*"
    if key == "gravity" and (match := re.search(r"=\s*-?(\d+,\d+)\s*(?=#|$)", line)):  # one number, with a decimal comma
        return line[: match.start()] + f"= [0.0, -{pointed(match[1])}]" + line[match.end() :]
    if key in PAIRS and (match := re.search(rf"=\s*({number},\d+,\s+{number}(,\d+)?|{number},\s+{number},\d+)\s*(?=#|$)", line)):
        right = with_points(key, f"[{match[1]}]")  # two numbers, with decimal commas
        return line if right is None else line[: match.start()] + f"= {right}" + line[match.end() :]
    return re.sub(rf"(=\s*)({number})\s*[,;x]\s*({number})(?=\s*(#|$))", r"\1[\2, \3]", line) if key in PAIRS else line


def _components(line: str, key: str) -> str:
    if key not in ("velocity", "gravity", "direction"):
        return line
    return re.sub(POLAR, lambda m: written(turned(float(m[1]), float(m[2]), m[3].startswith("rad"))), line)


def _closed(line: str, key: str) -> str:
    code, mark, comment = line.partition("#")
    code = code.rstrip()
    if code.count("[") > code.count("]"):
        return code + "]" * (code.count("[") - code.count("]")) + (f"  {mark}{comment}" if mark else "")
    if code.count("]") == code.count("[") + 1 and "=" in code and "[" in code and key in PAIRS:
        return code.removesuffix("]") + (f"  {mark}{comment}" if mark else "")
    if code.count("]") == code.count("[") + 1 and "=" in code:
        return re.sub(r"=\s*", "= [", line, count=1)
    if code.count("{") > code.count("}"):
        return code + "}"
    return line + '"' if code.count('"') % 2 else line


def _worded(line: str, key: str) -> str:
    if key in TEXTS:
        return re.sub(r"=\s*([A-Za-z][^\"#=]*?)\s*(?=#|$)", r'= "\1"', line)
    return line


def _several(line: str, key: str) -> str:
    """Each key with its value in a line of its own; two that are one key here as that."""
    value = r"\[[^\[\]]*\]|\"[^\"]*\"|[^\s,;=\[\]\"#]+"
    pair = rf"(\w+)\s*=\s*({value})"
    if re.fullmatch(rf"\s*{pair}(?:\s*[,;]\s*|\s+){pair}(?:(?:\s*[,;]\s*|\s+){pair})*\s*[,;]?\s*(#.*)?", line) is None:
        return line
    found = dict(re.findall(pair, line.partition("#")[0]))
    try:
        told = combined({name: tomllib.loads(f"value = {text}")["value"] for name, text in found.items()})
    except ValueError:
        return line
    return told or "\n".join(f"{name} = {text}" for name, text in found.items())


def _header(line: str, key: str) -> str:
    found = re.fullmatch(r"\s*(\w+)\s*\]{1,2}\s*", line)
    return line if found is None else f"[[{found[1]}]]" if found[1] in LISTS else f"[{found[1]}]"


SLIPS = (
    Slip("write the blank of the keyboard, and nothing unseen", lambda line, key: without_foreign_blanks(line)),
    Slip("write the signs of the keyboard, as its minus -", lambda line, key: with_plain_signs(line)),
    Slip("quotation marks are straight", _sub("[“”„‟«»]", '"')),
    Slip("a comment begins with #", _sub(r"\s*(//|%%|--).*$", "")),
    Slip("a line ends without a mark", _sub(r"[;,]\s*$", "")),
    Slip("a scene is no program: leave this line out", _sub(r"^\s*(?:import|from|print|def|for|while|if|return)\b[^=]*$", "")),
    Slip("a line holds one key and one value", _several),
    Slip(
        "tables of a list stand in double brackets",
        _sub(r"^\s*[\[({]{1,2}\s*(" + "|".join(LISTS) + r")\s*[\])}]{0,2}\s*$", r"[[\1]]"),
    ),
    Slip("the name of a table stands in brackets", _header),
    Slip("the name of a table stands in brackets", _sub(r"^\s*\[\s*(\w+)\s*$", r"[\1]")),
    Slip("a key is followed by =", _sub(r"^(\s*\w+)\s*(?::=|==|=>|:)\s*", r"\1 = ")),
    Slip("a key is followed by =", _sub(r"^(\s*\w+)\s+(?=[-+.\d\[\"(])", r"\1 = ")),
    Slip("a key is one word", _sub(r"^(\s*\w+)[ ](\w+)(?=\s*=)", r"\1_\2")),
    Slip("lists stand in square brackets", _sub(r"\(([^()]*)\)", r"[\1]")),
    Slip("lists stand in square brackets", _sub(r"\{([^{}=]*)\}", r"[\1]")),
    Slip("two numbers stand in square brackets", _pair),
    Slip("a number has no marks between thousands", _thousands),
    Slip("a number has a decimal point, not a comma", _comma),
    Slip("a comma stands between two numbers, and a point in each", _semicolon),
    Slip("a comma stands between two numbers", _sub(r"(?<=\d)[ \t]+(?=[-+.]?\d)", ", ")),
    Slip("a comma stands between two points", _sub(r"\]\s*\[(?=[-+.\d])", "], [")),
    Slip("a number has a digit before its point", _sub(VALUE + r"([-+]?)\.(\d)", r"\g<1>0.\2")),
    Slip("a number has a digit after its point", _sub(r"(\d)\.(?![\d])", r"\1.0")),
    Slip("a number begins with no zero", _sub(VALUE + r"0+(\d)", r"\1")),
    Slip("it is a part of 1, not per cent", _sub(r"(\d+(?:\.\d+)?)\s*%", lambda m: written(float(m[1]) / 100.0))),
    Slip("a file does not compute", _sub(VALUE + r"(\d+(?:\.\d+)?)\s*([*/])\s*(\d+(?:\.\d+)?)", _fraction)),
    Slip("a power of ten is written with e", _sub(POWER, lambda m: f"{m[1] or 1}e{m[2]}")),
    Slip("a vector has two components, no length and angle", _components),
    Slip("units are your own: a number stands alone, in the unit of all others", _sub(UNIT, r"\1")),
    Slip("units are your own: a number stands alone, in the unit of all others", _sub(UNIT_IN_LIST, "")),
    Slip("true and false are written small", _sub(r"\b(True|False)\b", lambda m: m[1].lower())),
    Slip("infinity is written inf", _sub(r"\b(?:infinity|Infinity|infinite|Infinite|Inf|INF|oo|math\.inf|np\.inf)\b", "inf")),
    Slip("a text stands in quotation marks", _worded),
    Slip("what is opened is closed", _closed),
)  # fmt: skip
"""In the order in which they are tried; each alone, then all after one another."""


def problem_of(text: str, error: tomllib.TOMLDecodeError) -> str:
    """What is wrong with a text that is no TOML: a sentence, the line, a caret, and the line that would be right."""
    match = PLACE.fullmatch(str(error))
    lines = text.split("\n")
    if match is None or not lines:
        return str(error)
    if text.lstrip().startswith("{"):
        return "this is JSON: let the file's name end in .json"
    line = min(int(match[2]) if match[2] else len(lines), len(lines))
    column = int(match[3]) - 1 if match[2] else len(lines[line - 1])
    if len(text) <= LONGEST:
        if (single := _single_before(lines, line)) is not None:
            right = f"[{lines[single - 1].strip()}]"
            return f"tables of a list stand in double brackets, all of them (at line {single})" + shown(lines, single, right)
        for here in _lines_before(lines, line):
            for why, right in _mended(lines, here):
                if _reads_on(lines, here, right, line):
                    told = f"{why}: {two_ways(lines[here - 1])}" if otherwise(lines[here - 1], right) else why
                    return f"{told} (at line {_alike(lines, here, right)})" + shown(lines, here, right)
        for here in _lines_before(lines, line):
            if HEADER.match(lines[here - 1]) is not None and _reads_on(lines, here, "", line):
                why = "this table was begun before: put its keys there, and leave this line out"
                return f"{why} (at line {here})" + shown(lines, here, "")
    told = "a file does not compute: write the number itself" if COMPUTED.search(lines[line - 1]) else _in_words(match[1])
    key = _key_of(lines[line - 1])
    example = "" if not key or key not in EXAMPLES else EXAMPLES[key]
    return f"{told} (at line {line}, column {column + 1})" + quoted(
        lines[line - 1], column, "", example, f"line {line}", True
    )


WORDS = {
    "Cannot overwrite a value": "this key is there already, in the same table",
    "Invalid value": "this is no value: a number, a text in quotation marks, true or false, or a list in square brackets",
    "Expected newline or end of document after a statement": "a line holds one key and one value, and nothing more",
    "Unclosed array": "a list is not closed",
    "Invalid statement": "this is neither a key with a value, nor a table, nor a comment, which begins with #",
}
"""What the reader of TOML says, and what is meant."""


def _single_before(lines: list[str], line: int) -> int | None:
    """The first line with a table in single brackets, where the text can be read no further since others have double ones."""
    header = HEADER.match(lines[line - 1])
    if header is None or header[1] != "[[":
        return None
    name = header[2]
    found = next((k for k in range(1, line) if lines[k - 1].strip() == f"[{name}]"), None)
    return found if found is not None and _reads_on(lines, found, f"[[{name}]]", line) else None


def _in_words(told: str) -> str:
    return WORDS.get(told, told)


def _lines_before(lines: list[str], line: int) -> list[int]:
    """The line of an error and some that hold anything before it, nearest first."""
    near = (k for k in range(line, 0, -1) if lines[k - 1].strip() and not lines[k - 1].lstrip().startswith("#"))
    return [k for k in islice(near, 1 + LINES_BEFORE) if len(lines[k - 1]) <= WIDEST]


def _key_of(line: str) -> str:
    match = re.match(r"\s*([\w-]+)", line)
    return match[1] if match else ""


def _mended(lines: list[str], number: int) -> Iterator[tuple[str, str]]:
    """What may be wrong with a line, and the line without it."""
    line = lines[number - 1]
    key = meant(_key_of(line))
    for slip in SLIPS:
        if (right := slip.mend(line, key)) != line:
            yield slip.why, right
    right, found = line, list[str]()
    for slip in SLIPS:
        if (mended := slip.mend(right, key)) != right:
            right, found = mended, [*found, slip.why]
    if len(found) > 1:
        yield "; ".join(dict.fromkeys(found)), right
    header = next((HEADER.match(before) for before in reversed(lines[: number - 1]) if HEADER.match(before)), None)
    if header is not None and header[2] in LISTS and "=" in line:
        yield f"this table has {key} already; another one begins with its name", f"[[{header[2]}]]\n{line}"


def _alike(lines: list[str], number: int, right: str) -> str:
    """The number of a line, and of those before it that are as wrong, where all tables of a name are."""
    same = [k for k, line in enumerate(lines, 1) if line.strip() == lines[number - 1].strip()] if _is_list(right) else []
    return ", ".join(map(str, same)) if len(same) > 1 else str(number)


def _is_list(right: str) -> bool:
    return right in (f"[[{name}]]" for name in LISTS)


def _reads_on(lines: list[str], number: int, right: str, last: int) -> bool:
    """Whether a text can be read, or at least beyond line `last`, once line `number` is right."""
    text = "\n".join([*lines[: number - 1], right, *lines[number:]])
    if _is_list(right):  # all of that name
        text = re.sub(rf"(?m)^\s*\[{right.strip('[]')}\]\s*$", right, text)
    try:
        tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        match = PLACE.fullmatch(str(error))
        return match is not None and match[2] is not None and int(match[2]) > last + right.count("\n")
    except (ValueError, RecursionError):
        return False
    return True


def shown(lines: list[str], number: int, right: str) -> str:
    """A line, a caret where it departs from what is right, and that."""
    line = lines[number - 1].rstrip()
    same = next((k for k, (a, b) in enumerate(zip(line, right, strict=False)) if a != b), min(len(line), len(right)))
    column = same if "\n" not in right else 0
    return quoted(line, column, "", right, f"line {number}", other=otherwise(line, right))


def otherwise(line: str, right: str) -> str:
    """What is right if commas of a line part thousands; empty where what is right has no point in their place."""
    other = right
    for found in OPEN_COMMA.finditer(line):
        other = other.replace(f"{found[1]}.{found[2]}", f"{found[1]}{found[2]}")
    return other if other != right else ""
