"""Tables for notebooks: what objects show of themselves there."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

MOST_ROWS = 12
"""Rows that are shown; of more, the first ones and the last."""


def html_table(title: str, names: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """An HTML table.

    Args:
        title: above it.
        names: of the columns; none: no line of them.
        rows: the cells, numbers in six digits.
    """
    head = "".join(f"<th>{escape(name)}</th>" for name in names)
    body = "".join("<tr>" + "".join(f"<td>{escape(_cell(value))}</td>" for value in row) + "</tr>" for row in rows)
    return f"<table><caption>{escape(title)}</caption>" + (f"<tr>{head}</tr>" if names else "") + f"{body}</table>"


def few(count: int) -> list[int]:
    """The numbers of the rows that are shown of so many, -1 for those in between."""
    if count <= MOST_ROWS:
        return list(range(count))
    half = MOST_ROWS // 2
    return [*range(half), -1, *range(count - half, count)]


def _cell(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
