"""What people type who guess: verbs, options and kinds of figures by other names, and what these are called here."""

from __future__ import annotations

import re
from pathlib import Path

import click

from eventsim import suffixes
from eventsim.errors import did_you_mean

VERBS = {
    **dict.fromkeys(("simulate", "sim", "start", "play", "resume"), "run"),
    **dict.fromkeys(("plot", "draw", "graph"), "figure"),
    **dict.fromkeys(("movie", "video", "film", "render"), "animate"),
    **dict.fromkeys(("list", "scenes", "examples", "copy", "show", "new", "init"), "gallery"),
    **dict.fromkeys(("analyze", "analyse", "stats", "statistics"), "measure"),
    **dict.fromkeys(("scan", "parameters"), "sweep"),
    **dict.fromkeys(("compare", "verify"), "validate"),
    **dict.fromkeys(("prove", "proof"), "certify"),
    **dict.fromkeys(("test", "doctor", "version"), "selftest"),
    **dict.fromkeys(("gui", "view", "serve", "browser"), "live"),
    **dict.fromkeys(("info", "explain", "lint"), "check"),
}
"""Verbs of other programs."""

TIMES, COUNTS, FILES = ("--until", "--at", "--to"), ("--events",), ("--out", "--log", "--figure")
OPTIONS = {
    **dict.fromkeys(("--out", "--output", "--outfile", "--save", "--file", "-o"), FILES),
    **dict.fromkeys(("--time", "--times", "--duration", "--end", "--tmax", "--t-max", "--t-end", "--stop", "-t", "-T"), TIMES),
    **dict.fromkeys(("--steps", "--n-events", "--max-events", "--collisions", "--contacts", "--n", "-n"), COUNTS),
    **dict.fromkeys(("--param", "--parameter", "--define", "-p", "-D"), ("--set",)),
    **dict.fromkeys(("--type", "--what"), ("--kind",)),
    **dict.fromkeys(("--colour", "--colors", "--colours"), ("--color",)),
    **dict.fromkeys(("--step", "--timestep", "--time-step"), ("--dt",)),
}
"""Options of other programs, and those of ours that may be meant, the likeliest first."""

KINDS = {
    **dict.fromkeys(("energy", "temperature", "pressure", "time-series"), "series"),
    **dict.fromkeys(("paths", "tracks", "positions"), "trajectories"),
    **dict.fromkeys(("velocity", "velocities", "maxwell"), "speeds"),
    **dict.fromkeys(("events", "contacts", "collisions"), "raster"),
    **dict.fromkeys(("diffusion", "displacement"), "msd"),
    **dict.fromkeys(("gr", "g(r)", "rdf", "psi6"), "structure"),
    **dict.fromkeys(("density",), "profile"),
}
"""What people want a figure of, and the kind that shows it."""


def verb_hint(word: str, verbs: tuple[str, ...]) -> str:
    """What to say of a verb that there is not: what is meant, where that can be told."""
    if word == "help":
        return ": eventsim --help lists the verbs, eventsim VERB --help explains one"
    meant = VERBS.get(word.lower())
    if meant is not None:
        return f": eventsim {meant}; eventsim --help lists all verbs"
    if Path(word).suffix.lower() in (*suffixes.SCENES, *suffixes.LOGS) or _is_built_in(word):
        verb = "measure" if Path(word).suffix.lower() in suffixes.LOGS else "run"
        return f": a verb comes first, as in eventsim {verb} {word}"
    return f"{did_you_mean(word, verbs)}; eventsim --help lists them"


def _is_built_in(word: str) -> bool:
    from eventsim.scene.gallery import names  # only who errs pays for it

    return word in names()


def option_hint(option: str, context: click.Context | None) -> str | None:
    """The option of a verb that is meant by one that it does not have, with its help; None where that cannot be told."""
    if context is None:
        return None
    mine = {name: one for one in context.command.params if isinstance(one, click.Option) for name in one.opts}
    meant = next((name for name in OPTIONS.get(option, ()) if name in mine), None)
    if meant is None:
        return None
    one = mine[meant]
    return f"no such option: {option}. Here it is {' '.join(text for text in (meant, one.metavar) if text)}: {one.help}"


def kind_hint(message: str) -> str:
    """Which kind of figure is meant where a choice of kinds was refused; empty where that cannot be told."""
    found = re.match(r"'([^']*)' is not one of (.*'trajectories'.*)\.", message)
    if found is None:
        return ""
    word, kinds = found[1].lower(), re.findall(r"'([^']*)'", found[2])
    meant = KINDS.get(word.replace("_", "-"))
    if meant is None:
        return did_you_mean(word, kinds)
    return f" It is shown by {meant!r}."
