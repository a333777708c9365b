"""A table of measured rows: printed as it grows, kept as CSV with the commit that was measured and the machine."""

from __future__ import annotations

import argparse
import csv
import os
import platform
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path


def whole(text: str) -> int:
    """A whole number that may be written as 1e6."""
    return int(float(text))


def arguments(doc: str | None) -> argparse.ArgumentParser:
    """The command line of a benchmark: its module's text, and where to keep the table."""
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--csv", type=Path, help="write the table here as well")
    return parser


def commit() -> str:
    """What is measured."""
    command = ["git", "rev-parse", "--short", "HEAD"]
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout.strip()


def machine() -> str:
    """What it is measured on: the processor's name where the system tells it, and how many cores there are."""
    names = [line.split(":")[1].strip() for line in _about_processors() if line.startswith("model name")]
    return f"{names[0] if names else platform.machine()}, {os.cpu_count()} cores, {platform.system()}"


def _about_processors() -> list[str]:
    about = Path("/proc/cpuinfo")
    return about.read_text().splitlines() if about.exists() else []


class Table:
    """Rows of a benchmark; `columns` are printed, what else a row has is kept in the file only."""

    def __init__(self, columns: Sequence[str], width: int = 14) -> None:
        self._columns = columns
        self._width = width
        self._rows: list[dict[str, object]] = []
        self._commit = commit()
        print(" ".join(f"{name:>{width}}" for name in columns), flush=True)

    def add(self, row: Mapping[str, object]) -> None:
        """Print a row, and keep it."""
        self._rows.append({**row, "commit": self._commit, "machine": machine()})
        print(" ".join(f"{row[name]!s:>{self._width}}" for name in self._columns), flush=True)

    def write(self, path: Path | None) -> None:
        """Write the rows to a file, if there is to be one."""
        if path is None or not self._rows:
            return
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("w", newline="") as stream:
            writer = csv.DictWriter(stream, list(self._rows[0]))
            writer.writeheader()
            writer.writerows(self._rows)
