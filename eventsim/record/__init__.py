"""WHAT HAPPENED: the rows of a log, where they come from, their files, their digest, and replay."""

from eventsim.record.events import Kind, State
from eventsim.record.log import EventLog, MemorySink, load_log
from eventsim.record.provenance import Ending, Provenance

__all__ = ["Ending", "EventLog", "Kind", "MemorySink", "Provenance", "State", "load_log"]
