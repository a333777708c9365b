"""What it takes to make full rows of a compact log, beside the run that wrote it; in turn, medians, ratios within the run.

    python -m tests.benchmarks.expand [--n 1000 10000] [--eta 0.5] [--contacts 1e7] [--repeats 3] [--csv FILE]

The gas is that of `rates`, its log a compact npz file.  Times are those of the processor, of all threads.  `run_s`: until the
file is whole.  `expand_s`: until an engine has found all its rows again, and the digest of the log is verified.
"""

from __future__ import annotations

import statistics
import tempfile
from collections.abc import Callable
from pathlib import Path
from time import process_time

import eventsim as es
from eventsim.replay.log import stream_log
from tests.benchmarks.rates import lattice_gas
from tests.benchmarks.table import Table, arguments, whole

COLUMNS = ("n", "eta", "contacts", "run_s", "expand_s", "ratio")


def seconds(work: Callable[[], object]) -> float:
    """The processor time that something takes."""
    began = process_time()
    work()
    return process_time() - began


def measure(n: int, eta: float, contacts: int, repeats: int) -> dict[str, object]:
    """A row of the table."""
    scene, found = lattice_gas(n, eta), []
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "log.npz")

        def write(events: int) -> None:
            es.simulate(scene, events=events, engine="fast", log=path, compact=True)

        def expand() -> None:
            assert sum(map(len, stream_log(path)[1])) > 0

        write(10_000)  # kernels are compiled, or loaded
        expand()
        for _ in range(repeats):
            found.append((seconds(lambda: write(contacts)), seconds(expand)))
    return {
        "n": n,
        "eta": eta,
        "contacts": contacts,
        "run_s": round(statistics.median(run for run, _ in found), 2),
        "expand_s": round(statistics.median(expanded for _, expanded in found), 2),
        "ratio": round(statistics.median(expanded / run for run, expanded in found), 3),
    }


def main() -> None:
    """Print the table."""
    parser = arguments(__doc__)
    parser.add_argument("--n", type=whole, nargs="+", default=[1000, 10_000])
    parser.add_argument("--eta", type=float, nargs="+", default=[0.5])
    parser.add_argument("--contacts", type=whole, default=10_000_000)
    parser.add_argument("--repeats", type=int, default=3)
    chosen = parser.parse_args()
    table = Table(COLUMNS, 12)
    for n in chosen.n:
        for eta in chosen.eta:
            table.add(measure(n, eta, chosen.contacts, chosen.repeats))
    table.write(chosen.csv)


if __name__ == "__main__":
    main()
