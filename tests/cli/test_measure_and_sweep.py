"""`eventsim measure` and `eventsim sweep`."""

import json

import pytest

from eventsim.sweep import load_table

FLUID = ["periodic-fluid", "--set", "n=36", "--set", "packing_fraction=0.3", "--events", 4000]


def test_a_log_and_its_scene_measure_the_same(eventsim, tmp_path):
    log = tmp_path / "a.npz"
    assert eventsim("run", *FLUID, "--log", log, "-q").exit_code == 0
    from_log = json.loads(eventsim("measure", log, "--json").stdout)
    from_scene = json.loads(eventsim("measure", *FLUID, "--json").stdout)
    assert from_log["disks"] == 36
    for name in ("Z", "collision_rate", "mean_free_path"):
        first, second = from_log["quantities"][name]["value"], from_scene["quantities"][name]["value"]
        assert first == pytest.approx(second, rel=1e-9)  # the ends of the two clocks differ by rounding


def test_text_has_theory_and_a_verdict(eventsim):
    text = eventsim("measure", *FLUID).stdout
    assert "Kolafa & Rottner" in text
    assert "sigma" in text
    assert "equilibrated" in text


def test_structure_is_looked_at_along_the_run(eventsim):
    pytest.importorskip("freud")
    data = json.loads(eventsim("measure", *FLUID[:3], "--events", 300, "--structure", "--json").stdout)
    assert 0.0 <= data["structure"]["quantities"]["psi_6"]["value"] <= 1.0
    assert {"r", "g", "g_error"} == set(data["structure"]["tables"]["g"])
    assert "periodic ones" in eventsim("measure", "gas", "--events", 100, "--structure").stdout


def test_transport_needs_no_log(eventsim, tmp_path):
    log = tmp_path / "a.npz"
    assert eventsim("run", *FLUID[:3], "--events", 3000, "--log", log, "-q").exit_code == 0
    with_log = json.loads(eventsim("measure", log, "--transport", "--json").stdout)["transport"]
    without = json.loads(eventsim("measure", *FLUID[:3], "--events", 3000, "--transport", "--json").stdout)["transport"]
    one, other = (data["quantities"]["viscosity"] for data in (with_log, without))
    assert one["theory"] == other["theory"]
    assert abs(one["value"] - other["value"]) < one["error"] + other["error"]  # lags differ by the pace of the first rows


def test_studies_are_made_where_they_are_asked_for(eventsim, tmp_path):
    log, table = tmp_path / "a.npz", tmp_path / "a.csv"
    assert eventsim("run", *FLUID[:3], "--events", 300, "--log", log, "-q").exit_code == 0
    text = eventsim("measure", log, "--lyapunov", 2, "--out", table).stdout
    assert "lyapunov_1_per_contact" in text
    assert table.read_text().startswith("k,exponent,error,")
    data = json.loads(eventsim("measure", log, "--lyapunov", 2, "--json").stdout)
    assert len(data["lyapunov"]["tables"]["lyapunov"]["k"]) == 2
    assert json.loads(eventsim("measure", log, "--json").stdout)["lyapunov"] is None
    of_the_scene = json.loads(eventsim("measure", *FLUID[:3], "--events", 300, "--lyapunov", 2, "--json").stdout)
    assert of_the_scene["lyapunov"] == data["lyapunov"]


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["corner", "--discard", "1e9", "--events", 10], "discard"),
        (["gas", "--events", "0"], "no time passes"),
        (["two.csv"], "two.csv"),
        (["/dev/null"], "neither a log nor a scene file: these end in .csv, .jsonl, .npz, .parquet, or in .toml or .json"),
    ],
)
def test_bad_measures_are_one_clear_message(eventsim, words, expected):
    result = eventsim("measure", *words)
    assert result.exit_code == 2
    assert expected in result.stderr


def test_a_sweep_writes_a_table_and_a_figure(eventsim, tmp_path):
    table, figure = tmp_path / "z.csv", tmp_path / "z.svg"
    result = eventsim(
        "sweep", "periodic-fluid", "--set", "n=16", "--set", "packing_fraction=0.1,0.2", "--events", 400,
        "--replicas", 2, "--workers", 1, "--engine", "reference", "--out", table, "--figure", figure, "--json",
    )  # fmt: skip
    assert result.exit_code == 0, result.stderr
    data = json.loads(result.stdout)
    assert (data["runs"], data["failed"]) == (4, 0)
    rows = load_table(table)
    assert [row["packing_fraction"] for row in rows] == [0.1, 0.1, 0.2, 0.2] or len(rows) == 4
    assert figure.read_text().startswith("<?xml")


def test_a_sweep_draws_any_measure_against_any_key(eventsim, tmp_path):
    words = ["sweep", "cooling", "--set", "n=20", "--set", "restitution=0.8,0.9", "--events", 200, "--workers", 1]
    words += ["--engine", "reference", "--out", tmp_path / "e.csv"]
    drawn = tmp_path / "e.svg"
    result = eventsim(*words, "--figure", drawn, "--y", "mean_free_path")
    assert result.exit_code == 0, result.stderr
    assert drawn.exists()
    result = eventsim(*words, "--figure", drawn, "--x", "restituton", "--y", "mean_free_path")
    assert result.exit_code == 2
    assert "--x restituton: no run of the table has such a number (did you mean 'restitution'?); there are n, restitution," in (
        " ".join(result.stderr.split())
    )
    assert result.stderr.rstrip().endswith("e.csv is whole")
    bad = eventsim(*words, "--set", "gravity=0.99", "--figure", tmp_path / "f.svg", "--json")
    assert (bad.exit_code, json.loads(bad.stdout)["figure"], (tmp_path / "f.svg").exists()) == (2, None, False)
    assert "give --figure FILE too" in eventsim(*words, "--y", "mean_free_path").stderr


def test_a_sweep_makes_studies_of_each_run(eventsim, tmp_path):
    pytest.importorskip("freud")
    words = ["sweep", "periodic-fluid", "--set", "n=16", "--set", "packing_fraction=0.1", "--events", 1500, "--workers", 1]
    result = eventsim(*words, "--engine", "reference", "--structure", "--transport", "--out", tmp_path / "z.csv")
    assert result.exit_code == 0, result.stderr
    (row,) = load_table(tmp_path / "z.csv")
    assert row["failed"] is None
    assert 0.0 <= row["psi_6"] <= 1.0
    assert row["viscosity"] > 0.0
    assert row["viscosity_theory"] > 0.0


def test_a_sweep_of_nothing_but_failures_says_so(eventsim, tmp_path):
    result = eventsim("sweep", "periodic-fluid", "--set", "n=-1", "--events", 10, "--workers", 1, "--out", tmp_path / "z.csv")
    assert result.exit_code == 2
    assert "1 failed" in result.stdout


def test_a_sweep_needs_a_place_for_its_table(eventsim):
    assert eventsim("sweep", "gas").exit_code == 2
    assert "--workers" in eventsim("sweep", "gas", "--out", "a.csv", "--dask", "x", "--workers", 2).stderr
