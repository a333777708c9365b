"""Lets every write, flush, fsync, rename, ... of a run fail once, and looks at what is left: the old file or the whole new one.

    python -m tests.faults.inject [--every N] [--only WORD ...]

builds the shim (a C compiler and Linux are needed), and tries each call site: format x call x error.  What must hold each time:
the run ends well and its log is right, or it ends with an EventsimError that names the file; under the log's name stands what
stood there before or the whole new log; NAME.part, where it is left, reads as the beginning of the run; the run goes on from its
checkpoint to the same log; nothing else lies about.
"""

from __future__ import annotations

import argparse
import ctypes
import errno
import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

CALLS = ("write", "fsync", "rename", "truncate", "link", "open", "mkdir")
ERRORS = (errno.ENOSPC, errno.EIO, errno.EINTR)
EVENTS, FIRST, EVERY = 240, 60, 80
"""Events of a run; of the one before, whose log stands under the name; between two checkpoints."""


@dataclass(frozen=True)
class Finding:
    """A call that failed, and what did not hold."""

    what: str
    call: str
    number: int
    error: str
    problem: str


def built(folder: Path) -> Path | None:
    """The shim, compiled into a folder; None where there is no compiler, or no Linux."""
    compiler = shutil.which("cc")
    if compiler is None or not sys.platform.startswith("linux"):
        return None
    shim = folder / "shim.so"
    source = Path(__file__).with_name("shim.c")
    subprocess.run([compiler, "-shared", "-fPIC", "-O1", "-o", str(shim), str(source), "-ldl"], check=True)
    return shim


