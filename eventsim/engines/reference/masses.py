"""What disks weigh: their masses, alone and in pairs."""

from __future__ import annotations

import math

from eventsim.formulas.impulse import mass_fractions, reduced_mass
from eventsim.formulas.real import Real
from eventsim.scene.stage import Stage


class Masses:
    """The masses of a stage's disks: one for all, or a list with 0 (tracers) and inf (immovable disks) in it."""

    def __init__(self, stage: Stage) -> None:
        self._each: list[float] | None = None if stage.mass is None else stage.mass.tolist()
        self._same: float = stage.common_mass

    def of(self, i: int) -> float:
        """The mass of disk i."""
        return self._same if self._each is None else self._each[i]

    def is_immovable(self, i: int) -> bool:
        """Whether nothing moves disk i."""
        return self._each is not None and math.isinf(self._each[i])

    def is_usual(self, i: int) -> bool:
        """Whether disk i is neither a tracer nor immovable."""
        return 0.0 < self.of(i) < math.inf

    def shares(self, a: int, b: int) -> tuple[Real, Real]:
        """Of the sum of two masses."""
        return (0.5, 0.5) if self._each is None else mass_fractions(self._each[a], self._each[b])

    def reduced(self, a: int, b: int) -> float:
        """The reduced mass of two disks."""
        return 0.5 * self._same if self._each is None else reduced_mass(self._each[a], self._each[b])
