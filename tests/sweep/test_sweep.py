"""Sweeps: the same table whoever does the runs, and after every kind of trouble."""

import json
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import pytest

import eventsim as es
from eventsim.cli.source import seeded_scene
from eventsim.scene.files import scene_from_dict
from eventsim.scene.overrides import apply_overrides
from eventsim.sweep import load_table, sweep
from eventsim.sweep.grid import grid_of, seed_of, tasks_of

SCENE = {
    "domain": {"kind": "periodic", "size": [1.0, 1.0]},
    "gas": [{"count": 16, "packing_fraction": 0.1, "temperature": 1.0, "seed": 1}],
}
GRID = {"gas.0.packing_fraction": [0.1, 0.2]}


def make(settings, seed):
    return scene_from_dict(apply_overrides(SCENE, settings), seed=seed)


def make_or_die(marks: Path, settings, seed):
    """Kills its process the first time that it is asked for a packing fraction of 0.2 in a worker."""
    if "0.2" in str(settings) and os.getppid() == int((marks / "parent").read_text()):
        mark = marks / f"died-{seed}"
        if not mark.exists():
            mark.touch()
            os.kill(os.getpid(), signal.SIGKILL)
    return make(settings, seed)


def always_die(parent: int, settings, seed):
    if "0.2" in str(settings) and os.getpid() != parent:
        os.kill(os.getpid(), signal.SIGKILL)
    return make(settings, seed)


short = partial(sweep, events=400, engine="reference", replicas=2)


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    """A sweep by one worker: its file's bytes."""
    path = tmp_path_factory.mktemp("sweep") / "t.csv"
    rows = short(make, GRID, out=path, workers=1)
    assert [row["gas.0.packing_fraction"] for row in rows] == [0.1, 0.1, 0.2, 0.2]
    assert len({row["seed"] for row in rows}) == 4
    assert all(row["failed"] is None and row["events"] >= 400 for row in rows)
    assert not path.with_name("t.csv.journal").exists()
    return path.read_bytes()


def test_a_column_of_a_setting_has_what_was_set(tmp_path):
    """0.3 is 0.3 for whoever looks its rows up, although the disks cover 0.29999999999999993; that is in a column of its own."""
    make, path = partial(seeded_scene, "periodic-fluid"), tmp_path / "z.csv"
    rows = sweep(make, grid_of(["n=16", "packing_fraction=0.1:0.6:6"]), events=20, engine="reference", out=path)
    values = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]
    assert [row["packing_fraction"] for row in rows] == values
    assert [row["packing_fraction"] for row in load_table(path)] == values
    measured = [row["packing_fraction_measured"] for row in rows]
    assert measured == pytest.approx(values, rel=1e-12)  # rounding of areas
    assert measured != values


def test_two_workers_write_the_same_bytes(plain, tmp_path):
    short(make, GRID, out=tmp_path / "t.csv", workers=2)
    assert (tmp_path / "t.csv").read_bytes() == plain


def test_any_executor_writes_the_same_bytes(plain, tmp_path):
    with ThreadPoolExecutor(2) as executor:
        short(make, GRID, out=tmp_path / "t.csv", executor=executor)
    assert (tmp_path / "t.csv").read_bytes() == plain


@pytest.mark.slow
def test_a_dask_cluster_writes_the_same_bytes(plain, tmp_path):
    distributed = pytest.importorskip("distributed")
    from eventsim.sweep.dask import dask_executor

    with (
        distributed.LocalCluster(n_workers=1, threads_per_worker=2, processes=False, dashboard_address=None) as cluster,
        dask_executor(cluster.scheduler_address) as executor,
    ):
        short(make, GRID, out=tmp_path / "t.csv", executor=executor)
    assert (tmp_path / "t.csv").read_bytes() == plain


