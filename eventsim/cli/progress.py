"""How far a long piece of work has come, on a terminal's stderr."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import perf_counter
from types import TracebackType
from typing import TYPE_CHECKING

from eventsim.cli.output import visible

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID


PATIENCE = 0.5
"""Seconds of work before a bar appears: short work shows none and does not pay for importing one."""


IDLE = 2.0
"""Seconds without an event after which the bar says so: disks that only wrap may do so for ever."""


class ProgressBar:
    """A callback (fraction, events, time) that draws a bar; nothing where stderr is not a terminal."""

    def __init__(self, quiet: bool = False) -> None:
        self._wanted = not quiet and sys.stderr.isatty()
        self._begun = perf_counter()
        self._last = (0, 0.0, self._begun)  # events, the scene's clock and ours when they last became more
        self._bar: Progress | None = None
        self._task: TaskID | None = None

    def __enter__(self) -> ProgressBar:
        return self

    def __call__(self, fraction: float | None, events: int, time: float) -> None:
        """Show the fraction done (None: unknown), the number of events so far and the scene's clock."""
        if events != self._last[0]:
            self._last = events, time, perf_counter()
        _, last, seen = self._last
        idle = f", none since clock {last:.6g}" if perf_counter() - seen > IDLE else ""
        self.show(fraction, f"{events:,} events{idle}, clock {time:.6g}")

    def show(self, fraction: float | None, text: str) -> None:
        """Show the fraction done (None: unknown) and a text beside the bar."""
        if not self._wanted:
            return
        if self._bar is None or self._task is None:
            if perf_counter() - self._begun < PATIENCE:
                return
            self._bar, self._task = _new_bar()
        done = None if fraction is None else min(max(fraction, 0.0), 1.0)
        total = None if done is None else 1.0
        self._bar.update(self._task, completed=done, total=total, text=text)

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Take the bar away, so that the summary stands alone."""
        if self._bar is not None:
            self._bar.stop()


def _new_bar() -> tuple[Progress, TaskID]:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

    bar = Progress(
        BarColumn(),
        TaskProgressColumn(),
        TextColumn("{task.fields[text]}"),
        TimeRemainingColumn(),
        console=Console(stderr=True),
        transient=True,
    )
    bar.start()
    return bar, bar.add_task("", total=None, text="")


class TaskBar:
    """A callback (done, all) that draws a bar of tasks; nothing where stderr is not a terminal."""

    def __init__(self, quiet: bool = False) -> None:
        self._bar = ProgressBar(quiet)

    def __enter__(self) -> TaskBar:
        return self

    def __call__(self, done: int, total: int) -> None:
        """Show how many of the tasks are done."""
        self._bar.show(done / total, f"{done:,} of {total:,} runs")

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Take the bar away."""
        self._bar.__exit__(kind, error, trace)


CLEAR = "\r\x1b[K"


@contextmanager
def status_line(quiet: bool) -> Iterator[Callable[[str], None]]:
    """Give a function that shows a line; it shows nothing where stderr is not a terminal."""
    wanted = not quiet and sys.stderr.isatty()

    def tell(text: str) -> None:
        if wanted:
            sys.stderr.write(f"{CLEAR}{visible(text)[:100]}")
            sys.stderr.flush()

    try:
        yield tell
    finally:
        if wanted:
            sys.stderr.write(CLEAR)
            sys.stderr.flush()
