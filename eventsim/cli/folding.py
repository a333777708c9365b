"""Folding: long lines broken so that they fit a terminal."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import groupby
from textwrap import fill

WIDTH = 80
"""Columns of a terminal: what is printed for people fits them; names and numbers that are longer stay whole."""

LAST_COLUMN = 60
"""Text that begins behind it has too little room to go on below."""

COLUMN = re.compile(r"(?<=[^ .;:]) {2,}(?=\S)")
"""What parts columns; two blanks behind a full stop part sentences."""


def tables(head: Sequence[str], rows: Sequence[Sequence[str]]) -> Iterator[str]:
    """The lines of a table; columns that do not fit beside each other stand below, with the first column again."""
    widths = [max(len(line[k]) for line in (head, *rows)) for k in range(len(head))]
    begun = 1
    while begun < len(head):
        columns = [0, begun]
        while columns[-1] + 1 < len(head) and sum(widths[k] + 2 for k in (*columns, columns[-1] + 1)) - 2 <= WIDTH:
            columns.append(columns[-1] + 1)
        if begun > 1:
            yield ""
        for row in (head, *rows):
            yield "  ".join(row[k].ljust(widths[k]) for k in columns).rstrip()
        begun = columns[-1] + 1


def folded(text: str) -> str:
    """Return a text whose lines fit a terminal: the rest of a long one goes on below its last column."""
    return "\n".join(_folded(line) for line in text.split("\n"))


def _folded(line: str) -> str:
    if len(line) <= WIDTH:
        return line
    indent = len(line) - len(line.lstrip(" "))
    columns = [gap.end() for gap in COLUMN.finditer(line, indent) if gap.end() <= LAST_COLUMN]
    below = columns[-1] if columns else indent + 2
    return fill(
        line,
        WIDTH,
        subsequent_indent=" " * below,
        break_long_words=False,
        break_on_hyphens=False,
        replace_whitespace=False,
    )


def reflowed(text: str) -> str:
    """Return a text whose paragraphs, lines of one indent, are broken anew to fit a terminal."""
    found = []
    for (empty, indent), lines in groupby(text.split("\n"), lambda line: (not line.strip(), len(line) - len(line.lstrip(" ")))):
        words, left = " ".join(line.strip() for line in lines), " " * indent
        broken = fill(words, WIDTH, initial_indent=left, subsequent_indent=left, break_long_words=False, break_on_hyphens=False)
        found.append("" if empty else broken)
    return "\n".join(found)
