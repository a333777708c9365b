"""Which branches of the heart the tests take, kernels as plain Python: python -m tests.branches [PYTEST ARGUMENTS ...].

Without arguments it runs the quick tests of formulas, scene, record and engines, and of the oracle and of points, on all cores.
Left out is what numba alone can run.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections import defaultdict
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parent.parent

FOLDERS = ("formulas", "scene", "record", "engines")
TESTS = (*FOLDERS, "oracle", "points")
"""Folders of tests that run.  Measured are the first ones."""

COMPILED = ("numba_compiler.py", "numba_law.py", "numba_memory.py", "numba_parts.py")
AIM = 0.95
WORST, WAYS = 30, 12
"""Files, and branches of each (from line to line), that are named."""


SETTINGS = """[run]
branch = True
parallel = True
patch = subprocess
source = {source}
data_file = {data}
"""
"""Workers of pytest-xdist are measured, too, each into a file of its own."""


def measured(arguments: list[str]) -> dict[str, Any]:
    """Run pytest; what coverage tells of each file of the heart."""
    with tempfile.TemporaryDirectory() as folder:
        settings, report = Path(folder, "settings"), Path(folder, "report.json")
        source = ",".join(str(ROOT / "eventsim" / name) for name in FOLDERS)
        settings.write_text(SETTINGS.format(source=source, data=Path(folder, "data")))
        environment = os.environ | {"EVENTSIM_INTERPRET": "1"}

        def coverage(*words: str, check: bool = True) -> None:
            command = [sys.executable, "-m", "coverage", words[0], f"--rcfile={settings}", *words[1:]]
            subprocess.run(command, env=environment, check=check)

        coverage("run", "-m", "pytest", "-q", "-n", "auto", *arguments, check=False)
        coverage("combine", "-q")
        coverage("json", "-q", "-o", str(report))
        files = json.loads(report.read_text())["files"]
    return {name: found for name, found in files.items() if Path(name).name not in COMPILED}


def main() -> None:
    """Print the share of branches and of lines, folder by folder, and the files that have the most to be looked at."""
    found = measured(sys.argv[1:] or [f"tests/{name}" for name in TESTS])
    sums: dict[str, list[int]] = defaultdict(lambda: [0, 0, 0, 0])
    for name, told in found.items():
        counts = [told["summary"][key] for key in ("covered_branches", "num_branches", "covered_lines", "num_statements")]
        for folder in (Path(name).parts[1], "all"):
            sums[folder] = [a + b for a, b in zip(sums[folder], counts, strict=True)]
    for folder, (taken, branches, run, lines) in sorted(sums.items()):
        shares = 100 * taken / branches, 100 * run / lines
        print(f"{folder:10s} {shares[0]:6.1f} % of {branches} branches, {shares[1]:6.1f} % of {lines} statements")
    worst = sorted(found, key=lambda name: len(found[name]["missing_branches"]), reverse=True)[:WORST]
    for name in worst:
        missing = found[name]["missing_branches"]
        ways = ", ".join(f"{here}->{there}" if there > 0 else f"{here}->end" for here, there in missing[:WAYS])
        print(f"  {len(missing):4d} branches not taken in {name}: {ways}{', ...' if len(missing) > WAYS else ''}")
    taken, branches, *_ = sums["all"]
    raise SystemExit(0 if taken >= AIM * branches else 1)


if __name__ == "__main__":
    main()
