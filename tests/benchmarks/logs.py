"""What a log costs: rates with none, and with each format, compact and full; repeats in turn, medians, ratios within the run.

    python -m tests.benchmarks.logs [--n 1000 10000 100000] [--eta 0.5] [--contacts 2e6] [--repeats 5] [--csv FILE]

The gas is that of `rates`.  Elapsed time counts until the file is whole.  `own_ratio` compares the CPU time of the thread that
simulates and closes the file: what remains of the ratio where the writer has a core of its own.
"""

from __future__ import annotations

import statistics
import tempfile
from pathlib import Path
from time import perf_counter, process_time, thread_time

import eventsim as es
from tests.benchmarks.rates import lattice_gas
from tests.benchmarks.table import Table, arguments, whole

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
    parser = arguments(__doc__)
    parser.add_argument("--n", type=whole, nargs="+", default=[1000, 10_000, 100_000])
    parser.add_argument("--eta", type=float, nargs="+", default=[0.5])
    parser.add_argument("--contacts", type=whole, default=2_000_000)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=list(KINDS))
    chosen = parser.parse_args()
    table = Table(COLUMNS, 15)
    for n in chosen.n:
        for eta in chosen.eta:
            for row in measure(
                n, eta, chosen.contacts, chosen.repeats, ["none", *(k for k in chosen.kinds if k != "none")]
            ):
                table.add(row)
    table.write(chosen.csv)


if __name__ == "__main__":
    main()
