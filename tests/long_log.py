"""Logs of millions of rows, and what reading them takes."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import eventsim as es
from eventsim.record.files import open_sink
from eventsim.record.provenance import Ending
from tests.engines.scenes import lattice_gas

ROWS = 20_000
WATCHED = (
    "import resource, sys; from eventsim.__main__ import main\n"
    "try: main()\nfinally: print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, file=sys.stderr)"
)


def write(path: Path, millions: int) -> None:
    """Write a log of so many rows: one run again and again, each time at later epochs."""
    log = es.simulate(lattice_gas(36, 0.3), events=ROWS, engine="reference", log=True).log
    rows, last = log.rows.copy(), int(log.epoch[-1]) + 1
    sink = open_sink(path, log.provenance)
    for _ in range(millions * 1_000_000 // ROWS):
        sink.copy(rows, ())
        rows["event"] += len(rows)
        rows["epoch"] += last
    sink.close(Ending(int(rows["epoch"][-1]), 0.0, "until"))


def megabytes(*words: str) -> float:
    """The most memory that a command of eventsim has held."""
    environment = os.environ | {"PYTHONPATH": str(Path(__file__).parents[1])}
    done = subprocess.run(
        [sys.executable, "-c", WATCHED, *words], env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return int(done.stderr.split()[-1]) / 1024
