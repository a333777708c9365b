"""The reference is built from what is there: every public name, every verb, every page."""

import html
import re

import pytest

import eventsim
from eventsim.cli.program import VERBS
from tests import reference

pytest.importorskip("pdoc", reason="pdoc is not installed (the extra test brings it)")


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    files = reference.build(tmp_path_factory.mktemp("reference"))
    return {file.stem: html.unescape(file.read_text(encoding="utf-8")) for file in files}


def test_every_public_name_has_its_place_and_says_what_it_is(built):
    names = set(eventsim.__all__) - {"__version__"}
    assert names <= set(re.findall(r'<section id="(\w+)">', built["eventsim"]))
    bare = [name for name in names if not (getattr(eventsim, name).__doc__ or "").strip()]
    assert bare == []


def test_every_verb_shows_its_help(built):
    for verb in VERBS:
        assert f"Usage: eventsim {verb} " in built["command_line"]


def test_pages_are_part_of_it(built):
    assert "The format of the event log" in built["log_format"]
    assert "Which tool when" in built["which_tool"]
    assert all(f'href="{name}.html"' in built["index"] for name in ("eventsim", "command_line", "log_format", "which_tool"))
