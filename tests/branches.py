"""Which branches of the heart the tests take, kernels as plain Python: python -m tests.branches [PYTEST ARGUMENTS ...].

Without arguments it runs the tests of formulas, scene, record and engines.  Left out is what numba alone can run.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

FOLDERS = ("formulas", "scene", "record", "engines")
COMPILED = ("numba_compiler.py", "numba_memory.py")
AIM = 0.95


def measured(arguments: list[str]) -> dict[str, dict[str, int]]:
    """Run pytest; what coverage counted in each file of the heart."""
    with tempfile.TemporaryDirectory() as folder:
        data, report = Path(folder, "data"), Path(folder, "report.json")
        environment = os.environ | {"EVENTSIM_INTERPRET": "1", "COVERAGE_FILE": str(data)}
        command = [sys.executable, "-m", "coverage"]
        source = ",".join(f"eventsim/{name}" for name in FOLDERS)
        tests = ["-m", "pytest", "-q", "-p", "no:xdist", *arguments]
        subprocess.run([*command, "run", "--branch", f"--source={source}", *tests], env=environment, check=False)
        subprocess.run([*command, "json", "-q", "-o", str(report)], env=environment, check=True)
        files = json.loads(report.read_text())["files"]
    return {name: found["summary"] for name, found in files.items() if Path(name).name not in COMPILED}


def main() -> None:
    """Print the share of branches and of lines, folder by folder, and the files that have the most to be looked at."""
    found = measured(sys.argv[1:] or [f"tests/{name}" for name in FOLDERS])
    sums: dict[str, list[int]] = defaultdict(lambda: [0, 0, 0, 0])
    for name, summary in found.items():
        counts = [summary[key] for key in ("covered_branches", "num_branches", "covered_lines", "num_statements")]
        for folder in (Path(name).parts[1], "all"):
            sums[folder] = [a + b for a, b in zip(sums[folder], counts, strict=True)]
    for folder, (taken, branches, run, lines) in sorted(sums.items()):
        shares = 100 * taken / branches, 100 * run / lines
        print(f"{folder:10s} {shares[0]:6.1f} % of {branches} branches, {shares[1]:6.1f} % of {lines} statements")
    worst = sorted(found, key=lambda name: found[name]["missing_branches"], reverse=True)[:12]
    for name in worst:
        print(f"  {found[name]['missing_branches']:4d} branches not taken in {name}")
    taken, branches, *_ = sums["all"]
    raise SystemExit(0 if taken >= AIM * branches else 1)


if __name__ == "__main__":
    main()
