"""Every file that a run goes on writing belongs to it: a second run is refused, whatever became of the first."""

from __future__ import annotations

import subprocess
import sys

import pytest

import eventsim as es
from eventsim.sweep import sweep
from tests.sweep.test_sweep import make

GRID = {"gas.0.packing_fraction": [0.05, 0.1, 0.2]}

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="there an open file cannot be replaced")

HOLDING = """
import sys, eventsim as es
def wait(rows):
    print("writing", flush=True)
    sys.stdin.read()
es.simulate(es.gallery("two-disks"), events=20, engine="reference", checkpoint=sys.argv[1], every=1, on_event=wait)
"""


def in_the_middle(run, second):
    """Call `second` while `run(callback)` goes on."""
    called = []

    def once(*_):
        if not called:
            called.append(True)
            second()

    run(once)
    assert called


def test_a_second_run_that_writes_the_same_checkpoint_is_refused(tmp_path):
    path = tmp_path / "run.checkpoint"
    scene = es.gallery("two-disks")

    def second():
        with pytest.raises(es.CheckpointError, match=r"another run is writing the checkpoint run\.checkpoint"):
            es.simulate(scene, events=20, checkpoint=path)
        with pytest.raises(es.CheckpointError, match=r"another run is writing the checkpoint run\.checkpoint"):
            es.resume(path, events=30)

    in_the_middle(lambda tell: es.simulate(scene, events=10, checkpoint=path, every=1, on_event=tell), second)
    assert [file.name for file in tmp_path.iterdir()] == ["run.checkpoint"]
    assert es.resume(path, events=20).counters.events == 20


def test_a_checkpoint_that_was_refused_takes_nothing_from_the_run_that_has_it(tmp_path):
    path, logs = tmp_path / "run.checkpoint", (tmp_path / "a.csv", tmp_path / "b.csv")
    scene = es.gallery("two-disks")

    def second():
        with pytest.raises(es.CheckpointError, match="another run"):
            es.simulate(scene, events=20, checkpoint=path, log=logs[1])

    in_the_middle(lambda tell: es.simulate(scene, events=10, checkpoint=path, log=logs[0], on_event=tell), second)
    assert sorted(file.name for file in tmp_path.iterdir()) == ["a.csv", "run.checkpoint"]
    assert es.resume(path, events=20).counters.events == 20


def test_the_checkpoint_of_a_run_that_was_killed_is_free(tmp_path):
    path = tmp_path / "run.checkpoint"
    words = [sys.executable, "-c", HOLDING, str(path)]
    with subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as run:
        assert run.stdout.readline() == "writing\n"
        with pytest.raises(es.CheckpointError, match="another run"):
            es.resume(path)
        run.kill()
    assert es.resume(path, events=20).counters.events == 20
    assert [file.name for file in tmp_path.iterdir()] == ["run.checkpoint"]


def test_a_second_sweep_that_writes_the_same_table_is_refused(tmp_path):
    path = tmp_path / "table.csv"

    def second():
        with pytest.raises(es.EventsimError, match=r"another run is writing the sweep table\.csv"):
            sweep(make, GRID, events=30, engine="reference", out=path)

    in_the_middle(lambda tell: sweep(make, GRID, events=30, engine="reference", out=path, progress=tell), second)
    assert [file.name for file in tmp_path.iterdir()] == ["table.csv"]


@pytest.mark.parametrize("text", ["my notes\n", '{"sweep": "another"}\n', "[1]\n", "7"])
def test_a_file_that_is_no_journal_of_the_sweep_is_left_alone(tmp_path, text):
    notes = tmp_path / "table.csv.journal"
    notes.write_text(text)
    with pytest.raises(es.EventsimError, match="belongs to another sweep"):
        sweep(make, GRID, events=30, engine="reference", out=tmp_path / "table.csv")
    assert notes.read_text() == text


@pytest.mark.parametrize("end", [b"", b"\x00\xff\xfe", b'{"task": 7, "row": {}}\n', b'["task"]\n', b'{"task": "x", "row"'])
def test_a_journal_whose_end_is_damaged_goes_on_with_what_is_whole(tmp_path, end):
    path, grid = tmp_path / "table.csv", GRID
    right = sweep(make, grid, events=30, engine="reference")

    class Enough(Exception):  # noqa: N818
        pass

    def stop(done, _):
        if done == 2:
            raise Enough

    with pytest.raises(Enough):
        sweep(make, grid, events=30, engine="reference", out=path, progress=stop)
    journal = tmp_path / "table.csv.journal"
    journal.write_bytes(journal.read_bytes() + end)
    done = []
    again = sweep(make, grid, events=30, engine="reference", out=path, progress=lambda *now: done.append(now))
    assert repr(again) == repr(right)  # bars that nobody knows are nan
    assert done == [(3, 3)]
