"""The atlas: every engine on every case, each engine in a process of its own that is ended where it does not come back."""

from __future__ import annotations

import csv
import multiprocessing
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from pathlib import Path
from time import perf_counter

from eventsim.validate.stress.case import Case
from eventsim.validate.stress.catalogue import CASES
from eventsim.validate.stress.verdict import Verdict, Word, hung, judge

PATIENCE = 180.0
"""Seconds beyond the limit after which an engine is ended from outside: kernels for a scene may have to be compiled."""

COLUMNS = ("scene", "engine", "verdict", "fault", "error", "tolerance", "seconds", "sentence")

Told = Callable[[Verdict], None]


@dataclass(slots=True)
class _Worker:
    """A process that judges one engine: where to hear from it, which cases are left, when the present one began.

    patience: seconds for one case.  ended: it will say no more.
    """

    engine: str
    process: BaseProcess
    pipe: Connection
    left: list[Case]
    began: float
    patience: float
    ended: bool = False


def atlas_of(
    cases: Sequence[Case], engines: Sequence[str], limit: float, workers: int, told: Told | None = None
) -> list[Verdict]:
    """Judge every engine on every case, `workers` engines at a time; told(verdict) is called with each as it comes.

    limit: seconds for one engine on one case.  Verdicts are in the order of the cases, then of the engines.
    """
    found: dict[tuple[str, str], Verdict] = {}
    for verdict in _verdicts(list(cases), list(engines), limit, max(workers, 1)):
        found[verdict.case, verdict.engine] = verdict
        if told is not None:
            told(verdict)
    return [found[case.name, engine] for case in cases for engine in engines]


def _verdicts(cases: list[Case], engines: list[str], limit: float, workers: int) -> Iterator[Verdict]:
    waiting = list(engines) if cases else []
    running: list[_Worker] = []
    try:
        while waiting or running:
            while waiting and len(running) < workers:
                running.append(_started(waiting.pop(0), cases, limit))
            ready = wait([worker.pipe for worker in running], timeout=0.2)
            for worker in list(running):
                verdict = _heard(worker, worker.pipe in ready)
                if verdict is None:
                    continue
                yield verdict
                worker.left.pop(0)
                worker.began = perf_counter()
                if worker.left and not worker.ended:
                    continue
                running.remove(worker)
                _end(worker)
                if worker.left:
                    running.append(_started(worker.engine, worker.left, limit))
    finally:
        for worker in running:
            _end(worker)


def _started(engine: str, cases: list[Case], limit: float) -> _Worker:
    context = multiprocessing.get_context("spawn")
    here, there = context.Pipe(duplex=False)
    names = [case.name for case in cases]
    process = context.Process(target=judge_all, args=(names, engine, limit, there), daemon=True)
    process.start()
    there.close()
    return _Worker(engine, process, here, list(cases), perf_counter(), limit + PATIENCE)


def judge_all(names: Iterable[str], engine: str, limit: float, pipe: Connection) -> None:
    """Judge an engine on cases, one after the other; what a process of the atlas does."""
    for name in names:
        pipe.send(judge(CASES[name], engine, limit))
    pipe.close()


def _heard(worker: _Worker, ready: bool) -> Verdict | None:
    """The next verdict from a process, or on it: one that ends or takes too long has hung."""
    seconds = perf_counter() - worker.began
    if ready:
        try:
            verdict: Verdict = worker.pipe.recv()
        except EOFError:
            worker.ended = True
            return hung(worker.left[0], worker.engine, seconds, "its process ended")
        return verdict
    if seconds > worker.patience:
        worker.ended = True
        return hung(worker.left[0], worker.engine, seconds)
    return None


def _end(worker: _Worker) -> None:
    worker.process.kill()
    worker.process.join()
    worker.pipe.close()


def write_csv(verdicts: Iterable[Verdict], path: Path) -> None:
    """Write the atlas as a table, one row a verdict."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(COLUMNS)
        for v in verdicts:
            error = "" if v.word in (Word.REFUSED, Word.SLOW) else repr(v.error)
            tolerance = repr(CASES[v.case].tolerance)
            writer.writerow((v.case, v.engine, v.word, int(v.fault), error, tolerance, f"{v.seconds:.3f}", v.sentence))
