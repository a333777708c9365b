"""What the command line prints, and the codes that it exits with; no character of what others wrote controls the terminal."""

from __future__ import annotations

import sys

import click

from eventsim.letters import is_letter

LINE = "\n"


def say(text: str, err: bool = False) -> None:
    """Print lines to stdout, or to stderr."""
    click.echo(visible(text), err=err)


def visible(text: str) -> str:
    """A text in which control characters and halves of pairs are written as escapes; lines stay lines."""
    if text.isascii() and text.isprintable():
        return text
    return "".join(_visible(letter) for letter in text)


def _visible(letter: str) -> str:
    if letter == LINE or is_letter(letter):
        return letter
    return letter.encode("ascii", "backslashreplace").decode() if ord(letter) > 127 else f"\\x{ord(letter):02x}"


def write_what_is_known() -> None:
    """Let stdout and stderr write letters that their encoding does not have as escapes."""
    for stream in (sys.stdout, sys.stderr):
        reconfigure = getattr(stream, "reconfigure", None)  # a test may have put another stream there
        if reconfigure is not None:
            reconfigure(errors="backslashreplace")


DONE = 0
FAILED = 1
BAD_INPUT = 2
STOPPED_EARLY = 3
INTERRUPTED = 130
