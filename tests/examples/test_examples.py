"""The examples run as they stand in their folder, and say what the file beside them says."""

import os
import subprocess
import sys
from pathlib import Path
from shutil import which

import pytest

import eventsim as es

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "examples"
STORIES = sorted(path.name for path in EXAMPLES.glob("*.py"))
SCENES = sorted(path.name for path in EXAMPLES.iterdir() if path.suffix in (".toml", ".json"))


@pytest.mark.parametrize("name", STORIES)
def test_a_story_prints_the_output_beside_it(name: str) -> None:
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    told = subprocess.run(
        [sys.executable, EXAMPLES / name], capture_output=True, text=True, env=environment, timeout=120, check=False
    )
    assert told.returncode == 0, told.stderr
    assert told.stdout == (EXAMPLES / name).with_suffix(".out").read_text()


@pytest.mark.parametrize("name", STORIES)
def test_a_story_is_at_most_50_lines_long(name: str) -> None:
    assert len((EXAMPLES / name).read_text().splitlines()) <= 50


@pytest.mark.parametrize("name", SCENES)
def test_a_scene_file_runs_to_its_end(name: str) -> None:
    scene = es.load_scene(EXAMPLES / name)
    run = es.simulate(scene, engine="reference")
    assert run.stopped in ("until", "events", "quiet")
    assert run.counters.events > 0
    assert run.residuals.max_overlap < 1e-12


@pytest.mark.skipif(which("node") is None, reason="node is not installed")
def test_the_engine_in_javascript_writes_the_positions_beside_it() -> None:
    told = subprocess.run(["node", EXAMPLES / "engine.js"], capture_output=True, text=True, timeout=60, check=True)
    assert told.stdout == (EXAMPLES / "javascript.csv").read_text()


def test_each_output_belongs_to_a_story() -> None:
    assert sorted(path.stem for path in EXAMPLES.glob("*.out")) == sorted(Path(name).stem for name in STORIES)
