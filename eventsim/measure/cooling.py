"""How the energy falls with the number of contacts: Haff's law in its own variable."""

from __future__ import annotations

import numpy as np

from eventsim.record.events import Floats, Kind, Rows

MOST_POINTS = 4096


class Cooling:
    """The kinetic energy after every so many pair contacts; the stride doubles when there are too many points."""

    def __init__(self, energy: float) -> None:
        self._stride = 1
        self._contacts = 0
        self._energies = [energy]

    def add(self, rows: Rows, energy: Floats) -> None:
        """Add rows and the energy (R,) after each."""
        after = energy[rows["kind"] == Kind.PAIR]
        due = self._stride - self._contacts % self._stride
        self._energies += after[due - 1 :: self._stride].tolist()
        self._contacts += len(after)
        while len(self._energies) > MOST_POINTS:
            self._energies = self._energies[::2]
            self._stride *= 2

    def points(self) -> tuple[Floats, Floats]:
        """(number of pair contacts, energy then), both (P,)."""
        energy: Floats = np.array(self._energies)
        return self._stride * np.arange(len(energy), dtype=np.float64), energy
