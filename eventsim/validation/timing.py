"""How long engines take: CPU seconds of runs of engines that are warm, repeated where they are short."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from statistics import median
from typing import NamedTuple

from eventsim.engines.base import Session
from eventsim.engines.stepped.session import SteppedSession
from eventsim.validation.follow import follow

REPEATS, SHORT_S = 5, 0.2
"""Runs that are timed, of those that are shorter than this; of longer ones there is one."""

WARM_S = 0.2
"""CPU seconds for which an engine runs before any stopwatch does: the first steps of a library load and compile."""

Open = Callable[[], Session]


class Timing(NamedTuple):
    """CPU seconds of runs that did the same: their median, the least, the most, and how many there were."""

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
    if not known_s and seconds[0] < SHORT_S:
        seconds.clear()  # caches are warm now, which is most of a run of some microseconds
    while len(seconds) < (REPEATS if not seconds or min(seconds) < SHORT_S else 1):
        seconds.append(_seconds(opened(), times))
    return Timing(median(seconds), min(seconds), max(seconds), len(seconds))


def _seconds(session: Session, times: Sequence[float]) -> float:
    """What a run takes, or its steps where there are steps."""
    if not isinstance(session, SteppedSession):
        return follow(session, times).elapsed_s
    session.only_step()
    follow(session, times)
    return session.stepping_s
