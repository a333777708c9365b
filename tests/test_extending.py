"""The page on extending does what it says: its files and lines, put into a copy of the package, give what its commands show."""

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import eventsim

PACKAGE = Path(eventsim.__file__).parent
PAGE = (PACKAGE / "EXTENDING.md").read_text()
PARTS = {part.partition("\n")[0]: part for part in re.split(r"^## ", PAGE, flags=re.MULTILINE)[1:]}
BLOCK = re.compile(r"(?P<above>[^\n]*)\n\n```(?P<kind>\w+)\n(?P<text>.*?)^```", re.DOTALL | re.MULTILINE)
COMMANDS = [
    pytest.param(name, marks=pytest.mark.slow if "--engine fast" in part else ())  # a copy has kernels of its own
    for name, part in PARTS.items()
    if "```console" in part
]


def into(text, anchor, lines):
    """The text with lines below the first line that is the anchor."""
    found = text.index(f"{anchor}\n") + len(anchor) + 1
    return text[:found] + lines + text[found:]


def put(root, block):
    """Do what a block says; the commands of a console block are returned."""
    above, kind, text = block["above"], block["kind"], block["text"]
    named = re.findall(r"`([^`]+)`", above)
    if kind == "console":
        return text
    if above.startswith("New file"):
        (root / named[0]).write_text(text)
    elif ", below `" in above:
        path = root / named[0]
        path.write_text(into(path.read_text(), named[1], text))
    elif kind == "diff":
        path = root / named[0]
        old, new = (next(line[1:] for line in text.splitlines() if line[0] == sign) for sign in "-+")
        assert path.read_text().count(old) == 1, old
        path.write_text(path.read_text().replace(old, new))
    else:
        assert kind == "toml", above
        (root / "scene.toml").write_text(text)
    return ""


@pytest.mark.parametrize("name", COMMANDS)
def test_what_the_page_adds_is_there(tmp_path, name):
    shutil.copytree(PACKAGE, tmp_path / "eventsim", ignore=shutil.ignore_patterns("__pycache__"))
    consoles = "".join(put(tmp_path, block) for block in BLOCK.finditer(PARTS[name]))
    commands = re.findall(r"^\$ eventsim (.*)\n(.*)$", consoles, flags=re.MULTILINE)
    assert commands
    for words, shown in commands:
        plain = {} if "--engine fast" in words else {"NUMBA_DISABLE_JIT": "1"}  # compiling would take longer than the run
        surroundings = {**os.environ, "PYTHONPATH": str(tmp_path), **plain}
        done = subprocess.run(
            [sys.executable, "-m", "eventsim", *shlex.split(words)],
            cwd=tmp_path, env=surroundings, capture_output=True, text=True, timeout=200, check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        assert shown in " ".join((done.stdout + done.stderr).split())  # lines are folded


def test_every_file_that_it_names_exists():
    named = set(re.findall(r"`((?:\w+/)+\w+\.py)`", PAGE))
    made = {path.removeprefix("eventsim/") for path in re.findall(r"New file `(.*?)`", PAGE)}
    assert named
    for path in named:
        places = (PACKAGE.parent / path, PACKAGE / path, PACKAGE.parent / "tests" / path)
        assert path.removeprefix("eventsim/") in made or any(place.exists() for place in places), path
