"""Work in processes of their own, each of which is ended from outside where it does not come back."""

from __future__ import annotations

import multiprocessing
import signal
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from time import perf_counter
from typing import Any, Generic, TypeVar

from eventsim.processes import obey_parent

Item = TypeVar("Item")
Answer = TypeVar("Answer")

TICK = 0.2
"""Seconds between two looks at processes that say nothing."""

WAITED_FOR = 10.0
"""In times of patience: how long a process is waited for by the wall clock, which other programs may fill."""


@dataclass(frozen=True, slots=True)
class Silence:
    """No answer: after so many seconds the process had ended, or was ended."""

    seconds: float
    ended: bool

    def __str__(self) -> str:
        return f"{'its process ended' if self.ended else 'did not come back'} after {self.seconds:.1f} s"


@dataclass(slots=True)
class _Worker(Generic[Item]):
    """A process at work: where to hear from it, the items without an answer yet, when the first of them began."""

    process: BaseProcess
    pipe: Connection
    left: list[Item]
    began: float


def answers(
    work: Callable[[Item], Answer], jobs: Sequence[Sequence[Item]], workers: int, patience: float
) -> Iterator[tuple[Item, Answer | Silence]]:
    """(item, work(item)) as answers come; each job, a list of items, has a process of its own, `workers` of them at a time.

    work: importable by its name; items and answers: picklable.  patience: seconds of computing for one item.  A process that
    ends or takes longer, or sleeps for ten times as long, costs only that item, whose answer is a Silence.
    """
    waiting = [list(job) for job in jobs if job]
    running: list[_Worker[Item]] = []
    try:
        while waiting or running:
            while waiting and len(running) < max(workers, 1):
                running.append(_started(work, waiting.pop(0), patience))
            ready = wait([worker.pipe for worker in running], timeout=TICK)
            for worker in list(running):
                answer = _heard(worker, worker.pipe in ready, patience)
                if answer is None:
                    continue
                yield worker.left.pop(0), answer if isinstance(answer, Silence) else answer[0]
                worker.began = perf_counter()
                if worker.left and not isinstance(answer, Silence):
                    continue
                running.remove(worker)
                _end(worker)
                if worker.left:
                    waiting.insert(0, worker.left)
    finally:
        for worker in running:
            _end(worker)


def _started(work: Callable[[Item], Any], items: list[Item], patience: float) -> _Worker[Item]:
    context = multiprocessing.get_context("spawn")
    here, there = context.Pipe(duplex=False)
    process = context.Process(target=_work, args=(work, tuple(items), there, patience), daemon=True)
    process.start()
    there.close()
    return _Worker(process, here, items, perf_counter())


def _work(work: Callable[[Item], Any], items: Sequence[Item], pipe: Connection, patience: float) -> None:
    """What a process does; Ctrl-C is left to its parent.  The system ends it where an item takes too long."""
    obey_parent()
    for item in items:
        if hasattr(signal, "setitimer"):
            signal.setitimer(signal.ITIMER_PROF, patience)
        pipe.send((work(item),))
    pipe.close()


def _heard(worker: _Worker[Item], ready: bool, patience: float) -> tuple[Any] | Silence | None:
    """The next answer of a process, alone in a tuple; None where it is still to be waited for."""
    seconds = perf_counter() - worker.began
    if ready:
        try:
            answer: tuple[Any] = worker.pipe.recv()
        except (EOFError, ConnectionError):
            worker.process.join()
            return Silence(seconds, ended=worker.process.exitcode != -getattr(signal, "SIGPROF", 0))
        return answer
    return Silence(seconds, ended=False) if seconds > WAITED_FOR * patience else None


def _end(worker: _Worker[Item]) -> None:
    worker.process.kill()
    worker.process.join()
    worker.pipe.close()
