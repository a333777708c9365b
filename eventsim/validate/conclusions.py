"""What a chart comes to: advantages as numbers, and where a stepped engine is the right choice, in sentences."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from eventsim.validate.chart import Chart
from eventsim.validate.precision import Curves, Point

EVENT_DRIVEN = ("fast", "reference")
WANTED = 1e-2
"""The error at which times are compared: diameters for trajectories, relative for pressures, see `precision` for unrest."""


@dataclass(frozen=True, slots=True)
class Advantage:
    """The event-driven engine against another one on one scene.

    time_ratio: the other's time over its own, both at an error of WANTED or less; inf where only the other one fails to
    reach it, 0 where only the event-driven engine fails, nan where both do.  error_ratio: the other's error over its own at
    equal time; nan where the other one has no run so short.
    """

    scene: str
    label: str
    time_ratio: float
    error_ratio: float


def best_event_driven(curves: Curves) -> list[Point]:
    """The points of the fastest event-driven engine that took part."""
    for label in EVENT_DRIVEN:
        if curves.of(label):
            return curves.of(label)
    return []


def time_at(points: Sequence[Point], error: float) -> float:
    """The least time for which an error was reached; inf where it was not."""
    return min((point.elapsed for point in points if point.error <= error), default=math.inf)


def error_at(points: Sequence[Point], elapsed: float) -> float:
    """The least error that was reached within a time; nan where no run was so short."""
    return min((point.error for point in points if point.elapsed <= elapsed), default=math.nan)


def advantages(chart: Chart) -> list[Advantage]:
    """The event-driven engine against every stepped one, scene by scene."""
    found = []
    for curves in chart.tasks:
        own = best_event_driven(curves)
        if not own:
            continue
        reference = min(own, key=lambda point: point.error)
        mine = time_at(own, WANTED)
        for label in curves.labels:
            if label in (*EVENT_DRIVEN, "certified"):
                continue
            points = curves.of(label)
            theirs = time_at(points, WANTED)
            ratio = math.nan if math.isinf(mine) and math.isinf(theirs) else theirs / mine
            errors = error_at(points, reference.elapsed) / reference.error
            found.append(Advantage(curves.task.name, label, ratio, errors))
    return found


def conclusions(chart: Chart) -> list[str]:
    """The sentences of the figure, one for each question that a reader has."""
    return [*_scenes(chart), *_float64(chart), *_pile(chart)]


def _scenes(chart: Chart) -> list[str]:
    """On each scene with a truth: the advantage at equal error and at equal time."""
    sentences = []
    every = advantages(chart)
    for curves in chart.tasks:
        if curves.task.measure == "unrest":
            continue
        own = best_event_driven(curves)
        others = [advantage for advantage in every if advantage.scene == curves.task.name]
        if not own or not others:
            continue
        reached = [a for a in others if 0.0 < a.time_ratio < math.inf]
        nearest = min(reached, key=lambda a: a.time_ratio, default=None)
        at_time = [a for a in others if not math.isnan(a.error_ratio)]
        closest = min(at_time, key=lambda a: a.error_ratio, default=None)
        text = f"{curves.task.name}: error {WANTED:g} is reached by "
        if nearest is None:
            text += f"{own[0].label} alone"
        elif nearest.time_ratio >= 1.0:
            text += f"{own[0].label} {nearest.time_ratio:,.0f} x faster than by {nearest.label}"
        else:
            text += f"{nearest.label} {1.0 / nearest.time_ratio:,.1f} x faster than by {own[0].label}"
        if closest is not None:
            text += f"; in equal time {closest.label}, the best, errs {closest.error_ratio:.0e} x as much"
        sentences.append(text + ".")
    return sentences


def _float64(chart: Chart) -> list[str]:
    if chart.chaos is None or math.isnan(chart.chaos.slope):
        return []
    return [
        f"float64 ends after {chart.chaos.horizon:.0f} contacts a disk: {chart.chaos.slope:.2g} bits are lost in each; "
        "after that only statistics are true, or the certified engine."
    ]


def _pile(chart: Chart) -> list[str]:
    """Where a stepped engine wins: long contacts."""
    sentences = []
    for curves in chart.tasks:
        own = best_event_driven(curves)
        if curves.task.measure != "unrest" or not own:
            continue
        wins = [
            (point.elapsed / time_at(curves.of(label), point.error), point.error, label)
            for label in curves.labels
            if label not in EVENT_DRIVEN
            for point in own
        ]
        ratio, error, label = max(wins, default=(0.0, 0.0, ""))
        if ratio > 1.0:
            sentences.append(
                f"{curves.task.name}: here a stepped engine wins. {label} is within {error:.0e} of rest {ratio:,.0f} x sooner: "
                f"{own[0].label} pays for each of ever more contacts, and has no state of rest."
            )
        else:
            sentences.append(f"{curves.task.name}: no stepped engine was nearer to rest in less time.")
    return sentences
