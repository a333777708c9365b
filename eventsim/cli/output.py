"""What the command line prints, and the codes that it exits with; no character of what others wrote controls the terminal."""

from __future__ import annotations

import re
import sys
from collections.abc import Sequence

import click

from eventsim.cli.folding import folded
from eventsim.letters import is_letter

LINE = "\n"


_broken: list[str] = []


def keep_in_line(arguments: Sequence[str]) -> None:
    """Let no name that was typed break a line of what is said: a line break in one of these is written as an escape."""
    parts = (part for argument in arguments if LINE in argument for part in re.split("[/=]", argument))
    _broken[:] = sorted({part for part in parts if LINE in part}, key=len, reverse=True)


def say(text: str, err: bool = False) -> None:
    """Print lines for people to stdout, or to stderr."""
    click.echo(folded(visible(text)), err=err)


def say_data(text: str) -> None:
    """Print data for programs: no line is broken."""
    click.echo(visible(text))


def visible(text: str) -> str:
    """A text in which control characters and halves of pairs are written as escapes; lines stay lines."""
    if text.isascii() and text.isprintable():
        return text
    for part in _broken:
        text = text.replace(part, part.replace(LINE, r"\n"))
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
