"""The writer: the same rows in the same order, whether beside the engine or in line with it."""

import threading

import numpy as np
import pytest

import eventsim as es
from eventsim.record.events import blank_rows
from eventsim.runner.writer import MANY_ROWS, WAITING, Writer
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
    monkeypatch.setattr("eventsim.runner.writer.MANY_ROWS", 1 << 60)
    in_line = es.simulate(scene, events=stop, engine="fast", log=tmp_path / "b.npz")
    assert beside.digest == in_line.digest == es.load_log(tmp_path / "a.npz").digest()
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()
