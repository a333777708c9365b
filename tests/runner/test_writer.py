"""The writer: the same rows in the same order, whether beside the engine or in line with it."""

import threading

import numpy as np
import pytest

import eventsim as es
from eventsim.engines import ENGINES
from eventsim.engines.base import Stop
from eventsim.engines.reference.loop import ReferenceSession
from eventsim.record.events import blank_rows
from eventsim.runner.loop import run_session
from eventsim.runner.options import RunOptions
from eventsim.runner.recording import MANY_ROWS, WAITING, Writer
from eventsim.scene.stage import stage_of
from tests.engines.scenes import lattice_gas


def blocks(*sizes):
    rows = blank_rows(sum(sizes))
    rows["event"] = np.arange(len(rows))
    return np.split(rows, np.cumsum(sizes)[:-1])


def test_rows_come_in_order_from_wherever():
    taken, threads = [], set()

    def take(rows):
        taken.extend(rows["event"].tolist())
        threads.add(threading.current_thread())

    writer = Writer([take])
    for block in blocks(3, MANY_ROWS - 1, MANY_ROWS, *[5] * (3 * WAITING)):
        writer.write(block)
    writer.finish()
    assert taken == list(range(len(taken)))
    assert len(taken) == 2 * MANY_ROWS + 2 + 15 * WAITING
    assert len(threads) == 2
    assert writer.waited_s > 0.0


@pytest.mark.parametrize("size", [1, MANY_ROWS])
def test_what_a_taker_raises_is_raised_to_the_caller(size):
    def refuse(rows):
        raise es.EventsimError("the disk is full")

    writer = Writer([refuse])
    first, *others = blocks(*[size] * (4 * WAITING))

    def write_all():
        for block in [first, *others]:
            writer.write(block)
        writer.finish()

    with pytest.raises(es.EventsimError, match="the disk is full"):
        write_all()
    writer.abandon()
    assert "eventsim writer" not in [thread.name for thread in threading.enumerate()]


def test_what_is_abandoned_is_not_taken():
    begun, go, taken = threading.Event(), threading.Event(), []

    def take(rows):
        begun.set()
        go.wait(10.0)
        taken.append(len(rows))

    writer = Writer([take])
    for block in blocks(MANY_ROWS, 2, 3):
        writer.write(block)
    begun.wait(10.0)
    threading.Timer(0.05, go.set).start()  # by then the writer has been told
    writer.abandon()
    assert taken == [MANY_ROWS]


def test_a_log_is_the_same_beside_the_engine_and_in_line(tmp_path, monkeypatch):
    pytest.importorskip("numba")
    scene, stop = lattice_gas(40, 0.3, es.Periodic), 30_000
    beside = es.simulate(scene, events=stop, engine="fast", log=tmp_path / "a.npz")
    monkeypatch.setattr("eventsim.runner.recording.MANY_ROWS", 1 << 60)
    in_line = es.simulate(scene, events=stop, engine="fast", log=tmp_path / "b.npz")
    assert beside.digest == in_line.digest == es.load_log(tmp_path / "a.npz").digest()
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()


@pytest.mark.parametrize("engine", ["reference", "fast"])
def test_whoever_is_told_of_events_cannot_change_them(tmp_path, engine):
    """Rows were the writer's own: who scaled them in place wrote another log."""
    told = []

    def scale(rows):
        told.append(rows)
        with pytest.raises(ValueError, match="read-only"):
            rows["xa"] *= 2.0

    scene = lattice_gas(36, 0.3)
    right = es.simulate(scene, events=9000, engine=engine, log=True).log
    es.simulate(scene, events=9000, engine=engine, log=tmp_path / "log.npz", on_event=scale)
    assert es.load_log(tmp_path / "log.npz").rows.tobytes() == right.rows.tobytes()
    assert np.concatenate(told).tobytes() == right.rows.tobytes()  # those of the first call too: they were not filled anew


@pytest.mark.parametrize("engine", ["reference", "fast"])
def test_rows_of_a_step_cannot_be_changed(engine):
    sim = es.Simulation(lattice_gas(36, 0.3), engine=engine)
    for rows in (sim.step(), sim.advance_to(1.0)):
        with pytest.raises(ValueError, match="read-only"):
            rows["xa"] = 0.0


class Compiles(ReferenceSession):
    """A session that compiles whenever it is asked for a snapshot, and nowhere else."""

    compile_s = 0.0

    def snapshot(self):
        self.compile_s += 1.0
        return super().snapshot()


def test_no_stopwatch_runs_backwards(tmp_path):
    """What was compiled for the first checkpoint was taken from the time of simulating: -418 ms."""
    scene, stop = lattice_gas(36, 0.3), Stop(events=50)
    wanted = RunOptions(checkpoint=tmp_path / "run.checkpoint")
    outcome = run_session(Compiles(stage_of(scene)), ENGINES["reference"], scene, stop, wanted)
    assert outcome.compile_s >= 2.0
    assert 0.0 < outcome.elapsed_s < 1.0
