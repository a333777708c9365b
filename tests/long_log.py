"""Logs of millions of rows, and what reading them takes."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import eventsim as es
from tests.engines.scenes import lattice_gas

WATCHED = (
    "import resource, sys; from eventsim.__main__ import main\n"
    "try: main()\nfinally: print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, file=sys.stderr)"
)


def write(path: Path, millions: int) -> None:
    """Write a log of so many rows."""
    es.simulate(lattice_gas(36, 0.3), events=millions * 1_000_000, log=path)


def megabytes(*words: str) -> float:
    """The most memory that a command of eventsim has held."""
    environment = os.environ | {"PYTHONPATH": str(Path(__file__).parents[1])}
    done = subprocess.run(
        [sys.executable, "-c", WATCHED, *words], env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return int(done.stderr.split()[-1]) / 1024
