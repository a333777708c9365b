"""What is not used costs nothing: the kernel of a plain gas beside kernels from which a feature's code was cut out.

    python -m tests.benchmarks.unused [--n 1000] [--eta 0.5] [--contacts 1e6] [--starts 9] [--repeats 3] [--csv FILE]

Every row is a process of its own, and all take turns.  Where a process happens to lie in memory is worth some per cent, so all
are started several times.  The first one does what a user's run does (the driver that looks after logs, measures, progress and
interrupts included); in each of the others functions of the engine are replaced, before anything is compiled, by ones that know
nothing of the feature, and the kernels are called without the driver.  `ratio`: the rate of the whole package to that of the row,
per second of processor time, the median over the turns and then over the starts; 1 means that the feature costs nothing.
`lowest`, `highest`: of the starts.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Callable
from operator import truediv
from pathlib import Path
from time import process_time
from types import ModuleType

from tests.benchmarks.table import Table, arguments, whole

COLUMNS = ("without", "ratio", "lowest", "highest", "rate_median")
WHOLE, BARE = "nothing", "the driver: log, measures, progress"


def cut(module: ModuleType, **functions: Callable[..., object]) -> None:
    """Put functions in the place of those that a module of the engine has by these names."""
    from eventsim.engines.fast.compiled import inline

    for name, function in functions.items():
        assert hasattr(module, name), f"{module.__name__} has no {name} any more: nothing would be cut"
        setattr(module, name, inline(function))


def cut_walls() -> None:
    """No wall shapes, and no contacts with hard walls."""
    from eventsim.engines.fast import loop, predict

    def without_shapes(m, grid, rules, i, now, floor, x, y, time, code, shared):  # type: ignore[no-untyped-def]
        return time, code, shared

    cut(predict, earliest_at_shapes=without_shapes)
    cut(loop, resolve_wall=lambda m, rules, sums, i, code, t, clock, number, slot: None)


def cut_gravity() -> None:
    """Straight flights, and nobody's own acceleration."""
    from eventsim.engines.fast import advance, cells, pairs, single_disk_events

    for module in (advance, cells, pairs, single_disk_events):
        cut(module, pulls=lambda m, rules, i: (None, None))
    for module in (advance, pairs):
        cut(module, position=lambda x, v, t, g: x + v * t, velocity=lambda v, t, g: v)


def cut_restitution() -> None:
    """Every contact is elastic: a constant."""
    from eventsim.engines.fast import resolve

    cut(resolve, _restitution_of_pair=lambda m, rules, a, b, t, dx, dy: 1.0)


def cut_masses() -> None:
    """All masses are one and finite."""
    from eventsim.engines.fast import resolve

    cut(resolve, _shares=lambda m, a, b: (0.5, 0.5), _reduced=lambda m, rules, a, b: 0.5)


def cut_radii() -> None:
    """One grid, four slots in a cell."""
    from eventsim.engines.fast import calendar, cells, loop, predict
    from eventsim.engines.fast.layout import USUAL_DEPTH

    for module in (calendar, loop, predict):
        cut(module, home_of=lambda m, grid, i: grid)
    for module in (calendar, cells, predict):
        cut(module, slot_of=lambda grid, column, row: USUAL_DEPTH * (column + (grid.columns + 2) * row))


def cut_log() -> None:
    """No rows."""
    from eventsim.engines.fast import resolve

    cut(resolve, write_pair=lambda m, number, slot, a, b, flight_a, flight_b, impulse, t, clock: None)
    cut(resolve, write_wall=lambda m, number, slot, a, wall, flight, impulse, t, clock: None)


CUTS: dict[str, Callable[[], None]] = {
    "walls": cut_walls,
    "gravity": cut_gravity,
    "restitution": cut_restitution,
    "masses": cut_masses,
    "unequal radii": cut_radii,
    "log": cut_log,
    BARE: lambda: None,
}


