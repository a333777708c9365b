"""Small logs for the tests of the record: drawn, or written by hand."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from eventsim.record import Ending, Kind, Provenance
from eventsim.record.events import Rows, blank_rows
from eventsim.replay.log import EventLog
from eventsim.scene import Box, Disks, Scene

FLOATS = ("time", "xa", "ya", "vxa", "vya", "impulse")
FLOATS_B = ("xb", "yb", "vxb", "vyb")
EXTREMES = (0.0, -0.0, 5e-324, -5e-324, 2.2250738585072014e-308, 1e308, -1.7976931348623157e308, 0.1, 1 / 3)


def scene(count: int = 4) -> Scene:
    """Resting disks in a row."""
    return Scene(Disks([(2.0 + 3.0 * i, 1.5) for i in range(count)], radius=1.0), Box((3.0 * count + 1.0, 3.0)))


def provenance(of: Scene | None = None, **changes: object) -> Provenance:
    """The provenance of a log of that scene."""
    given: dict[str, object] = {
        "scene": scene() if of is None else of,
        "engine": "reference",
        "version": "0.0",
        "epoch_length": 1.0,
        "wall_names": ("left", "right", "bottom", "top"),
        "ending": Ending(3, 0.25, "until"),
    }
    return Provenance(**(given | changes))  # type: ignore[arg-type]


def random_rows(count: int, seed: int = 1, disks: int = 4) -> Rows:
    """Rows that fit `provenance()`: kinds mixed, numbers of any size, some of them extreme."""
    rng = np.random.default_rng(seed)
    rows = blank_rows(count)
    rows["event"] = np.arange(count)
    rows["kind"] = rng.integers(0, 4, count)
    rows["a"] = rng.integers(0, disks - 1, count)
    rows["epoch"] = np.sort(rng.integers(0, 100, count))
    rows["remainder"] = rng.random(count)
    pair, wall = rows["kind"] == Kind.PAIR, np.isin(rows["kind"], (Kind.WALL, Kind.REST))
    rows["b"][pair] = disks - 1
    rows["wall"][wall] = rng.integers(0, 4, int(wall.sum()))
    for name in (*FLOATS, *FLOATS_B):
        numbers = rng.standard_normal(count) * 10.0 ** rng.integers(-300, 300, count)
        extreme = rng.random(count) < 0.2
        numbers[extreme] = rng.choice(EXTREMES, int(extreme.sum()))
        rows[name] = numbers if name in FLOATS else np.where(pair, numbers, np.nan)
    return rows


def random_log(count: int, seed: int = 1) -> EventLog:
    """A log of random rows; its kicks are in the provenance, as in a log that an engine gives."""
    from eventsim.record.provenance import kicks_of

    rows = random_rows(count, seed)
    return EventLog(provenance(rows=count, kicks=tuple(kicks_of(rows))), rows)


any_float = st.one_of(st.sampled_from(EXTREMES), st.floats(allow_nan=False, allow_infinity=False, width=64))
