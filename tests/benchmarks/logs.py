"""What logs and measures cost: rates with none, and with each; repeats in turn, medians, ratios within the run.

    python -m tests.benchmarks.logs [--n 1000 10000 100000] [--eta 0.5] [--contacts 2e6] [--repeats 5] [--csv FILE]

The gas is that of `rates`.  Elapsed time counts until the file is whole.  `own_ratio` compares the CPU time of the thread that
simulates and closes the file: what remains of the ratio where the writer has a core of its own.

`measures` keeps no log, and measures.  Where there is a second core, it takes what is larger: `own_ratio`, or `cpu_ratio` - 1.

`none beside` keeps no log either, while another process keeps a second core busy: on a machine whose cores share their units,
or are lent by a host, that alone costs something, from one minute to the next, and no log can cost less.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from time import perf_counter, process_time, sleep, thread_time

import eventsim as es
from tests.benchmarks.rates import lattice_gas
from tests.benchmarks.table import Table, arguments, whole

RATIOS = ("ratio", "own_ratio", "cpu_ratio")
COLUMNS = ("n", "eta", "log", "contacts", "rate_median", *RATIOS, "bytes_per_row")
BESIDE = "none beside"
MEASURES = "measures"
KINDS = ("none", BESIDE, MEASURES, "npz compact", "npz", "parquet compact", "parquet", "csv compact", "csv")
TEXT_SHARE = 0.05
"""Text is slower by far: it gets this share of the contacts."""


BUSY = "import hashlib; block = bytes(1 << 16)\nwhile True: hashlib.sha256(block)"


@contextmanager
def busy_core() -> Iterator[None]:
    """Another process that does nothing but compute, in its caches."""
    other = subprocess.Popen([sys.executable, "-c", BUSY])
    sleep(0.2)  # until it computes
    try:
        yield
    finally:
        other.kill()
        other.wait()


def run_once(scene: es.Scene, kind: str, contacts: int, folder: Path) -> tuple[float, float, float, float]:
    """(elapsed, own CPU, all CPU) seconds per contact, bytes per row."""
    suffix, _, compact = kind.partition(" ")
    path = None if suffix in ("none", MEASURES) else folder / f"log.{suffix}"
    with busy_core() if kind == BESIDE else nullcontext():
        begun = perf_counter(), thread_time(), process_time()
        wanted = {"measure": 0.0} if kind == MEASURES else {"log": path or False, "compact": compact == "compact"}
        run = es.simulate(scene, events=contacts, engine="fast", **wanted)
        ended = perf_counter(), thread_time(), process_time()
    size = 0 if path is None else path.stat().st_size
    if path is not None:
        path.unlink()
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
    return [
        {
            "n": len(scene.disks),
            "eta": eta,
            "log": kind,
            "contacts": max(1, int(share[kind] * contacts)),
            "rate_median": round(1.0 / statistics.median(costs[0] for costs in found[kind])),
            **{name: _ratio(found[kind], found["none"], place) for place, name in enumerate(RATIOS)},
            "bytes_per_row": round(found[kind][0][3], 1),
        }
        for kind in kinds
    ]


def _ratio(those: list[tuple[float, ...]], none: list[tuple[float, ...]], place: int) -> float:
    """The median of the ratios of runs that came in the same turn: others who use the machine come and go."""
    return round(statistics.median(cost[place] / plain[place] for cost, plain in zip(those, none, strict=True)), 2)


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
