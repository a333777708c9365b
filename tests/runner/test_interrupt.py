"""Interrupts: a run that is asked to end keeps what has happened; the signals of the caller's process are left alone."""

import os
import signal
import subprocess
import sys
import threading
import time
from contextlib import suppress

import numpy as np
import pytest

import eventsim as es
from eventsim.cli.signals import interruptible, terminable
from eventsim.engines import auto, engine_named
from eventsim.engines.auto import AutoSession
from eventsim.engines.base import BrokenOffError, Stop
from eventsim.engines.reference.loop import ReferenceSession
from eventsim.runner.loop import run_session
from eventsim.runner.options import Interrupt, RunOptions
from eventsim.scene.stage import stage_of
from eventsim.suffixes import LOGS
from tests.engines.scenes import lattice_gas

SCENE = lattice_gas(30, 0.3, es.Periodic)
IN_MAIN = pytest.mark.skipif(
    threading.current_thread() is not threading.main_thread(), reason="signals come to the main thread"
)


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


def run_of(session, engine="reference", events=10**6, **wanted):
    """A run as the command line has it."""
    with interruptible() as interrupt:
        wanted = RunOptions(interrupt=interrupt, **wanted)
        return run_session(session, engine_named(engine), SCENE, Stop(events=events), wanted)


@IN_MAIN
def test_an_interrupt_breaks_into_preparations_and_what_happened_is_kept():
    run = run_of(Preparing(stage_of(SCENE)), log=True)
    assert run.stopped == "interrupted"
    assert len(run.recorded.rows) == run.counters.events >= 20


@IN_MAIN
def test_an_interrupt_waits_for_the_end_of_a_stint():
    session = Busy(stage_of(SCENE))
    run = run_of(session, log=True)
    assert session.came_back
    assert run.stopped == "interrupted"
    assert len(run.recorded.rows) > 0


@IN_MAIN
def test_a_second_interrupt_breaks_into_a_stint():
    class Stubborn(Busy):
        def advance(self, stop, budget):
            signal.raise_signal(signal.SIGINT)
            return super().advance(stop, budget)

    with pytest.raises(KeyboardInterrupt):
        run_of(Stubborn(stage_of(SCENE)))


@IN_MAIN
def test_a_hand_over_that_is_broken_off_leaves_the_session_as_it_was(monkeypatch):
    fast = pytest.importorskip("eventsim.engines.fast.session")
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


@IN_MAIN
def test_nothing_is_kept_of_a_run_that_is_broken_off_before_it_began(monkeypatch):
    fast = pytest.importorskip("eventsim.engines.fast.session")
    monkeypatch.setattr(auto, "LARGE", 1)

    def refuse(*args, **options):
        signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(fast, "FastSession", refuse)
    with pytest.raises(KeyboardInterrupt):
        run_of(AutoSession(stage_of(SCENE)), "auto", events=100)


def test_the_fast_engine_prepares_itself_while_it_compiles():
    pytest.importorskip("numba")
    from numba import njit
    from numba.extending import overload

    from eventsim.engines.fast.compiled import timed_compiling
    from eventsim.engines.fast.session import FastSession

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


@IN_MAIN
def test_an_interrupt_that_somebody_swallows_is_not_missed():
    """The destructors and callbacks of compilers do."""

    class Deaf(ReferenceSession):
        def __init__(self, stage):
            super().__init__(stage)
            with suppress(KeyboardInterrupt):
                signal.raise_signal(signal.SIGINT)

    with interruptible() as interrupt:
        session = Deaf(stage_of(SCENE))
        wanted = RunOptions(interrupt=interrupt)
        assert run_session(session, engine_named("reference"), SCENE, Stop(events=10**6), wanted).stopped == "interrupted"


def test_another_thread_can_ask_a_run_to_end():
    interrupt = Interrupt()
    threading.Timer(0.1, interrupt.ask).start()
    run = es.simulate(SCENE, events=10**9, engine="reference", log=True, interrupt=interrupt)
    assert run.stopped == "interrupted"
    assert len(run.log) == run.counters.events > 0


