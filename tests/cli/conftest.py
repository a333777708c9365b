"""A command line to try things on, and a scene file for it."""

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from eventsim.cli import main

SCENE = """
name = "two in a box"
until = 4.0

[domain]
kind = "box"
size = [4.0, 2.0]

[[disk]]
position = [0.5, 1.0]
velocity = [1.0, 0.0]
radius = 0.25

[[disk]]
position = [2.5, 1.0]
radius = 0.25
mass = 3.0
"""

Command = Callable[..., Result]


@pytest.fixture
def eventsim() -> Command:
    """Call the command line in this process: eventsim("run", "break") gives exit_code, stdout, stderr."""

    def call(*words: object) -> Result:
        result = CliRunner().invoke(main, [str(word) for word in words], prog_name="eventsim")
        if result.exception is not None and not isinstance(result.exception, SystemExit):
            raise result.exception
        return result

    return call


@pytest.fixture
def scene_file(tmp_path: Path) -> Path:
    """A scene of two disks that meet once before each of them meets a wall."""
    path = tmp_path / "two.toml"
    path.write_text(SCENE)
    return path
