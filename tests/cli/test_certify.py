"""`eventsim certify`, and the horizon of `run` and `check`."""

import json

import pytest

from eventsim.record.log import load_log


def test_a_proof_is_told(eventsim, scene_file):
    result = eventsim("certify", scene_file)
    assert result.exit_code == 0
    for words in ("proven", "bits", "float64", "disk 1: x = ", "stopped  until"):
        assert words in result.stdout


def test_the_keys_of_json_are_those_of_the_help(eventsim):
    result = eventsim("certify", "galperin", "--json", "--events", 20)
    data = json.loads(result.stdout)
    assert data["proven"] == 20
    assert data["difference"] is None
    assert data["agreed"] == 20
    assert len(data["enclosures"]) == 2
    assert data["enclosures"][0]["x_error"] < 1e-14
    said = eventsim("certify", "--help").stdout
    assert all(key in said for key in data)


def test_the_certified_log_is_a_log(eventsim, tmp_path):
    path = tmp_path / "certified.jsonl"
    assert eventsim("certify", "two-disks", "--log", path, "--quiet").exit_code == 0
    log = load_log(path)
    assert len(log) == 8
    assert log.provenance.engine == "certified"


def test_a_scene_that_cannot_be_proven_is_refused_with_a_reason(eventsim):
    result = eventsim("certify", "funnel")
    assert result.exit_code == 2
    assert "quartic" in result.stderr


def test_an_end_of_the_bits_is_told_and_keeps_what_is_proven(eventsim):
    result = eventsim("certify", "gas", "--set", "n=16", "--events", 500, "--bits", 128, "--most-bits", 128)
    assert result.exit_code == 3
    assert "128 bits are the most allowed" in result.stdout


@pytest.mark.parametrize("verb", ["run", "check"])
def test_the_horizon_is_in_the_summary(eventsim, verb):
    result = eventsim(verb, "gas", "--set", "n=16", "--set", "events=600", "--set", "until=100", "--horizon")
    assert result.exit_code == 0
    assert "horizon" in result.stdout
    assert "the trajectory is right until about event" in result.stdout


@pytest.mark.parametrize("verb", ["run", "check"])
def test_the_horizon_is_in_the_json(eventsim, verb):
    words = (verb, "two-disks", "--json")
    assert json.loads(eventsim(*words).stdout)["horizon"] is None
    assert json.loads(eventsim(*words, "--horizon").stdout)["horizon"]["event"] is None
