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

PARTS = 32
"""Lines of a series, or fewer where less is known."""


@dataclass(frozen=True, slots=True)
class TimeSeries:
    """Columns (K,), a line for each part of the run.

    Attributes:
        time: at the end of the part, since the start of the run.
        contacts: of a disk with others, since what is discarded, by then.
        energy: kinetic; at `time` where contacts alone change it, else the mean over the part.
        temperature: kT of that energy; NaN where there is nobody to share it, and below the digits.
        pressure: over the part, on average over directions; NaN where nothing bounds the gas, and under gravity.
        collision_rate: contacts of a disk with others per time, over the part.
    """

    time: Floats
    contacts: Floats
    energy: Floats
    temperature: Floats
    pressure: Floats
    collision_rate: Floats

    def to_dict(self) -> dict[str, Any]:
        """As plain data."""
        return {field.name: getattr(self, field.name).tolist() for field in fields(self)}


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
    records: Records, time: Floats, contacts: Floats, energy: Floats, mean_energy: Floats, span: Floats, virial: Floats
) -> TimeSeries:
    """Return the series; contacts (K + 1,) at the ends of the parts, the other arrays (K,)."""
    ensemble = records.ensemble
    kt = np.full(len(time), np.nan)
    pressure = kt.copy()
    # after a kick nobody knows what is conserved
    common = ensemble.kept_momenta > 0 or ensemble.angular_momentum is not None
    if ensemble.n > 1 and records.on_a_line is None and not (ensemble.kicked and common) and not ensemble.falls:
        turning = records.turning_at(time)
        kt = np.array([ensemble.temperature(float(e)) for e in energy - turning])
        if ensemble.area is not None and ensemble.alone and ensemble.scene.gravity is None and not ensemble.turns:
            mean = np.array([ensemble.temperature(float(e)) for e in mean_energy - turning])
            pressure = (ensemble.n * mean + 0.5 * virial / span) / ensemble.area
    return TimeSeries(time, contacts[1:], energy, kt, pressure, np.diff(contacts) / span)
