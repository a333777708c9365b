"""Cliffs: rates of scenes with many of something beside the same with few of it; in turn, medians, ratios within the run.

    python -m tests.benchmarks.cliffs [--pairs sinai stadium segments corner] [--csv FILE]

sinai, stadium: 10000 points beside one, the log kept.  segments: disks among 10000 short segments beside four.  corner: 100000
disks in one corner of a box with sides 20 times as long as theirs, beside a box that they fill.  Rates count all contacts, per
second of processor time.
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable
from time import process_time

import numpy as np

import eventsim as es
from eventsim.engines.base import Stop
from eventsim.engines.fast.session import FastSession
from eventsim.scene.stage import stage_of
from tests.benchmarks.breadth import in_box
from tests.benchmarks.rates import lattice_gas
from tests.benchmarks.table import Table, arguments, whole

COLUMNS = ("pair", "contacts", "many", "few", "ratio", "crossings_many", "crossings_few")
BUDGET = 1 << 20


def sinai(points: int) -> es.Scene:
    """Points of mass 0 around a post in a unit torus."""
    rng = np.random.default_rng(1)
    place = rng.uniform(0.0, 1.0, (2 * points + 20, 2))
    place = place[np.hypot(*(place - 0.5).T) > 0.26][:points]
    angle = rng.uniform(0.0, 2.0 * math.pi, points)
    disks = es.Disks(
        np.vstack([[[0.5, 0.5]], place]),
        np.vstack([[[0.0, 0.0]], np.stack([np.cos(angle), np.sin(angle)], axis=1)]),
        np.append(0.25, np.zeros(points)),
        np.append(math.inf, np.zeros(points)),
    )
    return es.Scene(disks, es.Periodic((1.0, 1.0)))


def stadium(points: int) -> es.Scene:
    """Points of mass 0 in the stadium of the gallery."""
    rng = np.random.default_rng(1)
    angle = rng.uniform(0.0, 2.0 * math.pi, points)
    velocity = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    disks = es.Disks(rng.uniform(-0.8, 0.8, (points, 2)), velocity, 0.0, 0.0)
    return es.Scene(disks, es.Open(), walls=es.gallery("stadium").walls)


def segments(number: int) -> es.Scene:
    """1000 small disks in a box with so many short segments, spread evenly."""
    rng, side, count = np.random.default_rng(1), 100.0, round(math.sqrt(number))
    row, column = np.divmod(np.arange(number), count)
    middle = (np.stack([column, row], axis=1) + 0.5) * (side / count)
    angle = rng.uniform(0.0, math.pi, number)
    half = 0.3 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    row, column = np.divmod(rng.permutation(98 * 98)[:1000], 98)
    disks = es.Disks(np.stack([column, row], axis=1) + 1.0, rng.normal(size=(1000, 2)), 0.05)
    walls = [es.Segment(m - h, m + h) for m, h in zip(middle, half, strict=True)]
    return es.Scene(disks, es.Box((side, side)), walls=walls)


def corner(times: int) -> es.Scene:
    """100000 disks in the corner of a box whose sides are so many times as long as what they fill."""
    gas = in_box(lattice_gas(100_000, 0.4))
    width, height = gas.domain.size
    return es.Scene(gas.disks, es.Box((times * width, times * height)))


PAIRS: dict[str, tuple[Callable[[int], es.Scene], int, int, bool, int]] = {
    "sinai": (sinai, 10_000, 1, True, 300_000),
    "stadium": (stadium, 10_000, 1, True, 300_000),
    "segments": (segments, 10_000, 4, False, 50_000),
    "corner": (corner, 20, 1, False, 300_000),
}
"""The scene, how many and how few of it, whether a log is kept, contacts of a turn."""


def rate(session: FastSession, contacts: int) -> float:
    began = process_time()
    stop = Stop(events=session.counters.events + contacts)
    while session.advance(stop, BUDGET) is None:
        session.take_rows()
    session.take_rows()
    return contacts / (process_time() - began)


def measure(name: str, repeats: int, share: float) -> dict[str, object]:
    """A row of the table."""
    scene, many, few, log, contacts = PAIRS[name]
    sessions = [FastSession(stage_of(scene(number)), keep_rows=log) for number in (many, few)]
    contacts = max(1000, int(share * contacts))
    for session in sessions:
        rate(session, contacts)
    rates = [[rate(session, contacts) for session in sessions] for _ in range(repeats)]
    counted = [session.counters for session in sessions]
    return {
        "pair": name,
        "contacts": contacts,
        "many": round(statistics.median(one for one, _ in rates)),
        "few": round(statistics.median(other for _, other in rates)),
        "ratio": round(statistics.median(one / other for one, other in rates), 3),
        "crossings_many": round(counted[0].crossings / counted[0].events, 2),
        "crossings_few": round(counted[1].crossings / counted[1].events, 2),
    }


def main() -> None:
    parser = arguments(__doc__)
    parser.add_argument("--pairs", nargs="+", choices=list(PAIRS), default=list(PAIRS))
    parser.add_argument("--share", type=float, default=1.0, help="of the contacts of a turn")
    parser.add_argument("--repeats", type=whole, default=5)
    chosen = parser.parse_args()
    table = Table(COLUMNS)
    for name in chosen.pairs:
        table.add(measure(name, chosen.repeats, chosen.share))
    table.write(chosen.csv)


if __name__ == "__main__":
    main()
