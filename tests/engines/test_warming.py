"""Kernels that another process compiles while the run compiles its loop."""

import ast
import inspect
import json
import os
import subprocess
import sys
import threading
import time

import pytest
from click.testing import CliRunner

from eventsim import processes
from eventsim.cli import main
from eventsim.compiler import has_compiler, is_interpreted
from eventsim.engines import auto
from eventsim.engines.auto import LARGE, AutoSession
from eventsim.engines.base import Stop
from eventsim.engines.fast import instant, loop
from eventsim.engines.fast.session import FastSession
from eventsim.engines.reference.loop import ReferenceSession
from eventsim.engines.warming import PARENT, SWITCH, Warming, may_warm
from eventsim.processes import cores
from eventsim.scene.stage import stage_of
from tests.engines.scenes import lattice_gas

GAS = stage_of(lattice_gas(100, 0.3))
LONG = Stop(events=10**9)


class Compiler:
    """A process that compiles; what is asked of it."""

    def __init__(self, begins: bool = True) -> None:
        self.begins = begins
        self.asked: list[str] = []

    def __call__(self, *job: object) -> "Compiler":
        self.asked.append("begin")
        if not self.begins:
            raise OSError("no more processes")
        return self

    def wait(self) -> None:
        self.asked.append("wait")

    def end(self) -> None:
        self.asked.append("end")


class Fast(ReferenceSession):
    """A session in place of one whose kernels would have to be compiled."""

    def __init__(self, stage, keep_rows, saved, others) -> None:
        super().__init__(stage, keep_rows)
        if saved is not None:
            self.restore(saved)
        if others is not None:
            others()


@pytest.fixture
def cold(monkeypatch):
    """Nothing is compiled, and a second core is free."""
    monkeypatch.setattr(auto, "has_compiler", lambda: True)
    monkeypatch.setattr(auto, "may_warm", lambda: True)
    monkeypatch.setattr(auto, "_is_warm", lambda *asked: False)
    monkeypatch.setattr(auto, "PATIENCE", 0.0)
    monkeypatch.setattr(auto, "SAMPLE", 0.0)
    monkeypatch.setattr("eventsim.engines.fast.session.FastSession", Fast)


def changed(stage=GAS) -> AutoSession:
    """A session that has gone over to the fast engine."""
    session = AutoSession(stage)
    session.advance(LONG, 20)
    assert session.at_work == "fast"
    return session


@pytest.mark.parametrize("stage", [GAS, stage_of(lattice_gas(LARGE, 0.3))], ids=["long", "large"])
def test_another_process_compiles_half_of_the_kernels(cold, monkeypatch, stage):
    compiler = Compiler()
    monkeypatch.setattr(auto, "Warming", compiler)
    session = changed(stage)
    assert compiler.asked == ["begin", "wait", "end"]
    events = session.counters.events
    session.advance(LONG, 20)
    assert session.counters.events > events


def test_where_no_process_can_be_started_the_run_compiles_for_itself(cold, monkeypatch):
    compiler = Compiler(begins=False)
    monkeypatch.setattr(auto, "Warming", compiler)
    changed()
    assert compiler.asked == ["begin"]


@pytest.mark.parametrize("reason", ["may_warm", "_is_warm"], ids=["without a free core", "warm"])
def test_no_process_is_begun(cold, monkeypatch, reason):
    compiler = Compiler()
    monkeypatch.setattr(auto, "Warming", compiler)
    monkeypatch.setattr(auto, reason, lambda *asked: reason == "_is_warm")
    changed()
    assert compiler.asked == []


def test_it_is_ended_where_the_run_is_broken_off(cold, monkeypatch):
    compiler = Compiler()
    monkeypatch.setattr(auto, "Warming", compiler)

    def broken_off() -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(compiler, "wait", broken_off)
    with pytest.raises(KeyboardInterrupt):
        changed()
    assert compiler.asked == ["begin", "end"]


def test_a_long_run_begins_with_the_fast_engine_where_its_kernels_are_there(monkeypatch):
    """Though it is asked for its clock before it knows what the job is."""
    monkeypatch.setattr(auto, "has_compiler", lambda: True)
    monkeypatch.setattr(auto, "_is_warm", lambda *asked: True)
    monkeypatch.setattr("eventsim.engines.fast.session.FastSession", Fast)
    session = AutoSession(GAS)
    assert session.clock == ReferenceSession(GAS).clock
    session.advance(LONG, 20)
    assert (session.at_work, session.begun_by) == ("fast", None)


