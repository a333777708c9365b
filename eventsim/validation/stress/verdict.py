"""A verdict: what an engine made of a case, in one word and one sentence."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from time import perf_counter

from eventsim.engines import ONE_LOG
from eventsim.errors import EventsimError
from eventsim.validation.stress.case import CERTIFIED, Bench, Case, GaveUpError, TimeUpError
from eventsim.validation.stress.workers import Silence

COARSE = 0.1
"""Errors below it, in the case's units, are inaccurate; above it the answer is wrong."""

ENERGY = 1e-3
"""Relative change of energy that is worth a verdict of its own."""


class Word(StrEnum):
    """The verdicts, from the best on."""

    RIGHT = "right"
    REFUSED = "refused"
    INACCURATE = "inaccurate"
    ENERGY = "energy"
    WRONG = "wrong"
    SLOW = "hung"


@dataclass(frozen=True, slots=True)
class Verdict:
    """One cell of the atlas.

    error: in the case's units; nan where there is none.  seconds: how long it took.  fault: an event-driven engine that is
    neither right nor refuses for a documented reason.
    """

    case: str
    engine: str
    word: Word
    error: float
    seconds: float
    sentence: str
    fault: bool


def judge(case: Case, engine: str, limit: float) -> Verdict:
    """Run one engine on one case, for at most about `limit` seconds."""
    began = perf_counter()
    bench = Bench(engine, limit)
    error = math.nan
    documented = False
    try:
        error = case.judge(bench)
        word, sentence = _of_error(case, error, bench.energy)
    except GaveUpError as stop:
        documented = stop.stopped in case.refusals
        word, sentence = Word.REFUSED, f"stopped by {stop.stopped}: {stop}"
    except TimeUpError as late:
        word, sentence = Word.SLOW, str(late)
    except EventsimError as refusal:
        word, sentence = Word.REFUSED, str(refusal)
    except Exception as failure:
        # An engine that fails is a finding; the others are still to be judged.
        word, sentence = Word.WRONG, f"failed: {type(failure).__name__}: {failure}"
    return Verdict(case.name, engine, word, error, perf_counter() - began, sentence, is_fault(engine, word, documented))


def hung(case: Case, engine: str, silence: Silence) -> Verdict:
    """The verdict on an engine that did not come back."""
    fault = engine in ONE_LOG
    return Verdict(case.name, engine, Word.SLOW, math.nan, silence.seconds, str(silence), fault)


def is_fault(engine: str, word: Word, documented: bool) -> bool:
    """Whether an engine that claims to be exact falls short of it.

    The engines of ONE_LOG must be right, or refuse with a documented reason.  The certified one may say that it cannot prove a
    scene, or take its time, but not be wrong.
    """
    if word is Word.RIGHT or (word is Word.REFUSED and documented):
        return False
    return engine in ONE_LOG or (engine == CERTIFIED and word not in (Word.REFUSED, Word.SLOW))


def _of_error(case: Case, error: float, energy: float) -> tuple[Word, str]:
    if error <= case.tolerance:
        return Word.RIGHT, f"error {error:.2g}, allowed {case.tolerance:.2g}" if error else "no error"
    if abs(energy) > ENERGY:
        return Word.ENERGY, f"energy {'gained' if energy > 0.0 else 'lost'}: {100.0 * energy:+.2g} %"
    if error <= COARSE:
        return Word.INACCURATE, f"off by {error:.2g}, allowed {case.tolerance:.2g}"
    return Word.WRONG, f"off by {error:.2g}, allowed {case.tolerance:.2g}"