def test_an_interrupted_sweep_goes_on_where_it_was(plain, tmp_path):
    path, done = tmp_path / "t.csv", []

    def interrupt(count, total):
        done.append(count)
        if count == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        short(make, GRID, out=path, progress=interrupt)
    assert not path.exists()
    journal = path.with_name("t.csv.journal")
    journal.write_text(journal.read_text() + '{"task": "cut of')  # killed while it wrote
    short(make, GRID, out=path, progress=lambda count, total: done.append(count))
    assert done == [1, 2, 3, 4]
    assert path.read_bytes() == plain


def test_a_journal_that_cannot_be_written_is_told_and_what_was_done_stays(plain, tmp_path):
    resource = pytest.importorskip("resource", reason="a limit for files is set")
    path, limits, done = tmp_path / "t.csv", resource.getrlimit(resource.RLIMIT_FSIZE), []

    def fill(count, total):
        done.append(count)
        resource.setrlimit(resource.RLIMIT_FSIZE, (path.with_name("t.csv.journal").stat().st_size, limits[1]))

    try:
        with pytest.raises(es.EventsimError, match=r"t\.csv\.journal: cannot be written \(File too large\)"):
            short(make, GRID, out=path, progress=fill)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert not path.exists()
    short(make, GRID, out=path, progress=lambda count, total: done.append(count))
    assert done == [1, 2, 3, 4]
    assert path.read_bytes() == plain


def test_a_journal_of_another_sweep_is_not_mixed_in(tmp_path):
    def interrupt(count, total):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        short(make, GRID, out=tmp_path / "t.csv", progress=interrupt)
    with pytest.raises(es.EventsimError, match="another sweep"):
        sweep(make, GRID, out=tmp_path / "t.csv", events=500, engine="reference", replicas=2)


def test_the_task_of_a_crashed_worker_is_done_again(plain, tmp_path):
    (tmp_path / "parent").write_text(str(os.getpid()))
    short(partial(make_or_die, tmp_path), GRID, out=tmp_path / "t.csv", workers=2)
    assert len(list(tmp_path.glob("died-*"))) >= 1
    assert (tmp_path / "t.csv").read_bytes() == plain


@pytest.mark.slow
def test_a_task_that_kills_every_worker_is_a_row_with_its_reason():
    rows = short(partial(always_die, os.getpid()), GRID, workers=2)
    assert [row["failed"] is None for row in rows] == [True, True, False, False]
    assert "died" in rows[2]["failed"]


def test_a_run_that_fails_is_a_row_with_its_reason():
    rows = short(make, {"gas.0.packing_fraction": [0.1, 0.89]})
    assert [row["failed"] is None for row in rows] == [True, True, False, False]
    assert "do not fit" in rows[2]["failed"]


def test_parquet_holds_the_same_rows(plain, tmp_path):
    pq = pytest.importorskip("pyarrow.parquet")
    rows = short(make, GRID, out=tmp_path / "t.parquet")
    table = pq.read_table(tmp_path / "t.parquet")
    assert table.column("Z").to_pylist() == [row["Z"] for row in rows]
    (tmp_path / "t.csv").write_bytes(plain)
    assert [row["Z"] for row in load_table(tmp_path / "t.csv")] == table.column("Z").to_pylist()


def test_more_replicas_or_values_keep_the_seeds_of_the_others():
    few = {task.name for task in tasks_of({"a": ["1", "2"]}, 2, seed=7)}
    more = {task.name for task in tasks_of({"a": ["2", "3", "1"]}, 5, seed=7)}
    assert few < more
    assert len({seed_of(7, [("a", str(k))], replica) for k in range(100) for replica in range(100)}) == 10_000


@pytest.mark.parametrize(
    ("setting", "values"),
    [
        ("a=1", ["1"]),
        ("a=0.1:0.6:6", ["0.1", "0.2", "0.3", "0.4", "0.5", "0.6"]),
        ("a=[0,-1],[0,-2]", ["[0,-1]", "[0,-2]"]),
        ('a="x,y",z', ['"x,y"', "z"]),
        ("a=10:20", ["10:20"]),
    ],
)
def test_values_as_typed(setting, values):
    assert grid_of([setting]) == {"a": values}


