"""What is declared, what is tested, and what is built say the same."""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

HERE = Path(__file__).parent
ROOT = HERE.parents[1]


def versions_in(name: str) -> dict[str, str]:
    lines = (HERE / name).read_text().splitlines()
    return dict(line.split("==") for line in lines if "==" in line and not line.startswith("#"))


def test_the_lowest_versions_are_those_that_are_declared() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    extras = project["optional-dependencies"]
    chosen = [needs for name, needs in extras.items() if name not in ("all", "test")]
    declared = sorted({need for needs in (project["dependencies"], *chosen) for need in needs})
    parts = [re.fullmatch(r"([A-Za-z0-9_.-]+)>=([0-9.]+)", need) for need in declared]
    assert all(parts), declared
    found = versions_in("lowest.txt")
    for part in parts:
        name, least = part.groups()
        assert found[name] == least + ".0" * (found[name].count(".") - least.count(".")), name
    assert len(found) == len(parts)


def test_the_lock_has_all_that_is_needed() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    needed = {re.split(r"[>=\[]", need)[0] for needs in project["optional-dependencies"].values() for need in needs}
    assert needed - {"eventsim-disks"} - set(versions_in("lock.txt")) == set()


@pytest.mark.slow
def test_wheel_and_sdist_are_built_to_the_same_bytes(tmp_path: Path) -> None:
    """From copies in other folders, at other times."""
    pytest.importorskip("hatchling")
    hashes = []
    for name, time in (("a", 1_500_000_000), ("elsewhere/b", 1_700_000_000)):
        copy = tmp_path / name
        ignored = shutil.ignore_patterns(".git", ".venv", "*_cache", "__pycache__")
        shutil.copytree(ROOT, copy, ignore=ignored)
        for path in copy.rglob("*"):
            os.utime(path, (time, time))
        subprocess.run([sys.executable, "-m", "hatchling", "build"], cwd=copy, check=True, capture_output=True)
        hashes.append({file.name: hashlib.sha256(file.read_bytes()).hexdigest() for file in (copy / "dist").iterdir()})
    assert len(hashes[0]) == 2
    assert hashes[0] == hashes[1]
