"""The sweep of an equation of state, 13 packings with 8 replicas each: the same bytes whoever runs it, and its figure."""

import signal
import subprocess
import sys
import time

import pytest

pytestmark = [pytest.mark.slow, pytest.mark.timeout(900)]

SWEEP = ["sweep", "periodic-fluid", "--set", "n=64", "--set", "packing_fraction=0.05:0.65:13", "--replicas", "8"]
COMMAND = [sys.executable, "-m", "eventsim", *SWEEP, "--events", "600", "--quiet"]
RUNS = 13 * 8


def bytes_of(path, *options):
    subprocess.run([*COMMAND, "--out", str(path), *options], check=True)
    return path.read_bytes()


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    """The table that one worker writes, and its figure."""
    folder = tmp_path_factory.mktemp("sweep")
    table = bytes_of(folder / "z.csv", "--workers", "1", "--figure", str(folder / "z.png"))
    assert table.count(b"\n") >= RUNS + 1
    assert (folder / "z.png").stat().st_size > 10_000
    return table


def test_two_workers(alone, tmp_path):
    assert bytes_of(tmp_path / "z.csv", "--workers", "2") == alone


def test_a_dask_cluster(alone, tmp_path):
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        assert bytes_of(tmp_path / "z.csv", "--dask", cluster.scheduler_address) == alone


def test_an_interrupt_and_the_same_command_again(alone, tmp_path):
    path = tmp_path / "z.csv"
    journal = path.with_name("z.csv.journal")
    process = subprocess.Popen([*COMMAND, "--out", str(path), "--workers", "2"])
    while not journal.exists() or journal.read_text().count("\n") < RUNS // 4:
        assert process.poll() is None
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    assert process.wait() == 130
    assert not path.exists()
    kept = journal.read_text().count("\n")
    assert kept < RUNS
    assert bytes_of(path, "--workers", "2") == alone
    assert not journal.exists()
