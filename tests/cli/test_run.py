"""`eventsim run`: what it prints, writes, and refuses."""

import json
import subprocess
import sys
import tempfile
import time
from dataclasses import replace

import numpy as np
import pytest

import eventsim as es
from eventsim import gallery, load_log, simulate
from eventsim.cli.options import Files
from eventsim.cli.summary import stop_words, summary_text

JSON_KEYS = {
    "scene", "engine", "time", "events", "pair_contacts", "wall_contacts", "elapsed_s", "compile_s", "write_s",
    "events_per_s", "digest", "residuals", "stopped",
}  # fmt: skip


def test_a_run_prints_a_summary(eventsim, scene_file):
    result = eventsim("run", scene_file)
    assert result.exit_code == 0
    assert result.stderr == ""
    for words in ("two in a box", "2 disks in a box 4 x 2", "reference", "energy", "at the time asked for, 4"):
        assert words in result.stdout


@pytest.mark.parametrize(
    ("velocity", "keys", "words"),
    [
        ([(1.0, 0.0), (2.0, 0.0)], {}, "every disk flies free from here on"),
        ([(0.0, 0.0), (2.0, 0.0)], {}, "every disk is at rest or flies free from here on"),
        ([(0.0, 0.0), (0.0, 0.0)], {}, "every disk is at rest"),
        ([(0.0, 0.0), (0.0, 0.0)], {"gravity": (0.0, -1.0), "restitution": 0.5}, "every disk is at rest"),
    ],
    ids=["fly", "one flies", "nothing moves", "lie on the floor"],
)
def test_an_end_without_events_says_what_disks_do(velocity, keys, words):
    floor = [es.Segment((-5.0, 0.0), (5.0, 0.0))] if keys else []
    scene = es.Scene(es.Disks([(0.0, 1.0), (3.0, 1.0)], velocity, 0.5), es.Open(), floor, **keys)
    assert stop_words(es.simulate(scene, events=1000, engine="reference")) == f"no event is ahead: {words}"


def test_json_has_the_promised_keys_and_numbers(eventsim, scene_file):
    summary = json.loads(eventsim("run", scene_file, "--json").stdout)
    assert summary.keys() >= JSON_KEYS
    assert summary["residuals"].keys() == {"energy", "momentum", "max_overlap"}
    assert summary["scene"] == str(scene_file)
    assert summary["stopped"] == "until"
    assert summary["time"] == 4.0
    assert summary["pair_contacts"] == 1
    assert summary["events"] == summary["pair_contacts"] + summary["wall_contacts"]
    assert summary["digest"] is None


def test_json_documents_each_of_its_keys(eventsim, scene_file):
    summary = json.loads(eventsim("run", scene_file, "--json").stdout)
    page = eventsim("run", "--help").stdout
    assert [key for key in summary if key not in page] == []


def test_the_line_of_the_engine_names_both_of_auto_and_times_worth_a_word():
    run = simulate(gallery("break"), events=5)
    told = replace(run, engine="fast", begun_by="reference", elapsed_s=2.0, compile_s=4.0, write_s=1e-3)
    line = summary_text("break", told, Files(None, None, None)).splitlines()[1]
    assert " ".join(line.split()) == "engine reference, then fast: 2 s simulating + 4 s compiling"


def test_the_line_of_events_adds_up_where_disks_come_to_rest():
    scene = es.Scene(es.Disks([[1.0, 0.6]], radius=0.5), es.Box((2.0, 2.0)), gravity=(0.0, -1.0), restitution=0.5)
    run = simulate(scene, until=5.0)
    line = summary_text("rest", run, Files(None, None, None)).splitlines()
    events = next(text for text in line if text.strip().startswith("events"))
    assert f"{run.counters.events}: 0 pair contacts, {run.counters.wall_contacts} wall contacts, 1 rest;" in events
    assert run.counters.events == run.counters.wall_contacts + 1


def test_without_a_scene_it_runs_the_break(eventsim):
    summary = json.loads(eventsim("run", "--events", 5, "--json").stdout)
    assert summary["scene"] == "break"
    assert summary["events"] >= 5
    assert summary["stopped"] == "events"