@pytest.mark.parametrize("settings", [["a"], ["a="], ["=1"], ["a=1,,2"], ["a=1", "a=2"], ["a=0:1:0"]])
def test_settings_that_make_no_sense_are_refused(settings):
    with pytest.raises(es.EventsimError):
        grid_of(settings)


def test_replicas_of_a_scene_without_chance_are_refused():
    with pytest.raises(es.EventsimError, match="same run"):
        sweep(lambda settings, seed: es.gallery("corner"), {}, replicas=2)


def test_a_value_twice_is_refused():
    with pytest.raises(es.EventsimError, match="twice"):
        sweep(make, {"gas.0.packing_fraction": [0.1, 0.1]}, events=10)


def test_a_value_that_the_scene_refuses_has_a_row_that_says_why():
    def fast(settings, seed):
        gas = {"count": 16, "packing_fraction": 0.1, "seed": 1}
        return scene_from_dict(apply_overrides({**SCENE, "gas": [gas]}, settings), seed=seed)

    usual, very_fast = sweep(fast, {"gas.0.speed": [1.0, 1e250]}, events=200, engine="reference")
    assert usual["temperature"] == pytest.approx(0.5, rel=0.1)  # less the energy of the common motion
    assert very_fast.get("temperature") is None
    assert "velocity" in str(very_fast["failed"])


@pytest.mark.slow
def test_a_dask_scheduler_that_is_killed_is_told_and_what_was_done_stays(tmp_path):
    pytest.importorskip("distributed")
    scheduler = [sys.executable, "-m", "distributed.cli.dask_scheduler", "--port", "0", "--no-dashboard"]
    file = tmp_path / "scheduler.json"
    worker = [sys.executable, "-m", "distributed.cli.dask_worker", "--scheduler-file", str(file), "--no-dashboard", "--no-nanny"]
    out = tmp_path / "t.csv"
    words = ["sweep", "gas", "--set", "n=40,50,60,70,80,90", "--events", "6000", "--engine", "reference", "--out", str(out)]
    quiet = {"stderr": subprocess.DEVNULL, "stdout": subprocess.DEVNULL}
    with (
        ended(subprocess.Popen([*scheduler, "--scheduler-file", str(file)], **quiet)) as first,
        ended(subprocess.Popen(worker, **quiet)),
    ):
        wait_for(lambda: file.exists() and file.read_text().strip().endswith("}"))
        address = json.loads(file.read_text())["address"]
        command = [sys.executable, "-m", "eventsim", *words, "--dask", address]
        running = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
        wait_for(lambda: Path(f"{out}.journal").exists() and Path(f"{out}.journal").read_text().count("\n") >= 2)
        first.kill()
        _, stderr = running.communicate(timeout=60)
    assert running.returncode == 2
    assert stderr.startswith("Error: the executor gave up its tasks: its scheduler or its workers are gone")
    assert stderr.count("\n") == 1
    assert Path(f"{out}.journal").read_text().count("\n") >= 2


@contextmanager
def ended(process):
    try:
        yield process
    finally:
        process.kill()
        process.wait()


def wait_for(there, seconds=60):
    end = time.monotonic() + seconds
    while not there():
        assert time.monotonic() < end
        time.sleep(0.05)


def test_a_sweep_has_the_energies_of_all_runs_kept_or_not(tmp_path):
    grid = {"n": [20], "restitution": [0.8, 1.0]}
    rows = sweep(partial(seeded_scene, "cooling"), grid, events=400, engine="reference", out=tmp_path / "e.csv")
    lossy, kept = rows
    assert lossy["energy_end"] < 0.9 * lossy["energy_start"]
    assert kept["energy_start"] > 0.0
    assert kept["energy_end"] == pytest.approx(kept["energy_start"], rel=1e-12)
