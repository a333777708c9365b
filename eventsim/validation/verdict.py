"""What a comparison comes to, in sentences."""

from __future__ import annotations

import math

from eventsim.validation.advantages import amount
from eventsim.validation.compare import Comparison, Line

PERFECT_ENERGY = 1e-9
"""Relative; a run that keeps its energy so well looks perfect to who looks at nothing else."""

ROUNDING = 1e-16
"""What no energy is kept better than, whatever the difference of two sums says."""

ENOUGH, ALL = 0.98, 0.99
"""Shares of contacts: below the first one contacts go missing; from the second one all are found."""


def verdict(comparison: Comparison) -> list[str]:
    """The sentences, the most important first."""
    if not comparison.lines:
        return ["Nothing was compared: no engine came to the end of its run. A longer --patience gives them more time."]
    sentences = [*_energy(comparison), *_complete(comparison), *_stuck(comparison), *_orders(comparison)]
    return sentences or ["No engine lost a contact with any of these steps."]


def blindest(comparison: Comparison) -> list[Line]:
    """The runs whose energy looks perfect while contacts go missing, the worst first."""
    blind = [
        line
        for line in comparison.lines
        if line.energy is not None and abs(line.energy) < PERFECT_ENERGY and line.census.share(line.census.found) < ENOUGH
    ]
    return sorted(blind, key=lambda line: line.census.share(line.census.found))


def _energy(comparison: Comparison) -> list[str]:
    blind = blindest(comparison)
    if not blind:
        return []
    worst = blind[0]
    census = worst.census
    return [
        f"Energy hides it: {worst.label} at {worst.step:.2g} radii a step looks perfect by it, "
        f"and finds {census.share(census.found):.0%} of the contacts ahead of exact states.",
        f"It keeps the energy to {max(abs(worst.energy or 0.0), ROUNDING):.0e}.",
        f"Over the whole run it has {worst.ratio:.0%} of the true number of contacts.",
        *([] if math.isnan(census.angle) else [f"The angles of those that it finds are {census.angle:.2g} degrees off."]),
        f"Of this kind are {len(blind)} of {len(comparison.lines)} runs.",
    ]


def whole_from(comparison: Comparison) -> tuple[list[Line], list[Line]]:
    """(the run with the largest step that finds ALL contacts, for each engine; the best run of each that never does)."""
    whole, never = [], []
    for label in dict.fromkeys(line.label for line in comparison.lines):
        lines = [line for line in comparison.lines if line.label == label and line.census.exact]
        good = [line for line in lines if line.census.share(line.census.found) >= ALL]
        if good:
            whole.append(max(good, key=lambda line: line.dt))
        elif lines:
            never.append(max(lines, key=lambda line: line.census.share(line.census.found)))
    return whole, never


def _complete(comparison: Comparison) -> list[str]:
    good, bad = whole_from(comparison)
    whole = [
        f"{line.label} finds {ALL:.0%} of the contacts from {line.step:.2g} radii a step on, "
        f"in {amount(line.elapsed / comparison.exact.elapsed)} x the time of the event-driven run."
        for line in sorted(good, key=lambda line: line.elapsed)
    ]
    never = [
        f"{line.label} finds {line.census.share(line.census.found):.1%} at most, at {line.step:.2g} radii a step." for line in bad
    ]
    return whole + never


def _stuck(comparison: Comparison) -> list[str]:
    free = comparison.truth.mean_free_time
    worst = max(comparison.lines, key=lambda line: line.stuck, default=None)
    if worst is None or worst.stuck <= free:
        return []
    return [
        f"{worst.label} with a step of {worst.step:.2g} radii holds a disk at a wall for {worst.stuck:.3g} time units "
        f"({worst.stuck / free:.0f} mean free times)."
    ]


def _orders(comparison: Comparison) -> list[str]:
    known = {label: order for label, order in comparison.orders.items() if math.isfinite(order)}
    if not known:
        return []
    orders = ", ".join(f"{label} {order:.1f}" for label, order in known.items())
    return [f"Measured orders of convergence (position against step): {orders}."]
