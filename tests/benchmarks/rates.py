"""Rates side by side: fast, reference, yardstick where one is given, PyPI's `billiards` and pymunk where they are installed;
repeats in turn, medians of CPU time, ratios in one run.

    python -m tests.benchmarks.rates [--n 1000 10000] [--eta 0.2 0.5 0.7] [--yardstick FOLDER] [--alone] [--csv FILE]

The gas: equal disks of diameter 1 from a triangular lattice with Maxwell velocities, in a periodic box.  Up to 1000 disks a
second one, that of `peers` between hard walls, is for those two, with the fast engine beside them; pymunk's contacts are those
that the gas has in the time that it simulates.  The reference engine is left out above 1e5 disks, where it would take minutes
to begin.  The yardstick is a folder with a module `yardstick` that has `System(n, eta)` with `advance(contacts)`.
"""

from __future__ import annotations

import importlib
import math
import statistics
import sys
from collections.abc import Callable
from importlib.util import find_spec
from time import process_time

import numpy as np

import eventsim as es
from eventsim.engines import ENGINES
from eventsim.engines.base import Stop
from eventsim.scene.stage import stage_of
from tests.benchmarks import peers
from tests.benchmarks.table import Table, arguments, whole

COLUMNS = (
    "n",
    "eta",
    "domain",
    "engine",
    "log",
    "contacts",
    "rate_median",
    "rate_min",
    "rate_max",
    "of_fast",
    "of_yardstick",
    "bytes_per_disk",
)
BUDGET = 1 << 20
MOST_FOR_REFERENCE, MOST_FOR_PEERS = 100_000, 1000
Advance = Callable[[int], object]
"""Advance by so many contacts."""


def lattice_gas(n: int, eta: float, seed: int = 1) -> es.Scene:
    """About n disks: whole rows, an even number of them."""
    rows = 2 * max(1, round(math.sqrt(n * 2 / math.sqrt(3)) / 2))
    columns = max(1, round(n / rows))
    spacing = math.sqrt(math.pi / (2 * math.sqrt(3)) / eta)
    row, column = np.divmod(np.arange(rows * columns), columns)
    position = np.stack([(column + 0.25 + 0.5 * (row % 2)) * spacing, (row + 0.5) * spacing * math.sqrt(3) / 2], axis=1)
    velocity = np.random.default_rng(seed).normal(size=position.shape)
    velocity -= velocity.mean(axis=0)
    size = (columns * spacing, rows * spacing * math.sqrt(3) / 2)
    return es.Scene(disks=es.Disks(position, velocity, radius=0.5), domain=es.Periodic(size))


def engine_advance(name: str, scene: es.Scene, log: bool) -> Advance:
    """How to advance a session of an engine."""
    session = ENGINES[name].open(stage_of(scene), keep_rows=log)

    def advance(contacts: int) -> None:
        stop = Stop(events=session.counters.events + contacts)
        while session.advance(stop, BUDGET) is None:
            session.take_rows()
        session.take_rows()

    return advance


def timed(advance: Advance, contacts: int) -> float:
    """The CPU time of so many contacts: on a busy machine the elapsed time says how busy it is."""
    began = process_time()
    advance(contacts)
    return process_time() - began


def bytes_per_disk(scene: es.Scene) -> int:
    """The memory of the fast engine's arrays."""
    from eventsim.engines.fast.session import FastSession

    return FastSession(stage_of(scene), keep_rows=False).memory // len(scene.disks)


