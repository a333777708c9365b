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
    """On the scenes whose trajectories are compared: who reaches the error first, and who comes next."""
    known = [a for a in advantages(chart) if a.scene in _measured(chart, "trajectory")]
    if not known:
        return None
    wanted = known[0].wanted
    own = {curves.task.name: own_points(curves)[0].label for curves in chart.tasks if own_points(curves)}
    ahead = [_ahead(scene, [a for a in known if a.scene == scene]) for scene in dict.fromkeys(a.scene for a in known)]
    name = " or ".join(dict.fromkeys(own[a.scene] for a in known))
    question = f"Which engine for an error of {wanted:g}?"
    if any(a.bound == "" and a.time_ratio < 1.0 for a in known):
        return Answer(question, f"Against event-driven ({name}): {'; '.join(ahead)}.")
    return Answer(question, f"Event-driven ({name}), with ten digits to spare: {'; '.join(ahead)}.")


def _measured(chart: Chart, measure: str) -> list[str]:
    return [curves.task.name for curves in chart.tasks if curves.task.measure == measure]


def _ahead(scene: str, those: list[Advantage]) -> str:
    """How the nearest stepped engine does on one scene."""
    reached = [a for a in those if a.bound == "" and not math.isnan(a.time_ratio)]
    if reached:
        nearest = min(reached, key=lambda a: a.time_ratio)
        return f"on {scene} the next, {nearest.label}, takes {amount(nearest.time_ratio)} x the time"
    most = max((a.time_ratio for a in those if a.bound == ">"), default=math.nan)
    return f"on {scene} no other reached it" + ("" if math.isnan(most) else f" in up to {amount(most)} x the time")


def _steps(chart: Chart) -> Answer | None:
    """The largest step with which each engine finds all but one in a hundred contacts."""
    if chart.losses is None:
        return None
    found, never = whole_from(chart.losses)
    parts = [f"{line.label} {line.step:.2g}" for line in found]
    text = f"More than {1.0 - ALL:.0%} are missed where a disk flies more than so many radii a step: {', '.join(parts)}."
    lost = [f"{line.label} (at {line.step:.2g} still {100.0 * line.census.share(line.census.missed):.2g}%)" for line in never]
    text = (text if parts else "") + (f" With every step tried: {', '.join(lost)}." if lost else "")
    return Answer("At which step are contacts lost?", text.strip())


def _energy(chart: Chart) -> Answer | None:
    """The run that loses most while its energy looks perfect."""
    blind = [] if chart.losses is None else blindest(chart.losses)
    if not blind:
        return None
    worst = blind[0]
    return Answer(
        "What does energy hide?",
        f"Lost contacts. {worst.label} at {worst.step:.2g} radii a step keeps it to the last bits and misses "
        f"{worst.census.share(worst.census.missed):.0%} of the contacts; {len(blind)} runs are of this kind.",
    )


def _float64(chart: Chart) -> Answer | None:
    if chart.chaos is None or math.isnan(chart.chaos.slope):
        return None
    return Answer(
        "Where does float64 end?",
        f"After {chart.chaos.horizon:.0f} contacts of each disk in this gas: {chart.chaos.slope:.2g} bits are lost in each. "
        "From there on only statistics are true, or the certified engine with more bits.",
    )


def _stepped_wins(chart: Chart) -> Answer | None:
    """Where a stepped engine is nearer to the truth in less time, and where the best of them comes nearest to that."""
    places = [win for curves in chart.tasks if (win := winning(curves)) is not None]
    question = "Where does a stepped engine win?"
    if not places:
        return Answer(question, "On none of these scenes.") if advantages(chart) else None
    parts = [f"on the {win.scene} {win.label} is within {win.error:.1g} of rest {amount(win.ratio)} x sooner" for win in places]
    return Answer(question, f"Where contacts last: {'; '.join(parts)}. Event-driven pays for ever more contacts there.")


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
