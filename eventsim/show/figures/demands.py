"""What figures ask of a log: that time passes in it, and that something happens."""

from __future__ import annotations

from eventsim.errors import LogError
from eventsim.record.events import Kind
from eventsim.replay.log import EventLog
from eventsim.replay.replay import Replay


def replay_with_time(log: EventLog) -> Replay:
    """Return the replay of a log; raise LogError where no time passes in it."""
    replay = Replay(log)
    start, end = replay.span
    if start == end:
        raise LogError(f"there is nothing to draw: the log ends where it begins, at {start!r}")
    return replay


def with_events(log: EventLog, kind: Kind | None = None) -> None:
    """Raise LogError where a log has no events (of a kind)."""
    if len(log) == 0:
        raise LogError("there is nothing to draw: the log has no events")
    if kind is not None and not (log.kind == kind).any():
        raise LogError(f"there is nothing to draw: the log has no {kind.label} contacts")
