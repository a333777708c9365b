"""The README does what it says: its scene, its commands and its Python run as they stand there."""

import re
import shlex
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from eventsim.cli import main

README = (Path(__file__).parent.parent / "README.md").read_text()
BLOCKS = re.findall(r"^```(\w+)\n(.*?)^```", README, flags=re.DOTALL | re.MULTILINE)


def blocks(language):
    return [text for kind, text in BLOCKS if kind == language]


def eventsim_commands():
    lines = (line.strip() for text in blocks("bash") for line in text.splitlines())
    return [shlex.split(line, comments=True)[1:] for line in lines if line.startswith("eventsim")]


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A folder with the README's scene in it, and the log that its first command writes."""
    folder = tmp_path_factory.mktemp("readme")
    (scene,) = blocks("toml")
    (folder / "ramp.toml").write_text(scene)
    result = CliRunner().invoke(main, ["run", "break", "--log", str(folder / "break.csv")])
    assert result.exit_code == 0
    return folder


LONG = ("animate", "figure", "live", "measure", "sweep", "stress", "validate", "chart")
"""Commands that take long, or serve until they are ended: their own tests run them, here their words are parsed."""


def test_the_commands_do_what_they_say(place, monkeypatch):
    monkeypatch.chdir(place)
    commands = [words for words in eventsim_commands() if not words or words[0] not in LONG]
    assert len(commands) >= 8
    for words in commands:
        if "gas.csv" in words:  # a log that the reader has made
            result = CliRunner().invoke(main, ["run", "gas", "--events", "200", "--log", "gas.csv"])
            assert result.exit_code == 0
        result = CliRunner().invoke(main, words)
        assert result.exit_code == 0, (words, result.output)


@pytest.mark.parametrize("words", [words for words in eventsim_commands() if words and words[0] in LONG], ids=" ".join)
def test_the_words_of_a_long_command_are_right(place, monkeypatch, words):
    monkeypatch.chdir(place)
    with click.Context(main) as context:
        command = main.get_command(context, words[0])
        assert command is not None
        command.make_context(words[0], words[1:], parent=context)


@pytest.mark.parametrize("code", blocks("python"))
def test_the_python_runs(place, monkeypatch, code):
    monkeypatch.chdir(place)
    exec(compile(code, "README.md", "exec"), {})


def test_it_can_be_read_in_one_sitting():
    assert len(README.splitlines()) <= 250