def test_cores_are_counted_by_affinity_and_quota_and_can_be_kept(tmp_path, monkeypatch):
    monkeypatch.delenv(SWITCH, raising=False)
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0, 1, 2, 3}, raising=False)
    for text, count in (("max 100000", 4.0), ("150000 100000", 1.5), ("nonsense", 4.0)):
        quota = tmp_path / "cpu.max"
        quota.write_text(text)
        monkeypatch.setattr(processes, "QUOTA", quota)
        assert (cores(), may_warm()) == (count, count >= 2.0)
    monkeypatch.setenv(SWITCH, "0")
    assert not may_warm()


@pytest.mark.parametrize("is_damaged", [False, True])
def test_the_process_does_its_job_or_fails(monkeypatch, is_damaged):
    """As plain Python there is nothing to compile, but all else is done."""
    monkeypatch.setenv("EVENTSIM_INTERPRET", "1")
    session = ReferenceSession(GAS, False)
    session.advance(Stop(events=20), 10**6)
    if is_damaged:
        monkeypatch.setattr("pickle.dump", lambda job, file: file.write(b"nonsense"))
    process = Warming(GAS, False, session.snapshot())
    assert process.wait() == (not is_damaged)
    process.end()


@pytest.mark.kernels
@pytest.mark.skipif(not is_interpreted(), reason="calls of machine code are not seen from outside")
def test_the_process_compiles_every_kernel():
    """But for the loop, which the run compiles: it would have to compile what is missing."""
    wanted, called = set(), set()
    for module in (instant, loop):
        for function in ast.parse(inspect.getsource(module)).body:
            if isinstance(function, ast.FunctionDef) and any(map(is_kernel, function.decorator_list)):
                wanted.add((module.__file__, function.name))
    session = FastSession(GAS, True)
    sys.setprofile(lambda frame, *_: called.add((frame.f_code.co_filename, frame.f_code.co_name)))
    try:
        session.compile(with_loop=False)
    finally:
        sys.setprofile(None)
    assert len(wanted) > 4
    assert wanted - called == {(loop.__file__, name) for name in ("fill", "run")}  # a session begins with the one


@pytest.mark.kernels
def test_a_run_is_the_same_where_its_loop_is_compiled_first():
    sessions = FastSession(GAS, True), FastSession(GAS, True, others=lambda: None)
    for session in sessions:
        session.advance(Stop(events=100), 10**6)
    assert len({session.take_rows().tobytes() for session in sessions}) == 1


@pytest.mark.slow
def test_a_first_run_is_the_same_as_any_other(tmp_path):
    """With nothing compiled; with all compiled; with the loop alone compiled."""
    if not has_compiler():
        pytest.skip("nothing is compiled here")
    command = [sys.executable, "-m", "eventsim", "run", "gas", "--events", "1000000", "--digest", "--json"]
    environment = {name: value for name, value in os.environ.items() if name != SWITCH}
    digests = []
    for _ in range(3):
        done = subprocess.run(
            command, env=environment | {"EVENTSIM_CACHE_DIR": str(tmp_path)}, capture_output=True, text=True, check=True
        )
        digests.append(json.loads(done.stdout)["digest"])
        for kept in (*tmp_path.rglob("*.ready"), *tmp_path.rglob("*.nb?")) if len(digests) == 2 else ():
            if not kept.name.startswith("loop.run-"):
                kept.unlink()
    assert list(tmp_path.rglob("loop.run-*.nbc"))
    assert len(set(digests)) == 1


def is_kernel(decorator: ast.expr) -> bool:
    return isinstance(decorator, ast.Name) and decorator.id == "kernel"


def test_two_processes_compile_one_after_the_other(tmp_path, monkeypatch):
    compiler = pytest.importorskip("eventsim.engines.fast.numba_compiler")
    monkeypatch.setattr(compiler, "_FOLDER", tmp_path)
    order: list[str] = []

    def second() -> None:
        with compiler.compiling_alone():
            order.append("second")

    with compiler.compiling_alone():
        waiting = threading.Thread(target=second)
        waiting.start()
        waiting.join(0.5)
        order.append("first")
    waiting.join(60.0)
    assert order == ["first", "second"]


def test_the_process_ends_with_its_parent():
    """Which here is another one than it is told."""
    orphan = subprocess.Popen(
        [sys.executable, "-m", "eventsim", "warm", "--job"], stdin=subprocess.PIPE, env=os.environ | {PARENT: "1"}
    )
    wait_for(lambda: orphan.poll() is not None)
    orphan.communicate()
    assert orphan.returncode == 1


def wait_for(condition) -> None:
    end = time.monotonic() + 60.0
    while not condition() and time.monotonic() < end:
        time.sleep(0.02)
    assert condition()


def test_the_command_refuses_where_nothing_compiles(monkeypatch):
    monkeypatch.setenv("EVENTSIM_INTERPRET", "1")
    done = CliRunner().invoke(main, ["warm", "gas"])
    assert done.exit_code == 2
    assert "nothing can be compiled here" in done.output
