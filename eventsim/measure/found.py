"""What a study finds: quantities with bars, tables of columns, and what is to be said about them."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, TypeAlias

from eventsim.measure.measures import Measure

Columns: TypeAlias = dict[str, list[float]]
"""Name -> numbers; NaN where there is none."""


@dataclass(frozen=True, slots=True)
class Found:
    """What a study found in a run.

    Attributes:
        quantities: in order.
        tables: name -> columns.
        notes: sentences.
    """

    quantities: tuple[Measure, ...]
    tables: dict[str, Columns] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    def __getitem__(self, name: str) -> Measure:
        """Return the quantity of a name; KeyError where there is none."""
        for quantity in self.quantities:
            if quantity.name == name:
                return quantity
        raise KeyError(f"{name}; there are {', '.join(quantity.name for quantity in self.quantities)}")

    def to_dict(self) -> dict[str, Any]:
        """As plain data, for JSON; None where there is no number."""
        return {
            "quantities": {quantity.name: quantity.to_dict() for quantity in self.quantities},
            "tables": {
                name: {key: [number if math.isfinite(number) else None for number in column] for key, column in one.items()}
                for name, one in self.tables.items()
            },
            "notes": list(self.notes),
        }
