"""Rates of plain gases in this checkout and in another one, in turn.

    python -m tests.benchmarks.versions OTHER [--n 1000 10000] [--eta 0.2 0.5 0.7] [--processes 5] [--csv FILE]

OTHER is a checkout of an earlier version, for instance from `git worktree add ../before v0.1.0`.  Each checkout has a process of
its own, and the two take turns.  Where a process lands in memory changes its rate by some percent; so processes are begun anew
several times, and the ratio is the median over all pairs of turns.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
from pathlib import Path
from typing import IO

from tests.benchmarks.table import Table, arguments, whole

HERE = Path(__file__).resolve().parents[2]
COLUMNS = ("n", "eta", "engine", "rate_here", "rate_other", "ratio", "ratio_low", "ratio_high")
WORKER = """
import sys
from tests.benchmarks import rates
n, eta, engine, warm_up = int(sys.argv[1]), float(sys.argv[2]), sys.argv[3], int(sys.argv[4])
advance = rates.engine_advance(engine, rates.lattice_gas(n, eta), False)
advance(warm_up)
print("ready", flush=True)
for line in sys.stdin:
    print(rates.timed(advance, int(line)), flush=True)
"""


class Worker:
    """A process that advances a gas in one checkout and tells the CPU time."""

    def __init__(self, checkout: Path, *options: object) -> None:
        command = [sys.executable, "-c", WORKER, *map(str, options)]
        self._process = subprocess.Popen(
            command, cwd=checkout, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        self._line()

    def seconds(self, contacts: int) -> float:
        """The CPU time of so many contacts."""
        print(contacts, file=_open(self._process.stdin), flush=True)
        return float(self._line())

    def close(self) -> None:
        """End the process."""
        self._process.communicate()

    def _line(self) -> str:
        line = _open(self._process.stdout).readline()
        if not line:
            raise SystemExit("a checkout cannot run this benchmark: see its error above")
        return line


def _open(stream: IO[str] | None) -> IO[str]:
    assert stream is not None
    return stream


def measure(other: Path, n: int, eta: float, engine: str, contacts: int, turns: int, processes: int) -> dict[str, object]:
    """One row of the table."""
    here, there = list[float](), list[float]()
    for _ in range(processes):
        workers = [Worker(checkout, n, eta, engine, min(contacts, 10 * n)) for checkout in (HERE, other)]
        for turn in range(turns):
            pair = list(zip(workers, (here, there), strict=True))
            for worker, found in reversed(pair) if turn % 2 else pair:
                found.append(contacts / worker.seconds(contacts))
        for worker in workers:
            worker.close()
    ratios = [a / b for a, b in zip(here, there, strict=True)]
    low, _, high = statistics.quantiles(ratios, n=4)
    return {
        "n": n,
        "eta": eta,
        "engine": engine,
        "rate_here": round(statistics.median(here)),
        "rate_other": round(statistics.median(there)),
        "ratio": round(statistics.median(ratios), 3),
        "ratio_low": round(low, 3),
        "ratio_high": round(high, 3),
    }


def main() -> None:
    parser = arguments(__doc__)
    parser.add_argument("other", type=Path, help="the other checkout")
    parser.add_argument("--n", type=whole, nargs="+", default=[1000, 10_000, 100_000])
    parser.add_argument("--eta", type=float, nargs="+", default=[0.2, 0.5, 0.7])
    parser.add_argument("--engine", default="fast")
    parser.add_argument("--contacts", type=whole, default=500_000)
    parser.add_argument("--turns", type=int, default=5, help="turns of each pair of processes")
    parser.add_argument("--processes", type=int, default=5, help="pairs of processes")
    chosen = parser.parse_args()
    table = Table(COLUMNS)
    for n in chosen.n:
        for eta in chosen.eta:
            table.add(measure(chosen.other, n, eta, chosen.engine, chosen.contacts, chosen.turns, chosen.processes))
    table.write(chosen.csv)


if __name__ == "__main__":
    main()
