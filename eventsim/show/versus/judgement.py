"""The figure of a judgement: positions, times of contacts, energy against time, and the verdict beside them."""

from __future__ import annotations

import math
from os import PathLike
from textwrap import fill
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from eventsim.record.events import Floats
from eventsim.show.figures.style import label
from eventsim.show.output import as_written
from eventsim.show.palette import KINDS, LIGHT
from eventsim.show.versus.notes import ACROSS, note
from eventsim.show.versus.page import save_page
from eventsim.validation.judge.judgement import ASTRAY, Judgement
from eventsim.validation.judge.words import judged_in_words

SIZE = (13.6, 7.65)
"""Inches: 16 to 9."""

LETTERS, TITLE_LETTERS = 76, 120
"""In a line of the verdict, of the title."""

LETTER, LINES = 10.5, 17
"""The size of the verdict's letters, in points, where it has at most so many lines; more lines are smaller."""

LEAST, BELOW = 1e-16, 1e-19
"""In diameters: smaller errors are drawn at the first one; the axis goes down to the second one, and names its curves there."""

ASIDE = 0.1
"""Of the time from the first contact that was compared to the last one: how much more is drawn on both sides."""

PLAIN = (-3, 4)
"""Decimal exponents of numbers that are written in full beside an axis; others have the power of ten apart."""

WRONG = "#b3261e"
"""Red: no engine and no kind has it."""

SLIGHT = 1e-4
"""Of the energy: smaller changes than this are drawn on an axis that makes them small."""

MOST_MARKS = 40
"""Faults that are drawn; more would be a wall of lines."""


def write_judgement(judgement: Judgement, path: str | PathLike[str]) -> None:
    """Draw a judgement to `path`: .png, .svg or .pdf.  Raises EventsimError where it cannot be written."""
    figure = Figure(figsize=SIZE, dpi=110, facecolor="white", layout=ConstrainedLayoutEngine(h_pad=0.08))
    draw_judgement(figure, judgement)
    save_page(figure, path)


def draw_judgement(figure: Figure, judgement: Judgement) -> None:
    """Draw a judgement onto a figure: panels, marks at what is wrong, the verdict."""
    words = judged_in_words(judgement)
    first, stop, rest = words[0].partition(". ")
    title = fill(f"{judgement.source} on {judgement.name}. {first}{stop}", TITLE_LETTERS)
    figure.suptitle(as_written(title), fontsize=13, x=0.01, ha="left", color=LIGHT.ink)
    grid = figure.add_gridspec(2, 2)
    positions, late = figure.add_subplot(grid[0, 0]), figure.add_subplot(grid[1, 0])
    _draw_positions(positions, judgement)
    _draw_late(late, judgement)
    panels = [positions, late]
    if judgement.energy is not None:
        panels.append(figure.add_subplot(grid[0, 1]))
        _draw_energy(panels[-1], judgement.times, judgement.energy, judgement.lawful)
    told = [f"{judgement.told.capitalize()}.", *([rest] if rest else []), *words[1:]]
    _draw_words(figure.add_subplot(grid[:, 1] if judgement.energy is None else grid[1, 1]), told)
    for axes in panels:
        axes.set_xlim(*(_seen(judgement) if axes is late else (judgement.times[0], judgement.times[-1])))
        for place, fault in enumerate(judgement.faults[:MOST_MARKS]):
            axes.axvline(fault.time, color=WRONG, lw=1.6 if place == 0 else 0.5, alpha=1.0 if place == 0 else 0.35, zorder=1)


def _seen(judgement: Judgement) -> tuple[float, float]:
    """The times between which contacts were compared, and some more: what comes later is empty."""
    begin, end = float(judgement.times[0]), float(judgement.times[-1])
    fault = judgement.first_fault
    times = [*judgement.charge.compared_at, *([] if fault is None else [fault.time])]
    if not times:
        return begin, end
    aside = max(ASIDE * (max(times) - min(times)), judgement.tolerance)
    return max(min(times) - aside, begin), min(max(times) + aside, end)


def _draw_positions(axes: Axes, judgement: Judgement) -> None:
    """Errors of positions, and what float64 can know of them; both horizons."""
    truth = judgement.truth
    axes.semilogy(judgement.looks, np.maximum(judgement.errors, LEAST), color=KINDS[0], lw=1.6, label="the engine judged")
    doubt = np.maximum(truth.uncertainty, LEAST)
    axes.semilogy(judgement.looks, doubt, color=LIGHT.faint, lw=1.2, label="event-driven, the last bit of its start changed")
    axes.axhline(ASTRAY, color=LIGHT.ink, lw=0.8, ls=(0, (4, 3)))
    axes.set_ylim(BELOW, 30.0)
    axes.set_yticks([10.0**power for power in range(-16, 1, 4)])
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
    axes.legend(loc="lower center", ncols=2, fontsize=9, framealpha=1.0, edgecolor="white", borderaxespad=0.2)
    label(axes, "time", "position error [diameters]", "How far positions can be followed")


def _draw_late(axes: Axes, judgement: Judgement) -> None:
    """By how much each found contact is late."""
    times, late = judgement.charge.errors.T if len(judgement.charge.errors) else (np.empty(0), np.empty(0))
    axes.plot(times, late, ".", ms=7, color=KINDS[0])
    missed = [fault.time for fault in judgement.faults if fault.kind == "missed"]
    axes.plot(missed, np.zeros(len(missed)), "x", ms=8, mew=2.0, color=WRONG, gid="missed")
    axes.axhline(0.0, color=LIGHT.ink, lw=0.9)
    bound = 1.15 * float(np.abs(late).max(initial=0.0)) or judgement.tolerance
    axes.set_ylim(-bound, bound)
    axes.ticklabel_format(axis="y", scilimits=PLAIN)
    if not len(times) and not missed:
        note(axes, "no contact was compared", (0.5, 0.6), "axes fraction", ha="center")
    charge = judgement.charge
    text = f"{charge.found} found, {charge.missed} missed, {charge.doubled} doubled, {charge.false} false"
    label(axes, "time", "late by [time]", f"Contacts: {text}")


def _draw_energy(axes: Axes, times: Floats, energy: Floats, lawful: float | None) -> None:
    """The change of the energy; by how much it has changed at the end of the event-driven run, where contacts take some."""
    known = np.isfinite(energy)
    axes.plot(times[known], energy[known], color=KINDS[2], lw=1.2)
    if float(np.abs(energy[known]).max()) < SLIGHT:
        axes.set_ylim(-SLIGHT, SLIGHT)
    if lawful is not None:
        axes.axhline(lawful, color=LIGHT.ink, lw=0.8, ls=(0, (4, 3)))
        note(axes, "event-driven, at the end", (0.02, lawful), ACROSS, (0, 4))
        axes.margins(y=0.1)
    axes.ticklabel_format(axis="y", scilimits=PLAIN)
    label(axes, "time", "change, of that at the start", "Energy")


def _draw_words(axes: Axes, sentences: list[str]) -> None:
    """The rest of the verdict."""
    axes.set_axis_off()
    text = "\n\n".join(fill(sentence, LETTERS) for sentence in sentences)
    size = LETTER * min(1.0, LINES / (text.count("\n") + 1))
    style: dict[str, Any] = {"transform": axes.transAxes, "va": "top", "fontsize": size, "color": LIGHT.ink, "linespacing": 1.25}
    axes.text(0.0, 1.0, as_written(text), **style).set_in_layout(False)
