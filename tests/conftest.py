"""What holds for all tests."""

from __future__ import annotations

import os
import signal
import subprocess
from collections.abc import Iterator
from typing import Any

import pytest

from eventsim.compiler import is_interpreted

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    # Whoever starts tests in the background makes them ignore interrupts, and all programs that they start to interrupt them.
    signal.signal(signal.SIGINT, signal.default_int_handler)


os.environ.setdefault("EVENTSIM_WARM", "0")
"""Tests compile in their own process: another one would take the core of those beside them."""


@pytest.fixture(autouse=True)
def no_process_is_left(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """End what a test has started and not ended, as one that fails does: a run without an end would go on for ever."""
    started: list[subprocess.Popen[Any]] = []

    class Started(subprocess.Popen):
        def __init__(self, *words: Any, **options: Any) -> None:
            super().__init__(*words, **options)
            started.append(self)

    monkeypatch.setattr(subprocess, "Popen", Started)
    yield
    for process in started:
        if process.poll() is None:
            process.kill()
            process.wait()


@pytest.fixture(autouse=True)
def lines_are_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let tests read what is said as it is; that it is broken to fit a terminal has a test of its own."""
    monkeypatch.setattr("eventsim.cli.output.folded", str)


@pytest.fixture(scope="module")
def chromium(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """A browser for the tests of a module."""
    from tests.show.browser import browser

    with browser(tmp_path_factory.mktemp("profile")) as opened:
        yield opened


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Let tests of the fast engine run its kernels as plain Python, in a run of their own: compiling takes longer than they do.

    Such tests have the marker `kernels`, or the parameter engine = "fast".  Compiled they are slow, but for those that
    are marked `compiled`.
    """
    for item in items:
        call = getattr(item, "callspec", None)
        asked = item.get_closest_marker("kernels") or (call is not None and call.params.get("engine") == "fast")
        if asked and bool(item.get_closest_marker("compiled")) == is_interpreted():
            item.add_marker("slow")
        if asked:
            item.add_marker("kernels")
