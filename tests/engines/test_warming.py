"""Kernels that another process compiles while the reference engine goes on."""

import ast
import inspect
import os
import subprocess
import sys
import threading
import time

import pytest
from click.testing import CliRunner

from eventsim import processes
from eventsim.cli import main
from eventsim.compiler import is_interpreted
from eventsim.engines import auto
from eventsim.engines.auto import COLD, AutoSession, first_engine, reference_seconds
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
    """A process that is at work for so many questions, and then has failed or not."""

    begun = 0

    def __init__(self, questions: int, has_failed: bool) -> None:
        self.questions, self.has_failed = questions, has_failed

    def __call__(self, *job: object) -> "Compiler":
        self.begun += 1
        return self

    @property
    def is_at_work(self) -> bool:
        self.questions -= 1
        return self.questions >= 0


@pytest.fixture
def cold(monkeypatch):
    """Nothing is compiled, and a second core is free; which engines would have been handed over to."""
    handed: list[bool] = []
    monkeypatch.setattr(auto, "has_compiler", lambda: True)
    monkeypatch.setattr(auto, "may_warm", lambda: True)
    monkeypatch.setattr(auto, "_is_warm", lambda *asked: False)
    monkeypatch.setattr(auto, "PATIENCE", 0.0)
    monkeypatch.setattr(auto, "SAMPLE", 0.0)
    monkeypatch.setattr(AutoSession, "_hand_over", lambda self: handed.append(self._is_cold))
    return handed


def advanced(session: AutoSession, times: int) -> AutoSession:
    for _ in range(times):
        session.advance(LONG, 20)
    return session


def test_a_long_run_goes_on_while_kernels_are_compiled_and_takes_them_up(cold, monkeypatch):
    compiler = Compiler(3, has_failed=False)
    monkeypatch.setattr(auto, "Warming", compiler)
    session = advanced(AutoSession(GAS), 4)
    assert compiler.begun == 1
    assert cold == []
    events = session.counters.events
    monkeypatch.setattr(auto, "_is_warm", lambda *asked: True)
    advanced(session, 1)
    assert cold == [False]
    assert session.counters.events > events > 0


def test_a_compiler_that_failed_is_not_asked_again(cold, monkeypatch):
    compiler = Compiler(1, has_failed=True)
    monkeypatch.setattr(auto, "Warming", compiler)
    advanced(AutoSession(GAS), 3)
    assert (compiler.begun, cold) == (1, [True])


def test_where_no_process_can_be_started_the_run_compiles_for_itself(cold, monkeypatch):
    def refused(*job: object) -> None:
        raise OSError("no more processes")

    monkeypatch.setattr(auto, "Warming", refused)
    advanced(AutoSession(GAS), 1)
    assert cold == [True]


def test_without_a_free_core_a_long_run_begins_with_the_compiler(cold, monkeypatch):
    stop = Stop(events=int(2.0 * COLD / (reference_seconds(GAS, Stop(events=10**6)) / 10**6)))
    assert first_engine(GAS, stop) == "reference"
    monkeypatch.setattr(auto, "may_warm", lambda: False)
    assert first_engine(GAS, stop) == "fast"


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
    assert not process.has_failed
    wait_for(lambda: not process.is_at_work)
    assert process.has_failed == is_damaged


@pytest.mark.kernels
@pytest.mark.skipif(not is_interpreted(), reason="calls of machine code are not seen from outside")
def test_the_process_compiles_every_kernel():
    """A run that takes over would have to compile what is missing."""
    wanted, called = set(), set()
    for module in (instant, loop):
        for function in ast.parse(inspect.getsource(module)).body:
            if isinstance(function, ast.FunctionDef) and any(map(is_kernel, function.decorator_list)):
                wanted.add((module.__file__, function.name))
    session = FastSession(GAS, True)
    sys.setprofile(lambda frame, *_: called.add((frame.f_code.co_filename, frame.f_code.co_name)))
    try:
        session.compile()
    finally:
        sys.setprofile(None)
    assert len(wanted) > 4
    assert wanted <= called | {(loop.__file__, "fill")}  # a session begins with that


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
