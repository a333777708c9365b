"""Radii by rule: the law that the sizes of many disks are drawn from."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from eventsim.scene.disks import Floats
from eventsim.scene.numbers import RADII, is_length

RULES = {
    "uniform": "two radii [least, largest]",
    "lognormal": "[median, sigma], sigma the standard deviation of the logarithm",
    "values": "a list of radii, with weights = [...] beside it, or all alike",
}
"""What a rule is followed by in a scene file."""


@dataclass(frozen=True, slots=True)
class Sizes:
    """A law for radii.

    Attributes:
        rule: a key of RULES.
        numbers: what follows it.
        weights: of the values; empty: all alike.
    """

    rule: str
    numbers: tuple[float, ...]
    weights: tuple[float, ...] = ()

    def problems(self) -> Iterator[str]:
        """Every rule that the numbers break, one sentence each."""
        numbers = list(self.numbers)
        if self.rule == "uniform" and not (is_length(numbers[0]) and is_length(numbers[1]) and numbers[0] <= numbers[1]):
            yield f"uniform = {numbers}: must be lengths [least, largest], above 0, the least first"
        if self.rule == "lognormal" and not (is_length(numbers[0]) and 0.0 <= numbers[1] <= 2.0):
            yield f"lognormal = {numbers}: must be [median, sigma], a length above 0 and a number from 0 to 2"
        if self.rule == "values" and not (numbers and all(x == 0.0 or is_length(x) for x in numbers)):
            yield f"values = {numbers}: at least one, and each {RADII}"
        if self.weights and (
            len(self.weights) != len(numbers) or not all(0.0 <= w < math.inf for w in self.weights) or not sum(self.weights)
        ):
            yield f"weights = {list(self.weights)}: must be one for each of the {len(numbers)} values, at least 0, not all 0"

    def drawn(self, count: int, rng: np.random.Generator) -> Floats:
        """Radii (count,), one random number for each."""
        radii: Floats
        if self.rule == "uniform":
            radii = self.numbers[0] + (self.numbers[1] - self.numbers[0]) * rng.random(count)
        elif self.rule == "lognormal":
            radii = self.numbers[0] * np.exp(self.numbers[1] * rng.standard_normal(count))
        else:
            shares = np.cumsum(self.weights or np.ones(len(self.numbers)))
            chosen = np.searchsorted(shares, shares[-1] * rng.random(count), side="right")
            radii = np.array(self.numbers)[np.minimum(chosen, len(self.numbers) - 1)]
        return radii
