"""Two panels on one gas: contacts that are missed, and the energy that does not show it, against the step."""

from __future__ import annotations

import math
from collections.abc import Callable
from textwrap import fill

from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator, NullFormatter, NullLocator

from eventsim.show.figures.style import label
from eventsim.show.palette import LIGHT
from eventsim.show.versus.colours import NAMES, look
from eventsim.show.versus.notes import ACROSS, note
from eventsim.validation.compare import Comparison, Line
from eventsim.validation.verdict import ALL, PERFECT_ENERGY, ROUNDING, blindest

STEP = "step: radii that a typical disk flies in it"

NOTE_LETTERS = 20
"""In a line of a note: a wide one would hide curves."""

PERFECT = "#eef3ea"
"""Background where energy says that all is well."""

BESIDE = 1.3
"""How far the axis of steps goes beyond the least and the largest, as a factor."""

NONE = 0.2
"""Per cent: where runs that miss no contact are drawn, at most; half a contact may be more, and would lie above real losses."""


def draw_missed(axes: Axes, comparison: Comparison) -> None:
    """Contacts missed, per cent of those ahead of exact states; runs that miss none lie on the lower edge."""
    least = min(NONE, 50.0 / max([1, *(line.census.exact for line in comparison.lines)]))  # half a contact
    _draw(axes, comparison, lambda line: max(100.0 * line.census.share(line.census.missed), least))
    bound = 100.0 * (1.0 - ALL)
    axes.axhline(bound, color=LIGHT.ink, lw=0.9, ls=(0, (4, 3)))
    note(axes, "1 in 100", (0.0, bound), ACROSS, (4, 3))
    axes.set_ylim(0.8 * least, 130.0)
    axes.set_yticks([1.0, 10.0, 100.0], ["1", "10", "100"])
    axes.set_yticks([least], ["none"], minor=True)
    label(axes, STEP, "contacts missed [%]", "At which step are contacts lost?")


def draw_energy(axes: Axes, comparison: Comparison) -> None:
    """The relative change of energy of the same runs."""
    _draw(axes, comparison, lambda line: math.nan if line.energy is None else max(abs(line.energy), ROUNDING))
    largest = max((abs(line.energy) for line in comparison.lines if line.energy is not None), default=0.0)
    axes.set_ylim(0.3 * ROUNDING, 3.0 * max(largest, 1.0) if math.isfinite(largest) else 3.0)
    axes.axhspan(0.3 * ROUNDING, PERFECT_ENERGY, color=PERFECT, zorder=0)
    blind = blindest(comparison)
    text = "green: energy looks perfect"
    if blind:
        share = blind[0].census.share(blind[0].census.missed)
        text += f", yet up to {share:.0%} of the contacts are missed ({blind[0].label})"
    note(axes, fill(text, NOTE_LETTERS), (0.02, 1e-10), ACROSS, va="top", back=PERFECT)
    label(axes, STEP, "relative change of energy", "What does energy hide? The losses")


def _draw(axes: Axes, comparison: Comparison, value: Callable[[Line], float]) -> None:
    """A curve for each engine."""
    for name in dict.fromkeys(line.label for line in comparison.lines):
        lines = [line for line in comparison.lines if line.label == name]
        style = look(name).drawn(5.5)
        axes.plot([line.step for line in lines], [value(line) for line in lines], lw=1.3, label=NAMES.get(name, name), **style)
    scale_steps(axes, comparison)
    axes.set_yscale("log")


def scale_steps(axes: Axes, comparison: Comparison) -> None:
    """Make the axis of steps logarithmic, the same for all panels, with labels that do not run into each other.

    Within a decade these are few and plain numbers.
    """
    axes.set_xscale("log")
    axes.xaxis.set_minor_formatter(NullFormatter())
    steps = [line.step for line in comparison.lines]
    if steps:
        axes.set_xlim(min(steps) / BESIDE, max(steps) * BESIDE)
    if steps and max(steps) < 10.0 * min(steps):
        axes.xaxis.set_major_locator(MaxNLocator(4))
        axes.xaxis.set_major_formatter("{x:.3g}")
        axes.xaxis.set_minor_locator(NullLocator())
