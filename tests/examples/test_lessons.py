"""The lessons run and check themselves, and the notebook of each is its script with what that prints."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.examples import notebooks
from tests.examples.notebooks import LESSONS, cells_of

ROOT = LESSONS.parents[1]
NAMES = sorted(path.stem for path in LESSONS.glob("*.py"))
STEPS = ("Question", "Prediction", "Run", "Figure", "Check", "Exercise", "Answer")


def told(name: str, *arguments: str, folder: Path = LESSONS, here: Path | None = None) -> str:
    """What a lesson of a folder prints when it runs as a script, in the folder `here`; its own checks must hold."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "MPLBACKEND": "Agg"}
    ran = subprocess.run(
        [sys.executable, "-W", "ignore::UserWarning", str(folder / f"{name}.py"), *arguments], cwd=here,
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


def test_students_get_lessons_without_answers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", ["notebooks", "--without-answers", str(tmp_path / "students")])
    assert notebooks.main() == 0
    for name in NAMES:
        script = (tmp_path / "students" / f"{name}.py").read_text()
        question, answer = (LESSONS / f"{name}.py").read_text().split("\n#\n# **Answer.**")
        assert script == f"{question}\n\n# %%\n# your answer\n"
        assert not any(line in script for line in answer.splitlines() if line.startswith("assert "))
        made = json.loads((tmp_path / "students" / f"{name}.ipynb").read_text())
        assert [(cell["cell_type"], "".join(cell["source"])) for cell in made["cells"]] == cells_of(script)
        assert not any(cell.get("outputs") for cell in made["cells"])
    told("galperin", "--save", folder=tmp_path / "students", here=tmp_path)
    assert (tmp_path / "galperin.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("name", NAMES)
def test_a_lesson_saves_each_picture_that_it_shows(name: str) -> None:
    text = (LESSONS / f"{name}.py").read_text()
    saved = re.findall(r'^plt\.savefig\("([\w-]+)\.png"\) if SAVE else plt\.show\(\)$', text, re.MULTILINE)
    assert len(set(saved)) == text.count("plt.show()") > 0
    assert all(picture.startswith(name) for picture in saved)


@pytest.mark.slow
@pytest.mark.timeout(1600)
@pytest.mark.parametrize("name", NAMES)
def test_a_lesson_holds_in_full(name: str) -> None:
    told(name, "--full")
