"""Rates of plain gases in this checkout and in another one, in turn.

    python -m tests.benchmarks.versions OTHER [--n 1000 10000] [--eta 0.2 0.5 0.7] [--processes 5] [--layouts] [--csv FILE]

OTHER is a checkout of an earlier version, for instance from `git worktree add ../before v0.1.0`.  Each checkout has a process of
its own, and the two take turns.  Where a process lands in memory changes its rate by some percent; so processes are begun anew
several times, and the ratio is the median over all pairs of turns.

Where the compiler puts the jumps of a kernel changes its rate by up to 15 %, one way or the other, and any new line moves them.
With `--layouts` each pair of processes has its kernels compiled with blocks and loops aligned in another way, the same for both
checkouts: the median then tells of the code, and not of where it came to lie.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import IO

from tests.benchmarks.table import Table, arguments, whole

HERE = Path(__file__).resolve().parents[2]
COLUMNS = ("n", "eta", "engine", "rate_here", "rate_other", "ratio", "ratio_low", "ratio_high")
WORKER = """
import os
import sys
layout = sys.argv[5:]
if layout:
    from llvmlite import binding
    for option in layout:
        binding.set_option("eventsim", option)
    os.environ["EVENTSIM_CACHE_DIR"] = os.path.join(os.environ["LAYOUTS"], *layout)
from tests.benchmarks import rates
n, eta, engine, warm_up = int(sys.argv[1]), float(sys.argv[2]), sys.argv[3], int(sys.argv[4])
advance = rates.engine_advance(engine, rates.lattice_gas(n, eta), False)
advance(warm_up)
print("ready", flush=True)
for line in sys.stdin:
    print(rates.timed(advance, int(line)), flush=True)
"""


LAYOUTS = tuple(
    (f"-align-all-nofallthru-blocks={blocks}", f"-align-loops={loops}")
    for blocks in (0, 3, 4, 5)
    for loops in (1, 16, 32, 64)
)
"""Options of LLVM: blocks that are not fallen into at multiples of 2^blocks bytes, loops at multiples of `loops`."""


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


def measure(
    other: Path, n: int, eta: float, engine: str, contacts: int, turns: int, layouts: Sequence[Sequence[str]]
) -> dict[str, object]:
    """One row of the table; a pair of processes for each layout."""
    here, there = list[float](), list[float]()
    for layout in layouts:
        workers = [Worker(checkout, n, eta, engine, contacts, *layout) for checkout in (HERE, other)]
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
    parser.add_argument(
        "--layouts", action="store_true", help="a pair of processes for each of many layouts of the machine code"
    )
    chosen = parser.parse_args()
    layouts: Sequence[Sequence[str]] = LAYOUTS if chosen.layouts else [()] * chosen.processes
    table = Table(COLUMNS)
    with TemporaryDirectory() as folder:
        os.environ["LAYOUTS"] = folder
        for n in chosen.n:
            for eta in chosen.eta:
                table.add(measure(chosen.other, n, eta, chosen.engine, chosen.contacts, chosen.turns, layouts))
    table.write(chosen.csv)


if __name__ == "__main__":
    main()
