"""Installs the package into a fresh environment, and runs some tests there.

    python -m tests.installs [--python PATH] [--lowest | --locked] [--extras NAMES] [--tests PATH ...]
    python -m tests.installs --freeze

--lowest takes the lowest versions that are declared (lowest.txt), --locked those of the last full run (lock.txt).
--freeze writes lock.txt from the environment that runs this.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
TOOLS = ("pytest", "pytest-timeout", "pytest-xdist", "hypothesis", "mpmath", "pandas")
TESTS = (
    "tests/gallery/test_gallery_digests.py",
    "tests/cli/test_run.py",
    "tests/record",
    "tests/replay/test_passage.py",
    "tests/show/test_figures.py",
)
HEADING = "# The environment in which all tests were last run, on Python 3.11; written by python -m tests.installs --freeze.\n"


def freeze() -> None:
    """Write the versions of this environment."""
    words = [sys.executable, "-m", "pip", "freeze", "--exclude-editable"]
    found = subprocess.run(words, check=True, capture_output=True, text=True).stdout
    lines = [line for line in found.splitlines(keepends=True) if "eventsim" not in line and not line.startswith("-e")]
    (HERE / "lock.txt").write_text(HEADING + "".join(lines))


def tried(python: str, constraints: Path | None, extras: str, tests: list[str]) -> int:
    """Install and test; the exit code of pytest."""
    with tempfile.TemporaryDirectory() as place:
        subprocess.run([python, "-m", "venv", place], check=True)
        inside = str(Path(place, "bin", "python"))
        limits = [] if constraints is None else ["-c", str(constraints)]
        package = f"{ROOT}[{extras}]" if extras else str(ROOT)
        subprocess.run([inside, "-m", "pip", "install", "-q", *limits, "-e", package, *TOOLS], check=True)
        subprocess.run([inside, "-m", "eventsim", "selftest"], check=True)
        return subprocess.run([inside, "-m", "pytest", "-q", "-n", "2", *tests], cwd=ROOT, check=False).returncode


def main() -> int:
    """Do what is asked."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--python", default=sys.executable)
    parser.add_argument("--lowest", action="store_true")
    parser.add_argument("--locked", action="store_true")
    parser.add_argument("--extras", default="fast,figures,certify,live,parquet,pymunk")
    parser.add_argument("--tests", nargs="*", default=list(TESTS))
    parser.add_argument("--freeze", action="store_true")
    asked = parser.parse_args()
    if asked.freeze:
        freeze()
        return 0
    constraints = HERE / ("lowest.txt" if asked.lowest else "lock.txt") if asked.lowest or asked.locked else None
    return tried(asked.python, constraints, asked.extras, asked.tests)


if __name__ == "__main__":
    sys.exit(main())
