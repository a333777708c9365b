"""What choosing costs: `auto` against the better of the two engines, over job lengths; a process of its own for every run.

    python -m tests.benchmarks.auto [--scene gas 3000 ...] [--events 1e2 1e3 ...] [--by-time] [--repeats 3] [--csv FILE]

A scene is one of the gallery, or a number of disks: the gas of `rates`.  --by-time: `auto` is not told how many events, but
the time at which the fast engine has come to as many.
Compiled kernels are on disk (a first run sees to that) and loading them counts; so does importing the compiler.  Seconds are CPU
time of the process within `simulate`, which other work on the machine disturbs less than elapsed time.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
from collections.abc import Iterator

from tests.benchmarks.table import Table, arguments, whole

COLUMNS = ("scene", "events", "told", "reference_s", "fast_s", "auto_s", "ended_with", "auto_ratio")
ONCE = """
import sys
from time import process_time
import eventsim as es
from tests.benchmarks.rates import lattice_gas
name, engine, stop = sys.argv[1], sys.argv[2], {sys.argv[3]: eval(sys.argv[4])}
scene = lattice_gas(int(name), 0.5) if name.isdigit() else es.gallery(name)
begun = process_time()
run = es.simulate(scene, engine=engine, **stop)
print(process_time() - begun, run.engine, run.time)
"""
PATIENCE = 10.0
"""Seconds that the reference engine may take; beyond, its time is that of the next shorter job, scaled."""


def seconds(scene: str, engine: str, kind: str, stop: float) -> tuple[float, str, float]:
    """(CPU seconds, the engine at the end, the time on the clock there) of one run to a stop: `events` or `until`."""
    command = [sys.executable, "-c", ONCE, scene, engine, kind, repr(stop)]
    taken, ended_with, time = subprocess.run(command, capture_output=True, text=True, check=True).stdout.split()
    return float(taken), ended_with, float(time)


def measure(scene: str, lengths: list[int], repeats: int, by_time: bool) -> Iterator[dict[str, object]]:
    """The rows of the table for one scene."""
    seconds(scene, "fast", "events", 1000)
    reference, before = 0.0, 1
    for events in lengths:
        scaled = reference * events / before
        engines = ["fast", "auto"] if scaled > PATIENCE else ["reference", "fast", "auto"]
        found: dict[str, list[float]] = {engine: [] for engine in engines}
        ended_with = ""
        stop = ("until", seconds(scene, "fast", "events", events)[2]) if by_time else ("events", events)
        for _ in range(repeats):
            for engine in engines:
                taken, ended_with, _ = seconds(scene, engine, *stop)
                found[engine].append(taken)
        middle = {engine: statistics.median(values) for engine, values in found.items()}
        reference, before = middle.get("reference", scaled), events
        best = min(reference, middle["fast"])
        yield {
            "scene": scene,
            "events": events,
            "told": stop[0],
            "reference_s": round(reference, 3),
            "fast_s": round(middle["fast"], 3),
            "auto_s": round(middle["auto"], 3),
            "ended_with": ended_with,
            "auto_ratio": round(middle["auto"] / best, 2),
        }


def main() -> None:
    parser = arguments(__doc__)
    parser.add_argument("--scene", nargs="+", default=["gas", "periodic-fluid", "200", "3000", "9000"])
    parser.add_argument("--events", type=whole, nargs="+", default=[10**k for k in range(2, 8)])
    parser.add_argument("--by-time", action="store_true")
    parser.add_argument("--repeats", type=int, default=3)
    chosen = parser.parse_args()
    table = Table(COLUMNS)
    for scene in chosen.scene:
        for row in measure(scene, chosen.events, chosen.repeats, chosen.by_time):
            table.add(row)
    table.write(chosen.csv)


if __name__ == "__main__":
    main()
