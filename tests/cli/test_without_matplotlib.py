"""The core has no matplotlib: who asks for a picture is told what to install, all else works."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

PROGRAM = "import sys; sys.modules['matplotlib'] = None; from eventsim.__main__ import main; main()"
NEEDED = "pictures need matplotlib: pip install 'eventsim-disks[figures]'"


def called(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    command = [sys.executable, "-c", PROGRAM, *words]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=120, check=False)


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    folder = tmp_path_factory.mktemp("core")
    done = called(folder, "run", "two-disks", "--log", "a.csv")
    assert done.returncode == 0, done.stderr
    return folder / "a.csv"


@pytest.mark.parametrize("words", ["figure --help", "check gas", "measure a.csv", "state a.csv --at 1", "gallery tie"])
def test_what_draws_nothing_works(log, words):
    done = called(log.parent, *words.split())
    assert done.returncode == 0, done.stderr
    assert "matplotlib" not in done.stdout + done.stderr


@pytest.mark.parametrize(
    "words",
    [
        "figure a.csv --kind raster --out a.png",
        "animate a.csv --out a.html",
        "sweep gas --set n=4,5 --events 10 --out b.csv --figure a.png",
        "validate two-disks --csv b.csv --figure a.png",
        "stress graze --csv b.csv --out a.png",
        "chart two-disks --csv b.csv --out a.png",
    ],
)
def test_a_picture_is_refused_in_a_sentence_before_anything_is_run(log, words):
    done = called(log.parent, *words.split())
    assert done.returncode == 2
    assert NEEDED in done.stderr
    assert "Traceback" not in done.stderr
    assert [path.name for path in log.parent.iterdir()] == ["a.csv"]


def test_a_notebook_shows_text_instead_of_the_player(log):
    code = "import sys; sys.modules['matplotlib'] = None; import eventsim as es; "
    code += "print(es.simulate(es.gallery('two-disks'), log=True)._repr_html_())"
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, timeout=60, check=True)
    assert done.stdout == "None\n"
