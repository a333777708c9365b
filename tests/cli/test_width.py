"""What is printed for people fits 80 columns, whatever it says; what is printed for programs is not broken."""

import json

import pytest
from click.testing import CliRunner

from eventsim.cli import main
from eventsim.cli.folding import folded, reflowed, tables
from eventsim.cli.program import VERBS

PRINTED = (
    "", "--help", *(f"{verb} --help" for verb in VERBS),
    "gallery", "gallery ellipse", "gallery break", "check gas", "check jar", "check cooling", "check sculpture",
    "run break", "run break --horizon", "run mixture --events 50 --log m.csv", "run collapse --set restitution=0.01",
    "check m.csv", "measure m.csv", "measure gas --set n=50 --events 300 --profile y", "state m.csv --at 0 --out s.csv",
    "certify two-disks", "stress --list",
    "validate two-disks --against stepped --dt 0.01",
)  # fmt: skip


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    folder = tmp_path_factory.mktemp("width")
    patch = pytest.MonkeyPatch()
    patch.chdir(folder)
    assert CliRunner().invoke(main, ["run", "mixture", "--events", "50", "--log", "m.csv", "-q"]).exit_code == 0
    yield folder
    patch.undo()


@pytest.fixture(autouse=True)
def lines_are_whole():
    """Not here."""


@pytest.mark.parametrize("line", PRINTED)
def test_it_fits(place, line):
    told = CliRunner().invoke(main, line.split())
    assert told.exit_code in (0, 3), told.output
    long = [text for text in told.output.splitlines() if len(text) > 80]
    assert long == []


def test_data_are_not_broken(place):
    told = json.loads(CliRunner().invoke(main, ["check", "gas", "--json"]).stdout)
    assert max(map(len, map(str, told.values()))) > 80


def test_a_long_line_goes_on_below_its_last_column():
    assert folded("short") == "short"
    text = "  label   " + "word " * 20
    first, *others = folded(text.rstrip()).split("\n")
    assert first.startswith("  label   word")
    assert all(other.startswith(" " * 10 + "word") for other in others)
    assert " ".join(folded(text).split()) == " ".join(text.split())


def test_columns_that_do_not_fit_stand_below_with_the_first_one():
    head, rows = ["engine", *(f"{k}".rjust(30, "-") for k in range(3))], [["a", "1", "2", "3"], ["b", "4", "5", "6"]]
    lines = list(tables(head, rows))
    assert max(map(len, lines)) <= 80
    assert [line.split() for line in lines] == [
        ["engine", *head[1:3]], ["a", "1", "2"], ["b", "4", "5"], [], ["engine", head[3]], ["a", "3"], ["b", "6"],
    ]  # fmt: skip
    assert list(tables(["engine", "x"], [["a", "1"]])) == ["engine  x", "a       1"]


def test_paragraphs_are_broken_anew():
    text = "Title\n    " + "\n    ".join(["one two three four"] * 12) + "\n\nNext\n    end"
    lines = reflowed(text).split("\n")
    assert lines[0] == "Title"
    assert lines[-3:] == ["", "Next", "    end"]
    assert max(map(len, lines)) <= 80
    assert len(lines) < 12
