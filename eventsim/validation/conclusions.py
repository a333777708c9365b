"""What a chart comes to: the five questions that a reader has, each with its answer in a sentence or two."""

from __future__ import annotations

import math
from typing import NamedTuple

from eventsim.validation.advantages import Advantage, advantages, amount, own_points, stepped_labels, time_at
from eventsim.validation.chart import Chart
from eventsim.validation.precision import Curves
from eventsim.validation.verdict import ALL, blindest, whole_from


class Answer(NamedTuple):
    """A question and what the chart says to it."""

    question: str
    answer: str

    def __str__(self) -> str:
        return f"{self.question} {self.answer}"


def conclusions(chart: Chart) -> list[Answer]:
    """The answers that this chart can give."""
    every = [_engine(chart), _steps(chart), _energy(chart), _float64(chart), _stepped_wins(chart)]
    return [answer for answer in every if answer is not None]


def _engine(chart: Chart) -> Answer | None:
    """On the first scene whose trajectories are compared: by what the first engine is ahead of the next."""
    known = [a for a in advantages(chart) if a.scene in _measured(chart, "trajectory")]
    if not known:
        return None
    scene = known[0].scene
    question = f"Which engine for positions to {known[0].wanted:g} diameters?"
    return Answer(question, _ahead(scene, [a for a in known if a.scene == scene]))


def _measured(chart: Chart, measure: str) -> list[str]:
    return [curves.task.name for curves in chart.tasks if curves.task.measure == measure]


def _ahead(scene: str, those: list[Advantage]) -> str:
    """How the nearest stepped engine does on one scene."""
    reached = [a for a in those if a.bound == "" and not math.isnan(a.time_ratio)]
    if reached:
        nearest = min(reached, key=lambda a: a.time_ratio)
        if nearest.time_ratio < 1.0:
            return f"On {scene} {nearest.label}: event-driven takes {amount(1.0 / nearest.time_ratio)} x its time."
        return f"Event-driven: on {scene} the next, {nearest.label}, takes {amount(nearest.time_ratio)} x the time."
    most = max((a.time_ratio for a in those if a.bound == ">"), default=math.nan)
    if math.isnan(most):
        return f"None of them reaches it on {scene}."
    if most < 1.0:
        return f"Event-driven: on {scene} no other reached it in the time that it was given."
    return f"Event-driven: on {scene} no other reached it in up to {amount(most)} x the time."


def _steps(chart: Chart) -> Answer | None:
    """The largest step with which any engine finds all but one in a hundred contacts."""
    if chart.losses is None:
        return None
    question = "At which step are contacts lost?"
    found, _ = whole_from(chart.losses)
    if not found:
        return Answer(question, f"With every step that was tried, more than {1.0 - ALL:.0%} are.")
    best = max(found, key=lambda line: line.step)
    return Answer(question, f"Above {best.step:.2g} radii a step every engine loses more than 1 in 100 (the best: {best.label}).")


def _energy(chart: Chart) -> Answer | None:
    """The run that loses most while its energy looks perfect."""
    blind = [] if chart.losses is None else blindest(chart.losses)
    if not blind:
        return None
    worst = blind[0]
    lost = worst.census.share(worst.census.missed)
    text = f"Lost contacts: {worst.label} at {worst.step:.2g} radii a step misses {lost:.0%} and looks perfect by it."
    return Answer("What does energy hide?", text)


def _float64(chart: Chart) -> Answer | None:
    if chart.chaos is None or math.isnan(chart.chaos.slope):
        return None
    text = f"After {chart.chaos.horizon:.0f} contacts of each disk; then only statistics are true."
    return Answer("Where does float64 end?", text)


def _stepped_wins(chart: Chart) -> Answer | None:
    """Where a stepped engine is nearer to the truth in less time."""
    wins = [win for curves in chart.tasks if (win := winning(curves)) is not None]
    question = "Where does a stepped engine win?"
    if not wins:
        none = "Not on this scene." if len(chart.tasks) == 1 else "On none of these scenes."
        return Answer(question, none) if advantages(chart) else None
    win = max(wins, key=lambda one: one.ratio)
    return Answer(question, f"Where contacts last: on {win.scene} {win.label} comes to rest {amount(win.ratio)} x sooner.")


class Win(NamedTuple):
    """Where a stepped engine is ahead: it came to an error that an event-driven run had, in a ratio-th of its time.

    begins: the error below which a stepped engine is the faster one.
    """

    scene: str
    label: str
    error: float
    ratio: float
    begins: float


def winning(curves: Curves) -> Win | None:
    """The largest win of a stepped engine on a scene; None where there is none."""
    wins = [
        Win(curves.task.name, label, point.error, point.elapsed / time_at(curves.of(label), point.error), point.error)
        for label in stepped_labels(curves)
        for point in own_points(curves)
    ]
    wins = [win for win in wins if win.ratio > 1.0]
    if not wins:
        return None
    return max(wins, key=lambda win: win.ratio)._replace(begins=max(win.error for win in wins))
