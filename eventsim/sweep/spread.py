"""Spread the tasks of a sweep over workers, and gather their rows in order."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import CancelledError, Executor, Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing import get_context
from os import PathLike
from pathlib import Path
from typing import TypeAlias

from eventsim import __version__
from eventsim.errors import EventsimError
from eventsim.processes import obey_parent
from eventsim.sweep.grid import Task, tasks_of
from eventsim.sweep.journal import Journal, identity_of
from eventsim.sweep.table import FORMAT, check_suffix, write_table
from eventsim.sweep.task import MakeScene, Plan, Row, first_cells, row_of

TRIES = 3
"""How often a task is given to a worker: one that crashes three workers is to blame itself."""

Progress: TypeAlias = Callable[[int, int], None]
"""Called with the number of tasks that are done, and of all."""


def sweep(
    make: MakeScene,
    grid: Mapping[str, Sequence[object]],
    *,
    replicas: int = 1,
    seed: int = 1,
    until: float | None = None,
    events: int | None = None,
    discard: float | None = None,
    studies: Sequence[str] = (),
    engine: str = "auto",
    out: str | PathLike[str] | None = None,
    workers: int = 1,
    executor: Executor | None = None,
    progress: Progress | None = None,
    name: str | None = None,
) -> list[Row]:
    """Run a scene for every combination of values; a row of measures for each run, in the order of the grid.

    make(settings, seed) gives the scene.  grid: key of the scene -> values.  replicas: runs for each combination, every one with
    its own seed, derived from `seed`.  out: FILE.csv or .parquet; a journal beside it lets an interrupted sweep go on.
    name: what the table calls the scene.  studies: names of those (`measure.studies`) that are made of each run.
    workers: processes; or else any concurrent.futures executor (that of Dask: Client(...).get_executor()).
    The rows do not depend on workers, executor, interrupts or resumption.

    Raises EventsimError where nothing can be run; a single run that fails is a row with its reason in `failed`.
    """
    path = None if out is None else check_suffix(Path(out))
    tasks = tasks_of({key: [_written(value) for value in values] for key, values in grid.items()}, replicas, seed)
    plan = Plan(make, until, events, discard, engine, tuple(studies))
    _demand_chance(plan, tasks[0], replicas)
    journal = None if path is None else Journal(path, identity_of(plan, tasks[0]))
    done: dict[str, Row] = {} if journal is None else journal.done
    waiting = [task for task in tasks if task.name not in done]
    whole = False
    try:
        for task, row in _rows(plan, waiting, workers, executor):
            if journal is None:
                done[task.name] = row
            else:
                journal.add(task, row)
            if progress is not None:
                progress(sum(task.name in done for task in tasks), len(tasks))
        rows = [done[task.name] for task in tasks]
        if path is not None:
            write_table(path, rows, _provenance(name, plan, grid, replicas, seed))
        whole = True
    finally:
        if journal is not None:
            journal.close(whole)
    return rows


def _provenance(
    name: str | None, plan: Plan, grid: Mapping[str, Sequence[object]], replicas: int, seed: int
) -> dict[str, object]:
    """Where a table comes from: all that the runs depend on, nothing of how they were spread."""
    return {
        "format": FORMAT,
        "version": __version__,
        "scene": name,
        "grid": {key: [_written(value) for value in values] for key, values in grid.items()},
        "replicas": replicas,
        "seed": seed,
        "until": plan.until,
        "events": plan.events,
        "discard": plan.discard,
        **({"studies": list(plan.studies)} if plan.studies else {}),
        "engine": plan.engine,
    }


def _written(value: object) -> str:
    """A value as a setting has it; numbers keep every bit."""
    if isinstance(value, bool):
        return str(value).lower()
    return value if isinstance(value, str) else repr(value.item() if hasattr(value, "item") else value)


def _demand_chance(plan: Plan, task: Task, replicas: int) -> None:
    """Raise where replicas would be copies: the scene does not depend on the seed."""
    if replicas == 1:
        return
    try:
        same = plan.make(task.overrides, task.seed).disks == plan.make(task.overrides, task.seed + 1).disks
    except EventsimError:
        return  # the row will say what is wrong
    if same:
        raise EventsimError("replicas would all be the same run: nothing in the scene draws random numbers")


def _rows(plan: Plan, tasks: list[Task], workers: int, executor: Executor | None) -> Iterator[tuple[Task, Row]]:
    """(task, row) as they are done."""
    if workers < 1:
        raise EventsimError(f"workers = {workers}: must be at least 1")
    if executor is not None:
        yield from _gather(executor, plan, tasks)
        return
    if workers == 1:
        for task in tasks:
            yield task, row_of(plan, task)
        return
    waiting = dict.fromkeys(tasks)
    while waiting:
        try:
            with _processes(min(workers, len(waiting))) as pool:
                for task, row in _gather(pool, plan, list(waiting)):
                    del waiting[task]
                    yield task, row
        except BrokenProcessPool:
            # A worker died, and with it the pool. Whose fault it was shows when the suspects run alone.
            for task in list(waiting)[: 2 * workers]:
                del waiting[task]
                yield task, _alone(plan, task)


def _gather(executor: Executor, plan: Plan, tasks: Sequence[Task]) -> Iterator[tuple[Task, Row]]:
    """(task, row) of tasks that an executor does, as they are done."""
    futures: dict[Future[Row], Task] = {executor.submit(row_of, plan, task): task for task in tasks}
    try:
        for future in as_completed(list(futures)):
            yield futures[future], future.result()
    except CancelledError:
        raise EventsimError(
            "the executor gave up its tasks: its scheduler or its workers are gone; the same sweep again goes on from what is "
            "done"
        ) from None
    finally:
        for future in futures:
            future.cancel()


def _alone(plan: Plan, task: Task) -> Row:
    """The row of a task that has a process of its own; a row that says so where it dies again and again."""
    for _ in range(TRIES):
        try:
            with _processes(1) as pool:
                return pool.submit(row_of, plan, task).result()
        except BrokenProcessPool:
            continue
    return first_cells(task) | {"failed": f"its worker died {TRIES} times (is there enough memory?)"}


@contextmanager
def _processes(workers: int) -> Iterator[Executor]:
    """Fresh processes, the same on every system; Ctrl-C is left to the parent."""
    pool = ProcessPoolExecutor(workers, mp_context=get_context("spawn"), initializer=obey_parent)
    try:
        yield pool
    except BaseException:
        for process in list(getattr(pool, "_processes", {}).values()):
            process.terminate()
        pool.shutdown(wait=False, cancel_futures=True)
        raise
    pool.shutdown()
