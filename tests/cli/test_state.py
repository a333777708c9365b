"""`eventsim state`: where the disks are at any time, from a log file alone."""

import csv
import json

import numpy as np
import pytest

from eventsim.readers import read_samples
from eventsim.run import load_log


@pytest.fixture
def log_file(eventsim, scene_file, tmp_path):
    path = tmp_path / "two.csv"
    assert eventsim("run", scene_file, "--log", path, "--quiet").exit_code == 0
    scene_file.unlink()
    return path


def rows_of(text):
    return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(text.splitlines())]


def test_a_decimal_comma_is_answered_with_the_point(eventsim, log_file):
    result = eventsim("state", log_file, "--at", "0,5")
    assert result.exit_code == 2
    assert "A number has a decimal point, not a comma: 0.5" in " ".join(result.stderr.split())


def test_a_comma_that_may_part_thousands_is_answered_with_both_numbers(eventsim, log_file):
    told = " ".join(eventsim("state", log_file, "--at", "1,000").stderr.split())
    assert "1.000, or 1000 if the comma separates thousands" in told
    assert "between thousands: 1000" in " ".join(eventsim("run", "break", "--events", "1,000").stderr.split())


def test_one_at_takes_several_times(eventsim, log_file):
    rows = rows_of(eventsim("state", log_file, "--at", 0.5, "1e0", 1.25).stdout)
    assert [(row["time"], row["disk"]) for row in rows] == [
        (0.5, 0), (0.5, 1), (1.0, 0), (1.0, 1), (1.25, 0), (1.25, 1),
    ]  # fmt: skip
    assert [row["x"] for row in rows] == [1.0, 2.5, 1.5, 2.5, 1.75, 2.5]
    assert list(rows[0]) == ["time", "disk", "x", "y", "vx", "vy", "radius", "mass"]
    assert rows[1]["mass"] == 3.0


def test_at_the_time_of_an_event_it_is_the_state_after_it(eventsim, log_file):
    before, after = rows_of(eventsim("state", log_file, "--at", 1.4999, "--at", 1.5).stdout)[::2]
    assert (before["vx"], after["vx"]) == (1.0, -0.5)


@pytest.mark.parametrize("suffix", [".csv", ".npz"])
def test_out_writes_the_table_to_a_file(eventsim, log_file, tmp_path, suffix):
    target = tmp_path / f"states{suffix}"
    result = eventsim("state", log_file, "--at", 0.25, "--out", target)
    assert result.exit_code == 0
    assert "written to" in result.stdout
    if suffix == ".npz":
        with np.load(target) as table:
            assert table["x"].tolist() == [0.75, 2.5]
    else:
        assert [row["x"] for row in rows_of(target.read_text())] == [0.75, 2.5]


def test_json_holds_the_states(eventsim, log_file):
    data = json.loads(eventsim("state", log_file, "--at", 0.25, "--json").stdout)
    assert data["disks"] == 2
    assert data["states"] == [
        {"time": 0.25, "position": [[0.75, 1.0], [2.5, 1.0]], "velocity": [[1.0, 0.0], [0.0, 0.0]]}
    ]


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["two.csv"], "--at"),
        (["two.csv", "--at", "-1"], "-1"),
        (["two.csv", "--at", "99"], "99"),
        (["two.csv", "--at", "nan"], "nan"),
        (["two.csv", "--at", "now"], "now"),
        (["none.csv", "--at", "1"], "none.csv"),
        (["two.txt", "--at", "1"], "two.txt"),
        (["two.csv", "--at", "1", "--out", "a.txt"], ".csv, .npz"),
    ],
)
def test_bad_usage_is_one_clear_message(eventsim, log_file, tmp_path, monkeypatch, words, expected):
    monkeypatch.chdir(tmp_path)
    result = eventsim("state", *words)
    assert result.exit_code == 2
    assert expected in result.stderr
    assert result.stdout == ""
    assert list(tmp_path.iterdir()) == [log_file]


def test_a_changed_log_is_told_in_one_line(eventsim, tmp_path):
    log = tmp_path / "log.csv"
    eventsim("run", "two-disks", "--log", log)
    assert eventsim("state", log, "--at", 1).stderr == ""
    log.write_text(log.read_text().replace(",pair,0,1,,4.0,", ",pair,0,1,,4.25,", 1))
    result = eventsim("state", log, "--at", 1)
    assert result.exit_code == 0
    assert result.stderr.startswith(f"warning: {log} is not what its run wrote")
    assert result.stderr.count("\n") == 1


def test_unwrapped_places_go_on_over_the_sides(eventsim, tmp_path):
    eventsim("run", "periodic-fluid", "--set", "n=16", "--events", "400", "--log", tmp_path / "log.csv")
    for name in ("wrapped.csv", "going.csv", "going.dump"):
        options = ["--unwrapped"] if name == "going.csv" else []
        assert eventsim("state", tmp_path / "log.csv", "--frames", "20", *options, "--out", tmp_path / name).exit_code == 0
    wrapped, going = (read_samples(tmp_path / name).position for name in ("wrapped.csv", "going.csv"))
    size = load_log(tmp_path / "log.csv").scene.domain.size
    gone = (going - wrapped) / np.array(size)
    assert np.abs(gone - np.rint(gone)).max() < 1e-12
    assert gone.any()
    assert not gone[0].any()
    assert np.allclose(read_samples(tmp_path / "going.dump").position, going, rtol=0.0, atol=1e-12)
