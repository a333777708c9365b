"""What a study finds: quantities with bars, tables of columns, and what is to be said about them."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np

from eventsim.measure.measures import Measure
from eventsim.record.events import Floats

Columns: TypeAlias = dict[str, list[float]]
"""Name -> numbers; NaN where there is none."""


def lasting(times: Floats, told: Floats, name: str) -> Columns:
    """The share of `times` (n,) that are longer than each of `told`, a column of this name, with its error."""
    share = 1.0 - np.searchsorted(np.sort(times), told, side="right") / len(times)
    return {"time": told.tolist(), name: share.tolist(), "error": np.sqrt(share * (1.0 - share) / len(times)).tolist()}


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
