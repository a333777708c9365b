"""A scene has one name, in all that is printed, drawn and written; a file without a name gives its own."""

import json
import re

import pytest
from click.testing import CliRunner

import eventsim as es
from eventsim.cli import main
from eventsim.show.output import title_of
from eventsim.show.player.page import page

TEXT = """
until = 1.0
[domain]
kind = "box"
size = [2.0, 1.0]
[[disk]]
position = [0.5, 0.5]
velocity = [1.0, 0.2]
radius = 0.1
[[disk]]
position = [1.5, 0.5]
radius = 0.1
"""


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    folder = tmp_path_factory.mktemp("names")
    (folder / "two-balls.toml").write_text(TEXT)
    (folder / "named.toml").write_text('name = "the duel"\n' + TEXT)
    return folder


def asked(*words):
    result = CliRunner().invoke(main, [str(word) for word in words])
    assert result.exit_code == 0, result.output
    return result.stdout


@pytest.mark.parametrize(("file", "name"), [("two-balls", "two-balls"), ("named", "the duel")])
def test_every_output_calls_it_alike(place, file, name):
    scene, log, copy = place / f"{file}.toml", place / f"{file}.csv", place / f"{file}-copy.toml"
    told = json.loads(asked("run", scene, "--log", log, "--json"))
    assert told["name"] == name
    run_title, check_title = (asked(verb, scene).splitlines()[0] for verb in ("run", "check"))
    assert name in run_title
    assert name in check_title
    assert json.loads(asked("check", scene, "--json"))["name"] == name
    read = es.load_log(log)
    assert title_of(read) == name
    assert re.search("<title>(.*)</title>", page(read))[1] == name
    read.scene.save(copy)
    assert es.load_scene(copy).name == name


def test_a_log_of_a_scene_without_a_name_is_called_after_its_file(place):
    scene = es.Scene(es.Disks([(1, 0.5)], [(1, 0)], radius=0.1), es.Box((2, 1)), until=1.0)
    assert scene.called == "a scene without a name"
    path = place / "mine.npz"
    es.simulate(scene, log=True).log.save(path)
    assert title_of(es.load_log(path)) == "mine"


def test_a_file_named_without_its_end_and_a_scene_in_place_of_a_log_are_told(place, monkeypatch):
    monkeypatch.chdir(place)
    refused = CliRunner().invoke(main, ["check", "two-balls"])
    assert refused.exit_code == 2
    assert "two-balls.toml is here" in refused.output
    refused = CliRunner().invoke(main, ["state", "two-balls.toml", "--at", "1"])
    assert refused.exit_code == 2
    assert "eventsim run two-balls.toml --log two-balls.csv" in refused.output


def test_a_parameter_of_a_built_in_scene_that_is_misspelt_is_told_with_its_own():
    refused = CliRunner().invoke(main, ["run", "galperin", "--set", "massratio=5"])
    assert refused.exit_code == 2
    assert "did you mean 'mass_ratio'?" in refused.output
