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
    """Time runs through `times` from new; stepped engines only step, and tell nothing on their way.

    Args:
        opened: what opens a session of the engine.
        times: what the runs pass, increasing.
        known_s: what runs of the very same work have taken already.
    """
    seconds = list(known_s)
    while len(seconds) < (REPEATS if not seconds or min(seconds) < SHORT_S else 1):
        session = opened()
        if isinstance(session, SteppedSession):
            session.only_step()
        seconds.append(follow(session, times).elapsed_s)
    return Timing(median(seconds), min(seconds), max(seconds), len(seconds))
