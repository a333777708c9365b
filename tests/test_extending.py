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


def copied(folder):
    """Put a copy of the package into a folder."""
    shutil.copytree(PACKAGE, folder / "eventsim", ignore=shutil.ignore_patterns("__pycache__"))


def told_by(folder, *words, **surroundings):
    """What a copy says to the words of a command."""
    return subprocess.run(
        [sys.executable, *words], cwd=folder, capture_output=True, text=True, timeout=200, check=False,
        env={**os.environ, "PYTHONPATH": str(folder), **surroundings},
    )  # fmt: skip


@pytest.mark.parametrize("name", COMMANDS)
def test_what_the_page_adds_is_there(tmp_path, name):
    copied(tmp_path)
    consoles = "".join(put(tmp_path, block) for block in BLOCK.finditer(PARTS[name]))
    commands = re.findall(r"^\$ eventsim (.*)\n(.*)$", consoles, flags=re.MULTILINE)
    assert commands
    for words, shown in commands:
        plain = {} if "--engine fast" in words else {"NUMBA_DISABLE_JIT": "1"}  # compiling would take longer than the run
        done = told_by(tmp_path, "-m", "eventsim", *shlex.split(words), **plain)
        assert done.returncode == 0, done.stderr
        assert shown in " ".join((done.stdout + done.stderr).split())  # lines are folded


@pytest.mark.parametrize(
    ("name", "old", "new", "problem"),
    [
        ("A wall", "center = [0.0, 0.0]", "center = [1e17, 0.0]", "wall[0].side = 3.0: must be longer"),
        ("A wall", '"hexagon"', '"hexagno"', 'write: kind = "hexagon"'),
        ("A law of contacts", "softening = 0.5", "softening = 0.0", "softening = 0.0: must be a finite number above 0"),
        ("A law of contacts", "softening = 0.5", "softening = 0.5, yield_speed = 1.0", "one law says what comes back"),
    ],
)
def test_what_the_page_adds_is_refused_where_it_cannot_be(tmp_path, name, old, new, problem):
    copied(tmp_path)
    for block in BLOCK.finditer(PARTS[name]):
        put(tmp_path, block)
    scene = tmp_path / "scene.toml"
    assert old in scene.read_text()
    scene.write_text(scene.read_text().replace(old, new))
    done = told_by(tmp_path, "-m", "eventsim", "check", "scene.toml")
    assert done.returncode == 2
    assert problem in " ".join(done.stderr.split())


def test_what_the_page_adds_goes_together_and_keeps_imports_and_lines_in_order(tmp_path):
    pytest.importorskip("ruff")
    rules = PACKAGE.parent / "pyproject.toml"
    if not rules.exists():
        pytest.skip("an installed package has no rules for ruff")
    copied(tmp_path)
    for name in COMMANDS:
        for block in BLOCK.finditer(PARTS[name.values[0]]):
            put(tmp_path, block)
    shutil.copy(rules, tmp_path)
    done = told_by(tmp_path, "-m", "ruff", "check", "eventsim")
    assert done.returncode == 0, done.stdout
    code = "import eventsim as es; print(es.Hexagon((0, 0), 1).contains(es.Disks([[0, 0]], radius=0).position))"
    public = told_by(tmp_path, "-c", code)
    assert public.stdout.strip() == "[ True]", public.stderr


def test_every_file_that_it_names_exists():
    named = set(re.findall(r"`((?:\w+/)+\w+\.py)`", PAGE))
    made = {path.removeprefix("eventsim/") for path in re.findall(r"New file `(.*?)`", PAGE)}
    assert named
    for path in named:
        places = (PACKAGE.parent / path, PACKAGE / path, PACKAGE.parent / "tests" / path)
        assert path.removeprefix("eventsim/") in made or any(place.exists() for place in places), path
