"""What an event-driven run is ahead of each other engine by: time at equal error, error at equal time, scene by scene."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from eventsim.validation.chart import Chart
from eventsim.validation.precision import Curves, Point

OWN = ("fast", "reference")
"""The engines that speak for event-driven simulation, the best first."""

BALLS, PLAIN = "certified", "plain"
"""Event-driven too: the reference engine on balls, and with the plain formula alone; nothing that they could be ahead of."""

WANTED = {"trajectory": 1e-3, "pressure": 1e-2, "unrest": 1e-2}
"""The errors at which times are compared, by measure; a pressure has chance in it that is not much smaller."""


@dataclass(frozen=True, slots=True)
class Advantage:
    """The event-driven engine against another one on one scene.

    wanted: the error at which times are compared.  time_ratio: the other's time over the event-driven one; `bound` ">": the
    other one did not come to this error, and this is how much longer its longest run took; "<": the event-driven engine did
    not; nan where neither did.  error_ratio: the other's error over the event-driven one in the same time; nan where even its
    coarsest run takes longer.
    """

    scene: str
    label: str
    wanted: float
    time_ratio: float
    bound: str
    error_ratio: float


def own_points(curves: Curves) -> list[Point]:
    """The points of the best event-driven engine that took part."""
    return next((curves.of(label) for label in OWN if curves.of(label)), [])


def stepped_labels(curves: Curves) -> list[str]:
    """The time-stepped engines that took part."""
    return [label for label in curves.labels if label not in (*OWN, BALLS, PLAIN)]


def time_at(points: Sequence[Point], error: float) -> float:
    """The least time for which an error was reached; inf where it was not."""
    return min((point.elapsed for point in points if point.error <= error), default=math.inf)


def error_at(points: Sequence[Point], elapsed: float) -> float:
    """The least error that was reached within a time; nan where no run was so short."""
    return min((point.error for point in points if point.elapsed <= elapsed), default=math.nan)


def advantages_on(curves: Curves) -> list[Advantage]:
    """The event-driven engine against every stepped one on one scene."""
    own = own_points(curves)
    if not own:
        return []
    wanted = WANTED[curves.task.measure]
    best = min(own, key=lambda point: point.error)
    found = []
    for label in stepped_labels(curves):
        points = curves.of(label)
        ratio, bound = _ratio(own, points, wanted)
        error_ratio = error_at(points, best.elapsed) / best.error
        found.append(Advantage(curves.task.name, label, wanted, ratio, bound, error_ratio))
    return found


def _ratio(own: Sequence[Point], points: Sequence[Point], wanted: float) -> tuple[float, str]:
    """(the other's time over its own at the wanted error, "" or which way it is a bound)."""
    mine, theirs = time_at(own, wanted), time_at(points, wanted)
    if math.isinf(mine):
        longest = max(point.elapsed for point in own)
        return (math.nan, "") if math.isinf(theirs) else (theirs / longest, "<")
    if math.isinf(theirs):
        return max(point.elapsed for point in points) / mine, ">"
    return theirs / mine, ""


def advantages(chart: Chart) -> list[Advantage]:
    """The event-driven engine against every stepped one, scene by scene."""
    return [advantage for curves in chart.tasks for advantage in advantages_on(curves)]


def table(chart: Chart) -> tuple[list[str], list[list[str]]]:
    """(head, rows): an engine in each row, its times and errors on each scene in the columns, as texts."""
    every = {(advantage.label, advantage.scene): advantage for advantage in advantages(chart)}
    labels = list(dict.fromkeys(label for label, _ in every))
    head = [f"{curves.task.name}: {WANTED[curves.task.measure]:g}" for curves in chart.tasks]
    rows = []
    for label in labels:
        cells = [cell(every.get((label, curves.task.name))) for curves in chart.tasks]
        rows.append([label, *cells])
    return ["engine", *head], rows


def cell(advantage: Advantage | None) -> str:
    """Two numbers: times the time at equal error, times the error in equal time."""
    if advantage is None:
        return "left out"
    time = "-" if math.isnan(advantage.time_ratio) else f"{advantage.bound}{amount(advantage.time_ratio)}"
    error = "-" if math.isnan(advantage.error_ratio) else amount(advantage.error_ratio)
    return f"{time} | {error}"


def amount(value: float) -> str:
    """A factor in few letters: 0.4, 3.2, 38, 1200, 2e14."""
    if value >= 1e5:
        return f"{value:.0e}".replace("e+", "e")
    return f"{value:.2g}" if value < 10.0 else f"{float(f'{value:.2g}'):.0f}"
