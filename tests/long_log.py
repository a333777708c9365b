"""Logs of millions of rows, and what reading them takes.

    python -m tests.long_log [--millions 10] [--suffix .npz .parquet] [--kinds KIND ...]

writes a log, and looks at it by `state`, `measure`, `animate` and each kind of `figure`: the memory that they hold, which may be
MOST_MEGABYTES.  Then the states of a csv of 1e6 rows, and the figure msd of 2e6 rows: the seconds of computing, which may be CSV
and MSD.
"""

from __future__ import annotations

import argparse
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import eventsim as es
from eventsim.kinds import TITLES
from tests.engines.scenes import lattice_gas

MOST_MEGABYTES, CSV, MSD = 400.0, 3.0, 10.0
TIMED = (("1e6.csv", 1, CSV, "state", "--at", "50"), ("2e6.npz", 2, MSD, "figure", "--kind", "msd"))
"""A log, its millions of rows, the seconds that may be, and what looks at it."""

WATCHED = (
    "import sys; from pathlib import Path; from eventsim.__main__ import main\n"
    "try: main()\n"
    "finally: print(Path('/proc/self/status').read_text().partition('VmHWM:')[2].split()[0], file=sys.stderr)"
)
"""What Linux says of a program: `resource` would count what its parent held when it began."""


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


def looked_at(log: Path, kinds: list[str]) -> bool:
    """Whether all that looks at a log keeps to its memory; prints what it took."""
    out = str(log.parent / "out")
    looks = [("state", "--frames", "5", "--out", out + ".csv"), ("measure",), ("animate", "--trails", "--out", out + ".png")]
    looks += [("figure", "--kind", kind, "--out", out + ".png") for kind in kinds]
    kept = True
    for verb, *words in looks:
        began = time.monotonic()
        most = megabytes(verb, str(log), *words)
        kept = kept and most <= MOST_MEGABYTES
        print(f"{log.name} {verb} {' '.join(words[:2])}: {most:.0f} MB, {time.monotonic() - began:.1f} s", flush=True)
    return kept


def in_time(log: Path, limit: float, *words: str) -> bool:
    """Whether a command keeps to its time, the better of two tries; prints what it took."""
    times, out = [], log.parent / ("out.png" if words[0] == "figure" else "out.csv")
    for _ in range(2):
        began = computed()
        megabytes(words[0], str(log), *words[1:], "--out", str(out))
        times.append(computed() - began)
    print(f"{log.name} {' '.join(words)}: {min(times):.1f} s, of {limit:g} s", flush=True)
    return min(times) <= limit


def computed() -> float:
    """Seconds that the programs begun here have computed, whatever else the machine does."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main() -> int:
    """Write, look, and print what it took."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--millions", type=int, default=10)
    parser.add_argument("--suffix", nargs="+", default=[".npz", ".parquet"])
    parser.add_argument("--kinds", nargs="*", default=sorted(set(TITLES) - {"boundary"}))  # that one is of billiards
    asked = parser.parse_args()
    kept = True
    with tempfile.TemporaryDirectory() as folder:
        for suffix in asked.suffix:
            log = Path(folder, f"{asked.millions}e6{suffix}")
            write(log, asked.millions)
            print(f"{log.name}: {log.stat().st_size >> 20} MB", flush=True)
            kept = looked_at(log, asked.kinds) and kept
            log.unlink()
        for name, millions, limit, *words in TIMED:
            log = Path(folder, name)
            write(log, millions)
            kept = in_time(log, limit, *words) and kept
    return 0 if kept else 1


if __name__ == "__main__":
    sys.exit(main())