@pytest.mark.parametrize("suffix", [".csv", ".jsonl", ".npz", ".parquet"])
@pytest.mark.parametrize("compact", [[], ["--compact"]])
def test_a_log_reads_back_with_the_digest_that_was_printed(eventsim, scene_file, tmp_path, suffix, compact):
    log = tmp_path / f"two{suffix}"
    summary = json.loads(eventsim("run", scene_file, "--log", log, *compact, "--json").stdout)
    assert summary["log"] == str(log)
    events = load_log(log)
    assert len(events) == summary["events"]
    assert events.digest() == summary["digest"]


@pytest.mark.parametrize("suffix", [".csv", ".jsonl", ".npz", ".parquet"])
def test_a_log_takes_the_place_of_another_one_and_says_so(eventsim, scene_file, tmp_path, suffix):
    log, told = tmp_path / f"two{suffix}", "in place of the log that was there"
    log.touch()  # as made by mktemp: nothing is lost
    runs = [" ".join(eventsim("run", scene_file, "--log", log, *until).stdout.split()) for until in ([], ["--until", 0.5])]
    assert [told in run for run in runs] == [False, True]
    assert len(load_log(log)) == 0


@pytest.mark.parametrize("suffix", [".csv", ".jsonl", ".npz", ".parquet"])
def test_a_file_that_is_no_log_is_not_replaced(eventsim, scene_file, tmp_path, suffix):
    other = tmp_path / f"marks{suffix}"
    other.write_text("x,y\n1,2\n")
    result = eventsim("run", scene_file, "--log", other)
    assert (result.exit_code, other.read_text()) == (2, "x,y\n1,2\n")
    assert "holds no event log that a new one may replace; name another file" in " ".join(result.stderr.split())
    assert not other.with_name(f"marks{suffix}.part").exists()
    with pytest.raises(es.LogError, match="holds no event log"):
        simulate(gallery("bounce"), log=True).log.save(other)


def test_the_digest_needs_no_file(eventsim, scene_file, tmp_path):
    kept = json.loads(eventsim("run", scene_file, "--log", tmp_path / "a.csv", "--json").stdout)
    asked = json.loads(eventsim("run", scene_file, "--digest", "--json").stdout)
    assert kept["digest"] == asked["digest"]
    assert len(asked["digest"]) == 64


def test_the_final_state_starts_the_next_run(eventsim, scene_file, tmp_path):
    state = tmp_path / "end.csv"
    assert eventsim("run", scene_file, "--state", state).exit_code == 0
    next_scene = tmp_path / "next.toml"
    next_scene.write_text('until = 1.0\n[domain]\nkind = "box"\nsize = [4.0, 2.0]\n[[disks_file]]\npath = "end.csv"\n')
    assert eventsim("run", next_scene).exit_code == 0


def test_quiet_prints_nothing(eventsim, scene_file):
    result = eventsim("run", scene_file, "--quiet")
    assert (result.exit_code, result.output) == (0, "")


def test_set_overrides_a_key_of_the_scene(eventsim, scene_file):
    summary = json.loads(eventsim("run", scene_file, "--set", "until=0.5", "--json").stdout)
    assert summary["time"] == 0.5


def test_set_reaches_parameters_of_a_built_in_scene_first(eventsim):
    summary = json.loads(eventsim("run", "galperin", "--set", "mass_ratio=10000", "--json").stdout)
    assert summary["events"] == 314


def test_a_run_ends_where_no_event_is_ahead(eventsim):
    summary = json.loads(eventsim("run", "galperin", "--until", "1e9", "--json").stdout)
    assert summary["stopped"] == "quiet"
    assert summary["events"] == 31


def test_set_reaches_keys_of_a_built_in_scene_too(eventsim):
    words = ("run", "galperin", "--set", "mass_ratio=10000", "--set", "restitution=0.9", "--events", 3, "--json")
    summary = json.loads(eventsim(*words).stdout)
    assert summary["residuals"]["energy"] is None


