"""One task of a sweep: make the scene, run it, measure it, and say it in a row."""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing import parent_process
from typing import TypeAlias

from eventsim import __version__
from eventsim.engines import engine_named
from eventsim.engines.warming import SWITCH as WARM
from eventsim.errors import EventsimError, SceneError, sentence_of
from eventsim.measure import Meter
from eventsim.measure.studies import STUDIES
from eventsim.replay.log import EventLog
from eventsim.runner.loop import run_scene
from eventsim.runner.options import OnEvent, RunOptions, stop_of
from eventsim.scene.scene import Scene
from eventsim.sweep.grid import Task

Cell: TypeAlias = float | int | str | bool | None
Row: TypeAlias = dict[str, Cell]

MakeScene: TypeAlias = Callable[[tuple[str, ...], int | None], Scene]
"""(settings, seed) -> scene; it travels to other processes, so it must be picklable: partial(load_scene, path) is."""


@dataclass(frozen=True, slots=True)
class Plan:
    """What all tasks have in common.

    until, events: None for what the scene says.  discard: as of `Meter`.  studies: names of those that are made as well.
    """

    make: MakeScene
    until: float | None = None
    events: int | None = None
    discard: float | None = None
    engine: str = "auto"
    studies: tuple[str, ...] = ()


def row_of(plan: Plan, task: Task) -> Row:
    """The row of a task: settings, provenance, measures with their errors, theory with its accuracy; `failed` says why it failed.

    A column that is called like a setting has what was set; what was measured of that name is beside it, as NAME_measured.
    Only what the scene, the seed and the version determine is in it: no times of the day, no speed of the machine.
    """
    if parent_process() is not None:  # its siblings have the other cores
        os.environ.setdefault(WARM, "0")
    row, keys = first_cells(task), dict(task.settings)
    try:
        row |= {f"{key}_measured" if key in keys else key: value for key, value in _measured(plan, task).items()}
    except SceneError as error:
        row["failed"] = "; ".join(" ".join(sentence_of(problem).split()) for problem in error.problems)
    except EventsimError as error:
        row["failed"] = " ".join(str(error).split())
    except (ArithmeticError, LookupError, TypeError, ValueError, MemoryError) as error:
        row["failed"] = f"{type(error).__name__}: {error}"
    return row


def first_cells(task: Task) -> Row:
    """What every row of a task begins with."""
    row: Row = {key: _cell(value) for key, value in task.settings}
    return row | {"replica": task.replica, "seed": task.seed, "version": __version__, "failed": None}


def _measured(plan: Plan, task: Task) -> Row:
    scene = plan.make(task.overrides, task.seed)
    meter = Meter(scene, plan.discard)
    stop = stop_of(scene, plan.until, plan.events)
    asked = [one for one in STUDIES if one.name in plan.studies]
    sinks = {one.name: one.sink(scene, plan.discard) for one in asked if one.sink is not None}
    takers: list[OnEvent] = [meter.write, *(sink.write for sink in sinks.values())]
    run = run_scene(engine_named(plan.engine), scene, stop, RunOptions(log=len(sinks) < len(asked), takers=takers))
    if run.stopped == "interrupted":
        raise KeyboardInterrupt
    if run.time == scene.start_time:
        raise EventsimError("no time passes in this run")
    measures = meter.finish(run.time - scene.start_time)
    found = [sink.found(run.time - scene.start_time) for sink in sinks.values()]
    if run.recorded is not None:
        log = EventLog(*run.recorded)
        found += [one.of(log, plan.discard) for one in asked if one.sink is None]
    row: Row = {
        "disks": measures.disks,
        "packing_fraction": measures.packing_fraction,
        "events": run.counters.events,
        "pair_contacts": run.counters.pair_contacts,
        "time": run.time,
        "stopped": run.stopped,
        "energy_residual": run.residuals.energy,
        "momentum_residual": run.residuals.momentum,
        "max_overlap": run.residuals.max_overlap,
        "discarded": measures.discarded,
        "equilibrated": measures.equilibrated,
        "doubts": "; ".join(measures.doubts) or None,
    }
    if (energies := meter.kinetic_energies) is not None:  # of every run: kept or not
        row |= zip(("energy_start", "energy_end"), energies, strict=True)
    for quantity in (*measures.quantities, *(quantity for one in found for quantity in one.quantities)):
        if math.isnan(quantity.value):  # it has no meaning in this run
            continue
        row[quantity.name] = quantity.value
        row[f"{quantity.name}_error"] = quantity.error
        if quantity.theory is not None:
            row[f"{quantity.name}_theory"] = quantity.theory
            row[f"{quantity.name}_accuracy"] = quantity.accuracy
    return row


def _cell(text: str) -> Cell:
    """A setting's value as a number where it is one."""
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text
