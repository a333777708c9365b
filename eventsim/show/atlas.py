"""The atlas as a readable matrix: hard scenes down, engines across, a verdict in each cell."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from matplotlib import rc_context
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from eventsim import suffixes
from eventsim.record.files.atomic import atomic_write
from eventsim.show.output import suffix_of
from eventsim.show.palette import LIGHT
from eventsim.validation.stress.catalogue import CASES
from eventsim.validation.stress.verdict import Verdict, Word

COLOURS = {
    Word.RIGHT: "#009E73",
    Word.REFUSED: "#C9CED6",
    Word.INACCURATE: "#F6D55C",
    Word.ENERGY: "#E69F00",
    Word.WRONG: "#D55E00",
    Word.SLOW: "#7A2A6B",
}
"""Safe for the colour-blind, and the cells say in words what they show."""

LIGHT_TEXT = (Word.RIGHT, Word.WRONG, Word.SLOW)

ROW, COLUMN, NAMES, HEAD, FOOT, DPI = 0.205, 0.92, 4.7, 0.75, 0.45, 150
"""Inches: a cell, the column of names, room above and below; dots per inch."""


def write_atlas(verdicts: Sequence[Verdict], path: Path) -> None:
    """Draw the verdicts to `path`: .png, .svg or .pdf.

    Raises EventsimError where the suffix is unknown or the file cannot be written.
    """
    suffix = suffix_of(path, suffixes.FIGURES, "the atlas")
    with rc_context({"svg.hashsalt": "eventsim", "svg.fonttype": "path"}):
        figure = _drawn(verdicts)
        FigureCanvasAgg(figure)
        dates = {".png": {}, ".svg": {"Date": None}, ".pdf": {"CreationDate": None}}
        with atomic_write(path) as part:
            figure.savefig(part, format=suffix[1:], metadata=dates[suffix])


def _drawn(verdicts: Sequence[Verdict]) -> Figure:
    cases = list(dict.fromkeys(v.case for v in verdicts))
    engines = list(dict.fromkeys(v.engine for v in verdicts))
    width, height = NAMES + COLUMN * len(engines) + 0.15, HEAD + ROW * len(cases) + FOOT
    figure = Figure(figsize=(width, height), dpi=DPI, facecolor="white")
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set(xlim=(0.0, width), ylim=(height, 0.0))
    axes.axis("off")
    for row, name in enumerate(cases):
        y = HEAD + (row + 0.5) * ROW
        label, _, _ = name.partition("-")
        axes.text(0.12, y, label.upper(), fontsize=7, color=LIGHT.faint, va="center")
        axes.text(0.48, y, CASES[name].title, fontsize=7.4, color=LIGHT.ink, va="center")
    for column, engine in enumerate(engines):
        x = NAMES + (column + 0.5) * COLUMN
        axes.text(x, HEAD - 0.12, engine, fontsize=8.5, color=LIGHT.ink, ha="center", weight="bold")
    place = {(name, engine): (i, j) for i, name in enumerate(cases) for j, engine in enumerate(engines)}
    for verdict in verdicts:
        row, column = place[verdict.case, verdict.engine]
        x, y = NAMES + column * COLUMN, HEAD + row * ROW
        edge = "#B00020" if verdict.fault else "white"
        axes.add_patch(
            Rectangle((x + 0.015, y + 0.01), COLUMN - 0.03, ROW - 0.02, facecolor=COLOURS[verdict.word], edgecolor=edge)
        )
        ink = "white" if verdict.word in LIGHT_TEXT else LIGHT.ink
        axes.text(
            x + 0.5 * COLUMN, y + 0.53 * ROW, cell_text(verdict), fontsize=6.6, color=ink, ha="center", va="center"
        )
    axes.text(0.12, 0.28, title_of(verdicts), fontsize=10.5, color=LIGHT.ink, va="center")
    _legend(figure, height)
    return figure


def _legend(figure: Figure, height: float) -> None:
    axes, x, y = figure.axes[0], 0.12, height - 0.22
    for word, colour in COLOURS.items():
        axes.add_patch(Rectangle((x, y - 0.07), 0.14, 0.14, facecolor=colour, edgecolor="white"))
        axes.text(x + 0.2, y, word, fontsize=7, color=LIGHT.faint, va="center")
        x += 0.85
    axes.text(
        x + 0.05,
        y,
        "hung: not done within the limit; numbers: the error, in reaches, typical speeds or counts",
        fontsize=7,
        color=LIGHT.faint,
        va="center",
    )


def cell_text(verdict: Verdict) -> str:
    """What a cell says: the word, and the size of an error."""
    if verdict.word is Word.INACCURATE or (verdict.word is Word.WRONG and 0.0 < verdict.error < 1e9):
        return f"{verdict.word[:5] + '.' if verdict.word is Word.INACCURATE else verdict.word} {verdict.error:.1e}"
    if verdict.word is Word.ENERGY:
        return verdict.sentence.removeprefix("energy ").replace(": ", " ")
    return str(verdict.word)


def title_of(verdicts: Sequence[Verdict]) -> str:
    """The verdict of all verdicts."""
    faults = sum(v.fault for v in verdicts)
    scenes = len({v.case for v in verdicts})
    exact = (
        "event-driven engines: right, or refused with a reason"
        if not faults
        else f"event-driven engines: {faults} faults"
    )
    return f"Where methods fail: {scenes} scenes. {exact[0].upper()}{exact[1:]}."
