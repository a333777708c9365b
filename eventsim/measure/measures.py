"""What was measured: numbers with error bars, theory beside them where it holds, and reasons where there is none."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from eventsim.meant import NamesMeant
from eventsim.measure.correlation import Correlations
from eventsim.measure.profile import Profile
from eventsim.measure.series import TimeSeries
from eventsim.measure.speeds import SpeedHistogram
from eventsim.measure.words import table_text
from eventsim.notebook import html_table


@dataclass(frozen=True, slots=True)
class Measure:
    """A measured number, its standard error, and what theory says.

    Attributes:
        value: NaN where the quantity has no meaning or was not seen; then `doubt` says why.
        error: standard error; NaN where none can be given.
        theory: None where there is none, or where it does not hold.
        unit: in the scene's units.
        doubt: why value or error are missing, or what they do not say; None: nothing speaks against them.
        name: unique.
        accuracy: of the theory, absolute.
        source: of the theory.
        blocks: how many were averaged.
        block_length: time.
        fixed: whether conservation laws fix the value, so that it has no error.
    """

    value: float
    error: float = math.nan
    theory: float | None = None
    unit: str = "1"
    doubt: str | None = None
    name: str = ""
    accuracy: float = 0.0
    source: str | None = None
    blocks: int = 0
    block_length: float = math.nan
    fixed: bool = False

    @property
    def deviation(self) -> float | None:
        """Measured less theory, in standard errors (the theory's own accuracy included); None without either."""
        if self.theory is None or not math.isfinite(self.value):
            return None
        off = self.value - self.theory
        if abs(off) <= 1e-9 * abs(self.theory):  # but for rounding
            return 0.0
        error = 0.0 if self.fixed else self.error
        spread = math.hypot(error, self.accuracy)
        return off / spread if spread > 0.0 and math.isfinite(spread) else None

    def to_dict(self) -> dict[str, Any]:
        """As plain data; None where there is none."""
        return {
            "value": _number(self.value),
            "error": _number(self.error),
            "unit": self.unit,
            "doubt": self.doubt,
            "blocks": self.blocks,
            "block_length": _number(self.block_length),
            "theory": self.theory,
            "accuracy": _number(self.accuracy),
            "deviation": self.deviation,
            "source": self.source,
            "fixed": self.fixed,
        }


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None


@dataclass(frozen=True, slots=True)
class Measures(NamesMeant):
    """What was measured in a run: `measures["Z"].value`, `measures.keys()`, `measures.table()`.

    Attributes:
        disks: those that carry energy.
        tracers: those of mass 0.
        packing_fraction: of the area that disks can cover; None where nothing bounds it.
        table_seen: (area, perimeter) of the region of a centre, where those who move never meet.
        duration: of the run.
        discarded: at its beginning, time; discard_given: whether that was asked for.
        steady: whether the scene can have a steady state at all.
        driven: whether walls keep it up, so that it need not be an equilibrium.
        doubts: reasons why it cannot be, or may not have been, reached.
        quantities: in order.
        speeds: histograms, one a species.
        correlations: mean squared displacement and velocity autocorrelation.
        series: energy, temperature, pressure, collision rate along the run.
        profile: along an axis, where that was asked for.
        legend: what names of quantities mean, sentences: the species, the sides of walls.
    """

    disks: int
    tracers: int
    packing_fraction: float | None
    table_seen: tuple[float, float] | None
    duration: float
    discarded: float
    discard_given: bool
    steady: bool
    driven: bool
    doubts: tuple[str, ...]
    quantities: tuple[Measure, ...]
    speeds: tuple[SpeedHistogram, ...]
    correlations: Correlations
    series: TimeSeries
    profile: Profile | None
    by_name: dict[str, Measure] = field(repr=False)
    legend: tuple[str, ...] = ()

    def __eq__(self, other: object) -> bool:
        """Whether all numbers are the same; what has none in both is equal."""
        if not isinstance(other, Measures):
            return NotImplemented
        return repr(self.to_dict()) == repr(other.to_dict())  # in which nan is like nan

    def __hash__(self) -> int:
        return hash((self.disks, self.duration))

    def __repr__(self) -> str:
        return f"Measures({len(self.quantities)} quantities of {self.disks} disks over {self.duration:g} units of time)"

    def _repr_html_(self) -> str:
        rows = [
            (q.name, q.value, q.error, "" if q.theory is None else q.theory, q.unit, q.doubt or "") for q in self.quantities
        ]
        return html_table(repr(self), ("", "value", "error", "theory", "unit", "doubt"), rows)

    @property
    def equilibrated(self) -> bool:
        """Whether nothing speaks against a steady state."""
        return self.steady and not self.doubts

    def __getitem__(self, name: str) -> Measure:
        if name not in self.by_name:
            raise KeyError(f"{name}; there are {', '.join(self.by_name)}")
        return self.by_name[name]

    def __contains__(self, name: object) -> bool:
        return name in self.by_name

    def __iter__(self) -> Iterator[str]:
        return iter(self.by_name)

    def __len__(self) -> int:
        return len(self.by_name)

    def items(self) -> tuple[tuple[str, Measure], ...]:
        """The names and the measures of all quantities, in order."""
        return tuple(self.by_name.items())

    def keys(self) -> tuple[str, ...]:
        """The names of all quantities, in order."""
        return tuple(self.by_name)

    def table(self) -> str:
        """The quantities as aligned lines: measured, theory, difference, where the theory comes from, doubts; the legend."""
        return "\n".join([table_text(self.quantities), *(f"  {line}" for line in self.legend)])

    def to_dict(self) -> dict[str, Any]:
        """As plain data, for JSON."""
        return {
            "disks": self.disks,
            "tracers": self.tracers,
            "packing_fraction": self.packing_fraction,
            "table": None if self.table_seen is None else {"area": self.table_seen[0], "perimeter": self.table_seen[1]},
            "duration": self.duration,
            "discarded": self.discarded,
            "discard_given": self.discard_given,
            "steady": self.steady,
            "driven": self.driven,
            "equilibrated": self.equilibrated,
            "doubts": list(self.doubts),
            "quantities": {quantity.name: quantity.to_dict() for quantity in self.quantities},
            "speeds": [histogram.to_dict() for histogram in self.speeds],
            "correlations": self.correlations.to_dict(),
            "series": self.series.to_dict(),
            "profile": None if self.profile is None else self.profile.to_dict(),
        }