@pytest.mark.parametrize("written", ["30", "3e1", "0.3e2", "30.0"])
def test_a_number_of_events_may_be_written_with_an_exponent(eventsim, written):
    words = ("run", "gas", "--set", "n=2e1", "--json", "--events")
    assert json.loads(eventsim(*words, written).stdout)["events"] == 30
    set_in_scene = ("run", "gas", "--set", "n=20", "--set", f"events={written}", "--json")
    assert json.loads(eventsim(*set_in_scene).stdout)["events"] == 30


@pytest.mark.parametrize("written", ["1.5", "1e-1", "-1e3", "many", "nan", "inf", "1e999999999"])
def test_what_is_no_number_of_events_is_refused(eventsim, written):
    result = eventsim("run", "gas", "--events", written)
    assert result.exit_code == 2
    assert "--events" in result.stderr


def test_a_seed_without_chance_is_told(eventsim, scene_file):
    for scene in (scene_file, "two-disks"):
        result = eventsim("run", scene, "--seed", 3, "--json")
        assert result.exit_code == 0
        assert f"--seed 3 changes nothing: {scene} draws no random numbers" in result.stderr
    scene_file.write_text(
        scene_file.read_text() + '\n[[gas]]\ncount = 2\nradius = 0.01\nregion = [3, 0, 4, 1]\nseed = 1\n'
    )
    assert "changes nothing" not in eventsim("run", scene_file, "--seed", 3).stderr
    assert "changes nothing" not in eventsim("check", "gas", "--seed", 3).stderr


def test_a_seed_draws_another_start_and_the_same_seed_the_same(eventsim):
    def digest(seed):
        words = ("run", "gas", "--set", "n=20", "--seed", seed, "--events", 20, "--digest", "--json")
        return json.loads(eventsim(*words).stdout)["digest"]

    assert digest(1) == digest(1) != digest(2)


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["run", "brek"], "did you mean 'break'"),
        (["run", "nowhere.toml"], "nowhere.toml"),
        (["run", "break", "--log", "a.txt"], "must end in .csv, .jsonl, .npz, .parquet"),
        (["run", "break", "--log", "nowhere/a.csv"], "there is no directory nowhere"),
        (["run", "break", "--state", "nowhere/a.csv"], "there is no directory nowhere"),
        (["run", "break", "--log", "a.csv", "--state", "a.csv"], "the same file"),
        (["run", "break", "--compact"], "--log FILE"),
        (["run", "break", "--until", "nan"], "must be a time"),
        (["run", "break", "--until", "soon"], "'soon' is not a valid float"),
        (["run", "break", "--events", "-1"], "--events"),
        (["run", "break", "--engine", "refrence"], "reference"),
        (["run", "galperin", "--set", "mass_ratoi=1"], "mass_ratoi"),
        (["run", "galperin", "--set", "mass_ratio=-1"], "mass_ratio"),
        (["run", "break", "--set", "restitution"], "restitution"),
    ],
)
def test_bad_usage_is_one_clear_message_and_writes_nothing(eventsim, tmp_path, monkeypatch, words, expected):
    monkeypatch.chdir(tmp_path)
    result = eventsim(*words)
    assert result.exit_code == 2
    assert expected in result.stderr
    assert "Traceback" not in result.stderr
    assert result.stdout == ""
    assert list(tmp_path.iterdir()) == []


def test_a_bad_scene_leaves_no_log(eventsim, scene_file, tmp_path):
    scene_file.write_text(scene_file.read_text().replace("radius = 0.25", "radius = -0.25"))
    result = eventsim("run", scene_file, "--log", tmp_path / "a.csv")
    assert result.exit_code == 2
    assert result.stderr.count("radius") >= 2
    assert list(tmp_path.iterdir()) == [scene_file]


def test_without_a_stop_both_ways_to_give_one_are_named(eventsim, scene_file):
    scene_file.write_text(scene_file.read_text().replace("until = 4.0", ""))
    result = eventsim("run", scene_file)
    assert result.exit_code == 2
    assert "--until" in result.stderr
    assert "--events" in result.stderr


