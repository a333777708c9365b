"""The atlas: every engine on every case, each engine in a process of its own that is ended where it does not come back."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path

from eventsim.validation.stress.case import PROOF, Case
from eventsim.validation.stress.catalogue import CASES
from eventsim.validation.stress.verdict import Verdict, Word, hung, judge
from eventsim.validation.stress.workers import Silence, answers

PATIENCE = 180.0
"""Seconds of computing beyond the limit after which an engine is ended from outside: kernels may have to be compiled."""

COLUMNS = ("scene", "engine", "verdict", "fault", "error", "tolerance", "seconds", "sentence")

ToldContacts = Callable[[Verdict], None]


def atlas_of(
    cases: Sequence[Case], engines: Sequence[str], limit: float, workers: int, told: ToldContacts | None = None
) -> list[Verdict]:
    """Judge every engine on every case, `workers` engines at a time; told(verdict) is called with each as it comes.

    limit: seconds for one engine on one case.  Verdicts are in the order of the cases, then of the engines.
    """
    # What compiles most begins first, so that all others are done beside it.
    jobs = [[(engine, case.name) for case in cases] for engine in sorted(engines, key=lambda name: name != "fast")]
    found: dict[tuple[str, str], Verdict] = {}
    for (engine, name), answer in answers(partial(judge_named, limit=limit), jobs, workers, PROOF * limit + PATIENCE):
        verdict = hung(CASES[name], engine, answer) if isinstance(answer, Silence) else answer
        found[name, engine] = verdict
        if told is not None:
            told(verdict)
    return [found[case.name, engine] for case in cases for engine in engines]


def judge_named(cell: tuple[str, str], limit: float) -> Verdict:
    """Judge a cell of the atlas, (engine, case)."""
    engine, name = cell
    return judge(CASES[name], engine, limit)


def write_csv(verdicts: Iterable[Verdict], path: Path) -> None:
    """Write the atlas as a table, one row a verdict."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(COLUMNS)
        for v in verdicts:
            error = "" if v.word in (Word.REFUSED, Word.SLOW) else repr(v.error)
            tolerance = repr(CASES[v.case].tolerance)
            writer.writerow((v.case, v.engine, v.word, int(v.fault), error, tolerance, f"{v.seconds:.3f}", v.sentence))
