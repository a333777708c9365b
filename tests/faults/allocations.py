"""Lets every array of a run fail to be allocated once, and looks at what is left.

    python -m tests.faults.allocations [--every N] [--engine NAME ...]

Each call of NumPy by the package's own code that asks for memory (`CALLS`) raises MemoryError once.  What must hold: the run ends
with MemoryError, which the command tells in a sentence, or goes on and is right; under its log's name stands what stood there
before or the whole new log; nothing that cannot be read lies about; and the next run in the same process is right.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np

import eventsim as es

CALLS = (
    "empty", "zeros", "ones", "full", "concatenate", "repeat", "tile", "array", "arange", "column_stack", "ascontiguousarray",
)  # fmt: skip
ENGINES = ("reference", "fast", "frames", "stepped", "penalty")
EVENTS = 60


class Allocations:
    """Counts what the package allocates, and lets the one of a number fail."""

    def __init__(self, number: int = 0) -> None:
        self.count, self._number = 0, number
        self.where = ""

    @contextmanager
    def watched(self) -> Iterator[None]:
        """Do so inside."""
        with ExitStack() as patched:
            for name in CALLS:
                patched.enter_context(mock.patch.object(np, name, self._watching(getattr(np, name))))
            yield

    def _watching(self, call: Any) -> Any:
        def allocate(*values: Any, **named: Any) -> Any:
            frame = sys._getframe(1)
            if "/eventsim/" in frame.f_code.co_filename:
                self.count += 1
                if self.count == self._number:
                    self.where = f"{Path(frame.f_code.co_filename).name}:{frame.f_lineno}"
                    raise MemoryError(f"Unable to allocate 1. TiB for an array (call {self._number})")
            return call(*values, **named)

        return allocate


def run(place: Path, engine: str) -> str:
    """A run with a log and checkpoints; the digest of its log."""
    scene = es.gallery("gas", n=12)
    goes_on = {"checkpoint": place / "cp", "every": 20} if es.ENGINES[engine].engine.replays else {}
    es.simulate(scene, events=EVENTS, engine=engine, log=place / "log.npz", **goes_on)
    return es.load_log(place / "log.npz").digest()


def fail(engine: str, every: int) -> tuple[Counter[str], list[str]]:
    """Let each allocation of an engine's run fail, each `every`-th of them; what was tried, and what did not hold."""
    tried: Counter[str] = Counter()
    findings: list[str] = []
    with tempfile.TemporaryDirectory() as folder:
        first = Path(folder, "first")
        first.mkdir()
        right = run(first, engine)  # imports and compiles what there is
        every_call = Allocations()
        with every_call.watched():
            run(first, engine)
        for number in range(1, every_call.count + 1, every):
            place = Path(folder, str(number))
            place.mkdir()
            allocations = Allocations(number)
            try:
                with allocations.watched():
                    run(place, engine)
                ended = "went on"
            except (MemoryError, es.EventsimError) as error:
                ended = type(error).__name__
            except BaseException as error:
                ended = "raised"
                findings.append(f"{engine}, {allocations.where}: raised {type(error).__name__}: {error}")
            tried[f"{engine} {allocations.where} {ended}"] += 1
            findings += [f"{engine}, {allocations.where}: {problem}" for problem in problems(place, right, engine)]
    return tried, findings


def problems(place: Path, right: str, engine: str) -> Iterator[str]:
    """What does not hold after an allocation has failed."""
    for file in place.iterdir():
        if file.name not in ("log.npz", "log.npz.part", "cp"):
            yield f"leaves {file.name} behind"
    if (place / "log.npz").exists() and es.load_log(place / "log.npz").digest() != right:
        yield "the log is neither the old nor the whole new one"
    if (place / "log.npz.part").exists():
        es.load_log(place / "log.npz.part")
    if (place / "cp").exists():
        es.resume(place / "cp", events=EVENTS)
        if es.load_log(place / "log.npz").digest() != right:
            yield "goes on to another log"
    if run(place, engine) != right:
        yield "the next run is another one"


def main() -> int:
    """Fail, and print what was tried and found."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--engine", nargs="*", default=list(ENGINES))
    asked = parser.parse_args()
    total, wrong = 0, 0
    for engine in asked.engine:
        tried, findings = fail(engine, asked.every)
        ended = Counter(site.rsplit(" ", 1)[1] if site.endswith("Error") else site.split(" ", 2)[2] for site in tried.elements())
        print(f"{engine}: {tried.total()} allocations failed at {len(tried)} places: {dict(ended)}", flush=True)
        for finding in findings:
            print("  " + finding, flush=True)
        total, wrong = total + tried.total(), wrong + len(findings)
    print(f"{total} failed allocations, {wrong} findings")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
