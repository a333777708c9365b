"""A run that is over: what it gave, and the way back into its past."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Self, TypeVar

from eventsim.errors import LogError
from eventsim.record.events import State
from eventsim.replay.log import EventLog
from eventsim.replay.replay import one_time
from eventsim.runner.outcome import Outcome

Log = TypeVar("Log", bound=EventLog)


@dataclass(slots=True)
class PastRun(Outcome):
    """An outcome that knows the states in between."""

    _log: EventLog | None = None

    @classmethod
    def of(cls, outcome: Outcome) -> Self:
        """What an engine's run came out as, to look back on."""
        return cls(**{item.name: getattr(outcome, item.name) for item in fields(Outcome)})

    @property
    def has_log(self) -> bool:
        """Whether a log was kept."""
        return self.recorded is not None or self.log_path is not None

    @property
    def log(self) -> EventLog:
        """The log; one that was streamed to a file is read when first asked for.  Raises LogError where none was kept."""
        return self._kept(EventLog)

    def _kept(self, kind: type[Log]) -> Log:
        """The log, as a class that has more to offer."""
        if not isinstance(self._log, kind):
            if self.recorded is not None:
                self._log = kind(*self.recorded)
            elif self.log_path is not None:
                self._log = kind.loaded(self.log_path)
            else:
                raise LogError("this run kept no log: simulate(..., log=True), or log='file.csv'")
        return self._log

    def _log_for(self, method: str) -> EventLog:
        """The log, for a method that cannot do without; raises LogError, which names it."""
        if not self.has_log:
            raise LogError(f"{method} needs the log of the run: simulate(..., log=True)")
        return self.log

    def state_at(self, time: float) -> State:
        """The state at any time of the run, by replay of its log; at the time of an event, the state after it.

        Of a stepped engine: free flight from the last sample of its trajectory before.
        Raises LogError where no log was kept or the time is outside the run.
        """
        if self.trajectory is not None:
            time = one_time(time)
            if not self.start_time <= time <= self.time:
                raise LogError(
                    f"there is no state at time {time!r}: the run is from {self.start_time!r} to {self.time!r}"
                )
            return replace(self.trajectory.state_at(time, self.start_time), scene=self.scene)
        return self._log_for("state_at").state_at(time)
