"""The page: the player's parts and a packed log in one html file that needs nothing else."""

from __future__ import annotations

import html
import json
from importlib.resources import files
from pathlib import Path
from string import Template

from eventsim.replay.log import AnyLog
from eventsim.replay.passage import Passage
from eventsim.show.output import title_of
from eventsim.show.player.pack import packed

SCRIPTS = ("world.js", "drawing.js", "player.js", "load.js")
FRAME_HEIGHT = 560
"""CSS pixels of a player inside a notebook."""

MOST_EVENTS = 50_000
"""Events (4 MB) beyond which a notebook shows a run as text: each output stays in the notebook's file."""


def page(
    log: AnyLog,
    *,
    color: str | None = None,
    dark: bool = False,
    trails: bool = False,
    velocities: bool = False,
    flash: bool = False,
    seconds: float | None = None,
) -> str:
    """Return an html page that plays a log; seconds: how long that lasts at the speed that it begins with.

    Raises EventsimError where the log has no time to play or the colouring does not exist.
    """
    view = {"dark": dark, "trails": trails, "arrows": velocities, "flash": flash, "impulse": False}
    description, numbers = packed(log, color, seconds)
    parts = files(__package__)
    return Template(parts.joinpath("player.html").read_text(encoding="utf-8")).substitute(
        title=html.escape(title_of(log)),
        style=parts.joinpath("player.css").read_text(encoding="utf-8"),
        script="\n".join(parts.joinpath(name).read_text(encoding="utf-8") for name in SCRIPTS),
        description=json.dumps(description | view, allow_nan=False).replace("<", "\\u003c"),
        numbers=numbers,
    )


def notebook_frame(log: AnyLog) -> str | None:
    """Return the player as an html element of its own; None for a log too long for a notebook, or without time."""
    if len(log) > MOST_EVENTS:
        return None
    start, end = Passage(log).span
    if start == end:
        return None
    source = html.escape(page(log), quote=True)
    return f'<iframe srcdoc="{source}" style="width: 100%; height: {FRAME_HEIGHT}px; border: 0"></iframe>'


def write_page(part: Path, text: str) -> None:
    """Write a page to the file `part`."""
    part.write_text(text, encoding="utf-8")
