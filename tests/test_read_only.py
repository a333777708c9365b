"""Where nothing may be written but what is asked for: packages and home of another owner, as in a cluster or a container."""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "eventsim"
PR_CAPBSET_DROP, CAP_DAC_OVERRIDE = 24, 1
"""Of Linux: without it even root heeds the permissions of files, once it has become another program."""


def heed_permissions() -> None:
    if os.geteuid() == 0:
        ctypes.CDLL(None).prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE)


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the package, a home, and a folder in which all is to be done; only the last can be written to."""
    place = tmp_path_factory.mktemp("place")
    (place / "home").mkdir()
    (place / "work").mkdir()
    shutil.copytree(PACKAGE, place / "site" / "eventsim", ignore=shutil.ignore_patterns("__pycache__"))
    for folder in (place / "home", *(path for path in (place / "site").rglob("*") if path.is_dir()), place / "site"):
        folder.chmod(0o555)
    return place


def run(place: Path, *words: str) -> subprocess.CompletedProcess[str]:
    environment = {"PATH": os.environ["PATH"], "HOME": str(place / "home"), "PYTHONPATH": str(place / "site")}
    return subprocess.run(
        [sys.executable, "-m", "eventsim", *words],
        env=environment, cwd=place / "work", preexec_fn=heed_permissions, capture_output=True, text=True, check=False,
    )  # fmt: skip


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="permissions and capabilities of Linux")
@pytest.mark.parametrize(
    "words",
    [
        ("run", "break", "--log", "break.npz"),
        pytest.param(("figure", "break", "--kind", "speeds", "--out", "speeds.png"), marks=pytest.mark.slow),
        pytest.param(("run", "gas", "--events", "500", "--engine", "fast", "--log", "gas.csv"), marks=pytest.mark.slow),
    ],
)
def test_the_command_works_where_packages_and_home_are_read_only(place: Path, words: tuple[str, ...]) -> None:
    done = run(place, *words)
    assert done.returncode == 0, done.stderr
    assert (place / "work" / words[-1]).exists()
    assert "Traceback" not in done.stderr
    assert not list(place.glob("site/**/__pycache__"))


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="permissions and capabilities of Linux")
def test_a_folder_that_cannot_be_written_to_is_told(place: Path) -> None:
    done = run(place, "run", "two-disks", "--log", str(place / "home" / "two.csv"))
    assert done.returncode == 2
    assert "two.csv" in done.stderr
    assert "no permission to write there" in done.stderr
    assert "Traceback" not in done.stderr
