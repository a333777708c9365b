"""Slips of the pen in scene files that are no JSON: which line, what is wrong there, and what would be right.

The whole text is mended by one rule after the other; what is proposed has been read: the text is JSON then, at least beyond
that line.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from itertools import zip_longest
from typing import NamedTuple

from eventsim.scene.keyboard import plain
from eventsim.scene.quoting import quoted
from eventsim.scene.remedies import two_ways
from eventsim.scene.slips import otherwise, shown

LONGEST = 1 << 20
"""Letters of a file that is read again with a rule applied."""

TEXT = r'"(?:[^"\\\n]|\\.)*"'


class Slip(NamedTuple):
    """What is wrong, and a function of a text that gives it without."""

    why: str
    mend: Callable[[str], str]


def _outside(pattern: str, by: str | Callable[[re.Match[str]], str]) -> Callable[[str], str]:
    """Replace a pattern where it stands in no text."""

    def one(found: re.Match[str]) -> str:
        if found[0].startswith('"'):
            return found[0]
        return found.expand(by) if isinstance(by, str) else by(found)

    return lambda text: re.sub(f"{TEXT}|{pattern}", one, text)


SLIPS = (
    Slip("texts and keys stand in double quotation marks", _outside(r"'([^'\"\n]*)'", r'"\1"')),
    Slip("quotation marks are straight", lambda text: re.sub("[“”„‟«»]", '"', text)),
    Slip("JSON has no comments", _outside(r"[ \t]*(?://|#).*", "")),
    Slip("nothing follows a last comma: leave it out", _outside(r",(\s*[\]}])", r"\1")),
    Slip("a comma stands between two", _outside(r"((?<=[\]}\"\d])|(?<=\btrue)|(?<=\bfalse))(\s*\n\s*)(?=[\[{\"])", r",\2")),
    Slip("a key stands in double quotation marks", _outside(r"([{,]\s*)([A-Za-z_]\w*)(?=\s*:)", r'\1"\2"')),
    Slip("a key is followed by :", _outside(r"\s*=\s*", ": ")),
    Slip("a number has a decimal point, not a comma", _outside(r"(:\s*-?\d+),(\d+)(?=\s*[,}\n])", r"\1.\2")),
    Slip("true and false are written small", _outside(r"\b(True|False)\b", lambda word: word[1].lower())),
    Slip('infinity is written "inf", in quotation marks', _outside(r"\b(?:inf|infinity|infinite|Inf)\b", '"inf"')),
    Slip("lists stand in square brackets", _outside(r"\(([^()]*)\)", r"[\1]")),
    Slip("a number has a digit before its point", _outside(r"(?<![\d.])\.(?=\d)", "0.")),
    Slip("a number has a digit after its point", _outside(r"(?<=\d)\.(?!\d)", ".0")),
    Slip("it has other blanks and signs than those of a keyboard, or some that nobody sees", plain),
)  # fmt: skip
"""In the order in which they are tried; each alone, then all after one another."""

WORDS = {
    "Expecting property name enclosed in double quotes": "a key in double quotation marks is wanted here",
    "Expecting value": 'a value is wanted here: a number, a text in double quotation marks, true, false, a list [] or a table {}',
    "Expecting ',' delimiter": "here a comma is wanted, or what closes the list or the table",
    "Expecting ':' delimiter": "a key is followed by :",
    "Extra data": "one pair of {} holds the whole scene: this is behind it",
    "Illegal trailing comma before end of object": "nothing follows a last comma: leave it out",
    "Illegal trailing comma before end of array": "nothing follows a last comma: leave it out",
    "Unterminated string starting at": "a text is not closed by a quotation mark",
    "Invalid control character at": "a text ends in its line",
}
"""What the reader of JSON says, and what is meant."""


def problem_of(text: str, error: json.JSONDecodeError) -> str:
    """What is wrong with a text that is no JSON: a sentence, the line, a caret, and the line that would be right."""
    if is_toml(text):
        return "this is TOML: let the file's name end in .toml"
    if len(text) <= LONGEST:
        for why, right in _mended(text):
            if not _reads_on(right, error.lineno):
                continue
            lines, mended = text.split("\n"), right.split("\n")
            pairs = enumerate(zip_longest(lines, mended, fillvalue=""), 1)
            number, line, new = next((k, one, other) for k, (one, other) in pairs if one != other)
            ways = f": {two_ways(line)}" if otherwise(line, new) else ""
            return f"{why}{ways} (at line {number})" + shown([*lines, ""], number, new)
    line = text.split("\n")[error.lineno - 1]
    told = f"{WORDS.get(error.msg, error.msg)} (at line {error.lineno}, column {error.colno})"
    return told + quoted(line, error.colno - 1, "", "", f"line {error.lineno}")


def is_toml(text: str) -> bool:
    """Whether a text begins as a scene in TOML does: with a table, or a key, or comments before these."""
    bare = re.sub(r"\A(?:\s*#[^\n]*\n|\s+)*", "", text)
    return re.match(r"\[\[?[A-Za-z]\w*\]|[A-Za-z]\w*\s*=", bare) is not None


def _mended(text: str) -> Iterator[tuple[str, str]]:
    """What may be wrong with a text, and the text without it."""
    for slip in SLIPS:
        if (right := slip.mend(text)) != text:
            yield slip.why, right
    right, found = text, list[str]()
    for slip in SLIPS:
        if (mended := slip.mend(right)) != right:
            right, found = mended, [*found, slip.why]
            yield "; ".join(found), right


def _reads_on(text: str, last: int) -> bool:
    """Whether a text can be read, or at least beyond line `last`."""
    try:
        json.loads(text)
    except json.JSONDecodeError as error:
        return error.lineno > last
    except (ValueError, RecursionError):
        return False
    return True
