"""Packing: a scene and its log as a description in JSON and one string of numbers, as the player reads them.

The numbers are little-endian columns, one after the other, in base64. Positions are relative to the corner of the domain,
lines on the scene's axes. Rows have no positions: the player flies each disk from row to row, which is exact to some ulp.
"""

from __future__ import annotations

import base64
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any, TypeAlias

import numpy as np
from matplotlib.colors import to_hex

from eventsim.engines import engine_named
from eventsim.errors import EventsimError
from eventsim.measure.trust import UNASKED, TrustLine
from eventsim.record.events import SPINS, Column, Rows, has_spins, joined
from eventsim.record.provenance import has_spin
from eventsim.replay.any_log import LogInMemory
from eventsim.replay.log import AnyLog, EventLog
from eventsim.replay.motion import Motion
from eventsim.replay.replay import Replay
from eventsim.scene.stage import Stage
from eventsim.show import outlines
from eventsim.show.colouring import (
    DARK_ENOUGH,
    FEW,
    amounts,
    default_mode,
    mode_named,
    species_labels,
    species_of,
)
from eventsim.show.frames import shown_span
from eventsim.show.images import lines_with_images
from eventsim.show.overview import overview_of
from eventsim.show.palette import DARK, KINDS, LIGHT
from eventsim.show.window import window_of

SECONDS = 10.0
"""How long a log plays at the speed that the player begins with."""

MOST_PLAYED = 2_000_000
"""Events on a page (150 MB): browsers hold no more."""

SHADES = 64
"""Colours on the scale of amounts: more cannot be told apart, and fewer are drawn faster."""

ROW_COLUMNS = (
    ("epoch", "f8"), ("remainder", "f8"), ("vxa", "f8"), ("vya", "f8"), ("vxb", "f8"), ("vyb", "f8"),
    ("a", "i4"), ("b", "i4"), ("wall", "i4"), ("kind", "i1"),
)  # fmt: skip

PackedColumn: TypeAlias = tuple[str, str, Column]
"""Name, type and numbers of a column."""


def packed(log: AnyLog, color: str | None = None, seconds: float | None = None) -> tuple[dict[str, Any], str]:
    """Return the description of a log for the player, and its numbers in base64.

    seconds: how long it plays at the speed that it begins with. Raises EventsimError where the log has no time to
    play, or more events than a page can hold, or the colouring does not exist.
    """
    if len(log) > MOST_PLAYED:
        raise EventsimError(
            f"a page plays at most {MOST_PLAYED:,} events and this log has {len(log):,}: write an .mp4 or .gif"
        )
    replay = Replay(EventLog(log.provenance, joined(list(log.blocks()), has_spin(log.scene))))
    first, last = shown_span(replay.span, None, None)
    columns = [*start_columns(replay), *row_columns(replay.full.rows)]
    description = {
        "startTime": first,
        "duration": last - first,
        "trusted": trusted(replay.full),
        "seconds": seconds or SECONDS,
        "colour": mode_named(color) or default_mode(log.scene.disks),
        "columns": described_columns(columns),
        "scene": scene_description(replay.stage),
        "stage": stage_description(replay, last),
    }
    return description, base64.b64encode(column_bytes(columns)).decode("ascii")


def trusted(log: LogInMemory) -> dict[str, float] | None:
    """Return the event, and its time, from which on places are beyond the digits; None where that is not known to come."""
    if not engine_named(log.provenance.engine).replays:
        return None
    line = TrustLine(log.scene, UNASKED)
    line.write(log.rows[: UNASKED + 1])
    found = line.found()
    return None if found.event is None or found.time is None else {"event": found.event, "time": found.time}


def start_columns(motion: Motion) -> list[PackedColumn]:
    """Return the disks at the start."""
    stage, disks = motion.stage, motion.log.scene.disks
    start = {
        "x": stage.x,
        "y": stage.y,
        "vx": stage.vx,
        "vy": stage.vy,
        "radius": disks.radius,
        "mass": disks.mass,
    }
    columns: list[PackedColumn] = [(name, "f8", column) for name, column in start.items()]
    columns.append(("species", "i4", species_of(disks)[0]))
    return columns if stage.spin is None else [*columns, ("spin", "f8", stage.spin)]


def row_columns(rows: Rows) -> list[PackedColumn]:
    """Return what the player needs of rows."""
    turning = SPINS if has_spins(rows) else ()
    return [(name, kind, rows[name]) for name, kind in (*ROW_COLUMNS, *((name, "f8") for name in turning))]


def described_columns(columns: Sequence[PackedColumn]) -> list[dict[str, Any]]:
    """Return how columns lie one after the other in `column_bytes`."""
    return [{"name": name, "type": kind, "length": len(column)} for name, kind, column in columns]


def column_bytes(columns: Sequence[PackedColumn]) -> bytes:
    """Return the numbers of columns, little-endian."""
    return b"".join(column.astype(f"<{kind}").tobytes() for _, kind, column in columns)


def scene_description(stage: Stage) -> dict[str, Any]:
    """Return what the player's world needs to know besides the disks."""
    return {
        "count": stage.n,
        "epochLength": stage.epoch_length,
        "period": stage.period,
        "gravity": stage.gravity,
        "wallNames": stage.wall_names,
        "slopes": None if stage.supports is None else stage.slopes.tolist(),
    }


def stage_description(replay: Replay, last: float) -> dict[str, Any]:
    """Return what the player's drawing needs to know besides the disks; last: a time that the log covers."""
    scene, stage = replay.log.scene, replay.stage
    overview = overview_of(replay.log)
    masses = scene.disks.mass[np.isfinite(scene.disks.mass)]
    hard, open_ = outlines.boundary_lines(scene)
    lines = {"walls": lines_with_images(outlines.wall_lines(scene), scene), "hard": hard, "open": open_}
    shades = amounts()(np.linspace(0.0, 1.0, SHADES))
    return {
        "shown": window_of(replay, last),
        "corner": stage.corner,
        "size": scene.domain.size,
        "period": stage.period,
        **{name: [line.tolist() for line in of_kind] for name, of_kind in lines.items()},
        "usualRadius": float(np.median(scene.disks.radius)),
        "fastest": overview.usual,
        "speciesNames": [name for name, _ in species_labels(scene.disks)],
        "masses": [float(masses.min()), float(masses.max())] if len(masses) else [1.0, 1.0],
        "kinds": KINDS,
        "few": FEW,
        "darkEnough": DARK_ENOUGH,
        "own": "species" if default_mode(scene.disks) == "species" else "index",
        "amounts": [to_hex(shade) for shade in shades],
        "palettes": {"light": asdict(LIGHT), "dark": asdict(DARK)},
    }
