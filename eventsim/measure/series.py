"""Series along a run: energy, temperature, pressure and collision rate against time and against the contacts of a disk.

Where contacts alone change the energy, the run is cut into parts of equal numbers of contacts, so a gas that cools by many
decades is told as well at its end as at its beginning; else into parts of equal time.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from eventsim.measure import sums
from eventsim.measure.records import Records
from eventsim.record.events import Floats

PARTS = 64
"""Lines of a series, or fewer where less is known."""


@dataclass(frozen=True, slots=True)
class TimeSeries:
    """Columns (K,), a line for each part of the run.

    Attributes:
        time: at the end of the part, since the start of the run.
        contacts: of a disk with others, since what is discarded, by then.
        energy: kinetic; at `time` where contacts alone change it, else the mean over the part.
        temperature: kT of that energy; NaN where disks did not share it out, and below the digits.
        pressure: over the part, on average over directions: N kT / area, and what contacts carry; NaN where nothing bounds the
            gas, and under gravity.
        collision_rate: contacts of a disk with others per time, over the part.
        begin: time where the first part begins.
        start_energy: kinetic, at `begin`, where contacts alone change it; None: energies are means over parts.
    """

    time: Floats
    contacts: Floats
    energy: Floats
    temperature: Floats
    pressure: Floats
    collision_rate: Floats
    begin: float = 0.0
    start_energy: float | None = None

    @property
    def ends(self) -> Floats:
        """The times (K + 1,) between which the parts are."""
        return np.concatenate([[self.begin], self.time])

    def to_dict(self) -> dict[str, Any]:
        """The columns as plain data."""
        columns = {field.name: getattr(self, field.name) for field in fields(self)}
        return {name: column.tolist() for name, column in columns.items() if isinstance(column, np.ndarray)}


def series_of(records: Records) -> TimeSeries:
    """Return the series of a run."""
    ensemble = records.ensemble
    if not ensemble.conserved and ensemble.scene.gravity is None and records.sums.counts[sums.POINTS] > 1:
        return _along_contacts(records)
    return _along_time(records)


def _along_contacts(records: Records) -> TimeSeries:
    counts, ensemble = records.sums.counts, records.ensemble
    points = records.sums.points[: counts[sums.POINTS]]
    stride = int(counts[sums.STRIDE])
    step = -(-len(points) // PARTS)
    chosen = np.arange(step - 1, len(points), step)
    begin = np.zeros((1, sums.POINT_COLUMNS))
    begin[0, sums.POINT_ENERGY] = ensemble.start_energy
    line = np.concatenate([begin, points[chosen]])
    number = np.concatenate([[0], (chosen + 1) * stride])
    span = np.diff(line[:, sums.POINT_TIME])
    energy = line[:, sums.POINT_ENERGY]
    virial = np.diff(line[:, sums.POINT_VIRIAL])
    return _series(
        records,
        line[1:, sums.POINT_TIME],
        2.0 * number / ensemble.n,
        energy[1:],
        np.diff(line[:, sums.POINT_ACTION]) / span,
        span,
        virial,
        ensemble.start_energy,
    )


def _along_time(records: Records) -> TimeSeries:
    step = -(-records.count // PARTS)
    first = np.arange(0, records.count, step)

    def parts(channel: Floats) -> Floats:
        """Sums over the bins of each part."""
        found: Floats = np.add.reduceat(channel, first)
        return found

    span = parts(records.all_widths)
    time = records.origin + np.cumsum(span)
    met = np.cumsum(parts(records.all_contacts))
    movers = max(int(records.ensemble.movers.sum()), 1)
    energy = parts(records.bins[:, sums.ENERGY]) / span
    virial = parts(records.reach_force)
    contacts = np.concatenate([[0.0], met / movers])
    return _series(records, time, contacts, energy, energy, span, virial)


def _series(
    records: Records,
    time: Floats,
    contacts: Floats,
    energy: Floats,
    mean_energy: Floats,
    span: Floats,
    virial: Floats,
    start_energy: float | None = None,
) -> TimeSeries:
    """Return the series; contacts (K + 1,) at the ends of the parts, the other arrays (K,)."""
    ensemble = records.ensemble
    kt = np.full(len(time), np.nan)
    pressure = kt.copy()
    # after a kick nobody knows what is conserved
    common = ensemble.kept_momenta > 0 or ensemble.angular_momentum is not None
    if records.no_sharing is None and ensemble.held and not (ensemble.kicked and common) and not ensemble.falls:
        turning = records.turning_at(time)
        kt = np.array([ensemble.temperature(float(e)) for e in energy - turning])
        if ensemble.no_common_pressure is None and records.pairs > 0.0:
            assert ensemble.area is not None
            mean = np.array([ensemble.temperature(float(e)) for e in mean_energy - turning])
            pressure = (ensemble.n * mean + 0.5 * virial / span) / ensemble.area
    rate = np.diff(contacts) / span
    begin = records.origin if start_energy is None else 0.0  # contacts are counted from the start
    return TimeSeries(time, contacts[1:], energy, kt, pressure, rate, begin, start_energy)
