"""The lessons run and check themselves, and the notebook of each is its script with what that prints."""

import json
import os
import subprocess
import sys

import pytest

from tests.examples.notebooks import LESSONS, cells_of

ROOT = LESSONS.parents[1]
NAMES = sorted(path.stem for path in LESSONS.glob("*.py"))
STEPS = ("Question", "Prediction", "Run", "Figure", "Check", "Exercise", "Answer")


def told(name: str, *arguments: str) -> str:
    """What a lesson prints when it runs as a script; its own checks must hold."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "MPLBACKEND": "Agg"}
    ran = subprocess.run(
        [sys.executable, "-W", "ignore::UserWarning", str(LESSONS / f"{name}.py"), *arguments],
        capture_output=True, text=True, env=environment, timeout=1500, check=False,
    )  # fmt: skip
    assert ran.returncode == 0, ran.stdout + ran.stderr
    return ran.stdout


def test_there_are_ten() -> None:
    assert len(NAMES) == 10
    told = (LESSONS / "README.md").read_text()
    assert all(f"`{name}`" in told for name in NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_a_lesson_asks_predicts_runs_draws_checks_and_answers_in_this_order(name: str) -> None:
    text = (LESSONS / f"{name}.py").read_text()
    places = [text.find(f"**{step}") for step in STEPS]
    assert -1 not in places
    assert places == sorted(places)
    assert "assert " in text


@pytest.mark.parametrize("name", NAMES)
def test_a_lesson_runs_and_its_notebook_shows_the_same(name: str) -> None:
    notebook = json.loads((LESSONS / f"{name}.ipynb").read_text())
    cells = [(cell["cell_type"], "".join(cell["source"])) for cell in notebook["cells"]]
    assert cells == cells_of((LESSONS / f"{name}.py").read_text()), "python -m tests.examples.notebooks makes it anew"
    outputs = [output for cell in notebook["cells"] for output in cell.get("outputs", ())]
    assert any("image/png" in output.get("data", ()) for output in outputs)
    assert told(name) == "".join("".join(output["text"]) for output in outputs if output["output_type"] == "stream")


@pytest.mark.slow
@pytest.mark.timeout(1600)
@pytest.mark.parametrize("name", NAMES)
def test_a_lesson_holds_in_full(name: str) -> None:
    told(name, "--full")
