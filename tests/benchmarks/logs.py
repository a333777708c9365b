"""What a log costs: rates with none, and with each format, compact and full; repeats in turn, medians, ratios within the run.

    python -m tests.benchmarks.logs [--n 1000 10000 100000] [--eta 0.5] [--contacts 2e6] [--repeats 5] [--csv FILE]

The gas is that of `rates`.  Elapsed time counts until the file is whole.  `own_ratio` compares the CPU time of the thread that
simulates and closes the file: what remains of the ratio where the writer has a core of its own.
"""

from __future__ import annotations

import argparse
import csv
import statistics
import subprocess
import tempfile
from pathlib import Path
from time import perf_counter, process_time, thread_time

import eventsim as es
from tests.benchmarks.rates import lattice_gas

COLUMNS = ("n", "eta", "log", "contacts", "rate_median", "ratio", "own_ratio", "cpu_ratio", "bytes_per_row")
KINDS = ("none", "npz compact", "npz", "parquet compact", "parquet", "csv compact", "csv")
TEXT_SHARE = 0.05
"""Text is slower by far: it gets this share of the contacts."""


def run_once(scene: es.Scene, kind: str, contacts: int, folder: Path) -> tuple[float, float, float, float]:
    """(elapsed, own CPU, all CPU) seconds per contact, bytes per row."""
    suffix, _, compact = kind.partition(" ")
    path = folder / f"log.{suffix}"
    begun = perf_counter(), thread_time(), process_time()
    run = es.simulate(
        scene, events=contacts, engine="fast", log=False if kind == "none" else path, compact=bool(compact)
    )
    ended = perf_counter(), thread_time(), process_time()
    size = 0 if kind == "none" else path.stat().st_size
    path.unlink(missing_ok=True)
    done = run.counters.events
    elapsed, own, cpu = ((after - before) / done for before, after in zip(begun, ended, strict=True))
    return elapsed, own, cpu, size / done


def measure(n: int, eta: float, contacts: int, repeats: int, kinds: list[str]) -> list[dict[str, object]]:
    """The rows of the table for one gas."""
    start = lattice_gas(n, eta)
    state = es.simulate(start, events=10 * n, engine="fast").state
    scene = es.Scene(es.Disks(state.position, state.velocity, 0.5), start.domain)
    share = {kind: TEXT_SHARE if kind.startswith("csv") else 1.0 for kind in kinds}
    found: dict[str, list[tuple[float, float, float, float]]] = {kind: [] for kind in kinds}
    with tempfile.TemporaryDirectory() as folder:
        for repeat in range(repeats + 1):
            for kind in kinds:
                costs = run_once(scene, kind, max(1, int(share[kind] * contacts)), Path(folder))
                if repeat:  # the first loads what is needed
                    found[kind].append(costs)
    middle = {kind: [statistics.median(values) for values in zip(*costs, strict=True)] for kind, costs in found.items()}
    return [
        {
            "n": len(scene.disks),
            "eta": eta,
            "log": kind,
            "contacts": max(1, int(share[kind] * contacts)),
            "rate_median": round(1.0 / middle[kind][0]),
            "ratio": round(middle[kind][0] / middle["none"][0], 2),
            "own_ratio": round(middle[kind][1] / middle["none"][1], 2),
            "cpu_ratio": round(middle[kind][2] / middle["none"][2], 2),
            "bytes_per_row": round(middle[kind][3], 1),
        }
        for kind in kinds
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--n", type=lambda text: int(float(text)), nargs="+", default=[1000, 10_000, 100_000])
    parser.add_argument("--eta", type=float, nargs="+", default=[0.5])
    parser.add_argument("--contacts", type=lambda text: int(float(text)), default=2_000_000)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=list(KINDS))
    parser.add_argument("--csv", type=Path, help="write the table here as well")
    chosen = parser.parse_args()
    commit = subprocess.run(
        ["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=False
    ).stdout.strip()
    table = []
    print(" ".join(f"{name:>15}" for name in COLUMNS))
    for n in chosen.n:
        for eta in chosen.eta:
            for row in measure(
                n, eta, chosen.contacts, chosen.repeats, ["none", *(k for k in chosen.kinds if k != "none")]
            ):
                table.append({**row, "commit": commit})
                print(" ".join(f"{row[name]!s:>15}" for name in COLUMNS), flush=True)
    if chosen.csv is not None:
        with chosen.csv.open("w", newline="") as stream:
            writer = csv.DictWriter(stream, [*COLUMNS, "commit"])
            writer.writeheader()
            writer.writerows(table)


if __name__ == "__main__":
    main()
