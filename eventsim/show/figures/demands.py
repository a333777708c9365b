"""What figures ask of a log: that time passes in it, and that something happens."""

from __future__ import annotations

from eventsim.errors import LogError
from eventsim.record.events import Kind
from eventsim.replay.log import AnyLog
from eventsim.replay.passage import Passage


def passage_with_time(log: AnyLog) -> Passage:
    """Return the passage through a log; raise LogError where no time passes in it."""
    passage = Passage(log)
    start, end = passage.span
    if start == end:
        raise LogError(f"there is nothing to draw: the log ends where it begins, at {start!r}")
    return passage


def with_events(log: AnyLog, kind: Kind | None = None) -> None:
    """Raise LogError where a log has no events (of a kind)."""
    if len(log) == 0:
        raise LogError("there is nothing to draw: the log has no events")
    if kind is not None and not any((rows["kind"] == kind).any() for rows in log.blocks()):
        raise LogError(f"there is nothing to draw: the log has no {kind.label} contacts")
