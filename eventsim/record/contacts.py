"""Which rows of a log are contacts, and who meets whom in them."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np

from eventsim.record.events import Kind, Rows

Key: TypeAlias = tuple[int, int, int]
"""(kind, a, b or wall)."""


def contacts_of(rows: Rows) -> Rows:
    """The rows that are contacts, in their order: the beginning of rest, and kicks, are none."""
    contacts: Rows = rows[(rows["kind"] == Kind.PAIR) | (rows["kind"] == Kind.WALL)]
    return contacts


def keys_of(rows: Rows) -> list[Key]:
    """Who meets whom, row by row."""
    other = np.where(rows["kind"] == Kind.PAIR, rows["b"], rows["wall"])
    return list(zip(rows["kind"].tolist(), rows["a"].tolist(), other.tolist(), strict=True))
