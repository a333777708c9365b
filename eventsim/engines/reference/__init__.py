"""The reference engine: plain Python that reads like the textbook; the oracle of the others."""

from eventsim.engines.reference.loop import ReferenceSession

__all__ = ["ReferenceSession"]
