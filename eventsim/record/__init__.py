"""WHAT HAPPENED: the rows of a log, where they come from, their digest and their files."""

from eventsim.record.events import Kind, State
from eventsim.record.provenance import Ending, Provenance

__all__ = ["Ending", "Kind", "Provenance", "State"]
