"""How long engines take: CPU seconds of runs of engines that are warm, repeated where they are short."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import ceil
from statistics import fmean, median
from typing import NamedTuple

from eventsim.engines.base import Session
from eventsim.engines.stepped.session import SteppedSession
from eventsim.validation.follow import follow

REPEATS, SHORT_S = 5, 0.2
"""How often runs are timed that are shorter than this; of longer ones there is one."""

MEASURABLE_S, MOST = 1e-3, 100
"""CPU seconds that are read from a stopwatch at least: a shorter run is done so often, from new, that it takes so long in all;
but not more often than this."""

WARM_S = 0.2
"""CPU seconds for which an engine runs before any stopwatch does: the first steps of a library load and compile."""

Open = Callable[[], Session]


class Timing(NamedTuple):
    """CPU seconds of runs that did the same: their median, the least, the most, and how often they were timed."""

    median: float
    least: float
    most: float
    runs: int

    def per(self, duration: float) -> Timing:
        """The same for each unit of time of the scene."""
        return Timing(self.median / duration, self.least / duration, self.most / duration, self.runs)


def warm_up(opened: Open, times: Sequence[float]) -> None:
    """Let an engine run a little, and forget it."""
    follow(opened(), times, WARM_S)


def timing_of(opened: Open, times: Sequence[float], known_s: Sequence[float] = ()) -> Timing:
    """Time runs through `times` from new; of stepped engines only the steps are timed, and they tell nothing on their way.

    Args:
        opened: what opens a session of the engine.
        times: what the runs pass, increasing.
        known_s: what runs of the very same work have taken already.
    """
    seconds = list(known_s) or [_seconds(opened(), times)]
    if min(seconds) < SHORT_S:  # caches are warm now, which is most of a run of some microseconds
        often = ceil(MEASURABLE_S / max(min(seconds), MEASURABLE_S / MOST))
        seconds = [fmean(_seconds(opened(), times) for _ in range(often)) for _ in range(REPEATS)]
    return Timing(median(seconds), min(seconds), max(seconds), len(seconds))


def _seconds(session: Session, times: Sequence[float]) -> float:
    """What a run takes, or its steps where there are steps."""
    if not isinstance(session, SteppedSession):
        return follow(session, times).elapsed_s
    session.only_step()
    follow(session, times)
    return session.stepping_s
