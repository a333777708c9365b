"""`eventsim certify`, and the horizon of `run` and `check`."""

import json

import pytest

from eventsim.run import load_log


def scene_of(tmp_path, **changes):
    path = tmp_path / "scene.json"
    path.write_text(json.dumps({"events": 40, "domain": {"kind": "box", "size": [1.0, 0.7]}} | changes))
    return path


def test_a_proof_is_told(eventsim, scene_file):
    result = eventsim("certify", scene_file)
    assert result.exit_code == 0
    for words in ("proven", "bits", "float64", "disk 1: x = ", "stopped  at the time asked for"):
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


def test_a_cluster_of_irrational_numbers_ends_a_proof_with_a_reason(eventsim):
    result = eventsim("certify", "break")
    assert result.exit_code == 3
    assert "35 events" in result.stdout
    assert "joint impulses cannot be proven" in result.stdout


def test_an_end_of_the_bits_is_told_and_keeps_what_is_proven(eventsim):
    result = eventsim("certify", "gas", "--set", "n=16", "--events", 500, "--bits", 128, "--most-bits", 128)
    assert result.exit_code == 3
    assert "a comparison for disk 4 is not decided; 128 bits are the most allowed: allow more" in result.stdout


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


def test_what_float64_stops_before_is_a_difference(eventsim):
    """There are 89 contacts; long before, the gaps sink below the last bits of places."""
    words = ("certify", "collapse", "--set", "restitution=0.0719")
    proof = json.loads(eventsim(*words, "--json").stdout)
    assert proof["proven"] == 89
    agreed = proof["agreed"]
    assert 20 <= agreed < 89
    assert (proof["difference"]["event"], proof["float64_stopped"]) == (agreed, "digits")
    assert "the gaps sank below the digits" in proof["float64_reason"]
    assert f"has {agreed} events in the same order, then stopped (digits) before event {agreed}" in eventsim(*words).stdout


def test_the_errors_of_float64_have_a_scale(eventsim, tmp_path):
    """The same scene a power of two smaller has errors that much smaller, and they are the same part of it."""
    found = []
    for size in (1.0, 2.0**-200):
        path = tmp_path / "pair.json"
        disks = [
            {"position": [0.25 * size, 0.3 * size], "velocity": [size, 0.3 * size], "radius": 0.1 * size},
            {"position": [0.7 * size, 0.4 * size], "velocity": [-0.9 * size, 0.1 * size], "radius": 0.1 * size},
        ]
        domain = {"kind": "box", "size": [size, 0.7 * size]}
        path.write_text(json.dumps({"events": 40, "domain": domain, "disk": disks}))
        found.append(json.loads(eventsim("certify", path, "--json").stdout))
    here, there = found
    assert here["deviation"] * 2.0**-200 == there["deviation"] > 0.0
    assert here["deviation_share"] == there["deviation_share"] == here["deviation"]
    assert here["velocity_deviation"] * 2.0**-200 == there["velocity_deviation"] > 0.0
    assert here["velocity_deviation_share"] == there["velocity_deviation_share"]
    assert here["velocity_deviation_share"] < here["velocity_deviation"]


def test_on_the_open_plane_the_extent_of_all_places_is_the_scale(eventsim, tmp_path):
    """Two disks in a circle of radius 0.6: their centres keep within 1, and what they fill is between 0.2 and 1.2 wide."""
    disks = [
        {"position": [-0.25, 0.05], "velocity": [1.0, 0.3], "radius": 0.1},
        {"position": [0.2, 0.1], "velocity": [-0.9, 0.1], "radius": 0.1},
    ]
    wall = {"kind": "circle", "center": [0.0, 0.0], "radius": 0.6}
    scene = scene_of(tmp_path, domain={"kind": "open"}, disk=disks, wall=[wall])
    proof = json.loads(eventsim("certify", scene, "--json").stdout)
    assert proof["agreed"] == proof["proven"] == 40
    assert proof["deviation"] / 1.2 <= proof["deviation_share"] <= proof["deviation"] / 0.2
    assert proof["deviation"] > 0.0


def test_bits_that_contradict_each_other_are_refused(eventsim):
    result = eventsim("certify", "gas", "--bits", 128, "--most-bits", 64)
    assert result.exit_code == 2
    assert "cannot have fewer bits than the first" in result.stderr


@pytest.mark.parametrize(("engine", "word"), [("frames", "time steps"), ("certified", "proven")])
def test_a_horizon_belongs_to_float64_and_events(eventsim, engine, word):
    result = eventsim("run", "break", "--engine", engine, "--horizon")
    assert result.exit_code == 2
    assert word in result.stderr


def test_a_tie_is_told_by_its_disks_and_walls(eventsim, tmp_path):
    """Mirror images in x that meet at another height reach left and right at one time, by different expressions."""
    disks = [
        {"position": [0.25, 0.3], "velocity": [1.0, 0.3], "radius": 0.1},
        {"position": [0.75, 0.4], "velocity": [-1.0, 0.1], "radius": 0.1},
    ]
    result = eventsim("certify", scene_of(tmp_path, disk=disks))
    assert result.exit_code == 3
    (stopped,) = (line for line in result.stdout.splitlines() if "stopped" in line)
    assert "after 2 proven events, at t = 0.525762466 whether the contact of disk 0 with left" in stopped
    assert "or the contact of disk 1 with right comes first is not decided; more bits do not help" in stopped
    assert len(stopped) < 400


def test_a_cluster_that_cannot_be_proven_is_told_by_its_disks(eventsim):
    result = eventsim("certify", "break")
    assert result.exit_code == 3
    assert "after 35 proven events, at t = 0.794884692 the contacts of disks 8, 9, 13 at one instant" in result.stdout
    assert "what comes before is proven" in result.stdout
