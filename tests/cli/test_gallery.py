"""`eventsim gallery`: list, tell, copy."""

import json
import re

import numpy as np
import pytest

from eventsim import gallery, load_scene
from eventsim.scene.gallery import names


def test_the_list_has_a_line_for_every_scene(eventsim):
    result = eventsim("gallery")
    assert result.exit_code == 0
    for name in names():
        assert f"  {name} " in result.stdout


def test_one_scene_is_told_with_its_parameters(eventsim):
    result = eventsim("gallery", "galperin")
    for words in ("What happens", "Why", "Source", "A question", "mass_ratio", "100.0"):
        assert words in result.stdout


def test_json_lists_and_tells(eventsim):
    listed = json.loads(eventsim("gallery", "--json").stdout)
    told = json.loads(eventsim("gallery", "galperin", "--json").stdout)
    assert [scene["name"] for scene in listed["scenes"]] == names()
    assert told["parameters"] == {"mass_ratio": 100.0}


@pytest.mark.parametrize("name", ["break", "cooling", "stadium", "periodic-fluid"])
@pytest.mark.parametrize("suffix", [".toml", ".json"])
def test_a_copy_is_the_same_scene_bit_for_bit(eventsim, tmp_path, name, suffix):
    target = tmp_path / f"my{suffix}"
    assert eventsim("gallery", name, "--copy", target).exit_code == 0
    copied, scene = load_scene(target), gallery(name)
    for key in ("position", "velocity", "radius", "mass"):
        assert np.array_equal(getattr(copied.disks, key), getattr(scene.disks, key))
    for key in ("domain", "walls", "gravity", "restitution", "contact_duration", "until", "events", "start_time"):
        assert getattr(copied, key) == getattr(scene, key)


@pytest.mark.parametrize("name", ["two-disks", "stadium", "channel"])
def test_a_copy_has_its_vectors_in_one_line(eventsim, tmp_path, name):
    target = tmp_path / "copy.toml"
    eventsim("gallery", name, "--copy", target)
    text = target.read_text()
    assert re.search(r"(?m)^position = \[[-\d.e]+, [-\d.e]+\]$", text)
    assert not re.search(r"(?m)^ +[-\d.e]+,$", text)


def test_a_copy_may_have_settings(eventsim, tmp_path):
    target = tmp_path / "my.toml"
    eventsim("gallery", "galperin", "--set", "mass_ratio=16", "--copy", target)
    assert load_scene(target).disks.mass.tolist() == [1.0, 16.0]


def test_a_copy_overwrites_nothing(eventsim, tmp_path):
    target = tmp_path / "my.toml"
    target.write_text("mine")
    result = eventsim("gallery", "break", "--copy", target)
    assert result.exit_code == 2
    assert target.read_text() == "mine"


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["brek"], "did you mean 'break'"),
        (["--copy", "a.toml"], "name the scene"),
        (["break", "--copy", "a.txt"], ".toml, .json"),
        (["break", "--set", "speed=2"], "--copy"),
    ],
)
def test_bad_usage_is_one_clear_message(eventsim, tmp_path, monkeypatch, words, expected):
    monkeypatch.chdir(tmp_path)
    result = eventsim("gallery", *words)
    assert result.exit_code == 2
    assert expected in result.stderr
    assert list(tmp_path.iterdir()) == []