def test_ctrl_c_in_a_loop_of_simulations_ends_the_loop(tmp_path):
    code = f"""
import threading, signal, time, os
import eventsim as es
scene, done = es.gallery("gas", n=30), 0
threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT)).start()
try:
    while True:
        es.simulate(scene, events=2000, engine="reference", log=f"{tmp_path}/{{done}}.csv")
        done += 1
except KeyboardInterrupt:
    print(done)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    count = int(done.stdout)
    for number in range(count):
        assert len(es.load_log(tmp_path / f"{number}.csv")) >= 2000
    rest = tmp_path / f"{count}.csv.part"
    assert not (tmp_path / f"{count}.csv").exists()
    if rest.exists():
        es.load_log(rest)


def lone(domain, velocity=(0.7, 0.3)):
    return es.Scene(es.Disks([[0.5, 0.5]], [velocity], 0.1), domain)


ENDLESS = {
    "cooled by 1e12": lambda: es.gallery("cooling", n=100, restitution=0.8),
    "alone": lambda: lone(es.Periodic((1.3, 0.7))),
    "alone in a box": lambda: lone(es.Box((1.3, 0.7))),
    "quiet for long": lambda: es.Scene(
        es.Disks([[0.25, 0.25], [0.75, 0.75]], [[1.0, 0.0], [1.0, 2.0**-50]], 0.1), es.Periodic((1.0, 1.0))
    ),
}


@pytest.fixture(scope="module")
def measuring_kernels():
    """Compiled, since a signal breaks into compiling at the end of a run; with numba loaded so many rows are enough."""
    pytest.importorskip("numba")
    es.simulate(es.gallery("gas", n=16), events=5000, engine="reference", measure=True)


@IN_MAIN
@pytest.mark.usefixtures("measuring_kernels")
@pytest.mark.parametrize("name", ENDLESS)
def test_a_measured_run_hears_signals_within_a_second(name):
    """A gas that had cooled was measured for 53 s after it had been asked to end.  Seconds are CPU time: others may run."""
    scene, cools, asked = ENDLESS[name](), name.startswith("cooled"), []

    def ask():
        asked.append(time.process_time())
        os.kill(os.getpid(), signal.SIGINT)

    def told(rows):
        cold.append(float(np.abs(rows["vxa"]).max()) < 1e-6)

    def at_work(*_):  # only then is there a session to be asked
        if waiting.ident is None and ((cold and cold[-1]) or not cools):
            waiting.start()

    waiting, cold = threading.Timer(0.05, ask), []
    with interruptible() as interrupt:
        try:
            run = es.simulate(
                scene, 1e30 if cools else 1e9, engine="reference", measure=True, interrupt=interrupt,
                on_event=told if cools else None, progress=at_work,
            )  # fmt: skip
        finally:
            waiting.cancel()
    assert time.process_time() - asked[0] < 1.0
    assert run.stopped == "interrupted"
    assert run.has_measures


@IN_MAIN
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_the_handlers_of_the_caller_are_honoured(number):
    class OursError(Exception):
        pass

    def raised(_number, _frame):
        raise OursError

    before = signal.signal(number, raised)
    try:
        with pytest.raises(OursError):
            es.simulate(SCENE, events=10**9, engine="reference", on_event=lambda rows: os.kill(os.getpid(), number))
        assert signal.getsignal(number) is raised
    finally:
        signal.signal(number, before)


@IN_MAIN
@pytest.mark.parametrize(
    ("suffix", "compact", "turns"),
    [
        (".csv", False, 5),
        (".npz", True, 5),
        *(pytest.param(suffix, compact, 50, marks=pytest.mark.slow) for suffix in LOGS for compact in (False, True)),
    ],
)
def test_whatever_a_run_is_broken_off_at_its_log_can_be_read(tmp_path, suffix, compact, turns):
    """Ctrl-C breaks in anywhere: in the middle of an event, of a block, of a column."""
    if suffix == ".parquet":
        pytest.importorskip("pyarrow")
    rng = np.random.default_rng(1)
    whole = es.simulate(SCENE, events=3000, engine="reference", log=True).log
    before, found = signal.signal(signal.SIGALRM, signal.default_int_handler), []

    def arm(rows):
        if rows["event"][0] == 0:
            signal.setitimer(signal.ITIMER_REAL, rng.uniform(0.001, 0.1))

    try:
        for turn in range(turns):
            path = tmp_path / f"{turn}{suffix}"
            with suppress(KeyboardInterrupt):
                es.simulate(SCENE, events=3000, engine="reference", log=path, compact=compact, on_event=arm)
            signal.setitimer(signal.ITIMER_REAL, 0.0)
            part = path.with_name(path.name + ".part")
            if part.exists():
                rows = es.load_log(part).rows
                found.append(len(rows))
                assert rows["remainder"].tobytes() == whole.rows["remainder"][: len(rows)].tobytes()
            else:
                assert len(es.load_log(path)) >= 3000
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
    assert found


@IN_MAIN
def test_a_simulation_that_was_broken_off_in_an_event_is_refused_until_it_is_restored(monkeypatch):
    sim = es.Simulation(SCENE, engine="reference")
    sim.advance_to(0.5)
    saved, straight = sim.snapshot(), es.Simulation(SCENE, engine="reference")
    resolve = ReferenceSession._resolve_instant

    def broken_off(session):
        resolve(session)
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(ReferenceSession, "_resolve_instant", broken_off)
        with pytest.raises(KeyboardInterrupt):
            sim.advance_to(2.0)
    for again in (sim.step, sim.snapshot, lambda: sim.advance_to(2.0), lambda: sim.set_velocity(0, (0.0, 0.0))):
        with pytest.raises(es.EventsimError, match="broken off in the middle of an event"):
            again()
    sim.restore(saved)
    sim.advance_to(2.0)
    straight.advance_to(2.0)
    assert sim.log.digest() == straight.log.digest()


@IN_MAIN
def test_a_verb_that_is_asked_to_terminate_is_interrupted_and_then_the_handler_is_the_old_one():
    before = signal.getsignal(signal.SIGTERM)
    with pytest.raises(KeyboardInterrupt), terminable():
        signal.raise_signal(signal.SIGTERM)
    assert signal.getsignal(signal.SIGTERM) is before
