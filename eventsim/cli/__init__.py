"""The command line: parse, call one function, print."""

from eventsim.cli.program import main

__all__ = ["main"]