def serve(without: str, n: int, eta: float, contacts: int) -> None:
    """Simulate so many contacts for each line of the input; say at which rate."""
    if without in CUTS:
        CUTS[without]()
    from eventsim.engines import ENGINES
    from eventsim.engines.base import Stop
    from eventsim.engines.fast.session import FastSession
    from eventsim.runner.loop import run_session
    from eventsim.runner.options import RunOptions
    from eventsim.scene.stage import stage_of
    from tests.benchmarks.rates import lattice_gas

    scene = lattice_gas(n, eta)
    session = FastSession(stage_of(scene), keep_rows=False)

    def advance() -> None:
        stop = Stop(events=session.counters.events + contacts)
        if without == WHOLE:
            run_session(session, ENGINES["fast"], scene, stop, RunOptions())
        else:
            session.advance(stop, 1 << 40)

    advance()
    print("ready", flush=True)
    for _ in sys.stdin:
        began = process_time()
        advance()
        print(contacts / (process_time() - began), flush=True)


def measure(n: int, eta: float, contacts: int, starts: int, repeats: int) -> list[dict[str, object]]:
    """The rows of the table."""
    names = (WHOLE, *CUTS)
    rates: dict[str, list[float]] = {name: [] for name in names}
    ratios: dict[str, list[float]] = {name: [] for name in names}
    sizes = ["--n", str(n), "--eta", str(eta), "--contacts", str(contacts)]
    with tempfile.TemporaryDirectory() as folder:
        # A cache of its own for each: what was cut out does not show in the sources.
        caches = {name: str(Path(folder) / str(place)) for place, name in enumerate(names)}
        for _ in range(starts):
            found = turns({name: start(name, sizes, cache) for name, cache in caches.items()}, repeats)
            for name, own in found.items():
                ratios[name].append(statistics.median(map(truediv, found[WHOLE], own)))
                rates[name] += own
    rows = []
    for name, own in ratios.items():
        values = (round(value, 3) for value in (statistics.median(own), min(own), max(own)))
        rows.append(dict(zip(COLUMNS, (name, *values, round(statistics.median(rates[name]))), strict=True)))
    return rows


def start(name: str, sizes: list[str], cache: str) -> subprocess.Popen[str]:
    """A process for a row, which compiles or loads its kernels."""
    command = [sys.executable, "-m", "tests.benchmarks.unused", "--serve", name, *sizes]
    where = {**os.environ, "EVENTSIM_CACHE_DIR": cache}
    return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=where)


def turns(workers: dict[str, subprocess.Popen[str]], repeats: int) -> dict[str, list[float]]:
    """The rates of processes that take turns."""
    for name, worker in workers.items():
        if ask(worker, None) != "ready":
            raise RuntimeError(f"the kernel without {name} did not compile")
    rates: dict[str, list[float]] = {name: [] for name in workers}
    for _ in range(repeats):
        for name, worker in workers.items():
            rates[name].append(float(ask(worker, "go")))
    for worker in workers.values():
        worker.communicate()
    return rates


def ask(worker: subprocess.Popen[str], line: str | None) -> str:
    """What a worker answers."""
    assert worker.stdin is not None
    assert worker.stdout is not None
    if line is not None:
        print(line, file=worker.stdin, flush=True)
    return worker.stdout.readline().strip()


def main() -> None:
    parser = arguments(__doc__)
    parser.add_argument("--n", type=whole, default=1000)
    parser.add_argument("--eta", type=float, default=0.5)
    parser.add_argument("--contacts", type=whole, default=1_000_000)
    parser.add_argument("--starts", type=int, default=9)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--serve", help=argparse.SUPPRESS)
    chosen = parser.parse_args()
    if chosen.serve is not None:
        serve(chosen.serve, chosen.n, chosen.eta, chosen.contacts)
        return
    table = Table(COLUMNS, 40)
    gas = {"n": chosen.n, "eta": chosen.eta, "contacts": chosen.contacts}
    for row in measure(chosen.n, chosen.eta, chosen.contacts, chosen.starts, chosen.repeats):
        table.add({**row, **gas})
    table.write(chosen.csv)


if __name__ == "__main__":
    main()