def test_a_collapse_ends_with_exit_code_3_and_keeps_its_log(eventsim, tmp_path):
    scene = tmp_path / "collapse.toml"
    scene.write_text(
        'until = 10.0\nrestitution = 0.05\n[domain]\nkind = "open"\n'
        "[[disk]]\nposition = [-1.0, 0.0]\nvelocity = [1.0, 0.0]\nradius = 0.0625\n"
        "[[disk]]\nposition = [0.125, 0.0]\nradius = 0.0625\n"
        "[[disk]]\nposition = [2.25, 0.0]\nvelocity = [-1.0, 0.0]\nradius = 0.0625\n"
    )
    log = tmp_path / "collapse.csv"
    result = eventsim("run", scene, "--log", log)
    assert result.exit_code == 3
    assert "early" in result.stdout
    assert len(load_log(log)) > 10


def test_the_step_of_a_stepped_engine_is_given_with_dt(eventsim):
    summary = json.loads(eventsim("run", "two-disks", "--until", "3", "--engine", "stepped", "--dt", "0.01", "--json").stdout)
    assert summary["engine"] == "stepped"
    assert summary["counters"]["steps"] == 300


def test_options_of_an_engine_are_read_as_what_they_are(eventsim):
    located = ("--engine", "stepped", "--dt", "0.5", "--option", "locate=true")
    positions = [
        load_log_of(eventsim, "run", "two-disks", "--until", "9", *options)
        for options in ((), located, ("--engine", "stepped", "--dt", "0.5"))
    ]
    assert np.allclose(positions[0], positions[1], atol=1e-12)
    assert not np.allclose(positions[0], positions[2], atol=1e-3)


def load_log_of(eventsim, *words):
    """The positions at the contacts of a run."""
    with tempfile.TemporaryDirectory() as folder:
        assert eventsim(*words, "--log", f"{folder}/log.csv").exit_code == 0
        return load_log(f"{folder}/log.csv").xa


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--dt", "0.1"), "the engine auto has no option 'dt'; dt belongs to frames, stepped"),
        (("--engine", "stepped", "--option", "memory=frame"), "has no option 'memory'; memory belongs to frames"),
        (("--engine", "stepped", "--option", "locate"), "must be KEY=VALUE"),
        (("--engine", "stepped", "--option", "locate=maybe"), "--option locate=maybe: must be true or false"),
        (("--engine", "stepped", "--dt", "0"), "a step must be a finite time above 0"),
    ],
)
def test_an_option_that_the_engine_does_not_have_is_a_sentence_and_exit_code_2(eventsim, words, message):
    result = eventsim("run", "two-disks", *words)
    assert result.exit_code == 2
    assert message in result.stderr


def test_an_interrupt_keeps_the_log_and_exits_130(tmp_path):
    log = tmp_path / "gas.csv"
    command = [sys.executable, "-m", "eventsim", "run", "gas", "--until", "1e9", "--log", str(log)]
    running = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    part = tmp_path / "gas.csv.part"
    patience = time.monotonic() + 30
    while not (part.exists() and part.stat().st_size > 100_000) and time.monotonic() < patience:
        time.sleep(0.05)
    running.send_signal(2)
    stdout, stderr = running.communicate(timeout=30)
    assert running.returncode == 130, stderr
    assert "interrupted" in stdout
    events = load_log(log)
    assert np.array_equal(events.event, np.arange(len(events)))


def test_a_small_run_imports_nothing_heavy_and_is_quick():
    code = (
        "import sys, time\nbegun = time.perf_counter()\nfrom eventsim.cli import main\n"
        "try: main(['run', 'two-disks'])\nexcept SystemExit as end: assert end.code == 0\n"
        "elapsed = time.perf_counter() - begun\n"
        "loaded = {'matplotlib', 'numba', 'pyarrow', 'rich', 'flint', 'pandas'} & set(sys.modules)\n"
        "assert not loaded, loaded\nprint(elapsed)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    # About 0.15 s on an idle core; the bound leaves room for a busy one.
    assert float(done.stdout.splitlines()[-1]) < 2.0