def run_with_faults(every: int, only: list[str], folder: Path) -> dict[str, Any] | None:
    """Inject in a process of its own; {"tried": ..., "findings": [...]}, None where the shim cannot be built."""
    shim = built(folder)
    if shim is None:
        return None
    words = [sys.executable, "-m", "tests.faults.inject", "--inside", str(shim), "--every", str(every), "--only", *only]
    environment = os.environ | {"LD_PRELOAD": str(shim)}
    done = subprocess.run(words, env=environment, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(done.stderr[-3000:])
    found: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return found


class Faults:
    """The shim inside this process."""

    def __init__(self, shim: str) -> None:
        self._library = ctypes.CDLL(shim)
        self._library.fault_count.restype = ctypes.c_long
        self._library.fault_arm.argtypes = [ctypes.c_int, ctypes.c_long, ctypes.c_int, ctypes.c_char_p]

    def arm(self, call: int, number: int, error: int, folder: Path) -> None:
        """Let the call of this number fail below a folder; 0: none, but count."""
        self._library.fault_arm(call, number, error, str(folder).encode())

    def counted(self) -> list[int]:
        """How many calls of each kind there were since, and no more are counted."""
        counts = [self._library.fault_count(call) for call in range(len(CALLS))]
        self._library.fault_arm(-1, 0, 0, b"")
        return counts


def scenarios() -> dict[str, Callable[[Path], None]]:
    """What is run: writes into a folder, the log under the name `log` and a suffix, the checkpoint as `cp`."""
    import eventsim as es
    from eventsim.suffixes import LOGS, STATES
    from eventsim.sweep import sweep
    from tests.sweep.test_sweep import GRID, make

    scene = es.gallery("gas", n=12)

    def logged(suffix: str, compact: bool) -> Callable[[Path], None]:
        def run(place: Path) -> None:
            options: dict[str, Any] = {"log": place / f"log{suffix}", "compact": compact, "checkpoint": place / "cp"}
            es.simulate(scene, events=EVENTS, engine="reference", every=EVERY, **options)

        return run

    def stated(suffix: str) -> Callable[[Path], None]:
        from eventsim.replay.states import write_states

        state = es.simulate(scene, events=20, engine="reference").state
        return lambda place: write_states(place / f"state{suffix}", scene, [state])

    def swept(place: Path) -> None:
        sweep(make, GRID, events=30, engine="reference", out=place / "table.csv")

    found: dict[str, Callable[[Path], None]] = {}
    for suffix in LOGS:
        for compact in (False, True):
            found[f"{'compact' if compact else 'full'} {suffix}"] = logged(suffix, compact)
    for suffix in STATES:
        if suffix != ".gsd":  # its library writes that file
            found[f"state {suffix}"] = stated(suffix)
    found["sweep"] = swept
    return found


def inject(faults: Faults, every: int, only: list[str]) -> tuple[Counter[str], list[Finding]]:
    """Try the call sites, each `every`-th of them."""
    tried: Counter[str] = Counter()
    findings = []
    for what, run in scenarios().items():
        if only and not any(word in what for word in only):
            continue
        with tempfile.TemporaryDirectory() as folder:
            bench = Bench(what, run, faults, Path(folder))
            sites = [(call, number + 1) for call, count in enumerate(bench.counts) for number in range(count)]
            for place, (call, number) in enumerate(sites):
                for shift, error in enumerate(ERRORS):
                    if (place + shift) % every == 0:
                        tried[f"{what}: {CALLS[call]}"] += 1
                        for problem in bench.problems(call, number, error):
                            findings.append(Finding(what, CALLS[call], number, errno.errorcode[error], problem))
    return tried, findings


class Bench:
    """A scenario, what it writes when nothing fails, and what stood there before."""

    def __init__(self, what: str, run: Callable[[Path], None], faults: Faults, folder: Path) -> None:
        self.what, self._run, self._faults, self._folder = what, run, faults, folder
        self._old, right = folder / "old", folder / "right"
        self._old.mkdir()
        right.mkdir()
        run(self._old)  # imports what there is to import
        self._make_older()
        self._right = {}
        shutil.copytree(self._old, right, dirs_exist_ok=True)
        faults.arm(-1, 0, 0, right)
        run(right)
        self.counts = faults.counted()
        self._right = {file.name: read(file) for file in right.iterdir()}
        self._before = {file.name: read(file) for file in self._old.iterdir()}

    def _make_older(self) -> None:
        """Leave under the names what an earlier run, another one, had written."""
        import eventsim as es

        for file in self._old.iterdir():
            if file.name.startswith("log"):
                es.simulate(es.gallery("gas", n=12, seed=5), events=FIRST, engine="reference", log=file)
            elif file.name != "cp":
                file.write_text("what was there before")
            else:
                file.unlink()

    def problems(self, call: int, number: int, error: int) -> Iterator[str]:
        """What does not hold after a call has failed."""
        import eventsim as es

        place = self._folder / "now"
        shutil.rmtree(place, ignore_errors=True)
        shutil.copytree(self._old, place)
        self._faults.arm(call, number, error, place)
        said = ""
        try:
            self._run(place)
        except es.EventsimError as problem:
            said = str(problem)
        except BaseException as problem:
            yield f"raised {type(problem).__name__}: {problem}"
        finally:
            self._faults.counted()
        if said and str(place) not in said:
            yield f"names no file: {said}"
        yield from self._wrong_files(place, failed=bool(said))
        if (place / "cp").exists():
            yield from self._wrong_future(place)

    def _wrong_files(self, place: Path, failed: bool) -> Iterator[str]:
        import eventsim as es

        known = {*self._right, *(f"{name}.part" for name in self._right), "table.csv.journal"}
        for file in place.iterdir():
            if file.name not in known:
                yield f"leaves {file.name} behind"
            elif file.name in self._right and file.name != "cp":
                found = read(file)
                if found != self._right[file.name] and not (failed and found == self._before.get(file.name)):
                    yield f"{file.name} is neither the old nor the whole new file"
            elif file.name.startswith("log"):
                try:
                    rows = es.load_log(file).rows["remainder"]
                except es.EventsimError as problem:
                    yield f"cannot be read: {problem}"
                    continue
                if not self._right[file.name.removesuffix(".part")][0].startswith(rows.tobytes()):
                    yield f"{file.name} tells another story"

    def _wrong_future(self, place: Path) -> Iterator[str]:
        import eventsim as es

        try:
            es.resume(place / "cp", events=EVENTS)
        except es.EventsimError as problem:
            yield f"does not go on: {problem}"
            return
        for name in self._right:
            if name.startswith("log") and read(place / name)[0] != self._right[name][0]:
                yield "goes on to another log"
        if left := [file.name for file in place.iterdir() if file.name not in self._right]:
            yield f"leaves {left} behind when it goes on"


def read(file: Path) -> Any:
    """What a file says, as something that can be compared; of a log the clock of its rows and how many there are."""
    import eventsim as es

    if file.name.startswith("log"):
        log = es.load_log(file)
        return log.rows["remainder"].tobytes(), log.provenance.rows, log.provenance.ending
    return file.read_bytes() if file.name != "cp" else None


def main() -> int:
    """Inject, and print what was tried and found."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--only", nargs="*", default=[])
    parser.add_argument("--inside", help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if asked.inside:
        tried, findings = inject(Faults(asked.inside), asked.every, asked.only)
        print(json.dumps({"tried": tried, "findings": [vars(finding) for finding in findings]}))
        return 0
    with tempfile.TemporaryDirectory() as folder:
        found = run_with_faults(asked.every, asked.only, Path(folder))
    if found is None:
        print("no C compiler, or no Linux")
        return 2
    for site, count in found["tried"].items():
        print(f"{site}: {count}")
    for finding in found["findings"]:
        print(finding)
    print(f"{sum(found['tried'].values())} faults injected, {len(found['findings'])} findings")
    return 1 if found["findings"] else 0


if __name__ == "__main__":
    sys.exit(main())
