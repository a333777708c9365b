"""Whether the contacts of a run come ever faster, so that it may look endless and its log grow without bound."""

from __future__ import annotations

from eventsim.engines.base import Session, Stop
from eventsim.formulas.clock import clock_time
from eventsim.scene.settling import settling_of

FIRST = 64
"""Events from which on the pace of the start is known."""

WINDOW = 1 << 20
"""Events of which the pace is looked at after that."""

FASTER = 100.0
"""A pace so many times that of the start is worth a word."""


class Pace:
    """Looks at a session between its stints; told: the sentence that there is to say, None before."""

    def __init__(self, session: Session, stop: Stop) -> None:
        """Begin where a session stands."""
        self.told: str | None = None
        self._session, self._stop = session, stop
        self._events, self._time = self._now()
        self._rate: float | None = None

    def look(self) -> str | None:
        """Look at what has come since; the sentence when it is to be said, once."""
        events, time = self._now()
        passed, lasted = events - self._events, time - self._time
        if self.told is not None or passed < (FIRST if self._rate is None else WINDOW) or not lasted > 0.0:
            return None
        self._events, self._time = events, time
        if self._rate is None:
            self._rate = passed / lasted
            return None
        if passed / lasted < FASTER * self._rate:
            return None
        self.told = self._sentence(time, passed / lasted)
        return self.told

    def _now(self) -> tuple[int, float]:
        session = self._session
        stage = session.stage
        return session.counters.events, clock_time(*session.clock, stage.epoch_length, stage.start_time)

    def _sentence(self, time: float, rate: float) -> str:
        assert self._rate is not None
        stage, until = self._session.stage, self._stop.until
        words = f"by t = {time:.6g} contacts come every {1.0 / rate:.2g}, {rate / self._rate:,.0f} times as often as at first"
        if until is not None and until > time:
            words += f"; at this pace until = {until:g} is {(until - time) * rate:.2g} contacts away"
        settling, duration = settling_of(stage), stage.law.duration
        if settling is not None and duration is not None:
            words += f"; a disk that would rest {settling.cost(duration)}"
            if settling.duration is not None and settling.duration > duration:
                words += f", and {settling.rule()}"
        return words