def measure(
    n: int, eta: float, contacts: int, repeats: int, folder: str | None, warm_up: float, alone: bool
) -> list[dict[str, object]]:
    """The rows of the table for one gas."""
    scene = lattice_gas(n, eta)
    engines: dict[tuple[str, bool], Advance] = {
        ("fast", False): engine_advance("fast", scene, False),
        ("fast", True): engine_advance("fast", scene, True),
    }
    share = dict.fromkeys(engines, 1.0)
    if n <= MOST_FOR_REFERENCE and not alone:
        engines["reference", False] = engine_advance("reference", scene, False)
        share["reference", False] = 0.01
    if folder is not None:
        sys.path.insert(0, folder)
        engines["yardstick", False] = importlib.import_module("yardstick").System(n, eta).advance
        share["yardstick", False] = 1.0
    rates: dict[tuple[str, bool], list[float]] = {key: [] for key in engines}
    for key, advance in engines.items():
        advance(int(share[key] * warm_up * n) + 1)
    for _ in range(repeats):
        for key, advance in engines.items():
            part = max(1, int(share[key] * contacts))
            rates[key].append(part / timed(advance, part))
    middle = {key: statistics.median(found) for key, found in rates.items()}
    return [
        {
            "n": len(scene.disks),
            "eta": eta,
            "domain": "periodic",
            "engine": key[0],
            "log": "on" if key[1] else "off",
            "contacts": max(1, int(share[key] * contacts)),
            **spread(found),
            "of_fast": round(middle[key] / middle["fast", False], 6),
            "of_yardstick": round(middle[key] / middle["yardstick", False], 3) if folder is not None else "",
            "bytes_per_disk": bytes_per_disk(scene) if key == ("fast", False) else "",
        }
        for key, found in rates.items()
    ]


def spread(found: list[float]) -> dict[str, object]:
    """The columns of the rates that were found."""
    return {
        "rate_median": round(statistics.median(found)),
        "rate_min": round(min(found)),
        "rate_max": round(max(found)),
    }


def measure_peers(n: int, eta: float, repeats: int) -> list[dict[str, object]]:
    """The rows of other people's engines; none where there are none."""
    scene = peers.gas(n, eta)
    pace: dict[str, tuple[int, peers.Timed]] = {"fast": (peers.OWN_CONTACTS, peers.own_contacts(scene))}
    if find_spec("billiards"):
        pace["billiards"] = peers.PEER_CONTACTS, peers.billiards_contacts(scene)
    if find_spec("pymunk"):
        pace["pymunk"] = peers.pymunk_contacts(scene)
    if len(pace) == 1:
        return []
    pace["fast"][1]()  # loads the kernels
    rates: dict[str, list[float]] = {name: [] for name in pace}
    for _ in range(repeats):
        for name, (_, timed) in pace.items():
            rates[name].append(timed())
    return [
        {
            "n": n,
            "eta": eta,
            "domain": "box",
            "engine": name,
            "log": "off",
            "contacts": pace[name][0],
            **spread(found),
            "of_fast": round(statistics.median(found) / statistics.median(rates["fast"]), 6),
            "of_yardstick": "",
            "bytes_per_disk": "",
        }
        for name, found in rates.items()
    ]


def main() -> None:
    parser = arguments(__doc__)
    parser.add_argument("--n", type=whole, nargs="+", default=[100, 1000, 10_000, 100_000, 1_000_000])
    parser.add_argument("--eta", type=float, nargs="+", default=[0.2, 0.5, 0.7])
    parser.add_argument("--contacts", type=whole, default=1_000_000)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--warm-up", type=float, default=10.0, help="contacts per disk before the clock starts")
    parser.add_argument("--yardstick", help="folder of the yardstick")
    parser.add_argument("--alone", action="store_true", help="no reference engine and no peers: fast, and the yardstick")
    chosen = parser.parse_args()
    table = Table(COLUMNS)
    for n in chosen.n:
        for eta in chosen.eta:
            for row in measure(n, eta, chosen.contacts, chosen.repeats, chosen.yardstick, chosen.warm_up, chosen.alone):
                table.add(row)
            if n <= MOST_FOR_PEERS and not chosen.alone:
                for row in measure_peers(n, eta, chosen.repeats):
                    table.add(row)
    table.write(chosen.csv)


if __name__ == "__main__":
    main()
