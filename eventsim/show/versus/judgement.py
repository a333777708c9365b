"""The figure of a judgement: positions, times of contacts, energy against time, and the verdict beside them."""

from __future__ import annotations

import math
from os import PathLike
from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from eventsim.show.figures.style import label
from eventsim.show.output import as_written
from eventsim.show.palette import KINDS, LIGHT
from eventsim.show.versus.notes import note
from eventsim.show.versus.page import save_page
from eventsim.validation.judge.judgement import ASTRAY, Judgement
from eventsim.validation.judge.words import judged_in_words

SIZE = (13.6, 7.65)
"""Inches: 16 to 9."""

LETTERS, TITLE_LETTERS = 62, 125
"""In a line of the verdict, of the title."""

LEAST = 1e-16
"""In diameters: smaller errors are drawn here."""

WRONG = "#b3261e"
"""Red: no engine and no kind has it."""

MOST_MARKS = 40
"""Faults that are drawn; more would be a wall of lines."""


def write_judgement(judgement: Judgement, path: str | PathLike[str]) -> None:
    """Draw a judgement to `path`: .png, .svg or .pdf.  Raises EventsimError where it cannot be written."""
    figure = Figure(figsize=SIZE, dpi=110, facecolor="white", layout="constrained")
    draw_judgement(figure, judgement)
    save_page(figure, path)


def draw_judgement(figure: Figure, judgement: Judgement) -> None:
    """Draw a judgement onto a figure: panels, marks at what is wrong, the verdict."""
    words = judged_in_words(judgement)
    title = fill(f"{judgement.source} on {judgement.name}: {words[0]}", TITLE_LETTERS)
    figure.suptitle(as_written(title), fontsize=13, x=0.01, ha="left", color=LIGHT.ink)
    grid = figure.subplots(2, 2)
    _draw_positions(grid[0, 0], judgement)
    _draw_late(grid[1, 0], judgement)
    _draw_energy(grid[0, 1], judgement)
    _draw_words(grid[1, 1], [judgement.told.capitalize() + ".", *words[1:]])
    for axes in (grid[0, 0], grid[1, 0], grid[0, 1]):
        axes.set_xlim(judgement.times[0], judgement.times[-1])
        for place, fault in enumerate(judgement.faults[:MOST_MARKS]):
            axes.axvline(fault.time, color=WRONG, lw=1.6 if place == 0 else 0.5, alpha=1.0 if place == 0 else 0.35, zorder=1)


def _draw_positions(axes: Axes, judgement: Judgement) -> None:
    """Errors of positions, and what float64 can know of them; both horizons."""
    truth = judgement.truth
    axes.semilogy(judgement.looks, np.maximum(judgement.errors, LEAST), color=KINDS[0], lw=1.6, label="the engine judged")
    doubt = np.maximum(truth.uncertainty, LEAST)
    axes.semilogy(judgement.looks, doubt, color=LIGHT.faint, lw=1.2, label="the last bit of the start (event-driven)")
    axes.axhline(ASTRAY, color=LIGHT.ink, lw=0.8, ls=(0, (4, 3)))
    axes.set_ylim(LEAST / 3.0, 30.0)
    for time, text, height in ((judgement.lost, "positions lost", 1e-6), (judgement.believed, "float64 ends", 1e-9)):
        if math.isfinite(time):
            axes.axvline(time, color=LIGHT.ink, lw=1.1, ls=":")
            left = time > 0.5 * (judgement.times[0] + judgement.times[-1])
            style = {"ha": "right" if left else "left"}
            note(axes, f"{text}\nt = {time:.4g}", (time, height), offset=(-5 if left else 5, 0), **style)
    first = judgement.first_fault
    if first is not None:
        middle = 0.5 * (judgement.times[0] + judgement.times[-1])
        side = {"ha": "right", "offset": (-5, 0)} if first.time > middle else {"offset": (5, 0)}
        note(axes, f"first wrong event:\n{first.kind}", (first.time, 1e-12), color=WRONG, weight="bold", **side)
    axes.legend(loc="lower right", fontsize=9, framealpha=0.95)
    label(axes, "time", "position error [diameters]", "How far positions can be followed")


def _draw_late(axes: Axes, judgement: Judgement) -> None:
    """By how much each found contact is late."""
    times, late = judgement.charge.errors.T if len(judgement.charge.errors) else (np.empty(0), np.empty(0))
    axes.plot(times, late, ".", ms=5, color=KINDS[0])
    missed = [fault.time for fault in judgement.faults if fault.kind == "missed"]
    axes.plot(missed, np.zeros(len(missed)), "x", ms=8, mew=2.0, color=WRONG, gid="missed")
    axes.axhline(0.0, color=LIGHT.ink, lw=0.9)
    bound = 1.15 * float(np.abs(late).max(initial=0.0)) or judgement.tolerance
    axes.set_ylim(-bound, bound)
    charge = judgement.charge
    text = f"{charge.found} found, {charge.missed} missed, {charge.doubled} doubled, {charge.false} false"
    label(axes, "time", "late by [time]", f"Contacts: {text}")


def _draw_energy(axes: Axes, judgement: Judgement) -> None:
    """The change of the energy."""
    if judgement.energy is None:
        axes.set_axis_off()
        return
    known = np.isfinite(judgement.energy)
    axes.plot(judgement.times[known], judgement.energy[known], color=KINDS[2], lw=1.2)
    if float(np.abs(judgement.energy[known]).max()) < 1e-4:
        axes.set_ylim(-1e-4, 1e-4)
    label(axes, "time", "change of the energy [of that at the start]", "Energy")


def _draw_words(axes: Axes, sentences: list[str]) -> None:
    """The rest of the verdict."""
    axes.set_axis_off()
    text = "\n\n".join(fill(sentence, LETTERS) for sentence in sentences)
    axes.text(0.0, 1.0, as_written(text), transform=axes.transAxes, va="top", fontsize=10.5, color=LIGHT.ink, linespacing=1.25)
