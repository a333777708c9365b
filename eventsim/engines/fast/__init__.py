"""The fast engine: the reference engine's algorithm, compiled; the same log, bit for bit."""

from eventsim.engines.fast.session import FastSession

__all__ = ["FastSession"]
