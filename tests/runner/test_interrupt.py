"""Ctrl-C: at once while a session prepares itself, else between two of its stints; what has happened is kept."""

import signal
import threading
from contextlib import suppress

import pytest

import eventsim as es
from eventsim.engines import auto
from eventsim.engines.auto import AutoSession
from eventsim.engines.base import BrokenOffError, Stop
from eventsim.engines.reference import ReferenceSession
from eventsim.runner.interrupts import unmissed_interrupts
from eventsim.runner.loop import run_session
from eventsim.runner.options import RunOptions
from eventsim.scene.stage import stage_of
from tests.engines.scenes import lattice_gas

SCENE = lattice_gas(30, 0.3, es.Periodic)


class Preparing(ReferenceSession):
    """A session that is interrupted while it prepares the rest of its work, after some events."""

    prepares = False

    def advance(self, stop, budget):
        if self.counters.events < 20:
            return super().advance(stop, budget)
        self.prepares = True
        signal.raise_signal(signal.SIGINT)
        raise AssertionError("the interrupt did not break in")


class Busy(ReferenceSession):
    """A session that is interrupted at work."""

    came_back = False

    def advance(self, stop, budget):
        signal.raise_signal(signal.SIGINT)
        stopped = super().advance(stop, budget)
        self.came_back = True
        return stopped


def driven(session):
    return run_session(session, "reference", SCENE, Stop(events=10**6), RunOptions(log=True))


def test_an_interrupt_breaks_into_preparations_and_what_happened_is_kept():
    run = driven(Preparing(stage_of(SCENE)))
    assert run.stopped == "interrupted"
    assert len(run.recorded.rows) == run.counters.events >= 20


def test_an_interrupt_waits_for_the_end_of_a_stint():
    session = Busy(stage_of(SCENE))
    run = driven(session)
    assert session.came_back
    assert run.stopped == "interrupted"
    assert len(run.recorded.rows) > 0


def test_a_second_interrupt_breaks_into_a_stint():
    class Stubborn(Busy):
        def advance(self, stop, budget):
            signal.raise_signal(signal.SIGINT)
            return super().advance(stop, budget)

    with pytest.raises(KeyboardInterrupt):
        driven(Stubborn(stage_of(SCENE)))


def test_a_hand_over_that_is_broken_off_leaves_the_session_as_it_was(monkeypatch):
    fast = pytest.importorskip("eventsim.engines.fast")
    for name in ("PATIENCE", "SAMPLE", "WARM"):
        monkeypatch.setattr(auto, name, 0.0)
    monkeypatch.setattr(auto, "SURE", float("inf"))
    monkeypatch.setattr(auto, "_is_warm", lambda *asked: True)
    session = AutoSession(stage_of(SCENE))

    def refuse(*args, **options):
        assert session.prepares
        raise BrokenOffError

    with monkeypatch.context() as patch:
        patch.setattr(fast, "FastSession", refuse)
        with pytest.raises(BrokenOffError):
            session.advance(Stop(events=10**5), 64)
    assert not session.prepares
    assert session.at_work == "reference"
    rows = session.take_rows()
    assert len(rows) == session.counters.events > 0


def test_nothing_is_kept_of_a_run_that_is_broken_off_before_it_began(monkeypatch):
    fast = pytest.importorskip("eventsim.engines.fast")
    monkeypatch.setattr(auto, "LARGE", 1)

    def refuse(*args, **options):
        signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(fast, "FastSession", refuse)
    with pytest.raises(KeyboardInterrupt):
        run_session(AutoSession(stage_of(SCENE)), "auto", SCENE, Stop(events=100), RunOptions())


def test_the_fast_engine_prepares_itself_while_it_compiles():
    pytest.importorskip("numba")
    from numba import njit
    from numba.extending import overload

    from eventsim.engines.fast import FastSession
    from eventsim.engines.fast.compiled import timed_compiling

    session = FastSession(stage_of(SCENE))
    seen, seconds = [], []

    def probe(x):
        raise NotImplementedError

    @overload(probe)
    def ask(x):  # called by numba in the middle of a compilation
        seen.append(session.prepares)
        return lambda x: x

    with timed_compiling(seconds.append):
        assert njit(lambda x: probe(x))(3) == 3
    assert set(seen) == {True}
    assert not session.prepares
    assert len(seconds) == 1


@pytest.mark.skipif(threading.current_thread() is not threading.main_thread(), reason="signals come to the main thread")
def test_an_interrupt_that_somebody_swallows_is_not_missed():
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt), unmissed_interrupts(), suppress(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
        with pytest.raises(KeyboardInterrupt), unmissed_interrupts():
            signal.raise_signal(signal.SIGINT)
        with unmissed_interrupts():
            pass
    finally:
        signal.signal(signal.SIGINT, before)
