"""Packets: what the server tells a page. A packet is the length of a header (4 bytes), the header in JSON, and columns."""

from __future__ import annotations

import json
import struct
from collections.abc import Sequence
from typing import Any

from eventsim.record.events import Rows
from eventsim.show.player.pack import PackedColumn, column_bytes, described_columns, row_columns


def packet(kind: str, columns: Sequence[PackedColumn] = (), **header: Any) -> bytes:
    """Return a packet of a kind with the fields of its header and with columns of numbers."""
    told = {"type": kind, **header, "columns": described_columns(columns)}
    text = json.dumps(told, allow_nan=False).encode()
    return struct.pack("<I", len(text)) + text + column_bytes(columns)


def rows_packet(track: int, rows: Rows, horizon: float, ended: str | None) -> bytes:
    """Return rows of a track, and the time until which they are all.

    track: 0 the event-driven engine, whose rows the page flies disks between; 1 another one, which tells their places, too:
    its disks do not fly free. ended: why there are no more, None while there are.
    """
    columns = [*row_columns(rows), ("impulse", "f8", rows["impulse"])]
    if track:
        columns += [(name, "f8", rows[name]) for name in ("xa", "ya", "xb", "yb")]
    return packet("rows", columns, track=track, horizon=horizon, ended=ended)
